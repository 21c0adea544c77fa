// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// How to plug in a soil simulator of your own: derive from SoilSimulator, implement dig(), and run
/// the contract suite on it. Anything in this library that takes a SoilSimulator then takes yours.
/// Its identity() distinguishes the checkpoints of its searches.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/dig_search.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

#include "support/machine_file.hpp"
#include "support/soil_simulator_contract.hpp"

namespace excavplan {
namespace {

using test::loam;

/// A shovel without limits: lifts all soil above the tip's line, at a fixed energy per volume.
class ShovelSimulator : public SoilSimulator {
 public:
  ShovelSimulator(const Machine& machine, const SoilKind& soil, double density_percent)
      : width_(machine.bucket.width_outside),
        bank_(bank_state(soil, density_percent)),
        loose_(loose_state(soil)),
        identity_("shovel 1, machine " + fingerprint(machine) + ", soil " + fingerprint(soil) +
                  " at " + std::to_string(density_percent) + " %") {}

  std::string identity() const override { return identity_; }

  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override {
    check(path.poses.size() >= 2, "the path needs two poses");
    check(terrain.bank.z.size() > 0, "the map is empty");
    check(terrain.bank_void_ratio.size() == 0 && terrain.loose_void_ratio.size() == 0,
          "cells with void ratios of their own are more than it can handle");
    DigResult result;
    result.patch = uncut_patch(terrain, path, options);
    result.soil.solids_before = solids(result.patch, terrain.bank.cell_size);
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
      cut_below(path.poses[i - 1].bucket, path.poses[i].bucket, terrain.bank, result);
    }
    const double mass = result.soil.bank_cut * bank_.dry_density +
                        result.soil.loose_cut * loose_.dry_density;  // of solids [kg]
    result.payload_volume = result.soil.payload = mass / loose_.dry_density;
    result.payload_mass = result.payload_volume * loose_.bulk_density;
    fill_energy(result, path, options.history);
    if (options.dump_at) {
      const auto [row, col] = cell_at(terrain.bank, *options.dump_at);
      result.patch.loose(row - result.patch.row, col - result.patch.col) +=
          result.payload_volume / (terrain.bank.cell_size * terrain.bank.cell_size);
    }
    result.soil.solids_after =
        solids(result.patch, terrain.bank.cell_size) + (options.dump_at ? 0.0 : mass);
    return result;
  }

 private:
  static constexpr double energy_per_volume = 50e3;  ///< [J/m^3]

  static void check(bool holds, const char* rule) {
    if (!holds) throw Error(ErrorKind::bad_input, std::string("shovel: ") + rule);
  }

  /// Row and column of a point.
  static std::pair<Eigen::Index, Eigen::Index> cell_at(const HeightMap& map,
                                                       const Eigen::Vector2d& at) {
    const Eigen::Vector2d cells = (at - map.origin) / map.cell_size;
    check(cells.x() >= 0.0 && cells.y() >= 0.0 && cells.x() < static_cast<double>(map.z.cols()) &&
              cells.y() < static_cast<double>(map.z.rows()),
          "path and dump point must lie on the map");
    return {static_cast<Eigen::Index>(cells.y()), static_cast<Eigen::Index>(cells.x())};
  }

  /// The cells between the corners of all that the dig touches, as they are: a result holds no more
  /// of the terrain than can have changed.
  TerrainPatch uncut_patch(const Terrain& terrain, const DigPath& path,
                           const DigOptions& options) const {
    std::vector<Eigen::Vector2d> touched;
    for (const DigPose& pose : path.poses) {
      for (const double side : {-0.5, 0.5}) touched.emplace_back(pose.bucket.x, side * width_);
    }
    if (options.dump_at) touched.push_back(*options.dump_at);
    auto [first_row, first_col] = cell_at(terrain.bank, touched.front());
    auto [last_row, last_col] = std::pair(first_row, first_col);
    for (const Eigen::Vector2d& at : touched) {
      const auto [row, col] = cell_at(terrain.bank, at);
      first_row = std::min(first_row, row);
      first_col = std::min(first_col, col);
      last_row = std::max(last_row, row);
      last_col = std::max(last_col, col);
    }
    TerrainPatch patch;
    patch.row = first_row;
    patch.col = first_col;
    const Eigen::Index rows = last_row - first_row + 1;
    const Eigen::Index cols = last_col - first_col + 1;
    patch.bank = terrain.bank.z.block(first_row, first_col, rows, cols);
    patch.loose = terrain.loose.block(first_row, first_col, rows, cols);
    return patch;
  }

  /// Lowers every cell whose centre the bucket passes between two poses to the lower of both.
  void cut_below(const BucketPose& from, const BucketPose& to, const HeightMap& map,
                 DigResult& result) const {
    TerrainPatch& patch = result.patch;
    const Rectangle swept = {std::min(from.x, to.x), -0.5 * width_, std::max(from.x, to.x),
                             0.5 * width_};
    const double level = std::min(from.z, to.z);
    const double area = map.cell_size * map.cell_size;
    for (Eigen::Index col = 0; col < patch.bank.cols(); ++col) {
      for (Eigen::Index row = 0; row < patch.bank.rows(); ++row) {
        if (!swept.contains(map.x(patch.col + col), map.y(patch.row + row))) continue;
        double& z = patch.bank(row, col);
        double& loose = patch.loose(row, col);
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
    sample.joints = 0.5 * (path.poses.front().joints + path.poses.back().joints);
    sample.soil = {energy.total / travel, 0.0};
    sample.bucket_fill = result.payload_volume;
    result.peak_force = sample.soil.norm();
    if (history) result.history.push_back(sample);
  }

  /// Dry mass of the patch above z = -10 m [kg].
  double solids(const TerrainPatch& patch, double cell) const {
    const auto known = patch.bank == patch.bank;  // NaN is not
    return cell * cell *
           known
               .select((patch.bank + 10.0) * bank_.dry_density + patch.loose * loose_.dry_density,
                       0.0)
               .sum();
  }

  double width_;
  SoilState bank_;
  SoilState loose_;
  std::string identity_;
};

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
  options.stop.evaluations = 30;
  const auto found = search_dig(machine, simulator, ground, options);
  ASSERT_TRUE(found);
  EXPECT_GT(found->dig.payload_mass, 0.0);
}

}  // namespace
}  // namespace excavplan
