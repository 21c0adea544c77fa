// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/ground/surface.hpp>

/// @file
/// The ground between the points of a scan whose rings, lines or few points leave cells without
/// any. Private to the project.

namespace excavplan {

/// Fills cells between the points by a thin plate through those around: cells that known ones
/// enclose, where most known ones nearby have an unknown neighbour themselves. At a shadow or
/// another gap in a dense scan that is not so. Filled cells count no points, and their variance
/// stays unknown.
void fill_sampling_gaps(Surface& surface);

/// Variance of the volume of each zone by the ground between the points [m^6]; 0 for zones whose
/// cells hold enough points.
///
/// The ground of a patch of 2 g x 2 g, g being the spacing of the points, is known to about
/// s / sqrt(3), s being the scatter of its known cells about a plane beyond that of stable ground:
/// a face of height h somewhere between two lines of points misplaces g h / sqrt(12) along them,
/// and makes s = h / 4.
///
/// @param zone -1 for stable ground
/// @param count of zones
std::vector<double> variance_between_points(const Surface& surface, const Eigen::ArrayXXi& zone,
                                            std::size_t count);

}  // namespace excavplan
