// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/goal_inputs.hpp"

#include <algorithm>

#include <excavplan/kit/machine_kit.hpp>

#include "frame/quantity.hpp"

namespace excavplan::tools {
namespace {

/// "energy", "priced:WATT"
std::string usage(const DigGoalInfo& goal) {
  return goal.word + (goal.parameter ? ":" + goal.parameter_name : "");
}

/// All goals, each as `text` puts it.
template <typename Text>
std::string goals_text(const std::string& separator, const Text& text) {
  std::string all;
  for (const DigGoalInfo& goal : dig_goals()) all += (all.empty() ? "" : separator) + text(goal);
  return all;
}

std::string usual_text(const DigObjectiveParameter& parameter) {
  if (parameter.field != &DigObjective::min_fill) {
    return number_text(DigObjective().*parameter.field);
  }
  return goals_text(", ", [](const DigGoalInfo& goal) {
    return number_text(goal.min_fill) + " for " + goal.word;
  });
}

/// As the library does, which does not know the option. @throws Error (bad_input)
double in_range(const std::string& option, const DigObjectiveParameter& parameter, double value) {
  if (value >= parameter.lowest && value <= parameter.highest) return value;
  usage_error(option + ": the " + parameter.text + " is " + number_text(value) + ", must be in " +
              number_text(parameter.lowest) + " .. " + number_text(parameter.highest) +
              (parameter.unit == std::string("-") ? "" : std::string(" ") + parameter.unit));
}

std::size_t row_of(double DigObjective::*field) {
  const auto& all = objective_parameters();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.field == field; });
  return static_cast<std::size_t>(found - all.begin());
}

DigObjective goal_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string word = text.substr(0, colon);
  for (const DigGoalInfo& goal : dig_goals()) {
    if (goal.word != word || (goal.parameter == nullptr) != (colon == std::string::npos)) continue;
    DigObjective objective(goal.goal);
    if (goal.parameter) {
      const std::string option = "--goal " + word;
      objective.*goal.parameter =
          in_range(option, objective_parameters()[row_of(goal.parameter)],
                   parse_quantity(option, text.substr(colon + 1), Quantity::ratio));
    }
    return objective;
  }
  usage_error("--goal: '" + text + "' is none of " + goals_text(", ", usage));
}

}  // namespace

void declare_goal(Arguments& arguments, GoalInputs& inputs) {
  arguments.text("goal", goals_text("|", usage), inputs.goal,
                 goals_text("; ", [](const DigGoalInfo& goal) {
                   return usage(goal) + ": " + goal.description;
                 }));
  const auto& parameters = objective_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const DigObjectiveParameter& parameter = parameters[i];
    if (*parameter.option == '\0') continue;
    arguments.option(parameter.option, inputs.numbers[i], quantity_of(parameter.unit),
                     std::string(parameter.text) + " (default: " + usual_text(parameter) + ")");
  }
}

DigObjective objective_of(const GoalInputs& inputs) {
  DigObjective objective = goal_of(inputs.goal);
  const DigGoalInfo& goal = info_of(objective.goal);
  const auto& parameters = objective_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!inputs.numbers[i]) continue;
    const std::string option = std::string("--") + parameters[i].option;
    if (!parameters[i].matters_to(goal)) {
      usage_error(option + " has no effect on the goal " + goal.word);
    }
    objective.*parameters[i].field = in_range(option, parameters[i], *inputs.numbers[i]);
  }
  return objective;
}

DigObjective objective_of(const GoalInputs& inputs, const std::vector<Machine>& machines) {
  DigObjective objective = objective_of(inputs);
  const auto row = row_of(&DigObjective::dump_height);
  if (inputs.numbers[row]) return objective;
  for (const Machine& machine : machines) objective = feasible_objective(machine, objective);
  return objective;
}

std::vector<Warning> goal_warnings(const GoalInputs& inputs, const std::vector<Machine>& machines) {
  if (inputs.numbers[row_of(&DigObjective::dump_height)]) return {};
  std::vector<Warning> warnings = lowered_height_warnings(objective_of(inputs, machines));
  for (Warning& each : warnings) each.message += "; --dump-height sets it";
  return warnings;
}

}  // namespace excavplan::tools
