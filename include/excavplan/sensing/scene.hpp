// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/sensing/block_layer.hpp>
#include <excavplan/sensing/depth_camera.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// A simulated dig with the heap it leaves, and the scans of a camera before and after.

namespace excavplan {

/// Settings of run_scene().
struct SceneOptions {
  DigParameters path = paper_fixed_path();  ///< to dig
  std::optional<double> start_x = {};       ///< [m]; empty: make_dig_path_anywhere() chooses it
  DigPathOptions rules = {};                ///< that the path must keep
  Eigen::Vector2d dump_at = default_dump_point();  ///< centre of the heap (x, y) [m]
  bool dumps = true;                               ///< else the payload stays in the bucket
  SimulatorKind simulator = default_simulator();   ///< that digs
  bool history = false;                            ///< fill DigResult::history
  std::optional<BlockSettings> blocks = {};        ///< if hard soil shall fall as blocks
};

/// The path that run_scene() digs.
/// @throws Error (bad_input) if an argument breaks its rules, the path cannot be driven, or the
///         heap would reach the dig: the volumes of both would hide each other
DigPath scene_path(const Machine& machine, const SoilKind& soil, const Terrain& ground,
                   const SceneOptions& options = {});

/// One dig with the ground before and after it.
struct DigScene {
  std::string soil;                  ///< its name
  double density_percent = 0.0;      ///< of the bank in the strip of the dig, 0 .. 100
  DigPath path;                      ///< that was dug
  Eigen::Vector2d dump_at;           ///< centre of the heap (x, y) [m]
  bool dumped = true;                ///< else there is no heap: SceneOptions::dumps
  Terrain before;                    ///< the ground before
  Terrain after;                     ///< with the heap
  DigResult dig;                     ///< with a stall, if there was one
  std::optional<BlockLayer> blocks;  ///< instead of the loose soil of `after` that rose
  HeightMapVolumes volumes;          ///< of the two grounds, or of those with blocks
  double bulking_factor_true = 0.0;  ///< by the balance of dry mass [-]
  double duration = 0.0;             ///< of penetrate, drag and scoop [s]
  /// What a sensor sees before: with the blocks, where there are some.
  HeightMap ground_before() const { return blocks ? blocks->before : before.surface(); }
  HeightMap ground_after() const { return blocks ? blocks->after : after.surface(); }  ///< likewise

  /// dump_out_of_reach: the machine cannot dump there; no_blocks: the ground is not hard enough
  std::vector<Warning> warnings;
};

/// Digs once and dumps the payload. The ground must contain the path and the heap: scene_extent().
/// The density is that of the bank where the ground tells no void ratios. A stall is in the result
/// of the dig.
///
/// @throws Error (bad_input) as scene_path() or SoilSimulator::dig()
DigScene run_scene(const Machine& machine, const SoilKind& soil, double density_percent,
                   const Terrain& ground, const SceneOptions& options = {});

/// Points of a scene.
struct SceneScans {
  std::vector<Eigen::Vector3d> before;  ///< in the site frame [m]
  std::vector<Eigen::Vector3d> after;   ///< likewise
};

/// What a sensor saw from one place.
struct PlacedScan {
  Eigen::Vector3d place;                ///< where it stood, in the site frame [m]
  std::vector<Eigen::Vector3d> points;  ///< likewise
};

/// Looks at a scene.
struct SceneLooks {
  std::vector<PlacedScan> before;
  std::vector<PlacedScan> after;
};

/// The points of all looks, one after another.
std::vector<Eigen::Vector3d> points_of(const std::vector<PlacedScan>& looks);
SceneScans points_of(const SceneLooks& looks);

/// Where a camera stands in the site frame.
struct CameraPlace {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d target;    ///< point on the optical axis [m]
};

/// Looks of depth cameras at these places. Without any there are two, one over the dig and one over
/// the heap, placed by camera_above(). They have the errors, image and field of view of `camera`;
/// its place is not used.
///
/// @throws Error (bad_input) as scan_surface(), or if a camera sees no ground
SceneLooks look_at_scene(const DigScene& scene, const DepthCamera& camera, std::uint64_t seed,
                         const std::vector<CameraPlace>& places = {});
/// The points of these looks.
SceneScans scan_scene(const DigScene& scene, const DepthCamera& camera, std::uint64_t seed,
                      const std::vector<CameraPlace>& places = {});

}  // namespace excavplan
