// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/base/error.hpp>
#include <excavplan/base/measured.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/scans/scan_surface.hpp>

namespace excavplan {

/// Volume of one pile or hole of one scan.
struct PolygonVolume {
  Measured above;     ///< of the ground above the surface that its rim spans [m^3]
  Measured below;     ///< of what is missing below it [m^3]
  double area = 0.0;  ///< of the polygon [m^2]
  /// Scan::doubts, outliers (points without data, left out) and zone_partly_unseen, which ends
  /// trust: over 5 % of the polygon or a stretch of its rim were not seen.
  std::vector<Warning> warnings;
};

/// Compares the ground in a polygon with the surface that its rim spans: the plane through the
/// ground within 0.1 m of the outline, or two cells, and what 24 stretches of it lie off that
/// plane, weighted by the inverse squares of their distances (all ours). The outline has to run on
/// ground that does not belong to pile or hole. What was not seen in it is filled from around.
///
/// The deviations are of the noise of the points; of the rim, by leaving out one stretch after the
/// other, and by half of what it lies off its plane, as the ground inside may bend too (ours); and
/// of the cells: their bend, their sign on even ground, those that were filled.
///
/// @param polygon  corners in the site frame, in either sense, without crossings
/// @throws Error (bad_input) with fewer than three corners or without area; (bad_file) if a file
/// cannot be read, or less than half of the rim or of the polygon was seen
PolygonVolume volume_over(const Scan& scan, const std::vector<Eigen::Vector2d>& polygon);

}  // namespace excavplan
