// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>

#include <excavplan/scans/scan_surface.hpp>

#include "ground/obstacles.hpp"

/// @file
/// What a scan shows that a machine must not hit: every return counts, and what must lie between
/// and above the returns of a face, a post or a wire. The surface for volumes shows the ground.

namespace excavplan {

/// On one grid.
struct SeenTops {
  Eigen::ArrayXXd highest;  ///< return of each cell [m]; NaN: there is none
  /// As Terrain::obstacles, obstacle_returns and thin_obstacles.
  Eigen::ArrayXXd obstacles, returns;
  CellMask thin;
};

/// Which returns count.
struct TopsOptions {
  double spacing = 0.05;  ///< usual between returns [m]; obstacles are looked for on such cells
  double ceiling = std::numeric_limits<double>::infinity();  ///< returns above do not count [m]
  std::optional<Rectangle> own;  ///< of the machine where it stands: returns in it do not count
};

/// The tops of what a scan shows on the cells of a map, by one pass over its points, or two where
/// there are obstacles. Obstacles, found by shape (find_obstacles(), of ground to 3 m around the
/// map too), go on by 0.3 m to all sides, which a scan from one side may not see, and upwards by
/// 1.2 times the distance to the next return below, 1 m at most: the next ray above missed. Wires,
/// found as thin lines of returns with nothing between them and the ground, go on to the rim of the
/// map or until their direction is not known to 1 m; nothing passes between or closely above their
/// returns. They are thin, as is what scatters by less than 0.1 m in plan, or hangs over ground
/// seen all around. All numbers ours.
/// @throws Error (bad_file) as read_cloud()
SeenTops seen_tops(const Scan& scan, const HeightMap& grid, const TopsOptions& options);

}  // namespace excavplan
