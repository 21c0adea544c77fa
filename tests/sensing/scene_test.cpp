// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/sensing/scene.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/change/bulking.hpp>

#include "sensing/block_heap.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

class SceneTest : public testing::Test {
 protected:
  DigScene scene(const SceneOptions& options = {}) const {
    const Terrain ground = undisturbed(flat_ground(scene_extent(machine_, options.dump_at), 0.05));
    return run_scene(machine_, soil_, 40.0, ground, options);
  }

  const Machine machine_ = load_machine(shipped_or_file("machines", "zx120"));
  const SoilKind soil_ = load_soil(shipped_or_file("soils", "loam"));
};

TEST_F(SceneTest, HoldsTheHeapBesideTheHole) {
  const DigScene dug = scene();
  EXPECT_TRUE(dug.warnings.empty());
  EXPECT_NEAR(dug.volumes.dumped, dug.dig.payload_volume, 0.01 * dug.dig.payload_volume);
  // Soil that slides back into the cut hides part of the hole.
  const double freed = free_of_fallback(dug.volumes.bulking_factor, dug.dig.soil.fallback_fraction);
  EXPECT_NEAR(freed, dug.bulking_factor_true, 1e-3);
  EXPECT_GT(height_at(dug.after.surface(), dug.dump_at.x(), dug.dump_at.y()), 0.2);
  EXPECT_TRUE(dug.dig.history.empty());
  EXPECT_GT(dug.duration, 0.0);
}

TEST_F(SceneTest, DigsAtTheStartAndInTheSimulatorGiven) {
  SceneOptions options;
  options.start_x = 5.5;
  options.history = true;
  const DigScene built_in = scene(options);
  EXPECT_EQ(built_in.path.start_x, 5.5);
  EXPECT_FALSE(built_in.dig.history.empty());
  options.simulator = simulator_of_word("section");
  const DigScene section = scene(options);
  EXPECT_NE(section.dig.energy.total, built_in.dig.energy.total);
  EXPECT_NEAR(section.dig.energy.total, built_in.dig.energy.total, 0.2 * built_in.dig.energy.total);
}

TEST_F(SceneTest, WarnsOfADumpPointOutOfReachAndRefusesOneInTheDig) {
  SceneOptions options;
  options.dump_at = {-6.1, 6.1};
  const DigScene far = scene(options);
  ASSERT_EQ(far.warnings.size(), 1U);
  EXPECT_EQ(far.warnings[0].code, WarningCode::dump_out_of_reach);
  options.dump_at = {5.0, 0.0};
  EXPECT_EQ(test::error_of([&] { scene(options); }).find("the dump point 5,0 is 0.00 m from"), 0U);
}

TEST_F(SceneTest, PlannedPathsMayMissTheirDistancesByMillimetres) {
  SceneOptions options;
  options.path = {0.7, 0.35, 0.3};
  double last = 5.0;  // the tip comes ever nearer to the tracks
  const auto driven = [&] {
    options.start_x = last;
    return test::error_of([&] { scene(options); }) == "no error";
  };
  while (driven()) last -= 0.01;
  options.rules = rules_for_planned_path();
  EXPECT_TRUE(driven());
  last -= 0.1;
  EXPECT_FALSE(driven());
}

TEST_F(SceneTest, IsScannedOverTheDigAndOverTheHeap) {
  const DigScene dug = scene();
  DepthCamera camera;
  camera.noise = 0.0;
  camera.dropouts = 0.0;
  const SceneScans scans = scan_scene(dug, camera, 1);
  EXPECT_EQ(scans.before.size(), 2U * 256 * 144);
  const auto lowest = std::min_element(
      scans.after.begin(), scans.after.end(),
      [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.z() < b.z(); });
  const auto highest = std::max_element(
      scans.after.begin(), scans.after.end(),
      [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.z() < b.z(); });
  EXPECT_LT(lowest->z(), -0.2);
  EXPECT_LT((highest->head<2>() - dug.dump_at).norm(), 0.2);
  for (const Eigen::Vector3d& point : scans.before) ASSERT_NEAR(point.z(), 0.0, 1e-9);
}

