// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulation/ground_window.hpp"
#include "simulation/swath.hpp"

namespace excavplan {

/// The pile of loose soil that the bucket pushes before it: its surface falls from a level crest
/// along the lip, ahead and around both ends, by `slope` down to the ground. It is laid down at
/// rest, as soil on its way there would take many passes of slumping.
class PileAhead {
 public:
  /// Keeps references.
  PileAhead(GroundWindow& ground, const Swath& swath, double bucket_width, double slope)
      : ground_(ground), swath_(swath), half_width_(0.5 * bucket_width), slope_(slope) {}

  /// The bucket has come to `lip_x`, its lip lies there or has left soil there.
  void move_to(double lip_x);

  /// Soil between the ground and a pile with its crest at this level [m^3], and by how much that
  /// grows per metre of crest [m^2].
  struct Size {
    double volume = 0.0;
    double area = 0.0;
  };
  Size size(double crest);

  /// Raises the ground to such a pile; returns the cells of it.
  CellBlock lay(double crest);

 private:
  /// A cell that the pile may cover.
  struct Place {
    std::size_t cell = 0;
    double base = 0.0;   ///< level of the crest from which on the pile covers it [m]
    double share = 0.0;  ///< of it that lies ahead of the lip
  };
  void look(double crest);
  void look_at_column(Eigen::Index col, double reach);

  GroundWindow& ground_;
  const Swath& swath_;
  double half_width_;
  double slope_;
  double lip_x_ = 0.0;
  double seen_to_ = 0.0;  ///< crest for which all places are known
  double foot_ = 0.0;     ///< of that pile, from the lip [m]
  CellBlock seen_;
  std::vector<Place> places_;
};

}  // namespace excavplan
