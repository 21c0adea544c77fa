// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/height_map.hpp>

#include <Eigen/Core>

/// @file
/// Where rays of a sensor meet the ground. Private to the project.

namespace excavplan {

constexpr double longest_range = 1e4;  ///< ours: beyond it no sensor sees [m]

/// A surface that rays meet from above; it must outlive this.
class RayTarget {
 public:
  explicit RayTarget(const HeightMap& surface);

  /// Distance along the unit vector `ray` at which it first meets the surface, to half a cell and
  /// between by interpolation [m]; NaN where it does not, where it does not point down and where
  /// unknown ground hides the place.
  double distance(const Eigen::Vector3d& from, const Eigen::Vector3d& ray, double range) const;

 private:
  double march(const Eigen::Vector3d& from, const Eigen::Vector3d& ray, double range) const;
  double way_over(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const;
  double above(const Eigen::Vector3d& point) const;
  bool is_over_tile(const Eigen::Vector3d& point) const;

  const HeightMap& surface_;
  double top_ = 0.0;          // of all known ground
  Eigen::ArrayXXd tile_top_;  // of the ground that tiles of cells and the cells around them know
  double tiles_per_metre_ = 0.0;
};

}  // namespace excavplan
