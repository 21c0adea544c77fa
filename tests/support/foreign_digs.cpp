// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/foreign_digs.hpp"

#include <string>
#include <variant>

#include <gtest/gtest.h>

namespace excavplan::test {

Terrain uneven_ground(double cell_size) {
  Terrain ground = level_planning_ground(zx120(), cell_size);
  for (Eigen::Index col = 0; col < ground.loose.cols(); ++col) {
    for (Eigen::Index row = 0; row < ground.loose.rows(); ++row) {
      ground.bank.z(row, col) += 0.02 * std::sin(3.0 * static_cast<double>(row + 2 * col));
      ground.loose(row, col) = 0.03 * static_cast<double>((row * 7 + col * 3) % 5);
    }
  }
  ground.bank.z.topRows(3).setConstant(std::nan(""));
  return ground;
}

DigPath path_on(const Terrain& ground, const DigParameters& parameters) {
  return std::get<DigPath>(make_dig_path_anywhere(zx120(), parameters, boom_plane_profile(ground)));
}

DigResult dug(const SoilSimulator& simulator, const Terrain& ground, const DigOptions& options) {
  const DigPath path = path_on(ground, paper_fixed_path());
  return checked_dig(simulator, zx120(), ground, path, options);
}

DigResult dug(const SimulatorKind& kind, double density_percent) {
  return dug(*make_simulator(kind, zx120(), loam(), density_percent));
}

void expect_sound_digs(const SoilSimulator& simulator) {
  const Terrain ground = uneven_ground();
  for (const bool dumps : {false, true}) {
    DigOptions options;
    options.history = true;
    if (dumps) options.dump_at = Eigen::Vector2d(4.0, 0.5);
    const DigResult dig = dug(simulator, ground, options);
    const EnergyLedger& energy = dig.energy;
    EXPECT_GT(dig.payload_mass, 50.0);
    EXPECT_GT(energy.total, 1e3);
    EXPECT_NEAR(energy.by_phase[0] + energy.by_phase[1] + energy.by_phase[2], energy.total,
                1e-9 * energy.total);
    EXPECT_NEAR(energy.soil + energy.links, energy.total, 1e-9 * energy.total);
    EXPECT_EQ(dig.torques.size(), path_on(ground, paper_fixed_path()).poses.size() - 1);
    EXPECT_FALSE(dig.history.empty());
    EXPECT_GT(dig.peak_force, 1e3);
    EXPECT_NEAR(dig.soil.solids_after, dig.soil.solids_before, 1e-9 * dig.soil.solids_before);
    const Terrain after = dig.after(ground);
    EXPECT_EQ(after.bank.z.isNaN().count(), ground.bank.z.isNaN().count());
    EXPECT_GE(after.loose.minCoeff(), 0.0);
  }
}

}  // namespace excavplan::test
