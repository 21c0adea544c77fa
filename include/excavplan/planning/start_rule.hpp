// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace excavplan {

/// Where along the boom plane a dig begins. It decides the work of the links, and with it up to a
/// third of the efficiency: paths are compared under one rule (docs/methods.md#start).
struct StartRule {
  /// How the start is chosen.
  enum class Kind {
    largest_margin,  ///< make_dig_path_anywhere()
    /// Least positive work of the links' own weight, on known ground and with all joints 2 degrees
    /// off their limits; the largest margin where there is no such start. Starts are compared at
    /// coarse poses, on a grid of 0.2 m and then by halved steps (docs/methods.md#start).
    least_work,
    given,
    searched,  ///< one more number of a search; the best of some along the reach for a known path
  };
  Kind kind = Kind::largest_margin;  ///< how the start is chosen
  double x = 0.0;                    ///< if given [m]

  /// Chosen by a rule.
  StartRule(Kind rule = Kind::largest_margin) : kind(rule) {}  // NOLINT: is a rule
  /// At a given x [m].
  StartRule(double start_x) : kind(Kind::given), x(start_x) {}  // NOLINT: so is a place
};

std::string describe(const StartRule& rule);

/// A rule that has a word on the command line.
struct StartRuleInfo {
  StartRule::Kind kind = StartRule::Kind::largest_margin;  ///< that the row is of
  std::string word;                                        ///< "work"
  std::string description;  ///< "least work of the links' own weight"
};

/// All rules but that of a given place.
const std::vector<StartRuleInfo>& start_rules();

/// @return nothing if no rule has this word
std::optional<StartRule> start_rule_of_word(const std::string& word);

}  // namespace excavplan
