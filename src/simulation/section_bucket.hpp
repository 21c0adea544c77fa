// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/bucket_cavity.hpp>

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

  /// Volume of the soil held.
  double held(double support, const HoldingSlopes& slopes);

  /// Volume of soil that is pushed in over the lip, up to `level` above it; the walls of the cut
  /// hold what stands above the side plates.
  double pushed_in(double level);

  const Eigen::Vector2d& corner(std::size_t i) const { return corners_[i]; }
  /// A vector with the line from pin to tip along x, as the bucket is turned.
  Eigen::Vector2d turned(const Eigen::Vector2d& v) const { return turn_ * v; }

  /// The part of the side plates below a line of this height and slope.
  AreaCentre buried(const Below& ground);

 private:
  double heaped(const Eigen::Vector2d& top, const Below& face, const Below& rear,
                double slope) const;

  const Bucket& bucket_;
  Eigen::Rotation2Dd turn_{0.0};
  Polygon corners_;
  Polygon polygon_;
  Polygon scratch_;
};

/// The soil that has packed into the corner of floor and back.
class PackedFront {
 public:
  explicit PackedFront(const Bucket& bucket);

  struct Fill {
    double front = 0.0;      ///< angle at the lip from the floor to the front [rad]
    Eigen::Vector2d centre;  ///< of its area, from the lip; the line from pin to tip along x
  };
  Fill of(double volume) const;

 private:
  static constexpr int steps = 64;
  double mouth_ = 0.0;
  std::vector<double> volume_;
  std::vector<Eigen::Vector2d> centre_;
};

/// bucket_capacity() by another method: the side profile clipped by the slopes of the soil [m^3].
double clipped_capacity(const Machine& machine, double phi3, double support,
                        const HoldingSlopes& slopes);

}  // namespace excavplan
