// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "design/design_walls.hpp"
#include "job/job_learning.hpp"
#include "job/job_map.hpp"
#include "job/trench_job.hpp"

namespace excavplan::test {
namespace {

/// A trench from x = 2 to 6, 1 m wide at its floor, in level ground.
struct Cut : PlainSiteFolder {
  explicit Cut(double depth, const std::string& soil = "loam", double batter = 0.0) {
    site["design"]["depth_m"] = depth;
    site["design"]["floor_z_at_middle_m"] = -depth;
    site["soil"]["name"] = soil;
    if (batter > 0.0) site["design"]["wall_horizontal_per_vertical"] = batter;
  }
};

class Walls {
 public:
  /// @param rise  of the ground from 0.3 m beside the trench on [m]
  explicit Walls(const Cut& cut, double rise = 0.0)
      : of_(cut), ground(rising(rise)), map_(map_of(of_.settings, ground.bank)) {}

  std::optional<DesignWall> weakest(const std::optional<BasePose>& base = {}) const {
    return weakest_wall(task(base));
  }
  std::optional<DesignWall> weakest_about(const std::vector<Eigen::Vector2d>& about) const {
    return weakest_wall(task({}), about, 0.5);
  }

 private:
  static Terrain rising(double rise) {
    HeightMap level = flat_ground({-8.0, -7.0, 10.0, 7.0}, 0.05);
    for (Eigen::Index row = 0; row < level.z.rows(); ++row) {
      if (std::abs(level.y(row)) > 0.8) level.z.row(row) += rise;
    }
    return undisturbed(level);
  }
  WallTask task(const std::optional<BasePose>& base) const {
    const SoilKind& soil = of_.settings.site.soil;
    const SoilState state = bank_state(with_strength(soil, strength), of_.settings.density_percent);
    const WallSoil bank = {state, state};
    return {map_.target, map_.before, ground, bank, loose_state(soil), of_.settings.site.machine,
            base};
  }

  TrenchJob of_;

 public:
  Terrain ground;
  double strength = 1.0;

 private:
  JobMap map_;
};

TEST(JobWalls, AShallowTrenchStandsInLoamAndNotInSand) {
  const Cut in_loam(0.5), in_sand(0.5, "sand"), battered(0.5, "sand", 1.73);
  EXPECT_FALSE(Walls(in_loam).weakest());
  EXPECT_FALSE(Walls(battered).weakest());
  const auto wall = Walls(in_sand).weakest();
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->height, 0.5, 0.01);
  EXPECT_LT(wall->batter, 0.1);
  EXPECT_LT(wall->factor, 1.0);
  ASSERT_TRUE(wall->standing);
  EXPECT_GT(*wall->standing, 0.1);
  const Cut better(0.5, "sand", *wall->standing + 0.1);
  EXPECT_FALSE(Walls(better).weakest()) << "the batter that it asks for";
}

TEST(JobWalls, GravelStandsAtItsFrictionAngle) {
  const Cut flat(0.5, "gravel", 1.73), steep(0.5, "gravel", 1.0);
  EXPECT_FALSE(Walls(flat).weakest());
  EXPECT_TRUE(Walls(steep).weakest());
}

TEST(JobWalls, ADeepCutMayNotCountOnMoisture) {
  const Cut shallow(1.0, "sand", 1.2), deep(1.5, "sand", 1.2);
  EXPECT_FALSE(Walls(shallow).weakest());
  const auto wall = Walls(deep).weakest();
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->factor, std::tan(0.541 + 0.4 * 0.1745) * 1.2, 0.05) << "by friction alone";
  const Cut flat(1.5, "sand", 1.73);
  EXPECT_FALSE(Walls(flat).weakest());
}

TEST(JobWalls, SoilThatIsNotSurelyStrongIsNotTrusted) {
  const Cut cut(1.5);
  Walls walls(cut);
  EXPECT_FALSE(walls.weakest());
  walls.strength = 0.6;
  const auto wall = walls.weakest();
  ASSERT_TRUE(wall);
  EXPECT_GT(wall->factor, 1.1) << "enough for a wall of 1.25 m";
  EXPECT_LT(wall->factor, 1.3);
}

TEST(JobWalls, DeepOnesMustStandInSoilAsStrongAsItSurelyIs) {
  const SoilKind loam = load_soil(std::string(EXCAVPLAN_DATA_SOURCE) + "/soils/loam.json");
  const WallSoil bank = wall_soil(loam, 10.0);
  EXPECT_LT(bank.sure.cohesion, 0.6 * bank.believed.cohesion);
  EXPECT_FALSE(weak_wall(bank, 1.2, 0.0)) << "upright as rules let it be";
  EXPECT_TRUE(weak_wall(bank, 1.3, 0.0));
  EXPECT_FALSE(weak_wall(bank, 1.3, 1.0));
}

