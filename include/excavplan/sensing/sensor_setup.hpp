// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/sensing/depth_camera.hpp>
#include <excavplan/sensing/scene.hpp>

/// @file
/// Sensors where a machine carries them, for rehearsals of the dig cycle
/// (`docs/methods.md#set-ups`).

namespace excavplan {

/// A sensor on the upper structure of an excavator. It stands and faces as given while the swing is
/// 0, in the site frame, and turns with the swing. Boom, arm and bucket are out of its view.
struct SensorSetup {
  std::string name;                         ///< that chooses it on the command line: "boom-camera"
  std::variant<DepthCamera, Lidar> sensor;  ///< at swing 0
};

/// All set-ups that are shipped; their figures and the sources are in src/sensing/sensor_setup.cpp.
const std::vector<SensorSetup>& sensor_setups();

/// The set-up of this name. @throws Error (bad_input) naming the set-ups there are
const SensorSetup& sensor_setup_of_word(const std::string& word);

/// What a set-up sees of a surface when the machine has swung to each of these angles [rad]. Same
/// seed, same points. @throws Error (bad_input) as scan_surface()
std::vector<PlacedScan> look_at(const HeightMap& surface, const SensorSetup& setup,
                                const std::vector<double>& swings, std::uint64_t seed);
/// The points of these looks.
std::vector<Eigen::Vector3d> scan_surface(const HeightMap& surface, const SensorSetup& setup,
                                          const std::vector<double>& swings, std::uint64_t seed);

inline constexpr std::size_t looks_at_scene = 3;  ///< as many as look_at_scene() of a set-up gives
/// Looks of a set-up at a dig and its heap, swung to the dig (0) and to both sides of the dump
/// point.
/// @throws Error (bad_input) as scan_surface(), or if it sees no ground
SceneLooks look_at_scene(const DigScene& scene, const SensorSetup& setup, std::uint64_t seed);
/// The points of these looks.
SceneScans scan_scene(const DigScene& scene, const SensorSetup& setup, std::uint64_t seed);

}  // namespace excavplan
