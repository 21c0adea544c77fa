// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/step_motion.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/planning/plan_motion.hpp>
#include <excavplan/planning/standing_ground.hpp>
#include <excavplan/simulation/dig_along.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/angles.hpp"
#include "ground/grid_cells.hpp"
#include "job/job_map.hpp"
#include "planning/simulated_dig.hpp"

namespace excavplan {
namespace {

constexpr double motion_cell = 0.1;  // of the ground that the front passes over; ours [m]

/// The ground about the machine along a line, and what stands on it.
Terrain seen_along(const JobSettings& settings, const Terrain& ground, const DigLine& line,
                   const Rectangle& extent) {
  Terrain along = GroundAlong(ground, line, extent, motion_cell).terrain();
  if (settings.design.obstacles.empty()) return along;
  along.obstacles = Eigen::ArrayXXd::Constant(along.loose.rows(), along.loose.cols(), std::nan(""));
  for_each_cell(along.loose, [&](Cell at) {
    const Eigen::Vector2d place = line.place(along.bank.x(at.col), along.bank.y(at.row));
    for (const JobObstacle& obstacle : settings.design.obstacles) {
      if (!is_inside(obstacle.polygon, place)) continue;
      const double foot = along.bank.z(at.row, at.col);
      along.obstacles(at.row, at.col) = (std::isnan(foot) ? 0.0 : foot) + obstacle.height;
      along.bank.z(at.row, at.col) = std::nan("");
      return;
    }
  });
  return along;
}

/// The dig of a step once more, for its torques and the ground that it leaves.
DigPlan plan_of(const JobSettings& settings, const Terrain& ground, const DigLine& line,
                const JobStep& step) {
  const Machine& machine = settings.site.machine;
  const HeightMapSimulator simulator(machine, settings.site.soil, settings.density_percent);
  const GroundAlong along(ground, line, extent_along(machine, step.path), ground.bank.cell_size);
  const DigResult dug = simulator.dig(along.terrain(), step.path);
  DigPlan plan;
  plan.path = step.path;
  plan.trajectory.machine = machine.name;
  plan.torques = dug.torques;
  PlannedDig dig;
  dig.payload_mass = step.predicted.payload_mass;
  plan.dig = dig;
  plan.ground_after = dug.after(along.terrain()).surface();
  return plan;
}

}  // namespace

StepMotion motion_of(const JobSettings& settings, const Terrain& ground, const JobStep& step) {
  const Machine& machine = settings.site.machine;
  const DigLine line = dig_line(step.base, step.swung, step.lane);
  const Terrain about = seen_along(settings, ground, line, swing_extent(machine));
  CycleWayOptions way;
  way.whole_cycle = true;
  way.cycle.swing = std::remainder(
      std::atan2(step.dump.y() - step.base.y, step.dump.x() - step.base.x) - line.heading,
      2.0 * pi);
  way.cycle.dump_height = std::max(0.0, step.dump.z() - step.base.z);
  StepMotion motion;
  motion.warnings = standing_ground(machine, GroundAlong(ground, dig_line(step.base),
                                                         standing_extent(machine), motion_cell)
                                                 .terrain()
                                                 .surface())
                        .warnings;
  auto planned = plan_motion(machine, about, plan_of(settings, ground, line, step), way);
  if (const auto* stopped = std::get_if<BlockedWay>(&planned)) {
    motion.blocked = stopped->message;
    return motion;
  }
  motion.trajectory = std::move(std::get<Trajectory>(planned));
  motion.warnings.insert(motion.warnings.end(), motion.trajectory.warnings.begin(),
                         motion.trajectory.warnings.end());
  motion.is_trustworthy = std::none_of(motion.warnings.begin(), motion.warnings.end(),
                                       [](const Warning& each) { return each.ends_trust; });
  return motion;
}

}  // namespace excavplan
