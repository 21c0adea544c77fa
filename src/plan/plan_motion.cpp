// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/plan/plan_motion.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "planning/motion_load.hpp"

namespace excavplan {

std::variant<Trajectory, BlockedWay> plan_motion(const Machine& machine, const Terrain& ground,
                                                 const DigPlan& plan, const CycleWayOptions& way,
                                                 const MotionOptions& motion) {
  if (!plan.dig) return Trajectory{machine.name, {}, machine.robot_joints};
  require(plan.trajectory.machine == machine.name, "motion: the plan is of the machine " +
                                                       quoted(plan.trajectory.machine) +
                                                       ", not of " + quoted(machine.name));
  const auto laid =
      way_of_cycle(machine, ground, plan.path, {plan.torques, plan.dig->payload_mass}, way);
  if (const auto* blocked = std::get_if<BlockedWay>(&laid)) return *blocked;
  Trajectory timed = time_way(machine, std::get<Way>(laid), motion);
  timed.warnings = load_warnings(machine, std::get<Way>(laid));
  return timed;
}

}  // namespace excavplan
