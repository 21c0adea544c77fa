// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/goal_words.hpp>

#include <algorithm>
#include <system_error>

#include "base/check.hpp"
#include "base/read_double.hpp"
#include "base/text.hpp"

namespace excavplan {

const DigGoalInfo* goal_of_word(const std::string& word) {
  const auto& goals = dig_goals();
  const auto found = std::find_if(goals.begin(), goals.end(),
                                  [&](const DigGoalInfo& info) { return info.word == word; });
  return found == goals.end() ? nullptr : &*found;
}

std::string usage(const DigGoalInfo& goal) {
  return goal.word + (goal.parameter ? ":" + goal.parameter_name : "");
}

std::optional<WrittenGoal> written_goal(const std::string& text) {
  const std::size_t colon = text.find(':');
  const DigGoalInfo* const goal = goal_of_word(text.substr(0, colon));
  const bool has_number = colon != std::string::npos;
  if (!goal || (goal->parameter != nullptr) != has_number) return std::nullopt;
  return WrittenGoal{*goal, has_number ? text.substr(colon + 1) : ""};
}

DigObjective objective_named(const std::string& text) {
  if (const auto written = written_goal(text)) {
    DigObjective objective(written->goal.goal);
    if (!written->goal.parameter) return objective;
    const char* const end = written->number.data() + written->number.size();
    double& number = objective.*written->goal.parameter;
    const auto [after, error] = read_double(written->number.data(), end, number);
    if (error == std::errc() && after == end) return objective;
  }
  std::string known;
  for (const DigGoalInfo& goal : dig_goals()) known += (known.empty() ? "" : ", ") + usage(goal);
  refuse("the goal " + in_quotes(text) + " is none of " + known);
}

}  // namespace excavplan
