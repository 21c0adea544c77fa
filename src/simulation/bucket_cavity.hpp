// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

namespace excavplan {

/// Side view of the bucket's cavity in the boom plane, relative to the tip.
class Cavity {
 public:
  explicit Cavity(const Bucket& bucket);

  void turn_to(double phi3);

  /// As bucket_capacity(), in the attitude it was turned to [m^3].
  double capacity(double support, const HoldingSlopes& slopes) const;

  /// Angle from the floor to the front of `volume` packed into the corner of floor and back: the
  /// line through the lip with that much behind it [rad].
  double packed_front(double volume) const;

  /// Corner i of the profile, in the attitude it was turned to [m].
  const Eigen::Vector2d& corner(std::size_t i) const { return corners_[i]; }
  std::size_t corners() const { return corners_.size(); }
  const Eigen::Vector2d& centroid() const { return centroid_; }

 private:
  struct Slice;
  /// A side of the profile as a line over x, from `x_low` to before `x_high`.
  struct Side {
    double x_low = 0.0;
    double x_high = 0.0;
    double offset = 0.0;
    double slope = 0.0;
  };
  Slice at(double x) const;

  const Bucket& bucket_;
  std::vector<Eigen::Vector2d> corners_;
  std::vector<Side> sides_;  ///< from corner to corner; the last is the mouth
  Eigen::Vector2d centroid_ = Eigen::Vector2d::Zero();
  double x_min_ = 0.0;
  double x_max_ = 0.0;
};

}  // namespace excavplan
