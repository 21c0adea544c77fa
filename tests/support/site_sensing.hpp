// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "support/site_draft.hpp"

/// @file
/// Families of scenes by how they are scanned and by what the numbers of the clouds mean.

namespace excavplan::scenes {

// ---- Lidars -----------------------------------------------------------------------------------

/// A place beside the scene, `side` -1 or 1, so high above the ground there.
Eigen::Vector3d standpoint(Draft& d, double side, double height);

/// A lidar there whose window holds the scene.
Lidar lidar_at(const SiteScene& scene, const Eigen::Vector3d& position);

/// As many equal steps as give about this many points, at most 100,000; 0.6 of the beams meet the
/// scene.
void step_for(Lidar& lidar, std::size_t points);

/// The sensor came back to its place with an error of a hand or two.
Lidar moved_a_little(Lidar lidar, Random& random);

void scan_by(Draft& d, const std::vector<Lidar>& lidars);

/// Lidars that stand at one side of the scene, or one at either side, `height` up, walls 55-85 deg.
void scan_from(Draft& d, double height, bool both_sides);

void lidar_one(Draft& d);
/// Nothing says where the lidars stood.
void untold(Draft& d, double height, bool both_sides);
void lidar_untold(Draft& d);
void lidar_untold_low(Draft& d);
void lidar_untold_two(Draft& d);
/// One point is left in a voxel, which hides where the lidar stood.
void lidar_untold_thinned(Draft& d);
void lidar_one_low(Draft& d);
void lidar_two(Draft& d);

/// A spinning lidar, tilted so that its rings lie on the scene.
void rings(Draft& d, int count, bool both_sides = false);

void rings16(Draft& d);
void rings32(Draft& d);
void rings64(Draft& d);
void rings128(Draft& d);
/// From two standpoints.
void rings16_two(Draft& d);
void rings32_two(Draft& d);
void rings128_two(Draft& d);

// ---- Points that are few or in rows -----------------------------------------------------------

void sparse(Draft& d);

/// A dig of several metres in a cloud that was thinned to a lattice.
void lattice(Draft& d);

void stripes(Draft& d);

// ---- Points that are none of the ground -------------------------------------------------------

/// 1 % of the points off by up to a metre.
void outliers(Draft& d);
/// The same on uneven ground.
void outliers_rough(Draft& d);
/// The same seen by two lidars.
void outliers_lidars(Draft& d);
/// 2 % of the points lie between what a beam hits at two places.
void flying(Draft& d);
/// 2 % of the points in the hole lie too deep.
void multipath(Draft& d);
/// 2 % of the points hold a number that means "no data".
void no_data(Draft& d);

// ---- What the numbers mean --------------------------------------------------------------------

PointMap scaled(double factor);

PointMap moved(const Eigen::Isometry3d& motion);

Eigen::Vector3d level_direction(Random& random);

void units_mm(Draft& d);
void units_cm(Draft& d);
void one_scan_mm(Draft& d);

void tilted(Draft& d);

/// x right, y down, z forward of a camera beside the scene or above it.
void camera_frame(Draft& d);

/// The scan after is off by 0.3 m and 2 deg, on a slope.
void moved_far(Draft& d);

void swapped(Draft& d);

void swapped_areas(Draft& d);

/// Both scans by the same offset: on the grid of cells, to a far origin, or in UTM.
void offsets(Draft& d);

}  // namespace excavplan::scenes
