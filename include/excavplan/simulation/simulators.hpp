// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// A kind of simulator. Searches, plans and calibrations take one and make simulators with it for
/// the machine, the soil and the densities that they need. Fill one in to use your own simulator.
struct SimulatorKind {
  std::string word;  ///< that chooses it on the command line: "height-map"
  /// Name and version, "height-map 1". The version rises with every change that affects the result
  /// of a dig; laws and libraries state the name and are refused with another one.
  std::string name;
  /// @throws Error (bad_input) unless 0 <= density_percent <= 100
  std::function<std::unique_ptr<const SoilSimulator>(const Machine& machine, const SoilKind& soil,
                                                     double density_percent)>
      make;
};

/// All built-in simulators; the first is the default.
const std::vector<SimulatorKind>& simulator_kinds();
inline const SimulatorKind& default_simulator() { return simulator_kinds().front(); }

/// @throws Error (bad_input) naming the words there are
const SimulatorKind& simulator_of_word(const std::string& word);

}  // namespace excavplan
