// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/experiments/experiment.hpp>

#include "frame/console.hpp"
#include "inputs/goal_inputs.hpp"
#include "inputs/ground.hpp"
#include "inputs/search_method.hpp"
#include "inputs/simulator_inputs.hpp"

/// @file
/// What the command line says of an experiment.

namespace excavplan::tools {

struct ExperimentInputs {
  std::string machine = "zx120";  ///< as --machine names it
  std::string densities = "paper";
  std::optional<DigParameters> path;  ///< none: that of the paper
  std::string soil = "loam";
  SimulatorInputs simulator;
  std::optional<std::string> library;
  GoalInputs goal{info_of(DigObjective::Goal::energy).word};
  std::string law = "default";
  std::string second = "fresh";
  bool sensitivity = false;
  bool search = false;
  SearchMethodInputs method;  ///< of the search
  std::optional<double> cell_size;
  GroundInput ground;
  std::uint64_t seed = 1;
  std::uint64_t threads = 0;
};

void declare_experiment(Arguments& arguments, ExperimentInputs& inputs);

/// What the library calls them in its messages.
OptionNames experiment_option_names();

struct ExperimentCondition {
  std::string name;
  double density = 0.0;  ///< [%]
};
/// "soft: density 10.0 %"; "density 10.0 %" where the name is no more.
std::string condition_text(const ExperimentCondition& condition);

std::vector<ExperimentCondition> conditions_of(const ExperimentInputs& inputs);

ExperimentOptions options_of(const ExperimentInputs& inputs, const Machine& machine,
                             const SoilKind& soil, Console& console);

/// The default is the shipped one on the paper's path, on another one of digs along that.
DensityLaw law_of(const ExperimentInputs& inputs, const Machine& machine, const SoilKind& soil);

}  // namespace excavplan::tools
