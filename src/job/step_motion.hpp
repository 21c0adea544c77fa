// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_settings.hpp>
#include <excavplan/job/job_step.hpp>
#include <excavplan/machine/trajectory.hpp>

/// @file
/// The motion of a step over its whole cycle, and whether it can be trusted. Private to the
/// project.

namespace excavplan {

struct StepMotion {
  Trajectory trajectory;          ///< in the frame of the line of the dig; empty if it is blocked
  std::vector<Warning> warnings;  ///< of the motion, and of the ground that the machine stands on
  std::string blocked;            ///< what is in the way; empty: nothing
  bool is_trustworthy = false;    ///< not blocked, and no warning that ends trust
};

/// plan_motion() of a dig on the ground of the job with its obstacles: from the start of the dig
/// over swing and dump back to it; and standing_ground().
StepMotion motion_of(const JobSettings& settings, const Terrain& ground, const JobStep& step);

}  // namespace excavplan
