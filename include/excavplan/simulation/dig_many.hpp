// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/simulation/soil_simulator.hpp>

namespace excavplan {

/// Digs along each of many paths on the same ground, every time on the ground as it is: result i is
/// that of `simulator.dig(terrain, paths[i], options)` to the last bit, for any number of threads.
///
/// @param threads  to dig in; 0: one per core
/// @throws what the first of the digs throws, in their order
std::vector<DigResult> dig_many(const SoilSimulator& simulator, const Terrain& terrain,
                                const std::vector<DigPath>& paths, const DigOptions& options = {},
                                unsigned threads = 0);

}  // namespace excavplan
