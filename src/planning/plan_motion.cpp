// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/plan_motion.hpp>

#include <cstring>
#include <utility>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
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

}  // namespace excavplan
