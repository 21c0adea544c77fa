// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include <excavplan/planning/cycle_motion.hpp>
#include <excavplan/planning/plan_dig.hpp>

namespace excavplan {

/// The motion of a planned dig for a controller: way_of_cycle() of its path, with its torques, its
/// payload and the ground that it leaves, timed by time_way(). Its warnings are those of the way,
/// and say where off the dig a joint lacks torque for links and payload (motion_overload) or the
/// machine tips (motion_tips). It is stamped with an id of its plan, in the frame of the machine.
/// @param ground  before the dig: that of swing_extent(); the part that was planned on is too small
/// @return the motion, without points if the plan has no dig; or what blocks the way
/// @throws Error (bad_input) as way_of_cycle() and time_way(), or if the plan is of another machine
std::variant<Trajectory, BlockedWay> plan_motion(const Machine& machine, const Terrain& ground,
                                                 const DigPlan& plan,
                                                 const CycleWayOptions& way = {},
                                                 const MotionOptions& motion = {});
/// The same where the ground is taken to be level.
std::variant<Trajectory, BlockedWay> plan_motion(const Machine& machine, const DigPlan& plan,
                                                 const CycleWayOptions& way = {},
                                                 const MotionOptions& motion = {});

/// Code `obstacle_at_dump`: below the bucket where a planned dig dumps something stands whose
/// highest return is above the dump height. A truck, whose bed is lower, may stand there.
/// @param ground  as of plan_motion()
/// @return nothing if the plan has no dig or the machine does not state its swing
/// @throws Error (bad_input) as require_terrain()
std::optional<Warning> check_dump_place(const Machine& machine, const Terrain& ground,
                                        const DigPlan& plan, const CycleOptions& cycle = {});

}  // namespace excavplan
