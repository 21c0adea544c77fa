// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/calibration/fallback.hpp>

#include <cmath>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include "base/random.hpp"

#include "support/errors.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

class FallbackTest : public testing::Test {
 protected:
  FallbackTest() {
    path_ = std::get<DigPath>(
        make_dig_path_anywhere(machine_, {0.785, 0.35, 2.0}, boom_plane_profile(ground_)));
  }

  DigResult dig(double density) const {
    return HeightMapSimulator(machine_, loam_, density).dig(ground_, path_);
  }

  const Machine machine_ = test::zx120_held_down();
  const SoilKind loam_ = load_soil(find_data_file("soils/loam.json"));
  const Terrain ground_ = level_planning_ground(machine_);
  DigPath path_;
};

TEST_F(FallbackTest, IsWhatTheSimulatorSaysFellBack) {
  for (const double density : {10.0, 50.0, 75.0}) {
    const DigResult result = dig(density);
    const Fallback found =
        measure_fallback(machine_, path_, ground_.bank, result.after(ground_).surface());
    EXPECT_NEAR(found.cut, result.soil.bank_cut, 2e-3 * result.soil.bank_cut);
    EXPECT_NEAR(found.fraction.value, result.soil.fallback_fraction, 0.016) << density;
    EXPECT_EQ(found.seen_share, 1.0);
  }
}

TEST_F(FallbackTest, FreesTheBulkingFactor) {
  const DigResult result = dig(75.0);
  ASSERT_GT(result.soil.fallback_fraction, 0.02);
  const HeightMap after = result.after(ground_).surface();
  const HeightMapVolumes v = height_map_volumes(ground_, result.after(ground_), {99.0, 99.0});
  const double measured = (v.spilled + result.payload_volume) / v.excavated;
  const Fallback found = measure_fallback(machine_, path_, ground_.bank, after);
  const double freed = free_of_fallback(measured, found.fraction.value);
  const double truth = bulking_of_density(loam_, 75.0);
  EXPECT_GT(std::abs(measured - truth), 0.008);
  EXPECT_NEAR(freed, truth, 0.008);
}

TEST_F(FallbackTest, NoiseDoesNotBecomeSoil) {
  HeightMap after = dig(10.0).after(ground_).surface();
  const Fallback clean = measure_fallback(machine_, path_, ground_.bank, after);
  Random random(4);
  for (double& z : after.z.reshaped()) z += 0.02 * random.normal();
  const Fallback found = measure_fallback(machine_, path_, ground_.bank, after);
  // Clipping 2 cm of noise would make 0.012 m3 of it.
  EXPECT_NEAR(found.in_pit, clean.in_pit, 0.004);
}

TEST_F(FallbackTest, ErrorIsThatOfAPathThatLayDeeper) {
  const HeightMap after = dig(75.0).after(ground_).surface();
  DigPath deeper = path_;
  for (DigPose& pose : deeper.poses) pose.bucket.z -= 0.015;
  const Fallback found = measure_fallback(machine_, path_, ground_.bank, after, 0.015);
  const Fallback other = measure_fallback(machine_, deeper, ground_.bank, after, 0.015);
  EXPECT_NEAR(other.fraction.value - found.fraction.value, found.fraction.sd,
              0.15 * found.fraction.sd);
}

TEST_F(FallbackTest, UnseenFloorIsTakenAlikeAndRefusedAboveHalf) {
  const HeightMap after = dig(75.0).after(ground_).surface();
  HeightMap partly = after;
  for (Eigen::Index row = 0; row < partly.z.rows(); row += 4) partly.z.row(row) = std::nan("");
  const Fallback whole = measure_fallback(machine_, path_, ground_.bank, after);
  const Fallback some = measure_fallback(machine_, path_, ground_.bank, partly);
  EXPECT_LT(some.seen_share, 0.9);
  EXPECT_NEAR(some.fraction.value, whole.fraction.value, 0.05);
  partly.z.setConstant(std::nan(""));
  const std::string error =
      test::error_of([&] { measure_fallback(machine_, path_, ground_.bank, partly); });
  EXPECT_NE(error.find("is known in both scans"), std::string::npos) << error;
}

}  // namespace
}  // namespace excavplan
