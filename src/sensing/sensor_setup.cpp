// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/sensing/sensor_setup.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include <excavplan/base/error.hpp>

#include "base/random.hpp"

namespace excavplan {
namespace {

/// A D435i below the end of the boom of a machine of 12 t, which is lowered over what is scanned:
/// from farther than 3 m its heights err by centimetres. Its long image axis lies along the boom,
/// so that it sees from 1.8 m to 7.2 m before the swing axis. Place, range and frames are ours.
SensorSetup boom_camera() {
  DepthCamera camera;
  camera.position = {4.5, -0.3, 2.9};
  camera.target = {4.5, 0.0, 0.0};
  camera.max_range = 5.0;
  camera.frames = 5;
  return {"boom-camera", with_errors_of(sensor_of_word("d435i"), camera)};
}

/// A scanning lidar on a mast above the cab, left of the boom: lower, heaps and pits hide a fifth
/// of themselves. Place and window are ours.
SensorSetup cab_lidar() {
  Lidar lidar;
  lidar.position = {0.6, 0.7, 4.2};
  lidar.azimuth = {-1.0, 1.0};
  lidar.elevation = {-1.4, -0.15};
  return {"cab-lidar", lidar};
}

PlacedScan look_swung(const HeightMap& surface, DepthCamera camera, double swing,
                      std::uint64_t seed) {
  const Eigen::AngleAxisd turn(swing, Eigen::Vector3d::UnitZ());
  camera.position = turn * camera.position;
  camera.target = turn * camera.target;
  return {camera.position, scan_surface(surface, camera, seed)};
}

PlacedScan look_swung(const HeightMap& surface, Lidar lidar, double swing, std::uint64_t seed) {
  lidar.position = Eigen::AngleAxisd(swing, Eigen::Vector3d::UnitZ()) * lidar.position;
  lidar.azimuth.array() += swing;
  return {lidar.position, scan_surface(surface, lidar, seed)};
}

}  // namespace

const std::vector<SensorSetup>& sensor_setups() {
  static const std::vector<SensorSetup> list = {boom_camera(), cab_lidar()};
  return list;
}

const SensorSetup& sensor_setup_of_word(const std::string& word) {
  std::string words;
  for (const SensorSetup& setup : sensor_setups()) {
    if (setup.name == word) return setup;
    words += (words.empty() ? "" : " or ") + setup.name;
  }
  throw Error(ErrorKind::bad_input, "set-up is '" + word + "', must be " + words);
}

std::vector<PlacedScan> look_at(const HeightMap& surface, const SensorSetup& setup,
                                const std::vector<double>& swings, std::uint64_t seed) {
  std::vector<PlacedScan> looks;
  for (const double swing : swings) {
    const std::uint64_t of_look = Random(seed, looks.size()).bits();
    looks.push_back(
        std::visit([&](const auto& sensor) { return look_swung(surface, sensor, swing, of_look); },
                   setup.sensor));
  }
  return looks;
}

std::vector<Eigen::Vector3d> scan_surface(const HeightMap& surface, const SensorSetup& setup,
                                          const std::vector<double>& swings, std::uint64_t seed) {
  return points_of(look_at(surface, setup, swings, seed));
}

SceneLooks look_at_scene(const DigScene& scene, const SensorSetup& setup, std::uint64_t seed) {
  constexpr double beside = 0.25;  // ours: over both halves of a heap of several buckets [rad]
  const double dump = std::atan2(scene.dump_at.y(), scene.dump_at.x());
  const std::array<double, looks_at_scene> at = {0.0, dump - beside, dump + beside};
  const std::vector<double> swings(at.begin(), at.end());
  const auto look = [&](const HeightMap& surface, std::uint64_t epoch) {
    auto looks = look_at(surface, setup, swings, Random(seed, epoch).bits());
    const bool sees = std::any_of(looks.begin(), looks.end(),
                                  [](const PlacedScan& each) { return !each.points.empty(); });
    if (sees) return looks;
    throw Error(ErrorKind::bad_input, "the set-up " + setup.name + " sees no ground of the scene");
  };
  return {look(scene.ground_before(), 0), look(scene.ground_after(), 1)};
}

SceneScans scan_scene(const DigScene& scene, const SensorSetup& setup, std::uint64_t seed) {
  return points_of(look_at_scene(scene, setup, seed));
}

}  // namespace excavplan
