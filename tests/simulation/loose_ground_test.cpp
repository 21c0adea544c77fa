// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/compaction.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include <excavplan/soil/loose_soil.hpp>

#include "base/random.hpp"
#include "simulation/section_simulator.hpp"
#include "support/errors.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

const std::vector<std::string> soils = {"loam", "clay", "sand", "gravel"};

SoilKind soil_named(const std::string& name) {
  return load_soil(find_data_file("soils/" + name + ".json"));
}

template <typename Simulator>
class LooseGround : public testing::Test {
 protected:
  /// Level ground whose upper part is loose.
  Terrain covered(double thickness) const {
    Terrain ground = level_planning_ground(machine_);
    ground.bank.z -= thickness;
    ground.loose += thickness;
    return ground;
  }

  /// A heap that was dumped on level ground, 2 m wide at its top.
  Terrain stockpile(double height, double middle, double slope) const {
    Terrain ground = level_planning_ground(machine_);
    for (Eigen::Index col = 0; col < ground.loose.cols(); ++col) {
      const double beside = std::max(0.0, std::abs(ground.bank.x(col) - middle) - 1.0);
      ground.loose.col(col).setConstant(std::max(0.0, height - slope * beside));
    }
    return ground;
  }

  std::optional<DigPath> path_on(const Terrain& ground, const DigParameters& parameters,
                                 double x = 6.0) const {
    auto path = make_dig_path(machine_, parameters, x, boom_plane_profile(ground));
    if (!std::holds_alternative<DigPath>(path)) return std::nullopt;
    return std::get<DigPath>(std::move(path));
  }

  DigResult dig(const SoilKind& soil, double density, const Terrain& ground,
                const DigParameters& parameters = {0.785, 0.35, 1.5}) const {
    return Simulator(machine_, soil, density)
        .dig(ground, path_on(ground, parameters).value(), unsettled());
  }

  /// Payload and energy are those of settled ground.
  static DigOptions unsettled() {
    DigOptions options;
    options.settle = false;
    return options;
  }

  const Machine machine_ = test::zx120_held_down();
};

using LooseSimulators = testing::Types<HeightMapSimulator, SectionSimulator>;
TYPED_TEST_SUITE(LooseGround, LooseSimulators, );

void expect_same(const DigResult& a, const DigResult& b, double share) {
  EXPECT_NEAR(a.energy.total, b.energy.total, share * b.energy.total);
  EXPECT_NEAR(a.peak_force, b.peak_force, share * b.peak_force);
  EXPECT_NEAR(a.payload_mass, b.payload_mass, share * b.payload_mass);
  EXPECT_EQ(a.stall.has_value(), b.stall.has_value());
}

TYPED_TEST(LooseGround, ABankThatIsNotTouchedDoesNotCount) {
  for (const std::string& name : soils) {
    SCOPED_TRACE(name);
    const SoilKind soil = soil_named(name);
    for (const DigParameters& parameters :
         {DigParameters{0.785, 0.35, 1.5}, DigParameters{1.0, 0.5, 1.0}}) {
      const Terrain ground = this->covered(0.8);
      const DigResult first = this->dig(soil, 0.0, ground, parameters);
      EXPECT_EQ(first.soil.bank_cut, 0.0);
      EXPECT_FALSE(first.stall);
      for (const double density : {20.0, 40.0, 60.0, 80.0, 100.0}) {
        expect_same(this->dig(soil, density, ground, parameters), first, 1e-9);
      }
    }
  }
}

TYPED_TEST(LooseGround, AStockpileIsDugAlikeOnAnyBank) {
  Random random(11);
  int dug = 0;
  for (const std::string& name : soils) {
    const SoilKind soil = soil_named(name);
    const TypeParam soft(this->machine_, soil, 0.0);
    const TypeParam hard(this->machine_, soil, 100.0);
    for (int i = 0; i < 75;) {
      const Terrain ground =
          this->stockpile(1.5, random.uniform(5.0, 7.0), std::tan(soil.angle_of_repose));
      const auto path = this->path_on(
          ground, {random.uniform(0.3, 1.2), random.uniform(0.2, 0.7), random.uniform(0.3, 2.0)},
          random.uniform(5.5, 8.0));
      if (!path) continue;
      ++i;
      const DigResult on_soft = soft.dig(ground, *path, this->unsettled());
      if (on_soft.soil.bank_cut > 0.0) continue;
      ++dug;
      expect_same(hard.dig(ground, *path, this->unsettled()), on_soft, 1e-9);
    }
  }
  EXPECT_GT(dug, 250);
}

