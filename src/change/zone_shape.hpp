// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ground/grid_cells.hpp"

namespace excavplan {

/// Form of a zone, weighted by its change of height.
struct ZoneShape {
  double length = 0.0;    ///< of the strip of even height with its second moments [m]
  double width = 0.0;     ///< of that strip [m]
  double height = 0.0;    ///< mean of |D| weighted by |D| [m]
  double steepest = 0.0;  ///< slope that a tenth of its cells exceed [-]
  /// height over the |D| that a twentieth of its cells exceed: 1 of a box, 0.75 of half a ball, 0.5
  /// of a cone [-]
  double fullness = 0.0;

  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< along its length

  bool is_strip() const { return length > 3.0 * width; }
  /// Narrow and low, as tracks and what they push aside are.
  bool is_track_wide() const;
  /// Long too.
  bool is_track() const { return is_strip() && is_track_wide(); }
  /// Alike and parallel, as the tracks of one machine are.
  bool is_twin_of(const ZoneShape& other) const;
};

/// @param difference D, after - before [m]
/// @param cells of the zone
ZoneShape shape_of(const Eigen::ArrayXXd& difference, const std::vector<Cell>& cells,
                   double cell_size);

}  // namespace excavplan
