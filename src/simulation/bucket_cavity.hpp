// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/bucket_cavity.hpp>

namespace excavplan {

/// Side view of the bucket's cavity in the boom plane, relative to the tip.
class Cavity {
 public:
  explicit Cavity(const Bucket& bucket);

  void turn_to(double phi3);

  /// As bucket_capacity(), in the attitude it was turned to [m^3].
  double capacity(double support, const HoldingSlopes& slopes) const;

  /// How much soil that is pushed in over the lip lies in the cavity, up to `level` above the lip;
  /// the walls of the cut hold what stands above the side plates [m^3].
  double pushed_in(double level) const;

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
  /// Extent of the cavity above one x. Its mouth may be the upper or the lower bound.
  struct Slice {
    double x = 0.0;
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    bool open_below = false;
    bool open_above = false;
  };
  void cross_slices(const Eigen::Vector2d& a, const Eigen::Vector2d& b, bool mouth);
  template <typename OfSlice>
  double over_slices(const OfSlice& of_slice) const;

  const Bucket& bucket_;
  double phi3_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector2d> corners_;
  std::array<Slice, 64> slices_;
  double slice_width_ = 0.0;
};

}  // namespace excavplan
