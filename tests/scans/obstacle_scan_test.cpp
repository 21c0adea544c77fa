// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "ground/obstacles.hpp"
#include "scans/scan_obstacles.hpp"
#include "scans/scan_wires.hpp"

#include "support/machine_file.hpp"
#include "support/obstacle_judge.hpp"

/// @file
/// What of obstacles comes from a scan into the ground of a motion: shapes seen by rays.

namespace excavplan::test {
namespace {

using Eigen::Vector3d;

/// From 3.2 m above the machine, coarse rows.
RayScan seen(const Shape& shape) {
  ObstacleScene scene;
  scene.shapes = {shape};
  return ray_scan(scene, {{{0.3, 0.4, 3.2}, 0.006, 0.014}}, 1);
}

HeightMap ground_of(const Shape& shape) {
  return swing_terrain_from_scan(seen(shape).scan(), zx120()).terrain.highest();
}

/// The highest within 0.1 m.
double top_at(const HeightMap& map, double x, double y) {
  double top = -1.0;
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      if (std::hypot(map.x(col) - x, map.y(row) - y) < 0.1) top = std::max(top, map.z(row, col));
    }
  }
  return top;
}

TEST(ObstacleScan, MastWallAndPersonAreAsHighAsTheyAre) {
  using Kind = Shape::Kind;
  const HeightMap mast = ground_of({Kind::post, "mast", {3.0, 5.0, 0.0}, {0.1, 0.0, 4.0}});
  EXPECT_GE(top_at(mast, 3.0, 5.0), 4.0);
  EXPECT_GE(top_at(mast, 3.1, 5.17), 4.0) << "its hidden side";
  EXPECT_LT(top_at(mast, 3.0, 5.8), 0.1);
  const HeightMap wall = ground_of({Kind::box, "wall", {0.0, 5.0, 0.0}, {4.0, 0.2, 3.5}});
  for (const double x : {-1.8, -0.7, 0.0, 1.3}) EXPECT_GE(top_at(wall, x, 5.0), 3.45) << x;
  const HeightMap person = ground_of({Kind::post, "person", {-3.0, -4.0, 0.0}, {0.22, 0.0, 1.7}});
  EXPECT_GE(top_at(person, -3.0, -4.0), 1.7);
}

/// Few rays hit it; it goes on between and beyond them.
TEST(ObstacleScan, AWireIsThereBetweenItsReturns) {
  Shape wire{Shape::Kind::wire, "wire", {-8.0, 4.0, 3.0}, {0.01, 0.0, 0.0}};
  wire.to = Vector3d(8.0, 5.0, 3.4);
  const RayScan scan = seen(wire);
  ASSERT_GE(scan.hits[0], 3);
  ASSERT_LT(scan.hits[0], 200);
  const HeightMap map = ground_of(wire);
  for (double x = -7.0; x < 7.0; x += 0.25) {
    EXPECT_GE(top_at(map, x, 4.5 + x / 16.0), 3.4) << x;
  }
  EXPECT_LT(top_at(map, 1.0, 6.5), 0.1);
}

TEST(ObstacleScan, NothingStandsOnBareGroundAndHeaps) {
  const auto bare = swing_terrain_from_scan(
      seen({Shape::Kind::cone, "heap", {4.0, 4.0, 0.0}, {1.5, 0.0, 0.9}}).scan(), zx120());
  EXPECT_EQ(bare.terrain.obstacles.size(), 0);
}

/// The present scan sees the ground around and below them, from elsewhere.
Terrain with_earlier(const Shape& shape) {
  const Scan empty = ray_scan({}, {{{0.3, -0.4, 3.2}, 0.006, 0.014}}, 2).scan();
  return with_surroundings(swing_terrain_from_scan(empty, zx120()).terrain,
                           swing_terrain_from_scan(seen(shape).scan(), zx120()).terrain)
      .terrain;
}

/// No ray need hit it.
TEST(ObstacleScan, AWireOfAnEarlierScanStays) {
  Shape wire{Shape::Kind::wire, "wire", {-8.0, 4.0, 3.0}, {0.01, 0.0, 0.0}};
  wire.to = Vector3d(8.0, 5.0, 3.4);
  const HeightMap map = with_earlier(wire).highest();
  for (double x = -7.0; x < 7.0; x += 0.25) EXPECT_GE(top_at(map, x, 4.5 + x / 16.0), 3.4) << x;
  EXPECT_LT(top_at(map, 1.0, 6.5), 0.1);
  const HeightMap mast =
      with_earlier({Shape::Kind::post, "mast", {3.0, 5.0, 0.0}, {0.02, 0.0, 4.0}}).highest();
  EXPECT_GE(top_at(mast, 3.0, 5.0), 3.8);
}

