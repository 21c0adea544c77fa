// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/simulators.hpp>

#include "simulation/checked_dig.hpp"
#include "support/errors.hpp"
#include "support/machine_file.hpp"
#include "support/run_program.hpp"

/// @file
/// Digs of simulators that are no part of the program.

namespace excavplan::test {

/// Relief, loose soil and a corner that nobody has seen.
Terrain uneven_ground(double cell_size = 0.1);

DigPath path_on(const Terrain& ground, const DigParameters& parameters);

DigResult dug(const SoilSimulator& simulator, const Terrain& ground = uneven_ground(),
              const DigOptions& options = {});
DigResult dug(const SimulatorKind& kind, double density_percent = 40.0);

/// What holds of every dig with loads: energies add up, dry mass is kept, unknown cells stay so.
void expect_sound_digs(const SoilSimulator& simulator);

}  // namespace excavplan::test
