// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// What every SoilSimulator must satisfy. To check your own, compile the .cpp beside this too, and
/// in a test of yours:
///
///     INSTANTIATE_TEST_SUITE_P(Mine, SoilSimulatorContract, testing::Values(
///         SimulatorCase{"mine", [](const Machine& m, double density) { return make_mine(m,
///         density); }}));

namespace excavplan {

struct SimulatorCase {
  std::string name;
  std::function<std::unique_ptr<SoilSimulator>(const Machine&, double density_percent)> make;
};

/// The planning ground with 2 cm of relief and up to 5 cm of loose soil.
Terrain rough_ground(const Machine& machine, std::uint64_t seed);

/// Brings more than the bucket holds.
DigParameters overfilling_path();

class SoilSimulatorContract : public testing::TestWithParam<SimulatorCase> {
 protected:
  SoilSimulatorContract();

  static DigPath path_on(const Machine& machine, const Terrain& ground,
                         const DigParameters& parameters = paper_fixed_path());
  static bool same_bytes(const DigResult& a, const DigResult& b);
  /// Volume of grains over the whole map, from the cells' own void ratios.
  static double solids(const Terrain& terrain);

  const Machine machine_;
};

}  // namespace excavplan
