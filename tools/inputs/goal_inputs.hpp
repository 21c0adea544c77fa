// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/kit/kit_files.hpp>
#include <excavplan/planning/dig_goal.hpp>

#include "frame/arguments.hpp"

namespace excavplan::tools {

/// The goal of digs and its numbers, from the command line.
struct GoalInputs {
  std::string goal = dig_goals().front().word;
  GoalNumbers numbers = GoalNumbers(objective_parameters().size());
};

void declare_goal(Arguments& arguments, GoalInputs& inputs);

/// @throws Error (bad_input) naming the option, also if it does not matter to the goal
DigObjective objective_of(const GoalInputs& inputs);
/// Without --dump-height the usual height is lowered to what these machines reach.
DigObjective objective_of(const GoalInputs& inputs, const std::vector<Machine>& machines);
/// Warning `dump_height_lowered`, where that matters to the goal.
std::vector<Warning> goal_warnings(const GoalInputs& inputs, const std::vector<Machine>& machines);

}  // namespace excavplan::tools
