// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/simulation/compaction.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/dig_many.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/random.hpp"

namespace excavplan {
namespace {

class DigMany : public testing::Test {
 protected:
  std::vector<DigPath> paths_on(const Terrain& ground, int count) const {
    std::vector<DigPath> paths;
    Random random(7, 0);
    while (static_cast<int>(paths.size()) < count) {
      const DigParameters dig = {random.uniform(0.3, 1.2), random.uniform(0.05, 0.8),
                                 random.uniform(0.0, 2.5)};
      auto path =
          make_dig_path(machine_, dig, random.uniform(4.0, 7.0), boom_plane_profile(ground));
      if (auto* drivable = std::get_if<DigPath>(&path)) paths.push_back(*drivable);
    }
    return paths;
  }

  /// Level ground on which tracks have pressed part of a loose layer.
  Terrain pressed_ground() const {
    Terrain ground = level_planning_ground(machine_);
    ground.loose += 0.3;
    compact(ground, soil_, {{3.0, -0.6, 5.5, 0.8}, 6e4, Eigen::Isometry2d::Identity()});
    return ground;
  }

  Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  SoilKind soil_ = load_soil(find_data_file("soils/loam.json"));
  HeightMapSimulator simulator_{machine_, soil_, 55.0};
};

bool same(const Eigen::ArrayXXd& a, const Eigen::ArrayXXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && (a == b).all();
}

void expect_same(const DigResult& one, const DigResult& other) {
  EXPECT_EQ(one.payload_mass, other.payload_mass);
  EXPECT_EQ(one.energy.total, other.energy.total);
  EXPECT_EQ(one.energy.by_joint, other.energy.by_joint);
  EXPECT_EQ(one.energy.lift, other.energy.lift);
  EXPECT_EQ(one.peak_force, other.peak_force);
  EXPECT_EQ(one.torques, other.torques);
  ASSERT_EQ(one.stall.has_value(), other.stall.has_value());
  if (one.stall) {
    EXPECT_EQ(one.stall->travelled, other.stall->travelled);
  }
}

TEST_F(DigMany, AreTheDigsOneByOneForAnyNumberOfThreads) {
  for (const Terrain& ground : {level_planning_ground(machine_, 0.1), pressed_ground()}) {
    const std::vector<DigPath> paths = paths_on(ground, 12);
    for (const unsigned threads : {1U, 2U, 5U, 0U}) {
      const std::vector<DigResult> many = dig_many(simulator_, ground, paths, {}, threads);
      ASSERT_EQ(many.size(), paths.size());
      for (std::size_t i = 0; i < paths.size(); ++i) {
        const DigResult one = simulator_.dig(ground, paths[i]);
        expect_same(one, many[i]);
        EXPECT_EQ(one.soil.solids_after, many[i].soil.solids_after);
        EXPECT_TRUE(same(one.patch.bank, many[i].patch.bank));
        EXPECT_TRUE(same(one.patch.loose, many[i].patch.loose));
        EXPECT_TRUE(same(one.patch.loose_void_ratio, many[i].patch.loose_void_ratio));
      }
    }
  }
}

TEST_F(DigMany, TheirWorthAloneIsThatOfWholeDigs) {
  const Terrain ground = pressed_ground();
  const std::vector<DigPath> paths = paths_on(ground, 8);
  DigOptions alone;
  alone.settle = false;
  alone.worth_alone = true;
  const std::vector<DigResult> many = dig_many(simulator_, ground, paths, alone, 2);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const DigResult whole = simulator_.dig(ground, paths[i]);
    expect_same(whole, many[i]);
    EXPECT_EQ(whole.soil.bank_cut, many[i].soil.bank_cut);
    EXPECT_EQ(whole.soil.payload, many[i].soil.payload);
    EXPECT_EQ(many[i].patch.bank.size(), 0);
  }
}

TEST_F(DigMany, FailAsTheFirstThatFails) {
  const Terrain ground = level_planning_ground(machine_, 0.1);
  std::vector<DigPath> paths = paths_on(ground, 4);
  for (DigPose& pose : paths[1].poses) pose.bucket.x += 50.0;
  for (DigPose& pose : paths[2].poses) pose.bucket.x -= 50.0;
  std::string first;
  try {
    simulator_.dig(ground, paths[1]);
  } catch (const Error& error) {
    first = error.what();
  }
  for (const unsigned threads : {1U, 3U}) {
    try {
      dig_many(simulator_, ground, paths, {}, threads);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(first, error.what());
    }
  }
  EXPECT_TRUE(dig_many(simulator_, ground, {}).empty());
}

/// The heel stands on a heap to both sides of the boom plane, farther behind the path than the
/// window of the dig reached.
TEST_F(DigMany, PressSoilFarBehindTheirPath) {
  Terrain ground = level_planning_ground(machine_, 0.025);
  ground.loose += 0.3;
  for (Eigen::Index col = 0; col < ground.loose.cols(); ++col) {
    for (Eigen::Index row = 0; row < ground.loose.rows(); ++row) {
      if (ground.bank.x(col) > 6.3 && std::abs(ground.bank.y(row)) > 0.1) {
        ground.loose(row, col) += 0.6;
      }
    }
  }
  compact(ground, soil_, {{3.0, -0.6, 8.5, 0.8}, 6e4, Eigen::Isometry2d::Identity()});
  const auto path = make_dig_path(machine_, {0.15, 0.1, 0.1}, 5.4, boom_plane_profile(ground));
  const HeightMapSimulator simulator(machine_, soil_, 20.0);
  const DigResult dig = simulator.dig(ground, std::get<DigPath>(path));
  EXPECT_NEAR(dig.soil.solids_after / dig.soil.solids_before, 1.0, 1e-9);
}

}  // namespace
}  // namespace excavplan
