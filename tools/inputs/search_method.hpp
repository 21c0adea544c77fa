// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/planning/dig_search.hpp>

#include "frame/arguments.hpp"

/// @file
/// How digs are searched and between which, from the command line.

namespace excavplan::tools {

/// Options of the paper's algorithm that no other method has.
void declare_genetic(Arguments& arguments, GeneticAlgorithm& genetic);

struct SearchMethodInputs {
  /// FROM,TO of each number of dig_parameter_table().
  std::vector<std::optional<std::string>> ranges =
      std::vector<std::optional<std::string>>(dig_parameter_table().size());
  std::string method = "default";
  GeneticAlgorithm genetic;  ///< but for its generations
  int generations = 0;
  int evaluations = 0;
};

void declare_search_method(Arguments& arguments, SearchMethodInputs& inputs);

/// @param usual  what 0 stands for
void declare_evaluations(Arguments& arguments, SearchMethodInputs& inputs,
                         const std::string& usual);

/// What plan_dig() calls them in its messages.
const OptionNames& search_option_names();

/// Checks made before anything is read. @throws Error (bad_input)
void check(const SearchMethodInputs& inputs);

/// Sets method, ranges and number of digs, and the rule for the start: the paper's algorithm has no
/// gene for it.
void apply(const SearchMethodInputs& inputs, DigSearchOptions& options);

}  // namespace excavplan::tools
