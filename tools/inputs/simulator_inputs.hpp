// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/simulation/simulators.hpp>

#include "frame/tool.hpp"

/// @file
/// Which simulator digs: the same options in every tool that simulates.

namespace excavplan::tools {

struct SimulatorInputs {
  std::string simulator = default_simulator().word;  ///< a word, or the file of a shared library
  std::optional<std::string> command;                ///< of a program instead
  double timeout = 60.0;                             ///< of its answers [s]
};

void declare_simulator(Arguments& arguments, SimulatorInputs& inputs);

/// Whether it is that of the shipped libraries and laws.
bool is_default(const SimulatorInputs& inputs);

/// What the program of a simulator writes on standard error are notes.
/// @throws Error (bad_input) or (bad_file) naming option or file
SimulatorKind simulator_of(const SimulatorInputs& inputs, Console& console);

}  // namespace excavplan::tools