TEST(JobWalls, SpoilAndTracksAtTheEdgeLoadIt) {
  const Cut cut(1.5);
  Walls walls(cut);
  walls.strength = 0.75;
  EXPECT_FALSE(walls.weakest());
  const BasePose beside{4.0, 2.0, 0.0}, far{4.0, 5.0, 0.0};
  EXPECT_FALSE(walls.weakest(far));
  const auto by_tracks = walls.weakest(beside);
  ASSERT_TRUE(by_tracks);
  EXPECT_NEAR(by_tracks->edge->y(), 0.5, 0.1);
  EXPECT_NE(warning_of(*by_tracks).message.find("keep spoil and tracks off"), std::string::npos);
  for (Eigen::Index col = 0; col < walls.ground.loose.cols(); ++col) {
    for (Eigen::Index row = 0; row < walls.ground.loose.rows(); ++row) {
      const double y = walls.ground.bank.y(row);
      if (y < -0.5 && y > -2.0) walls.ground.loose(row, col) = 1.5;
    }
  }
  const auto by_spoil = walls.weakest();
  ASSERT_TRUE(by_spoil);
  EXPECT_NEAR(by_spoil->edge->y(), -0.5, 0.1);
}

TEST(JobWalls, HigherGroundBesideThemLoadsThem) {
  const Cut cut(1.5);
  Walls level(cut), below_a_bank(cut, 1.5);
  level.strength = below_a_bank.strength = 0.75;
  EXPECT_FALSE(level.weakest());
  EXPECT_TRUE(below_a_bank.weakest());
}

TEST(JobWalls, InLevelGroundIsThatOfTheDesign) {
  const Cut cut(0.5, "sand");
  Walls walls(cut);
  const auto there = walls.weakest();
  const SoilKind sand = load_soil(std::string(EXCAVPLAN_DATA_SOURCE) + "/soils/sand.json");
  const auto alone = weak_wall(wall_soil(sand, 40.0), 0.5, 0.0);
  ASSERT_TRUE(there && alone);
  EXPECT_NEAR(alone->factor, there->factor, 0.02);
  EXPECT_EQ(alone->standing, there->standing);
  EXPECT_EQ(warning_of(*alone).message.find(" at x ="), std::string::npos);
  EXPECT_FALSE(weak_wall(wall_soil(sand, 40.0), 0.2, 0.0)) << "no wall to speak of";
}

TEST(JobWalls, OnlyWallsNearbyAreLookedAt) {
  const Cut cut(0.5, "sand");
  const Walls walls(cut);
  const auto near = walls.weakest_about({{2.2, -0.5}, {3.0, -0.5}});
  ASSERT_TRUE(near);
  EXPECT_LT(near->edge->x(), 3.6);
  EXPECT_LT(near->edge->y(), 0.1);
  EXPECT_FALSE(walls.weakest_about({{2.0, -4.0}, {6.0, -4.0}}));
}

TEST(JobWalls, StepsAtAWallThatMayFailAreNotTrusted) {
  const Cut cut(0.5, "sand");
  TrenchJob of(cut);
  SiteJob job = of.begin();
  const auto told = job.wall_warnings();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].code, WarningCode::unstable_wall);
  EXPECT_TRUE(told[0].ends_trust);
  EXPECT_NE(told[0].message.find("give it a batter of"), std::string::npos);
  JobStep step = job.next();
  EXPECT_TRUE(step.trustworthy) << "a move";
  while (!step.digs()) {
    of.make_step(job);
    step = job.next();
  }
  EXPECT_FALSE(step.trustworthy);
  EXPECT_TRUE(std::any_of(step.warnings.begin(), step.warnings.end(), [](const Warning& each) {
    return each.code == WarningCode::unstable_wall;
  }));
}

TEST(JobWalls, StepsInSoilThatStandsAreTrusted) {
  const ShortTrench trench;
  TrenchJob of(trench);
  SiteJob job = of.begin();
  EXPECT_TRUE(job.wall_warnings().empty());
  JobStep step = job.next();
  while (!step.digs()) {
    of.make_step(job);
    step = job.next();
  }
  EXPECT_TRUE(step.trustworthy);
}

}  // namespace
}  // namespace excavplan::test
