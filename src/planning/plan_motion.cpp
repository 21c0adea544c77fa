// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/plan_motion.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "ground/obstacles.hpp"
#include "ground/terrain.hpp"
#include "planning/front_load.hpp"
#include "planning/motion_load.hpp"

namespace excavplan {

std::variant<Trajectory, BlockedWay> plan_motion(const Machine& machine, const Terrain& ground,
                                                 const DigPlan& plan, const CycleWayOptions& way,
                                                 const MotionOptions& motion) {
  const Machine standing = with_attitude(machine, plan.attitude);
  if (!plan.dig) return Trajectory{standing.name, {}, standing.robot_joints};
  require(plan.trajectory.machine == standing.name, "motion: the plan is of the machine " +
                                                        in_quotes(plan.trajectory.machine) +
                                                        ", not of " + in_quotes(standing.name));
  const DigLoad load = {plan.torques, plan.dig->payload_mass, plan.ground_after};
  const auto laid = way_of_cycle(standing, ground, plan.path, load, way);
  if (const auto* blocked = std::get_if<BlockedWay>(&laid)) return *blocked;
  Trajectory timed = time_way(standing, std::get<Way>(laid), motion);
  timed.warnings = std::get<Way>(laid).warnings;
  for (Warning& each : load_warnings(standing, std::get<Way>(laid), plan.on_slope)) {
    timed.warnings.push_back(std::move(each));
  }
  const HeightMap seen = ground.highest();
  const auto bytes = static_cast<std::size_t>(seen.z.size()) * sizeof(double);
  std::string content(bytes, '\0');
  std::memcpy(content.data(), seen.z.data(), bytes);
  timed.plan = PlanStamp{checksum_text(fingerprint(standing) + to_csv(timed) + content)};
  return timed;
}

std::variant<Trajectory, BlockedWay> plan_motion(const Machine& machine, const DigPlan& plan,
                                                 const CycleWayOptions& way,
                                                 const MotionOptions& motion) {
  return plan_motion(machine, level_swing_ground(machine), plan, way, motion);
}

std::optional<Warning> check_dump_place(const Machine& machine, const Terrain& ground,
                                        const DigPlan& plan, const CycleOptions& cycle) {
  const Machine stands = with_attitude(machine, plan.attitude);
  require_terrain(ground, "ground of the dump place");
  if (!plan.dig || !stands.swing || plan.path.poses.empty()) return std::nullopt;
  const JointAngles clear = plan.path.poses.back().joints;
  const double height = std::max(cycle.dump_height, pin_height(stands, clear));
  const JointAngles full = raised(stands, clear, height);
  double near = std::numeric_limits<double>::infinity(), far = -near;
  for (const JointAngles& joints : {full, opened(stands, full)}) {
    const LinkPositions links = link_positions(stands, joints);
    for (const Eigen::Vector2d& corner : stands.bucket.profile) {
      const double x = bucket_point(links, corner).x();
      near = std::min(near, x);
      far = std::max(far, x);
    }
  }
  const Eigen::Vector2d ahead(std::cos(cycle.swing), std::sin(cycle.swing));
  const double half = 0.5 * stands.bucket.width_outside;
  const auto below_bucket = [&](const Eigen::Vector2d& place) {
    const double along = place.dot(ahead);
    const double aside = ahead.x() * place.y() - ahead.y() * place.x();
    return along >= near && along <= far && std::abs(aside) <= half;
  };
  const auto top = highest_obstacle(ground, below_bucket);
  if (!top || !(top->seen > height)) return std::nullopt;
  return Warning{WarningCode::obstacle_at_dump,
                 "at the dump place, x = " + readable(top->place.x(), 2) +
                     " m, y = " + readable(top->place.y(), 2) + " m, something stands that is " +
                     text(*top) + ", above the dump height of " + readable(height, 2) +
                     " m: dump elsewhere or higher"};
}

}  // namespace excavplan
