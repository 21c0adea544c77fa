// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/site_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace excavplan::scenes {
namespace {

Family family_of(const std::string& name) {
  return *std::find_if(families().begin(), families().end(),
                       [&](const Family& family) { return family.name == name; });
}

/// Volumes of the moved soil by numerical integration.
class Integrated : public testing::TestWithParam<std::string> {};

TEST_P(Integrated, SoilIsWhatTheTruthSays) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const SiteScene scene = site_scene(family_of(GetParam()), seed, 1000);
    const auto& moved = scene.moved;
    const double fell =
        volume_of([&](double x, double y) { return std::min(0.0, moved(x, y)); }, scene.extent);
    const double rose =
        volume_of([&](double x, double y) { return std::max(0.0, moved(x, y)); }, scene.extent);
    EXPECT_NEAR(-fell, scene.truth.hole, 0.002 * scene.truth.hole);
    EXPECT_NEAR(rose, scene.truth.spill + scene.truth.heap, 0.002 * scene.truth.hole);
    EXPECT_GT(scene.truth.bulking(), 0.8);
    EXPECT_LT(scene.truth.bulking(), 1.6);
  }
}

INSTANTIATE_TEST_SUITE_P(SiteScenes, Integrated,
                         testing::Values("clean", "second-heap", "second-scrape", "two-pits",
                                         "two-pits-two-heaps", "two-heaps-alike", "clods",
                                         "heap-at-wall", "lidar-one", "heap-spread", "thin-dig"),
                         [](const auto& family) {
                           std::string name = family.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(SiteScenes, EqualSeedsGiveEqualScansAndOtherSeedsOthers) {
  const auto first_point = [](std::uint64_t seed) {
    const SiteScene scene = site_scene(family_of("clean"), seed, 1000);
    return scans_of(scene, seed).after.clouds.front()->points.front();
  };
  EXPECT_EQ(first_point(1), first_point(1));
  EXPECT_NE(first_point(1), first_point(2));
}

TEST(SiteScenes, WaterIsLevelAndHidesTheFloor) {
  const SiteScene scene = site_scene(family_of("water-even"), 1, 1000);
  const Dig& dig = scene.dig;
  EXPECT_EQ(scene.after(dig.pit_x, dig.pit_y), scene.water);
  EXPECT_GT(scene.water, -0.9 * dig.pit_depth - 1e-12);
  EXPECT_LT(scene.water, -0.8 * dig.pit_depth + 1e-12);
}

TEST(SiteScenes, TheLidarSeesNoFloorBehindASteepWall) {
  const SiteScene scene = site_scene(family_of("lidar-one-low"), 1, 20000);
  const Lidar& lidar = scene.sampling.lidars_after.front();
  EXPECT_GT(lidar.position.z(), 2.0);
  const HeightMap surface = surface_of(scene, true);
  const std::vector<Points> clouds = scanned(scene, true, 1);
  EXPECT_GT(clouds.front().size(), 5000u);
  for (const Eigen::Vector3d& point : clouds.front()) {
    const Eigen::Vector3d halfway = 0.5 * (point + lidar.position);
    const double height = height_at(surface, halfway.x(), halfway.y());
    EXPECT_FALSE(halfway.z() < height - 0.1) << point.transpose();
  }
}

}  // namespace
}  // namespace excavplan::scenes