// Soil whose bank is at its loosest, without cohesion, is the same soil whether it was dug or not.
TYPED_TEST(LooseGround, ALayerResistsLikeABankOfThatSoil) {
  for (const std::string& name : soils) {
    SCOPED_TRACE(name);
    SoilKind soil = soil_named(name);
    soil.cohesion_loosest = 0.0;
    soil.void_ratio_max = soil.void_ratio_loose;
    const DigResult bank = this->dig(soil, 0.0, this->covered(0.0));
    for (const double thickness : {0.1, 0.8}) {
      expect_same(this->dig(soil, 0.0, this->covered(thickness)), bank, 0.005);
    }
  }
}

TYPED_TEST(LooseGround, AThickerLayerIsEasierAndACompactedOneHarder) {
  const SoilKind soil = soil_named("loam");
  double last = this->dig(soil, 60.0, this->covered(0.0)).energy.total;
  for (const double thickness : {0.05, 0.1, 0.15, 0.2}) {
    const double energy = this->dig(soil, 60.0, this->covered(thickness)).energy.total;
    EXPECT_LT(energy, last);
    last = energy;
  }
  Terrain ground = this->covered(0.8);
  for (const double void_ratio : {1.283, 1.1, 0.9, 0.7}) {
    ground.loose_void_ratio.setConstant(ground.loose.rows(), ground.loose.cols(), void_ratio);
    const double energy = this->dig(soil, 60.0, ground).energy.total;
    if (void_ratio < 1.283) {
      EXPECT_GT(energy, last);
    }
    last = energy;
  }
}

double solids(const Terrain& ground, double bank_void_ratio) {
  return (ground.bank.z / (1.0 + bank_void_ratio) + ground.loose / (1.0 + ground.loose_void_ratio))
             .sum() *
         ground.bank.cell_size * ground.bank.cell_size;
}

// Dug, filled with what was dug, the tracks over it, and dug again.
TYPED_TEST(LooseGround, SoilThatIsDugAgainNeitherSwellsNorIsLost) {
  Random random(5);
  const SoilKind soil = soil_named("loam");
  const TypeParam simulator(this->machine_, soil, 60.0);
  const double dense = bank_state(soil, 60.0).void_ratio;
  Terrain ground = this->covered(0.0);
  ground.loose_void_ratio.setConstant(ground.loose.rows(), ground.loose.cols(),
                                      soil.void_ratio_loose);
  const double first = solids(ground, dense) + 1e3;
  for (int i = 0; i < 40; ++i) {
    DigOptions options;
    options.dump_at = Eigen::Vector2d(random.uniform(5.0, 6.0), 0.0);
    const auto path =
        this->path_on(ground, {random.uniform(0.4, 0.9), random.uniform(0.1, 0.3), 1.0},
                      random.uniform(5.8, 6.4));
    if (!path) continue;
    const DigResult result = simulator.dig(ground, *path, options);
    ground = result.after(ground);
    EXPECT_NEAR(solids(ground, dense) + 1e3, first, 1e-12 * first);
    if (i % 4 == 3) {
      compact(ground, soil, {{4.5, -0.5, 6.5, 0.5}, random.uniform(1e4, 8e4)});
      EXPECT_NEAR(solids(ground, dense) + 1e3, first, 1e-12 * first);
    }
    EXPECT_GE(ground.loose_void_ratio.minCoeff(), soil.void_ratio_min);
    EXPECT_LE(ground.loose_void_ratio.maxCoeff(), soil.void_ratio_loose);
  }
  // All in the loose state: what leaves the ground as loose soil is as much as is in the bucket.
  Terrain filled = this->covered(1.0);
  const DigResult again = this->dig(soil, 60.0, filled);
  const double lost = (filled.loose - again.after(filled).loose).sum() * 0.05 * 0.05;
  EXPECT_NEAR(lost, again.payload_volume, 1e-9);
}

using MapGround = LooseGround<HeightMapSimulator>;

TEST_F(MapGround, AHeelCompactsTheLooseSoilThatItStandsOn) {
  DigPath sunk = path_on(covered(0.8), {0.785, 0.35, 1.0}).value();
  for (DigPose& pose : sunk.poses) {
    if (pose.phase != DigPhase::drag) continue;
    pose.bucket.floor_angle = -0.1;
    const auto joints = inverse_kinematics(machine_, pose.bucket);
    ASSERT_TRUE(std::holds_alternative<JointAngles>(joints));
    pose.joints = std::get<JointAngles>(joints);
  }
  const SoilKind soil = soil_named("loam");
  Terrain ground = covered(0.8);
  ground.loose_void_ratio.setConstant(ground.loose.rows(), ground.loose.cols(),
                                      soil.void_ratio_loose);
  const DigResult result = HeightMapSimulator(machine_, soil, 60.0).dig(ground, sunk);
  const Terrain after = result.after(ground);
  EXPECT_LT(after.loose_void_ratio.minCoeff(), soil.void_ratio_loose - 0.1);
  EXPECT_NEAR(result.soil.solids_after, result.soil.solids_before,
              1e-12 * result.soil.solids_before);
}

