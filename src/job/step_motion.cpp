// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/step_motion.hpp"

#include <algorithm>

#include <excavplan/job/job_motion.hpp>
#include <excavplan/planning/standing_ground.hpp>
#include <excavplan/simulation/dig_along.hpp>
#include <excavplan/simulation/dig_ground.hpp>

namespace excavplan {
namespace {

constexpr double standing_cell = 0.1;  // of the ground under the machine; ours [m]

}  // namespace

std::vector<Warning> standing_warnings(const JobSettings& settings, const Terrain& ground,
                                       const BasePose& base) {
  const Machine& machine = settings.site.machine;
  const GroundAlong under(ground, dig_line(base), standing_extent(machine), standing_cell);
  return standing_ground(machine, under.terrain().surface()).warnings;
}

StepMotion checked_motion(const JobSettings& settings, const Terrain& ground, const JobStep& step) {
  StepMotion checked;
  checked.warnings = standing_warnings(settings, ground, step.base);
  const auto motion = motion_of(settings, ground, step);
  if (const auto* stopped = std::get_if<BlockedWay>(&motion)) {
    checked.blocked = stopped->message;
    return checked;
  }
  const auto& timed = std::get<Trajectory>(motion);
  if (!timed.points.empty()) {
    const TrajectoryPoint& last = timed.points.back();
    checked.rests_at << last.joints, last.swing.angle;
  }
  const std::vector<Warning>& more = timed.warnings;
  checked.warnings.insert(checked.warnings.end(), more.begin(), more.end());
  checked.is_trustworthy = !any_ends_trust(checked.warnings);
  return checked;
}

}  // namespace excavplan
