// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/planning/library_build.hpp>

#include "frame/tool.hpp"
#include "inputs/goal_inputs.hpp"
#include "inputs/simulator_inputs.hpp"

namespace excavplan::tools {

/// What libraries are built for and how their digs are searched, from the command line.
struct LibraryInputs {
  std::string densities = "0:5:100";
  std::string slopes = "0";
  std::string soils = "loam";
  std::string machines = "zx120";
  SimulatorInputs simulator;
  GoalInputs goal;
  std::string method = "memetic";
  AnchoredSearch anchored;
  GeneticAlgorithm genetic;
  LibrarySearch search;  ///< its cell size and seed; the rest is above
};

void declare_library(Arguments& arguments, LibraryInputs& inputs);

/// What build_path_libraries() calls them in its messages.
extern const OptionNames library_option_names;

/// @throws Error (bad_input) or (bad_file) naming option or file
LibraryGrid grid_of(const LibraryInputs& inputs);
LibrarySearch search_of(const LibraryInputs& inputs, const LibraryGrid& grid, Console& console);

}  // namespace excavplan::tools