/// Rays through their place show that they have gone.
TEST(ObstacleScan, PeopleAndTrucksOfAnEarlierScanThatLeftAreGone) {
  using Kind = Shape::Kind;
  const Terrain person = with_earlier({Kind::post, "person", {-3.0, -4.0, 0.0}, {0.22, 0.0, 1.7}});
  EXPECT_LT(top_at(person.highest(), -3.0, -4.0), 0.1);
  const Terrain truck = with_earlier({Kind::box, "truck", {0.0, 6.0, 0.0}, {5.0, 2.4, 2.6}});
  EXPECT_LT(top_at(truck.highest(), 0.0, 6.0), 0.1);
  EXPECT_LT(top_at(truck.highest(), 1.0, 5.0), 0.1);
}

/// How many cells are thin of a square, seen from above, that hangs over level ground.
Eigen::Index thin_cells_of(double width) {
  auto cloud = std::make_shared<Cloud>();
  for (int i = -40; i < 40; ++i) {
    for (int j = -40; j < 40; ++j) {
      const double x = 0.05 * i + 0.025, y = 0.05 * j + 0.025;
      const bool hangs = std::max(std::abs(x), std::abs(y)) < 0.5 * width;
      cloud->points.emplace_back(x, y, hangs ? 2.0 : 0.0);
    }
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  return seen_tops(scan, flat_ground({-1.5, -1.5, 1.5, 1.5}, 0.05), {}).thin.count();
}

/// What is thin stays where a later scan sees the ground behind it.
TEST(ObstacleScan, ALoadOnARopeIsThinAndARoofIsNot) {
  EXPECT_GT(thin_cells_of(0.2), 0);
  EXPECT_EQ(thin_cells_of(2.0), 0);
}

TEST(ObstacleScan, ThreeReturnsOnALineAreAWire) {
  std::vector<Vector3d> hits = {{-4.0, 3.0, 3.0}, {0.0, 4.0, 3.1}};
  EXPECT_TRUE(find_wires(hits).empty());
  hits.emplace_back(4.0, 5.0, 3.2);
  const std::vector<Wire> wires = find_wires(hits);
  ASSERT_EQ(wires.size(), 1U);
  EXPECT_NEAR(std::abs(wires[0].direction.y() / wires[0].direction.x()), 0.25, 1e-9);
  EXPECT_NEAR(wires[0].half, std::hypot(4.0, 1.0), 1e-9);
  EXPECT_EQ(wires[0].top, 3.2);
}

TEST(ObstacleScan, TheTopOfATruckHoldsNoWire) {
  std::vector<Vector3d> hits;
  for (int i = 0; i < 100; ++i) hits.emplace_back(0.15 * (i % 10), 4.0 + 0.15 * (i / 10), 2.6);
  EXPECT_TRUE(find_wires(hits).empty());
  for (const double x : {-6.0, -4.0, -2.0, 4.0}) hits.emplace_back(x, 7.0, 3.0);
  const std::vector<Wire> wires = find_wires(hits);
  ASSERT_EQ(wires.size(), 1U);
  EXPECT_NEAR(wires[0].middle.y(), 7.0, 1e-9);
}

TEST(ObstacleScan, TheHighestReturnIsKeptBesideTheTopThatIsCounted) {
  const Terrain ground =
      swing_terrain_from_scan(
          seen({Shape::Kind::box, "wall", {0.0, 5.0, 0.0}, {4.0, 0.2, 2.0}}).scan(), zx120())
          .terrain;
  const auto top = highest_obstacle(ground, {0.0, 5.0}, 1.0);
  ASSERT_TRUE(top);
  EXPECT_GT(top->seen, 1.7);
  EXPECT_LE(top->seen, 2.05);
  EXPECT_GT(top->counted, top->seen);
  EXPECT_LE(top->counted, top->seen + 1.0);
  EXPECT_NE(text(*top).find("by its highest return and counted up to"), std::string::npos);
}

/// Shift and turn show by what stands there, relief by the heights themselves.
TEST(ObstacleScan, SurroundingsThatAreShiftedOrTurnedEndTrust) {
  const auto moved = [](double shift, double turn) {
    ObstacleScene scene;
    scene.shapes = {{Shape::Kind::box, "wall", {1.0, 6.0, 0.0}, {4.0, 0.3, 2.0}},
                    {Shape::Kind::box, "box", {-4.0, 5.0, 0.0}, {1.0, 1.5, 1.2}}};
    Scan scan = ray_scan(scene, {{{0.3, 0.4, 3.2}, 0.006, 0.014}}, 2).scan();
    scan.site_from_scan.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(turn).toRotationMatrix();
    scan.site_from_scan(0, 3) = shift;
    return swing_terrain_from_scan(scan, zx120()).terrain;
  };
  const Terrain present = moved(0.0, 0.0);
  EXPECT_TRUE(with_surroundings(present, present).warnings.empty());
  EXPECT_TRUE(with_surroundings(present, moved(0.03, 0.003)).warnings.empty());
  for (const auto& [shift, turn] : {std::pair(0.6, 0.0), std::pair(0.0, 0.1)}) {
    const auto warnings = with_surroundings(present, moved(shift, turn)).warnings;
    ASSERT_EQ(warnings.size(), 1U) << shift << ' ' << turn;
    EXPECT_EQ(code_text(warnings[0].code), "surroundings_differ");
    EXPECT_TRUE(warnings[0].ends_trust);
    EXPECT_NE(warnings[0].message.find("shifted"), std::string::npos) << warnings[0].message;
  }
}

TEST(ObstacleScan, ReliefAgainstLevelGroundEndsTrust) {
  const Terrain level = level_swing_ground(zx120());
  Terrain waves = level;
  for (Eigen::Index col = 0; col < waves.bank.z.cols(); ++col) {
    waves.bank.z.col(col) += 0.4 * std::sin(waves.bank.x(col));
  }
  EXPECT_EQ(with_surroundings(level, waves).warnings.size(), 1U);
}

/// Scans of which a program of all of them (scripts/check.d/69-obstacles) has a thousand.
TEST(ObstacleScan, NoTrustedMotionHitsAShape) {
  const ObstacleJudge judge;
  int trusted = 0, clear = 0;
  for (const std::uint64_t number : {1U, 2U, 3U, 8U, 17U, 25U, 62U, 63U, 98U}) {
    const SceneVerdict verdict = judge.judge(number);
    EXPECT_FALSE(verdict.hits()) << number << ": " << verdict.text;
    trusted += verdict.trusted ? 1 : 0;
    clear += verdict.clear ? 1 : 0;
    EXPECT_FALSE(verdict.is_false_alarm()) << number << ": " << verdict.text;
  }
  EXPECT_GE(trusted, 5);
  EXPECT_GE(clear, 5);
}

class ReportedObstacles : public ::testing::TestWithParam<const char*> {};

/// The motion for level ground goes through them.
TEST_P(ReportedObstacles, AreInTheWayOfASwing) {
  const std::string file = std::string(EXCAVPLAN_SHARED_DATA) + "/reported/obstacles/" + GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const DigPlan plan = plan_dig(zx120(), loam, GroundDensity{40.0});
  CycleWayOptions cycle;
  cycle.whole_cycle = true;
  Scan scan;
  scan.files = {file};
  const Terrain ground = swing_terrain_from_scan(scan, zx120()).terrain;
  EXPECT_TRUE(std::holds_alternative<BlockedWay>(plan_motion(zx120(), ground, plan, cycle)));
  const Terrain both =
      with_surroundings(
          undisturbed(HeightMap{
              ground.bank.origin, ground.bank.cell_size,
              Eigen::ArrayXXd::Constant(ground.bank.z.rows(), ground.bank.z.cols(), std::nan(""))}),
          ground)
          .terrain;
  EXPECT_TRUE(std::holds_alternative<BlockedWay>(plan_motion(zx120(), both, plan, cycle)));
}

INSTANTIATE_TEST_SUITE_P(Scans, ReportedObstacles, ::testing::Values("mast.pcd", "wall.pcd"));

}  // namespace
}  // namespace excavplan::test
