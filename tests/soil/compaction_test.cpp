// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/compaction.hpp>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>

namespace excavplan {
namespace {

RelativeDensity density_of(double percent, double sd) {
  RelativeDensity density;
  density.percent = percent;
  density.sd_percent = sd;
  density.interval_percent = {percent - 1.96 * sd, percent + 1.96 * sd};
  return density;
}

TEST(Compaction, OfSandByHand) {
  SoilKind sand = load_soil(find_data_file("soils/sand.json"));  // e 0.85 .. 0.45, grains 2.65
  sand.specific_gravity = 2.65;
  sand.void_ratio_max = 0.85;
  sand.void_ratio_min = 0.45;
  const Compaction half = compaction_of(sand, density_of(50.0, 2.0), 1800.0);
  EXPECT_NEAR(half.percent, 100.0 * 2650.0 / 1.65 / 1800.0, 0.02 * half.percent / 100.0 + 0.1);
  EXPECT_NEAR(half.sd_percent, 2.0 * half.percent * 0.004 / 1.65, 1e-3);
  EXPECT_NEAR(half.interval_percent[1] - half.interval_percent[0], 2.0 * 1.96 * half.sd_percent,
              0.01);
  const Compaction densest = compaction_of(sand, density_of(100.0, 0.0), 2650.0 / 1.45);
  EXPECT_NEAR(densest.percent, 100.0, 0.3);  // of water at 20 degrees
  EXPECT_EQ(densest.sd_percent, 0.0);
}

TEST(Compaction, RefusesWhatIsNoDryDensity) {
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  for (const double density : {1.84, 0.0, 18400.0}) {
    EXPECT_THROW(compaction_of(loam, density_of(40.0, 3.0), density), Error) << density;
  }
}

}  // namespace
}  // namespace excavplan
