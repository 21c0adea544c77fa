// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/plan/plan_motion.hpp>

#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {

std::variant<Trajectory, BlockedWay> plan_motion(const Machine& machine, const Terrain& ground,
                                                 const DigPlan& plan, const CycleWayOptions& way,
                                                 const MotionOptions& motion) {
  if (!plan.dig) return Trajectory{machine.name, {}, machine.robot_joints};
  require(plan.trajectory.machine == machine.name,
          "motion: the plan is of the machine " + excavplan::quoted(plan.trajectory.machine) +
              ", not of " + excavplan::quoted(machine.name));
  const auto laid =
      way_of_cycle(machine, ground, plan.path, {plan.torques, plan.dig->payload_mass}, way);
  if (const auto* blocked = std::get_if<BlockedWay>(&laid)) return *blocked;
  return time_way(machine, std::get<Way>(laid), motion);
}

}  // namespace excavplan
