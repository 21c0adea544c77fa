// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_settings.hpp>
#include <excavplan/job/job_step.hpp>

/// @file
/// Whether the motion of a step over its whole cycle can be trusted. Private to the
/// project.

namespace excavplan {

/// What is found of the motion of a step.
struct StepMotion {
  std::vector<Warning> warnings;  ///< of the motion, and of the ground that the machine stands on
  std::string blocked;            ///< what is in the way; empty: nothing
  bool is_trustworthy = false;    ///< not blocked, and no warning that ends trust
  FrontJoints rests_at = FrontJoints::Zero();  ///< at its end [rad]; without a motion zero
};

/// motion_of() a step and standing_ground().
/// Of the ground under the machine at a place (standing_ground()).
std::vector<Warning> standing_warnings(const JobSettings& settings, const Terrain& ground,
                                       const BasePose& base);

StepMotion checked_motion(const JobSettings& settings, const Terrain& ground, const JobStep& step);

}  // namespace excavplan