TEST_F(SceneTest, ScansAreThoseOfTheirSeed) {
  const DigScene dug = scene();
  const SceneScans one = scan_scene(dug, DepthCamera{}, 1);
  EXPECT_EQ(scan_scene(dug, DepthCamera{}, 1).after, one.after);
  EXPECT_NE(scan_scene(dug, DepthCamera{}, 2).after, one.after);
}

TEST_F(SceneTest, IsScannedFromTheCamerasGiven) {
  DepthCamera camera;
  camera.noise = 0.0;
  camera.dropouts = 0.0;
  const CameraPlace over_heap = {{5.5, 3.0, 2.5}, {5.5, 4.0, 0.0}};
  const SceneScans one = scan_scene(scene(), camera, 1, {over_heap});
  EXPECT_EQ(one.before.size(), 256U * 144);
  for (const Eigen::Vector3d& point : one.after) ASSERT_GT(point.y(), 1.0);
  const SceneScans two = scan_scene(scene(), camera, 1, {over_heap, {{4.0, 1, 2.5}, {5, 0, 0}}});
  EXPECT_GT(two.before.size(), one.before.size() + 20000U);
}

class HardSoil : public SceneTest {
 protected:
  HardSoil() { held_down_.body.reset(); }

  /// @param blocks size, swell, fines
  DigScene broken(const BlockSettings& blocks, double density_percent = 90.0) const {
    SceneOptions options;
    options.blocks = blocks;
    const Terrain ground = undisturbed(flat_ground(scene_extent(machine_, options.dump_at), 0.05));
    return run_scene(held_down_, soil_, density_percent, ground, options);
  }
  static double loose_soil(const DigScene& scene) {
    const HeightMapVolumes volumes = height_map_volumes(scene.before, scene.after, scene.dump_at);
    return volumes.spilled + volumes.dumped;
  }

  Machine held_down_ = machine_;  // dense soil would lift the machine
};

TEST_F(HardSoil, FallsAsBlocksWithVoidsThatKeepItsVolume) {
  const DigScene scene = broken({});
  ASSERT_TRUE(scene.blocks);
  const BlockLayer& layer = *scene.blocks;
  EXPECT_NEAR(layer.soil, loose_soil(scene), 1e-9);
  const double seen = scene.volumes.spilled + scene.volumes.dumped;
  EXPECT_NEAR(seen, layer.soil + layer.voids, 1e-9);
  EXPECT_GT(layer.voids, 0.15 * seen);  // angular blocks with their fines: 0.35 .. 0.50 deep inside
  EXPECT_LT(layer.voids, 0.50 * seen);
  const double mean_edge = std::cbrt(layer.soil / layer.count);
  EXPECT_NEAR(mean_edge, 0.17, 0.04);
  EXPECT_GT(scene.volumes.bulking_factor, 1.2 * scene.bulking_factor_true);
}

TEST_F(HardSoil, KeepsItsHoleClearOfBlocks) {
  const DigScene scene = broken({});
  const HeightMapVolumes whole = height_map_volumes(scene.before, scene.after, scene.dump_at);
  EXPECT_NEAR(scene.volumes.excavated, whole.excavated, 0.02 * whole.excavated);
}

TEST_F(HardSoil, UndisturbedBlocksDoNotSwell) {
  BlockSettings undisturbed;
  undisturbed.swell = 0.0;
  const DigScene scene = broken(undisturbed);
  EXPECT_NEAR(scene.blocks->soil, loose_soil(scene) / scene.bulking_factor_true, 1e-9);
}

TEST_F(HardSoil, BlocksAreThoseOfTheirSizeAndSeed) {
  BlockSettings settings;
  const DigScene first = broken(settings);
  EXPECT_TRUE((broken(settings).blocks->after.z == first.blocks->after.z).all());
  settings.seed = 2;
  EXPECT_FALSE((broken(settings).blocks->after.z == first.blocks->after.z).all());
  settings.size = 0.3;
  EXPECT_LT(broken(settings).blocks->count, first.blocks->count / 3);
  settings = {};
  settings.fines = 0.0;
  EXPECT_GT(broken(settings).blocks->voids, 1.2 * first.blocks->voids);
}

