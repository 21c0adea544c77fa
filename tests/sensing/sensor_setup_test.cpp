// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/sensing/sensor_setup.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "support/errors.hpp"

namespace excavplan {
namespace {

HeightMap level_map() { return flat_ground({-20.0, -20.0, 20.0, 20.0}, 0.2); }

double farthest_from(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector2d& centre) {
  double farthest = 0.0;
  for (const Eigen::Vector3d& point : points) {
    farthest = std::max(farthest, (point.head<2>() - centre).norm());
  }
  return farthest;
}

TEST(SensorSetups, AreNamed) {
  EXPECT_EQ(sensor_setup_of_word("boom-camera").name, "boom-camera");
  EXPECT_EQ(sensor_setup_of_word("cab-lidar").name, "cab-lidar");
  EXPECT_EQ(test::error_of([] { sensor_setup_of_word("drone"); }),
            "set-up is 'drone', must be boom-camera or cab-lidar");
}

TEST(SensorSetups, TurnWithTheSwing) {
  for (const SensorSetup& setup : sensor_setups()) {
    const auto ahead = scan_surface(level_map(), setup, {0.0}, 1);
    const auto left = scan_surface(level_map(), setup, {0.5 * 3.14159265358979}, 1);
    ASSERT_GT(ahead.size(), 10000U) << setup.name;
    EXPECT_NEAR(static_cast<double>(left.size()), static_cast<double>(ahead.size()),
                0.01 * static_cast<double>(ahead.size()));
    Eigen::Vector3d mean_ahead = Eigen::Vector3d::Zero(), mean_left = Eigen::Vector3d::Zero();
    for (const auto& point : ahead) mean_ahead += point / static_cast<double>(ahead.size());
    for (const auto& point : left) mean_left += point / static_cast<double>(left.size());
    EXPECT_NEAR(mean_left.x(), -mean_ahead.y(), 0.03) << setup.name;
    EXPECT_NEAR(mean_left.y(), mean_ahead.x(), 0.03) << setup.name;
  }
}

TEST(SensorSetups, LooksDoNotShareNoise) {
  const SensorSetup& setup = sensor_setup_of_word("boom-camera");
  const auto twice = scan_surface(level_map(), setup, {0.0, 0.0}, 1);
  const std::size_t half = twice.size() / 2;
  EXPECT_NE(twice[0].z(), twice[half].z());
  EXPECT_EQ(twice, scan_surface(level_map(), setup, {0.0, 0.0}, 1));
}

TEST(SensorSetups, TellWhereTheyLookedFrom) {
  for (const SensorSetup& setup : sensor_setups()) {
    const std::vector<double> swings = {0.0, 0.5 * 3.14159265358979};
    const std::vector<PlacedScan> looks = look_at(level_map(), setup, swings, 1);
    ASSERT_EQ(looks.size(), 2U);
    const Eigen::Vector3d turned(-looks[0].place.y(), looks[0].place.x(), looks[0].place.z());
    EXPECT_LT((looks[1].place - turned).norm(), 1e-9) << setup.name;
    EXPECT_GT(looks[0].place.z(), 2.0);
    EXPECT_EQ(points_of(looks), scan_surface(level_map(), setup, swings, 1));
  }
}

TEST(SensorSetups, SeePitAndHeap) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  SceneOptions options;
  options.dump_at = {3.5, 3.5};
  const Terrain ground = undisturbed(flat_ground(scene_extent(machine, options.dump_at), 0.1));
  const DigScene scene = run_scene(machine, loam, 60.0, ground, options);
  for (const SensorSetup& setup : sensor_setups()) {
    const SceneScans scans = scan_scene(scene, setup, 1);
    EXPECT_EQ(look_at_scene(scene, setup, 1).after.size(), looks_at_scene);
    const auto near = [&](const Eigen::Vector2d& place) {
      return std::count_if(scans.after.begin(), scans.after.end(), [&](const auto& point) {
        return (point.template head<2>() - place).norm() < 0.5;
      });
    };
    EXPECT_GT(near(scene.dump_at), 500) << setup.name;
    EXPECT_GT(near({scene.path.start_x - 1.0, 0.0}), 500) << setup.name;
    EXPECT_GT(farthest_from(scans.before, scene.dump_at), 3.0) << setup.name;
  }
}

}  // namespace
}  // namespace excavplan
