// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/soil_scatter.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>

namespace excavplan {
namespace {

SoilKind soil_of(const char* name) {
  return load_soil(find_data_file(std::string("soils/") + name + ".json"));
}

TEST(SoilScatter, DrawnSoilsAreSoilsWithTheStatedScatter) {
  for (const char* name : {"loam", "sand", "clay", "gravel"}) {
    SCOPED_TRACE(name);
    const SoilKind soil = soil_of(name);
    const double usual = bank_state(soil, 0.0).dry_density;
    constexpr int draws = 2000;
    double squares = 0.0;
    for (std::uint64_t i = 0; i < draws; ++i) {
      const SoilKind drawn = drawn_soil(soil, {}, i);
      EXPECT_GE(drawn.void_ratio_max, drawn.void_ratio_loose);
      EXPECT_GT(drawn.void_ratio_loose, drawn.void_ratio_min);
      EXPECT_LE(bank_state(drawn, 100.0).saturation, 1.0 + 1e-12);
      squares += std::pow(bank_state(drawn, 0.0).dry_density / usual - 1.0, 2);
    }
    EXPECT_NEAR(std::sqrt(squares / draws), SoilScatter().limit_density, 0.001);
  }
}

TEST(SoilScatter, SameSeedSameSoilOtherSeedOtherSoil) {
  const SoilKind loam = soil_of("loam");
  EXPECT_EQ(fingerprint(drawn_soil(loam, {}, 3)), fingerprint(drawn_soil(loam, {}, 3)));
  EXPECT_NE(fingerprint(drawn_soil(loam, {}, 3)), fingerprint(drawn_soil(loam, {}, 4)));
  const SoilKind same = drawn_soil(loam, {0.0, 0.0, 0.0}, 3);
  EXPECT_NEAR(same.void_ratio_loose, loam.void_ratio_loose, 1e-12);
  EXPECT_EQ(same.water_content, loam.water_content);
}

TEST(SoilScatter, WeightGivesTheDensityBack) {
  const SoilKind clay = soil_of("clay");
  for (const double d : {0.0, 35.0, 100.0}) {
    EXPECT_NEAR(density_of_bulk_density(clay, bank_state(clay, d).bulk_density), d, 1e-9);
  }
  EXPECT_LT(density_of_bulk_density(clay, 900.0), 0.0);
}

// In sand 1.5 % of both limits makes about the 5 points that laboratories differ by.
TEST(SoilScatter, LimitsOfSandMakeFivePointsOfItsDensity) {
  const SoilKind sand = soil_of("sand");
  const DensityForm law = density_law_of(sand).form;
  const Eigen::Matrix2d dry = density_scatter(sand, law, 50.0, {0.0, 0.015, 0.0});
  EXPECT_NEAR(std::sqrt(dry(1, 1)), 5.0, 1.0);
  // One point of the water content is one per cent of the dry density: 4 points.
  const Eigen::Matrix2d wet = density_scatter(sand, law, 50.0, {0.2, 0.0, 0.0});
  EXPECT_NEAR(wet(0, 0), 0.0, 1e-18);
  EXPECT_NEAR(std::sqrt(wet(1, 1)), 100.0 * 0.01 / 1.05 * 1.65 / 0.4, 0.3);
  EXPECT_GT(std::sqrt(dry(0, 0)), 2.0);
}

TEST(SoilScatter, ShippedLawsSayWhatTheyWereMeasuredOn) {
  double weights = 0.0;
  for (const SoilLaw& each : shipped_soil_laws()) {
    SCOPED_TRACE(each.soil.name);
    weights += each.weight;
    EXPECT_EQ(each.law.soil, each.soil.name);
    EXPECT_EQ(each.law.machine, "zx120");
    EXPECT_FALSE(each.law.simulator.empty());
    ASSERT_TRUE(each.law.path);
    EXPECT_NEAR((*each.law.path)[1], 0.35, 1e-12);
    EXPECT_TRUE(each.law.any_path);
    EXPECT_GT(residual_sd_at(each.law.form, 50.0), 2.0);
    EXPECT_GT(residual_sd_at(each.law.form, 50.0), residual_sd_at(each.law.freed_form, 50.0));
  }
  EXPECT_NEAR(weights, 1.0, 1e-12);
}

}  // namespace
}  // namespace excavplan
