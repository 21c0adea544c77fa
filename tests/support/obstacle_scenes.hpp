// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/trajectory.hpp>
#include <excavplan/scans/scan_surface.hpp>

/// @file
/// Scenes around a machine with their true shapes, scans of them by rays, and how near a motion
/// comes to the shapes, by kinematics of its own.

namespace excavplan::test {

/// What stands in a scene.
struct Shape {
  enum class Kind { box, post, wire, ball, cone };

  Kind kind = Kind::box;
  std::string name;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();    ///< middle of the foot; of a ball its centre [m]
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< box: edges; post, cone: radius, -, height;
                                                   ///< ball, wire: radius
  double turn = 0.0;                               ///< of a box about z [rad]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< the other end of a wire [m]

  /// From a place to the surface, negative inside [m].
  double distance(const Eigen::Vector3d& place) const;
  /// Along a ray to the surface; infinite where it misses [m].
  double hit(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const;
  /// Whether it hangs over ground that is free.
  bool hangs() const { return kind == Kind::wire || kind == Kind::ball; }
};

struct ObstacleScene {
  std::vector<Shape> shapes;
  double edge = std::numeric_limits<double>::infinity();  ///< y beyond which the ground lies lower
  double drop = 0.0;                                      ///< by so much [m]

  double ground(double /*x*/, double y) const { return y > edge ? -drop : 0.0; }
};

/// One to four shapes of any kind within 10 m of the machine, clear of its place; now and then an
/// edge.
ObstacleScene any_scene(std::uint64_t number);

/// A spinning sensor.
struct RaySensor {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< [m]
  double step = 0.006;                           ///< between rays about z [rad]
  double row = 0.012;                            ///< between rows [rad]
};

/// Between one and three: one on the machine's roof, others on masts around.
std::vector<RaySensor> any_sensors(std::uint64_t number);

/// What sensors see of a scene, and how many rays hit each shape.
struct RayScan {
  std::shared_ptr<Cloud> cloud = std::make_shared<Cloud>();
  std::vector<int> hits;

  Scan scan() const;
};
RayScan ray_scan(const ObstacleScene& scene, const std::vector<RaySensor>& sensors,
                 std::uint64_t number);

/// Points all over boom, arm, bucket and upper structure at one time [m], in the site frame.
std::vector<Eigen::Vector3d> machine_points(const Machine& machine, const TrajectoryPoint& at);

/// How near a motion comes to each shape [m].
/// @param as_columns  what hangs counts down to the ground
std::vector<double> nearest(const Machine& machine, const Trajectory& motion,
                            const ObstacleScene& scene, bool as_columns = false);

/// Share of the ground that the front passes, beyond the circle of the tracks, within 0.2 m of
/// which a return lies.
double seen_share(const Machine& machine, const Trajectory& motion, const Cloud& cloud);

}  // namespace excavplan::test
