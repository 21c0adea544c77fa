// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/planning/dig_goal.hpp>

/// @file
/// Goals as users write them: by word, "energy", or word and number, "priced:2000".

namespace excavplan {

/// The goal of a word, "energy"; null if there is none.
const DigGoalInfo* goal_of_word(const std::string& word);

/// How a goal is written: "energy", "priced:WATT".
std::string usage(const DigGoalInfo& goal);

/// A goal as it was written.
struct WrittenGoal {
  const DigGoalInfo& goal;  ///< of its word
  std::string number;       ///< of its parameter, not read yet; empty if it has none
};
/// Nothing if the text has no goal's word, or a number where the goal takes none.
std::optional<WrittenGoal> written_goal(const std::string& text);

/// The objective of a goal by its word, "energy", or word and number, "priced:2000"; all other
/// numbers are the usual ones. @throws Error (bad_input) if the text is none
DigObjective objective_named(const std::string& text);

}  // namespace excavplan
