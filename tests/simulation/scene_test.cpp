// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/scene.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <excavplan/data_files.hpp>
#include <excavplan/ground/bulking.hpp>
#include <excavplan/simulation/calibration.hpp>

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
  EXPECT_EQ(far.warnings[0].code, "dump_out_of_reach");
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
