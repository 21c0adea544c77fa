// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <excavplan/planning/dig_search.hpp>

#include "frame/tool.hpp"
#include "inputs/goal_inputs.hpp"
#include "inputs/search_method.hpp"

namespace excavplan::tools {

/// Settings of a search for a dig, from the command line.
struct SearchInputs {
  GoalInputs goal;
  std::optional<std::string> start;  ///< none: searched, unless the method has a rule of its own
  SearchMethodInputs method;
  std::optional<std::string> checkpoint;
  bool resume = false;
  std::uint64_t seed = DigSearchOptions{}.seed;
  std::uint64_t threads = 0;
};

/// What is done with the options of a search.
enum class SearchUse {
  none,
  start_only,  ///< a path that is known is dug by its rule for the start
  all,
};

/// @param use  asked once all options are read
void declare_search(Arguments& arguments, SearchInputs& inputs,
                    const std::function<SearchUse()>& use);

/// Checks made before anything is read. @throws Error (bad_input)
void check(const SearchInputs& inputs);

/// For plan_dig(), with progress on the console, which also stops the search.
DigSearchOptions search_options(const SearchInputs& inputs, const Machine& machine, SearchUse use,
                                Console& console);

}  // namespace excavplan::tools
