// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

/// @file
/// What the bucket of SectionSimulator holds, by clipping the polygon of its side profile.

namespace excavplan {

/// The half plane z <= height + slope * x.
struct Below {
  double height = 0.0;
  double slope = 0.0;

  double at(double x) const { return height + slope * x; }
};

using Polygon = std::vector<Eigen::Vector2d>;

struct AreaCentre {
  double area = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
};

/// The bucket in one attitude, relative to the tip.
class BucketSection {
 public:
  explicit BucketSection(const Bucket& bucket) : bucket_(bucket) {}

  void turn_to(double phi3);

  /// Volume held, and the centre of the part between the side plates.
  AreaCentre held(double support, const HoldingSlopes& slopes);

  const Eigen::Vector2d& corner(std::size_t i) const { return corners_[i]; }

  /// The part of the side plates below a line of this height and slope.
  AreaCentre buried(const Below& ground);

 private:
  double heaped(const Eigen::Vector2d& top, const Below& face, const Below& rear,
                double slope) const;

  const Bucket& bucket_;
  Polygon corners_;
  Polygon polygon_;
  Polygon scratch_;
};

/// The front of the soil that has packed into the corner of floor and back.
class PackedFront {
 public:
  explicit PackedFront(const Bucket& bucket);

  /// Angle at the lip from the floor to the front of this volume [rad].
  double angle(double volume) const;

 private:
  static constexpr int steps = 64;
  double mouth_ = 0.0;
  std::vector<double> volume_;
};

}  // namespace excavplan
