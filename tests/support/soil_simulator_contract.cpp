// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/soil_simulator_contract.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <variant>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>

#include "base/random.hpp"

namespace excavplan {

Terrain rough_ground(const Machine& machine, std::uint64_t seed) {
  Terrain ground = level_planning_ground(machine);
  Random random(seed);
  for (Eigen::Index i = 0; i < ground.bank.z.size(); ++i) {
    ground.bank.z.data()[i] += 0.02 * random.normal();
    ground.loose.data()[i] = 0.05 * random.uniform();
  }
  return ground;
}

DigParameters overfilling_path() {
  DigParameters parameters = paper_fixed_path();
  parameters.drag_length = 2.0;
  return parameters;
}

SoilSimulatorContract::SoilSimulatorContract()
    : machine_(load_machine(find_data_file("machines/zx120.json"))) {}

DigPath SoilSimulatorContract::path_on(const Machine& machine, const Terrain& ground,
                                       const DigParameters& parameters) {
  const auto path =
      make_dig_path_anywhere(machine, parameters, boom_plane_profile(ground.surface()));
  if (const auto* failure = std::get_if<Infeasible>(&path)) {
    ADD_FAILURE() << failure->message;
    return {};
  }
  return std::get<DigPath>(path);
}

bool SoilSimulatorContract::same_bytes(const DigResult& a, const DigResult& b) {
  return a.patch.row == b.patch.row && a.patch.col == b.patch.col &&
         (a.patch.bank == b.patch.bank).all() && (a.patch.loose == b.patch.loose).all() &&
         a.payload_mass == b.payload_mass && a.energy.total == b.energy.total &&
         a.peak_force == b.peak_force;
}

double SoilSimulatorContract::solids(const Terrain& terrain) {
  return (terrain.bank.z / (1.0 + terrain.bank_void_ratio) +
          terrain.loose / (1.0 + terrain.loose_void_ratio))
             .sum() *
         terrain.bank.cell_size * terrain.bank.cell_size;
}

TEST_P(SoilSimulatorContract, ConservesSolids) {
  for (const double density : {0.0, 35.0, 100.0}) {
    const auto simulator = GetParam().make(machine_, density);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Terrain ground = rough_ground(machine_, seed);
      const DigResult result = simulator->dig(ground, path_on(machine_, ground));
      EXPECT_GT(result.payload_mass, 0.0);
      EXPECT_NEAR(result.soil.solids_after, result.soil.solids_before,
                  1e-9 * result.soil.solids_before);
      DigOptions dump;
      dump.dump_at = Eigen::Vector2d(4.0, 0.5);
      const DigResult dumped = simulator->dig(ground, path_on(machine_, ground), dump);
      EXPECT_NEAR(dumped.soil.solids_after, dumped.soil.solids_before,
                  1e-9 * dumped.soil.solids_before);
    }
  }
}

