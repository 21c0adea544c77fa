// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "earth/ground_window.hpp"
#include "simulation/swath.hpp"

namespace excavplan {

/// The pile of loose soil that the bucket pushes before it: level over the wedge that the bucket
/// pushes up, from there it falls by `slope` to the ground ahead and on both sides. It is laid down
/// at rest, as soil on its way there would take many passes of slumping.
class PileAhead {
 public:
  /// Keeps references.
  PileAhead(GroundWindow& ground, const Swath& swath, double bucket_width, double slope)
      : ground_(ground), swath_(swath), half_width_(0.5 * bucket_width), slope_(slope) {}

  /// The lip has come to `lip_x` and pushes a wedge whose top is so long [m].
  void move_to(double lip_x, double level_length);

  /// Makes sure that the ground is known to which a pile with its top at this level reaches; true
  /// if that is more than before.
  bool look(double top);

  /// Soil between the ground and a pile with its top at this level [m^3].
  double volume(double top) const;
  /// By how much that grows per metre [m^2].
  double area(double top) const;

  /// Raises the ground by this share of such a pile, 1 but for rounding; returns the cells that it
  /// is on.
  CellBlock lay(double top, double share);

 private:
  /// Where a column of cells is.
  struct Column {
    Eigen::Index col = 0;
    double along = 0.0;  ///< from the level top in the direction of travel [m]
    double reach = 0.0;  ///< from the level top, up to which soil is sought [m]
  };
  /// Cells in succession of a column that the pile may cover, of each of which the same share lies
  /// ahead of the lip.
  struct Run {
    std::size_t cell = 0;   ///< the first
    std::size_t bases = 0;  ///< where theirs begin
    std::size_t count = 0;
    double share = 0.0;
  };
  void find_rows();
  void look_at_column(Eigen::Index col, double reach);
  void look_at_rows(const Column& column, Eigen::Index first, Eigen::Index end, double share);
  double square(const Column& column, Eigen::Index row) const;

  GroundWindow& ground_;
  const Swath& swath_;
  double half_width_;
  double slope_;
  double lip_x_ = 0.0;
  double level_length_ = 0.0;
  double seen_to_ = 0.0;  ///< top for which all places are known
  double foot_ = 0.0;     ///< of that pile, from its level top [m]
  double foot_square_ = 0.0;
  CellBlock seen_;
  std::vector<double> across_;  ///< of the rows seen, beyond the sides of the bucket [m]
  std::vector<Run> runs_;
  /// Of all cells of the runs, one after another: the level of the pile's top from which on they
  /// are covered. Room that only grows.
  std::vector<double> bases_;
  std::size_t kept_ = 0;  ///< of bases_
  Run partly_;            ///< the run that the lip is in: of all others the share is 1
};

}  // namespace excavplan
