// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include <excavplan/job/job_settings.hpp>
#include <excavplan/job/job_step.hpp>
#include <excavplan/planning/cycle_motion.hpp>

namespace excavplan {

/// The motion of a dig of a job for a controller, in the machine's frame: dig, lift, swing to the
/// dump, dump and back. The swing is from the heading of JobStep::base; in a lane it turns during
/// the drag so that the tooth stays on the line, and the front reaches out accordingly. Clear of
/// the ground, of the obstacles of the design and of the truck's bed as way_of_cycle() sees it.
/// @param ground  before the dig, in the site's frame
/// @param start  joints from which it begins, the swing from that heading [rad]; nothing: from
/// where a load is carried, else where the path of the dig begins
/// @return the motion, without points of a step that is no dig; or what blocks the way
/// @throws Error (bad_input) as way_of_cycle() and time_way()
std::variant<Trajectory, BlockedWay> motion_of(const JobSettings& settings, const Terrain& ground,
                                               const JobStep& step,
                                               const MotionOptions& options = {},
                                               const std::optional<FrontJoints>& start = {});

}  // namespace excavplan
