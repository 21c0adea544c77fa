// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/job_step.hpp>

#include <cmath>

#include "base/check.hpp"

namespace excavplan {
namespace {

// The most that is believed of a report, and that a record holds of many; ours.
constexpr double most_mass = 1e6;      // [kg]
constexpr double most_work = 1e12;     // [J]
constexpr double farthest_step = 1e9;  // from the origin of the site's frame [m]
constexpr double most_turned = 1e3;    // [rad]
constexpr double latest_time = 1e11;   // as in a ground file [s]

}  // namespace

const char* name(JobAction action) {
  switch (action) {
    case JobAction::dig:
      return "dig";
    case JobAction::finish:
      return "finish";
    case JobAction::move:
      return "move";
    case JobAction::scan:
      return "scan";
    case JobAction::wait:
      return "wait";
    case JobAction::stop:
      return "stop";
  }
  return "unknown action";
}

bool digs(JobAction action) { return action == JobAction::dig || action == JobAction::finish; }

bool JobStep::ends_finished() const { return what == JobAction::stop && reason == finished_reason; }

void require_report(const JobStep& step, const StepReport& report) {
  const std::string of = " of step " + std::to_string(step.id) + ", " + name(step.what);
  const double lifted = report.payload_mass.value_or(0.0);
  require_in("time" + of + " [s]", report.time, -latest_time, latest_time);
  require_in("payload mass" + of + " [kg]", lifted, 0.0, most_mass);
  require_in("work of the joints" + of + " [J]", report.joint_work.value_or(0.0), 0.0, most_work);
  if (const auto& base = report.base) {
    for (const double place : {base->x, base->y, base->z})
      require_in("base" + of + " [m]", place, -farthest_step, farthest_step);
    require_in("heading" + of + " [rad]", base->heading, -most_turned, most_turned);
  }
  if (step.digs()) return;
  require(lifted == 0.0, "payload mass" + of + " [kg]", lifted,
          "0 or left out, as nothing is dug in it");
  require(!report.stalled, "step " + std::to_string(step.id) + " is a " + name(step.what) +
                               " and cannot have stalled: only a dig can");
}

}  // namespace excavplan
