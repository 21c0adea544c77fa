// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "inputs/maps.hpp"
#include "inputs/plots.hpp"
#include "simulate_dig/fuel_log.hpp"
#include "simulate_dig/scene_scans.hpp"

namespace excavplan::tools {

/// What is written of a simulated dig.
struct SceneFiles {
  SceneScanInputs scans;
  FuelLogInputs fuel_log;
  Plots plots;
  Maps maps;
  std::optional<std::string> history, report;
};

/// @param seed  of the noise of scans and fuel
void write_files(const SceneFiles& files, const Machine& machine, const DigScene& scene,
                 std::uint64_t seed, Outcome& outcome);

}  // namespace excavplan::tools
