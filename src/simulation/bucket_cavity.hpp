// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/bucket_cavity.hpp>

#include "earth/dig_kernels.hpp"

namespace excavplan {

/// Side view of the bucket's cavity in the boom plane, relative to the tip.
class Cavity {
 public:
  explicit Cavity(const Bucket& bucket);

  void turn_to(double phi3);

  /// As bucket_capacity(), in the attitude it was turned to [m^3].
  double capacity(double support, const HoldingSlopes& slopes) const;

  struct Room {
    double capacity = 0.0;  ///< capacity() [m^3]
    /// How much soil that is pushed in over the lip lies in the cavity, up to the level; the walls
    /// of the cut hold what stands above the side plates [m^3].
    double pushed_in = 0.0;
  };
  /// While the soil ahead stands up to `level` above the lip.
  Room room(double level, const HoldingSlopes& slopes) const;

  /// Soil packed into the corner of floor and back, up to a line through the lip.
  struct Packed {
    double front = 0.0;        ///< angle from the floor to that line [rad]
    Eigen::Vector2d centroid;  ///< in the attitude it was turned to, from the lip [m]
  };
  Packed packed(double volume) const;

  /// Corner i of the profile, in the attitude it was turned to [m].
  const Eigen::Vector2d& corner(std::size_t i) const { return corners_[i]; }
  std::size_t corners() const { return corners_.size(); }

 private:
  static constexpr std::size_t slice_count = 64;
  using EachSlice = std::array<double, slice_count>;
  static ProfileSide side(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  void bound(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  void keep(const EachSlice& open);
  CavitySlices slices() const;
  CavityLoad load(double support, const HoldingSlopes& slopes) const;
  double volume(double height) const;

  const Bucket& bucket_;
  double phi3_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector2d> corners_;
  double left_ = 0.0;  ///< of the first slice [m]
  double slice_width_ = 0.0;
  // Extent of the cavity above the middle x of each slice. Its mouth may be the upper or the lower
  // bound. Once they are all known, the slices open to soil from above or from the lip come first.
  EachSlice x_, low_, high_, lid_;
  EachSlice ahead_, short_of_top_;  ///< as in CavitySlices
  std::size_t open_ = 0;            ///< number of slices open to soil
};

}  // namespace excavplan
