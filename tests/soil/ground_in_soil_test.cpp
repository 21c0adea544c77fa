// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/ground_in_soil.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <excavplan/base/data_files.hpp>

#include "support/errors.hpp"
#include "support/machine_file.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using test::loam;

PlainGround plain_ground() {
  PlainGround plain;
  plain.ground.terrain = undisturbed(flat_ground({0.0, 0.0, 0.4, 0.1}, 0.1));
  plain.bank_density_percent.resize(1, 4);
  plain.bank_density_percent << 0.0, 40.0, 100.0, std::nan("");
  plain.loose_density_percent = plain.bank_density_percent;
  return plain;
}

TEST(GroundInSoil, DensitiesAreVoidRatios) {
  const SoilKind soil = loam();
  const GroundState state = ground_in_soil(plain_ground(), soil);
  const Eigen::ArrayXXd& bank = state.terrain.bank_void_ratio;
  EXPECT_EQ(state.soil, "loam");
  EXPECT_EQ(bank(0), soil.void_ratio_max);
  EXPECT_NEAR(bank(1), bank_state(soil, 40.0).void_ratio, 1e-15);
  EXPECT_NEAR(bank(2), soil.void_ratio_min, 1e-15);
  EXPECT_TRUE(std::isnan(bank(3)));
  const Eigen::ArrayXXd& loose = state.terrain.loose_void_ratio;
  EXPECT_EQ(loose(0), soil.void_ratio_loose);
  EXPECT_EQ(loose(1), bank(1));
}

TEST(GroundInSoil, WhatIsNotKnownIsFilled) {
  const SoilKind soil = loam();
  const Terrain terrain = terrain_to_dig(ground_in_soil(plain_ground(), soil), soil, 60.0);
  EXPECT_EQ(terrain.bank_void_ratio(3), bank_state(soil, 60.0).void_ratio);
  EXPECT_EQ(terrain.bank_void_ratio(0), soil.void_ratio_max);
  EXPECT_EQ(terrain.loose_void_ratio(3), soil.void_ratio_loose);
  PlainGround bare = plain_ground();
  bare.bank_density_percent.resize(0, 0);
  bare.loose_density_percent.resize(0, 0);
  const Terrain even = terrain_to_dig(ground_in_soil(bare, soil), soil, 60.0);
  EXPECT_EQ(even.bank_void_ratio.size(), 0);
  EXPECT_TRUE((even.loose_void_ratio == soil.void_ratio_loose).all());
}

TEST(GroundInSoil, TheDensityOfAPlaceIsThatOfItsCells) {
  const SoilKind soil = loam();
  const Terrain terrain = ground_in_soil(plain_ground(), soil).terrain;
  EXPECT_NEAR(*bank_density_percent(terrain, soil, {0.0, 0.0, 0.2, 1.0}), 20.0, 1e-9);
  EXPECT_NEAR(*bank_density_percent(terrain, soil, {0.2, 0.0, 0.4, 1.0}), 100.0, 1e-9);
  EXPECT_FALSE(bank_density_percent(terrain, soil, {0.3, 0.0, 0.4, 1.0}));
  EXPECT_FALSE(bank_density_percent(undisturbed(terrain.bank), soil, {0.0, 0.0, 1.0, 1.0}));
}

TEST(GroundInSoil, AFileIsOfItsSoil) {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("ground.tif");
  GroundState state = ground_in_soil(plain_ground(), loam());
  save_ground(file, state);
  EXPECT_EQ(load_ground(file, loam()).terrain.bank_void_ratio(1), state.terrain.bank_void_ratio(1));
  const SoilKind clay = load_soil(find_data_file("soils/clay.json"));
  EXPECT_EQ(test::error_about([&] { load_ground(file, clay); }, file),
            "its void ratios are of 'loam', but the soil is 'clay'");
  state.soil = "";
  save_ground(file, state);
  EXPECT_TRUE(test::contains(test::error_about([&] { load_ground(file, clay); }, file),
                             "a void ratio of the bank is "));
}

TEST(GroundInSoil, AJsonNamesGrids) {
  const test::TemporaryFolder folder;
  folder.write("bank.asc", "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n0.5\n");
  const std::string file = folder.write("ground.json", R"({"bank": "bank.asc"})");
  EXPECT_EQ(load_ground(file, loam()).terrain.bank.z(0), 0.5);
}

}  // namespace
}  // namespace excavplan