TEST_P(SoilSimulatorContract, GivesTheSameBytesAgainAndFromManyThreads) {
  const auto simulator = GetParam().make(machine_, 40.0);
  const Terrain ground = rough_ground(machine_, 7);
  const DigPath path = path_on(machine_, ground);
  const DigResult first = simulator->dig(ground, path);
  std::vector<DigResult> results(8);
  std::vector<std::thread> threads;
  for (DigResult& result : results) {
    threads.emplace_back([&] { result = simulator->dig(ground, path); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const DigResult& result : results) EXPECT_TRUE(same_bytes(first, result));
}

TEST_P(SoilSimulatorContract, HasAnIdentityOfItsMachineAndDensityOrNone) {
  Machine weaker = machine_;
  weaker.limits[1].torque *= 0.5;
  const auto identity_of = [](const Machine& machine, double density) {
    return GetParam().make(machine, density)->identity();
  };
  const std::string identity = identity_of(machine_, 40.0);
  EXPECT_EQ(identity, identity_of(machine_, 40.0));
  if (identity.empty()) return;
  EXPECT_NE(identity, identity_of(machine_, 40.001));
  EXPECT_NE(identity, identity_of(weaker, 40.0));
}

TEST_P(SoilSimulatorContract, UnsettledGroundChangesNeitherPayloadNorEnergy) {
  const auto simulator = GetParam().make(machine_, 40.0);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Terrain ground = rough_ground(machine_, seed);
    const DigPath path = path_on(machine_, ground, overfilling_path());
    DigOptions unsettled;
    unsettled.settle = false;
    const DigResult whole = simulator->dig(ground, path);
    const DigResult dug = simulator->dig(ground, path, unsettled);
    EXPECT_EQ(dug.payload_mass, whole.payload_mass);
    EXPECT_EQ(dug.energy.total, whole.energy.total);
    EXPECT_EQ(dug.soil.bank_cut, whole.soil.bank_cut);
    EXPECT_EQ(dug.peak_force, whole.peak_force);
    EXPECT_NEAR(dug.soil.solids_after, dug.soil.solids_before, 1e-9 * dug.soil.solids_before);
  }
}

TEST_P(SoilSimulatorContract, GivesUpNoDigThatReachesTheFloor) {
  const auto simulator = GetParam().make(machine_, 40.0);
  const Terrain ground = level_planning_ground(machine_);
  for (const DigParameters& parameters : {paper_fixed_path(), overfilling_path()}) {
    const DigPath path = path_on(machine_, ground, parameters);
    const DigResult whole = simulator->dig(ground, path);
    EXPECT_FALSE(whole.given_up);
    for (const double share : {0.5, 0.9999, 1.0001, 1.5, 20.0}) {
      DigOptions options;
      options.give_up_below = share * whole.efficiency();
      const DigResult dug = simulator->dig(ground, path, options);
      if (dug.given_up) {
        EXPECT_GT(share, 1.0);
        EXPECT_LT(dug.efficiency(), options.give_up_below);
        EXPECT_LE(dug.energy.total, whole.energy.total);
      } else {
        EXPECT_TRUE(same_bytes(dug, whole)) << share;
      }
      EXPECT_NEAR(dug.soil.solids_after, dug.soil.solids_before, 1e-9 * dug.soil.solids_before);
    }
  }
}

TEST_P(SoilSimulatorContract, LeavesUnknownCellsUnknownAndFarGroundAlone) {
  const auto simulator = GetParam().make(machine_, 40.0);
  Terrain ground = level_planning_ground(machine_);
  const Eigen::Index corner = 0;
  ground.bank.z(corner, corner) = std::nan("");
  const Terrain after = simulator->dig(ground, path_on(machine_, ground)).after(ground);
  EXPECT_TRUE(std::isnan(after.bank.z(corner, corner)));
  EXPECT_EQ(after.bank.z.isNaN().count(), 1);
  const Eigen::Index last = ground.bank.z.cols() - 1;
  EXPECT_TRUE((after.bank.z.col(last) == ground.bank.z.col(last)).all());
  EXPECT_EQ(after.loose.col(last).sum(), 0.0);
}

TEST_P(SoilSimulatorContract, CaresNotHowFarTheMapReaches) {
  const auto simulator = GetParam().make(machine_, 55.0);
  const Terrain near = level_planning_ground(machine_);
  Rectangle extent = near.bank.extent();
  extent.x_max += 30.0;
  extent.y_max += 20.0;
  Terrain far = undisturbed(flat_ground(extent, near.bank.cell_size));
  far.bank.origin = near.bank.origin;
  far.loose(far.loose.rows() - 1, far.loose.cols() - 1) = 3.0;
  const DigPath path = path_on(machine_, near);
  const DigResult a = simulator->dig(near, path);
  const DigResult b = simulator->dig(far, path);
  EXPECT_NEAR(a.payload_mass, b.payload_mass, 1e-9 * a.payload_mass);
  EXPECT_NEAR(a.energy.total, b.energy.total, 1e-9 * a.energy.total);
  EXPECT_EQ(b.after(far).loose(far.loose.rows() - 1, far.loose.cols() - 1), 3.0);
}

// Cells that say how dense they are: honoured to the last grain, or refused.
TEST_P(SoilSimulatorContract, UnevenGroundIsConservedOrRefused) {
  const auto simulator = GetParam().make(machine_, 55.0);
  double grains_per_mass = 0.0;  // of the payload: the same whatever the ground was like
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Terrain ground = rough_ground(machine_, seed);
    Random random(seed, 1);
    ground.bank_void_ratio = ground.loose_void_ratio = ground.loose;
    for (Eigen::Index i = 0; i < ground.loose.size(); ++i) {
      ground.bank_void_ratio.data()[i] = random.uniform(0.6, 0.75);
      ground.loose_void_ratio.data()[i] = random.uniform(0.6, 0.75);
    }
    try {
      const DigResult result = simulator->dig(ground, path_on(machine_, ground));
      EXPECT_GT(result.payload_mass, 0.0);
      const double gone = solids(ground) - solids(result.after(ground));
      if (seed == 1) grains_per_mass = gone / result.payload_mass;
      EXPECT_NEAR(gone / result.payload_mass, grains_per_mass, 1e-9 * grains_per_mass);
      EXPECT_NEAR(result.soil.solids_after, result.soil.solids_before,
                  1e-9 * result.soil.solids_before);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    }
  }
}