/// On a strip hardly wider than a block most drops find no room, which is no end of it; where none
/// finds any, it is.
TEST(BlocksOfRise, FindRoomWhereFewDropsDo) {
  const auto dropped = [](double width) {
    const HeightMap before = flat_ground({-1.0, -1.0, 1.0, 1.0}, 0.02);
    HeightMap after = before;
    for (Eigen::Index row = 0; row < after.z.rows(); ++row) {
      after.z.row(row) = std::abs(after.y(row)) < 0.5 * width ? 0.5 : std::nan("");
    }
    BlockSettings settings;
    settings.fines = 0.0;
    return blocks_of_rise(before, after, 0.05, settings);
  };
  const BlockLayer layer = dropped(0.3);
  EXPECT_GT(layer.count, 5);
  EXPECT_EQ(layer.soil, 0.05);
  EXPECT_GT(layer.voids, 0.0);
  EXPECT_EQ(test::error_of([&] { dropped(0.04); }),
            "blocks: blocks of 0.15 m find no room where soil rose");
}

TEST_F(HardSoil, SofterGroundCrumbles) {
  const DigScene scene = broken({}, 79.0);
  EXPECT_FALSE(scene.blocks);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(scene.warnings[0].code, WarningCode::no_blocks);
}

TEST_F(HardSoil, BlocksThatMakeNoSenseAreRefused) {
  const auto error = [&](double size, double swell, double fines) {
    BlockSettings settings;
    settings.size = size;
    settings.swell = swell;
    settings.fines = fines;
    return test::error_of([&] { broken(settings); });
  };
  EXPECT_EQ(error(0.01, 1.0, 0.3).rfind("blocks: size is 0.01, must be at least 0.0", 0), 0U);
  EXPECT_EQ(error(0.15, 1.5, 0.3), "blocks: swell is 1.5, must be in 0 .. 1");
  EXPECT_EQ(error(0.15, 1.0, 1.0), "blocks: fines is 1, must be in 0 .. 1");
}

TEST_F(SceneTest, CalibrationDigsInTheSimulatorGiven) {
  CalibrationOptions options;
  options.densities_percent = {0.0, 30.0, 60.0, 90.0};
  const DensityCalibration built_in = calibrate_density(machine_, soil_, options);
  options.simulator = simulator_of_word("section");
  const DensityCalibration section = calibrate_density(machine_, soil_, options);
  EXPECT_EQ(section.source, "digs of the simulator " + options.simulator.name + ", zx120 in loam");
  ASSERT_EQ(section.samples.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NE(section.samples[i].bulking_factor, built_in.samples[i].bulking_factor);
    EXPECT_NEAR(section.samples[i].bulking_factor, section.samples[i].bulking_factor_true, 0.02);
  }
}

TEST_F(SceneTest, TheUsualLawIsTheShippedOneOfTheVerySameSoil) {
  const auto known = shipped_soil_laws();
  SoilKind own = soil_;
  EXPECT_EQ(usual_law(machine_, own, known).name, known.front().law.name);
  own.void_ratio_loose *= 0.95;
  const DensityLaw calibrated = usual_law(machine_, own, known);
  EXPECT_LT(bulking_of_density(calibrated.form, 50.0),
            bulking_of_density(known.front().law.form, 50.0));
}

TEST_F(SceneTest, CalibrationFitsMeasuredSamples) {
  std::vector<BulkingSample> samples;
  for (const double d : {10.0, 30.0, 50.0, 70.0, 90.0}) {
    samples.push_back({1.0 / (1.0 - 0.004 * d), d});
  }
  const DensityCalibration fitted = calibrate_density(samples);
  EXPECT_EQ(fitted.source, "5 measured samples");
  EXPECT_EQ(fitted.use, "closed_form");
  EXPECT_NEAR(density_of_bulking(fitted.form("closed_form"), 1.25), 50.0, 1e-3);
  ASSERT_EQ(fitted.samples.size(), 5U);
  EXPECT_EQ(fitted.samples[1].density_percent, 30.0);
  EXPECT_EQ(fitted.samples[1].bulking_factor, samples[1].bulking_factor);
  samples.resize(2);
  EXPECT_NE(test::error_of([&] { calibrate_density(samples); }), "no error");
}

}  // namespace
}  // namespace excavplan
