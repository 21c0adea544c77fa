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

/// A way to simulate digs: whatever searches, plans or calibrates takes one, and makes simulators
/// of it for the machine, the soil and the densities that it needs. Fill one in to use a simulator
/// of your own.
struct SimulatorKind {
  std::string word;  ///< that chooses it on the command line: "height-map"
  /// With its version, "height-map 1": rises with every change that changes the result of a dig.
  /// Laws and libraries keep it, and another name refuses them.
  std::string name;
  /// @throws Error (bad_input) unless 0 <= density_percent <= 100
  std::function<std::unique_ptr<const SoilSimulator>(const Machine& machine, const SoilKind& soil,
                                                     double density_percent)>
      make;
};

/// All that excavplan knows of; the first is the default.
const std::vector<SimulatorKind>& simulator_kinds();
inline const SimulatorKind& default_simulator() { return simulator_kinds().front(); }

/// @throws Error (bad_input) naming the words there are
const SimulatorKind& simulator_of_word(const std::string& word);

}  // namespace excavplan