TEST_P(SoilSimulatorContract, DigsAgainAndAgainOnAnyGround) {
  const auto simulator = GetParam().make(machine_, 45.0);
  for (const double gradient : {-0.15, 0.0, 0.15}) {
    Terrain ground = rough_ground(machine_, 9);
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      ground.bank.z.col(col) += gradient * (ground.bank.x(col) - 5.0);
      if (ground.bank.x(col) < 4.5) ground.bank.z.col(col) -= 0.15;  // a step
    }
    ground.bank.z.topRows(4).setConstant(std::nan(""));  // unseen, beside the dig
    const Eigen::Index unknown = ground.bank.z.isNaN().count();
    int digs = 0;
    for (int i = 0; i < 3; ++i) {
      const auto path =
          make_dig_path_anywhere(machine_, {0.6, 0.25, 1.0}, boom_plane_profile(ground));
      if (!std::holds_alternative<DigPath>(path)) break;
      const DigResult result = simulator->dig(ground, std::get<DigPath>(path));
      EXPECT_NEAR(result.soil.solids_after, result.soil.solids_before,
                  1e-9 * result.soil.solids_before);
      apply(result.patch, ground);
      EXPECT_EQ(ground.bank.z.isNaN().count(), unknown);
      EXPECT_GE(ground.loose.minCoeff(), 0.0);
      ++digs;
    }
    EXPECT_GE(digs, 2) << gradient;
  }
}

TEST_P(SoilSimulatorContract, LedgersAddUp) {
  const auto simulator = GetParam().make(machine_, 60.0);
  const Terrain ground = level_planning_ground(machine_);
  DigOptions options;
  options.history = true;
  const DigResult result = simulator->dig(ground, path_on(machine_, ground), options);
  const EnergyLedger& energy = result.energy;
  const double total = energy.total;
  EXPECT_GT(total, 0.0);
  EXPECT_NEAR(energy.by_phase[0] + energy.by_phase[1] + energy.by_phase[2], total, 1e-9 * total);
  EXPECT_NEAR(energy.by_joint[0] + energy.by_joint[1] + energy.by_joint[2], total, 1e-9 * total);
  EXPECT_NEAR(energy.soil + energy.payload + energy.links, total, 1e-9 * total);
  ASSERT_FALSE(result.history.empty());
  double peak = 0.0;
  for (const ForceSample& sample : result.history) peak = std::max(peak, sample.soil.norm());
  EXPECT_NEAR(peak, result.peak_force, 1e-9 * peak);
  EXPECT_NEAR(result.payload_volume, result.soil.payload, 1e-12);
  EXPECT_NEAR(result.soil.fallback_fraction, result.soil.fallen_back / result.soil.bank_cut, 1e-12);
}

TEST_P(SoilSimulatorContract, NoEfficiencyAboveThePhysicalBound) {
  // f <= 1 / (g dz), dz = depth of the cut's middle + height of the payload
  // (docs/methods.md#energy).
  const Terrain ground = level_planning_ground(machine_);
  Random random(11);
  int digs = 0;
  for (int i = 0; i < 200; ++i) {
    const auto simulator = GetParam().make(machine_, random.uniform(0.0, 100.0));
    DigParameters parameters;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      parameters.*info.field = random.uniform(info.lower, info.upper);
    }
    const auto path =
        make_dig_path_anywhere(machine_, parameters, boom_plane_profile(ground.surface()));
    if (!std::holds_alternative<DigPath>(path)) continue;
    const DigResult result = simulator->dig(ground, std::get<DigPath>(path));
    const double depth = parameters.penetration_length * std::sin(parameters.penetration_angle);
    EXPECT_LE(result.efficiency(), 1.0 / (9.80665 * 0.5 * depth));
    ++digs;
  }
  EXPECT_GT(digs, 50);
}

TEST_P(SoilSimulatorContract, RefusesWhatItCannotDig) {
  const auto simulator = GetParam().make(machine_, 40.0);
  const Terrain ground = level_planning_ground(machine_);
  const DigPath path = path_on(machine_, ground);
  EXPECT_THROW(simulator->dig(Terrain{}, path), Error);
  EXPECT_THROW(simulator->dig(ground, DigPath{}), Error);
  EXPECT_THROW(simulator->dig(undisturbed(flat_ground({20, -2, 25, 2}, 0.05)), path), Error);
  EXPECT_THROW(simulator->dig(undisturbed(flat_ground({1, -0.2, 9, 0.2}, 0.05)), path), Error);
  Terrain unknown = ground;
  unknown.bank.z.setConstant(std::nan(""));
  EXPECT_THROW(simulator->dig(unknown, path), Error);
  DigOptions off_map;
  off_map.dump_at = Eigen::Vector2d(100.0, 0.0);
  EXPECT_THROW(simulator->dig(ground, path, off_map), Error);
}

}  // namespace excavplan
