// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/job_step.hpp>

#include <cmath>
#include <string>

#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

// The most that is believed of a report, and that a record holds of many; ours.
constexpr double most_mass = 1e6;            // [kg]
constexpr double most_work = 1e12;           // [J]
constexpr double farthest_step = 1e9;        // from the origin of the site's frame [m]
constexpr double most_turned = 1e3;          // [rad]
constexpr double most_buckets = 3.0;         // in one
constexpr double densest = 2200.0;           // of loose soil [kg/m^3]
constexpr double most_of_work = 20.0;        // over what is foretold
constexpr double least_work = 50.0;          // what is foretold over it
constexpr double farthest_from_step = 10.0;  // from where it should stand [m]
constexpr double latest_time = 1e11;         // as in a ground file [s]

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

void require_plausible(const JobStep& step, const StepReport& report, const Machine& machine) {
  const std::string of = " of step " + std::to_string(step.id) + ", " + name(step.what);
  const double most_lifted = most_buckets * heaped_capacity(machine) * densest;
  const double lifted = report.payload_mass.value_or(0.0);
  require(lifted <= most_lifted, "payload mass" + of + " [kg]", lifted,
          "at most " + readable(most_lifted, 3) + ", as much as three buckets hold: is it in kg?");
  const double foretold = step.predicted.energy;
  if (report.joint_work && foretold > 0.0) {
    const double least = report.stalled ? 0.0 : foretold / least_work;
    require(*report.joint_work >= least && *report.joint_work <= most_of_work * foretold,
            "work of the joints" + of + " [kJ]", 1e-3 * *report.joint_work,
            "within " + readable(1e-3 * least, 2) + " .. " +
                readable(1e-3 * most_of_work * foretold, 3) + ", as " +
                readable(1e-3 * foretold, 3) + " kJ are foretold: is it in kJ?");
  }
  if (!report.base) return;
  const double off = std::hypot(report.base->x - step.base.x, report.base->y - step.base.y);
  require(off <= farthest_from_step, "base" + of + ": its distance from where the step has it [m]",
          off, "at most " + readable(farthest_from_step, 2));
}

}  // namespace excavplan
