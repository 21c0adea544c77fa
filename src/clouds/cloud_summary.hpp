// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <excavplan/clouds/cloud.hpp>

#include "clouds/point_stream.hpp"

/// @file Extent and density of points that stream by. Private to the library.

namespace excavplan {

/// The points of a cloud, which must outlive it.
PointSource points_of(const Cloud& cloud);

/// The box of finite points without the farthest 0.1 % on each side.
Eigen::AlignedBox3d usual_box(const PointSource& source, std::size_t finite_points);

/// The plan of a box, which contains() the points on its upper edges.
Rectangle plan_of(const Eigen::AlignedBox3d& box);

/// CloudSummary::density, in cells of some ten points: first if the cloud filled its extent, then
/// as it really does.
double points_per_area(const PointSource& source, std::size_t finite_points,
                       const Rectangle& extent);

/// True of points within 60 degrees of the z axis, ahead, from `nearest` to `farthest` along it:
/// wider than depth cameras see.
bool is_along_z(const Eigen::Vector3d& point, double nearest, double farthest);

/// But for what a file says: width, height and points left out. From four passes.
CloudSummary summary_of(const PointSource& source);

}  // namespace excavplan
