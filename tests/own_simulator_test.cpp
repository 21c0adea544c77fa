// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// How to plug in a soil simulator of your own: derive from SoilSimulator, implement dig(), and run
/// the contract suite on it. Anything in this library that takes a SoilSimulator then takes yours.

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include <excavplan/planning/planner.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

#include "soil_simulator_contract.hpp"

namespace excavplan {
namespace {

/// A shovel without limits: lifts all soil above the tip's line, at a fixed energy per volume.
class ShovelSimulator : public SoilSimulator {
 public:
  ShovelSimulator(const Machine& machine, const SoilKind& soil, double density_percent)
      : width_(machine.bucket.width_outside),
        bank_(bank_state(soil, density_percent)),
        loose_(loose_state(soil)) {}

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override {
    check(path.poses.size() >= 2, "the path needs two poses");
    check(terrain.bank.z.size() > 0, "the map is empty");
    DigResult result;
    result.terrain = terrain;
    result.soil.solids_before = solids(terrain);
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
      cut_below(path.poses[i - 1].bucket, path.poses[i].bucket, result);
    }
    const double mass = result.soil.bank_cut * bank_.dry_density +
                        result.soil.loose_cut * loose_.dry_density;  // of solids [kg]
    result.payload_volume = result.soil.payload = mass / loose_.dry_density;
    result.payload_mass = result.payload_volume * loose_.bulk_density;
    fill_energy(result, path, options.history);
    result.soil.solids_after = solids(result.terrain) + mass;
    if (options.dump_at) {
      cell_at(result.terrain, *options.dump_at) +=
          result.payload_volume / (terrain.bank.cell * terrain.bank.cell);
      result.soil.solids_after = solids(result.terrain);
    }
    return result;
  }

 private:
  static constexpr double energy_per_volume = 50e3;  ///< [J/m^3]

  static void check(bool holds, const char* rule) {
    if (!holds) throw Error(ErrorKind::bad_input, std::string("shovel: ") + rule);
  }

  /// Loose thickness of the cell at a point.
  static double& cell_at(Terrain& terrain, const Eigen::Vector2d& at) {
    const Rectangle extent = terrain.bank.extent();
    check(extent.contains(at.x(), at.y()), "the dump point must lie on the map");
    const Eigen::Vector2d cells = (at - terrain.bank.origin) / terrain.bank.cell;
    return terrain.loose(static_cast<Eigen::Index>(cells.y()),
                         static_cast<Eigen::Index>(cells.x()));
  }

  /// Lowers every cell whose centre the bucket passes between two poses to the lower of both.
  void cut_below(const BucketPose& from, const BucketPose& to, DigResult& result) const {
    HeightMap& bank = result.terrain.bank;
    const Rectangle swept = {std::min(from.x, to.x), -0.5 * width_, std::max(from.x, to.x),
                             0.5 * width_};
    const Rectangle map = bank.extent();
    check(swept.x_min >= map.x_min && swept.x_max < map.x_max && swept.y_min >= map.y_min &&
              swept.y_max <= map.y_max,
          "the path must lie on the map");
    const double level = std::min(from.z, to.z);
    const double area = bank.cell * bank.cell;
    for (Eigen::Index col = 0; col < bank.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < bank.z.rows(); ++row) {
        if (!swept.contains(bank.x(col), bank.y(row))) continue;
        double& z = bank.z(row, col);
        double& loose = result.terrain.loose(row, col);
        check(!std::isnan(z), "the path must lie on known ground");
        const double loose_cut = std::clamp(z + loose - level, 0.0, loose);
        const double bank_cut = std::max(0.0, z - level);
        loose -= loose_cut;
        z -= bank_cut;
        result.soil.loose_cut += loose_cut * area;
        result.soil.bank_cut += bank_cut * area;
      }
    }
  }

  static void fill_energy(DigResult& result, const DigPath& path, bool history) {
    EnergyLedger& energy = result.energy;
    energy.total = energy.soil = energy_per_volume * result.payload_volume;
    energy.by_phase[1] = energy.by_joint[1] = energy.total;  // all of it in the arm, in the drag
    const double travel = std::max(1e-3, path.parameters.drag_length);
    ForceSample sample;
    sample.phase = DigPhase::drag;
    sample.travelled = travel;
    sample.soil = {energy.total / travel, 0.0};
    sample.bucket_fill = result.payload_volume;
    result.peak_force = sample.soil.norm();
    if (history) result.history.push_back(sample);
  }

  /// Dry mass of the map above z = -10 m [kg].
  double solids(const Terrain& terrain) const {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < terrain.bank.z.size(); ++i) {
      const double z = terrain.bank.z.data()[i];
      if (std::isnan(z)) continue;
      sum += (z + 10.0) * bank_.dry_density + terrain.loose.data()[i] * loose_.dry_density;
    }
    return sum * terrain.bank.cell * terrain.bank.cell;
  }

  double width_;
  SoilState bank_;
  SoilState loose_;
};

SoilKind loam() { return load_soil(find_data_file("soils/loam.json")); }

INSTANTIATE_TEST_SUITE_P(Own, SoilSimulatorContract,
                         testing::Values(SimulatorCase{"shovel",
                                                       [](const Machine& machine, double density) {
                                                         return std::make_unique<ShovelSimulator>(
                                                             machine, loam(), density);
                                                       }}),
                         [](const auto& tested) { return tested.param.name; });

TEST(OwnSimulator, IsTakenByThePlanner) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const ShovelSimulator simulator(machine, loam(), 40.0);
  const Terrain ground = level_planning_ground(machine);
  const auto dig = evaluate_dig(machine, simulator, ground, paper_fixed_path());
  ASSERT_TRUE(std::holds_alternative<PlannedDig>(dig));
  const PlannedDig& planned = std::get<PlannedDig>(dig);
  EXPECT_NEAR(planned.energy, 50e3 * planned.payload_volume, 1e-6);

  DigSearchOptions options;
  options.genetic.population = 8;
  options.genetic.generations = 2;
  options.polish_evaluations = 0;
  const auto found = search_dig(machine, simulator, ground, options);
  ASSERT_TRUE(found);
  EXPECT_GT(found->dig.payload_mass, 0.0);
}

}  // namespace
}  // namespace excavplan