/// The flank of a pile falls at repose, but the wedge before a deep lip reaches beyond its foot.
TEST_F(MapGround, SoilThatIsPushedThroughALowPileIsNotStrewnOverMetres) {
  for (const double middle : {4.9, 5.2, 5.5}) {
    Terrain ground = level_planning_ground(machine_);
    for (Eigen::Index col = 0; col < ground.loose.cols(); ++col) {
      const double beside = std::abs(ground.bank.x(col) - middle);
      ground.loose.col(col).setConstant(std::max(0.0, 0.25 - 0.7 * beside));
    }
    const DigPath path = path_on(ground, {1.0, 0.6, 1.5}, 6.8).value();
    const DigResult dug = HeightMapSimulator(machine_, soil_named("loam"), 10.0).dig(ground, path);
    const Eigen::ArrayXXd rise = dug.after(ground).surface().z - ground.surface().z;
    const double foot = path.poses.back().bucket.x - 1.0;
    for (Eigen::Index col = 0; ground.bank.x(col) < foot; ++col) {
      ASSERT_LT(rise.col(col).maxCoeff(), 0.01) << middle << ", at " << ground.bank.x(col) << " m";
    }
  }
}

TEST_F(MapGround, TracksCompactWhatLiesUnderThem) {
  const SoilKind soil = soil_named("loam");
  Terrain ground = covered(0.4);
  const Eigen::ArrayXXd before = ground.loose;
  Load track{{-1.5, -0.25, 1.5, 0.25}, 40e3};
  track.place.translate(Eigen::Vector2d(5.0, 0.5)).rotate(0.5);
  compact(ground, soil, track);
  double changed = 0.0;
  for (Eigen::Index col = 0; col < before.cols(); ++col) {
    for (Eigen::Index row = 0; row < before.rows(); ++row) {
      const Eigen::Vector2d at =
          track.place.inverse() * Eigen::Vector2d(ground.bank.x(col), ground.bank.y(row));
      const bool under = std::abs(at.x()) < 1.5 && std::abs(at.y()) < 0.25;
      EXPECT_EQ(ground.loose(row, col) < before(row, col), under);
      changed += under ? 1.0 : 0.0;
    }
  }
  EXPECT_NEAR(changed * 0.05 * 0.05, 3.0 * 0.5, 0.1);
  // The stress at half the depth of the layer: 2 : 1, and its own weight.
  const double stress = 40e3 * 3.0 * 0.5 / (3.2 * 0.7) + 0.2 * loose_state(soil).unit_weight;
  const double e =
      soil.void_ratio_loose - 0.3 * (soil.void_ratio_loose - 0.27) * std::log10(stress / 5000.0);
  EXPECT_NEAR(ground.loose_void_ratio.minCoeff(), e, 1e-12);
  EXPECT_NEAR(ground.loose.minCoeff(), 0.4 * (1.0 + e) / (1.0 + soil.void_ratio_loose), 1e-12);
  const Terrain once = ground;
  compact(ground, soil, {{-1.5, -0.25, 1.5, 0.25}, 10e3, track.place});
  EXPECT_LT((ground.loose - once.loose).abs().maxCoeff(), 1e-15);  // a lighter load does no more
}

TEST_F(MapGround, ALoadThatCannotBeIsRefused) {
  const SoilKind soil = soil_named("loam");
  Terrain ground = covered(0.4);
  const auto message = [&](const Load& load) {
    return test::error_of([&] { compact(ground, soil, load); });
  };
  EXPECT_EQ(message({{1.0, 0.0, 1.0, 1.0}, 1e4}), "compact: the area of a load must not be empty");
  EXPECT_EQ(message({{0.0, 0.0, 1.0, 1.0}, -1.0}),
            "compact: the pressure [Pa] is -1, must be not negative and finite");
  EXPECT_NE(message({{0.0, 0.0, std::nan(""), 1.0}, 1.0}).find("must be finite"),
            std::string::npos);
  ground.loose_void_ratio.setConstant(ground.loose.rows(), ground.loose.cols(), 2.0);
  EXPECT_EQ(message({{4.0, 0.0, 5.0, 1.0}, 1e4}),
            "compact: the void ratio of loose soil is 2, must be in 0.415 .. 1.283");
}

}  // namespace
}  // namespace excavplan
