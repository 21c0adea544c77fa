// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/error.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/simulation/depth_camera.hpp>
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
  SimulatorKind simulator = default_simulator();   ///< that digs
  bool history = false;                            ///< fill DigResult::history
};

/// One dig with the ground before and after it.
struct DigScene {
  std::string soil;                  ///< its name
  double density_percent = 0.0;      ///< 0 .. 100
  DigPath path;                      ///< that was dug
  Eigen::Vector2d dump_at;           ///< centre of the heap (x, y) [m]
  Terrain before;                    ///< the ground before
  Terrain after;                     ///< with the heap
  DigResult dig;                     ///< with a stall, if there was one
  HeightMapVolumes volumes;          ///< of the two grounds
  double bulking_factor_true = 0.0;  ///< by the balance of dry mass [-]
  double duration = 0.0;             ///< of penetrate, drag and scoop [s]
  std::vector<Warning> warnings;     ///< dump_out_of_reach: the machine cannot dump there
};

/// Digs once and dumps the payload. The ground must contain the path and the heap: scene_extent().
/// A stall is in the result of the dig.
///
/// @throws Error (bad_input) if the path cannot be driven, the heap would reach the dig (the
///         volumes of both would hide each other), or as SoilSimulator::dig()
DigScene run_scene(const Machine& machine, const SoilKind& soil, double density_percent,
                   const Terrain& ground, const SceneOptions& options = {});

/// Points of a scene.
struct SceneScans {
  std::vector<Eigen::Vector3d> before;  ///< in the site frame [m]
  std::vector<Eigen::Vector3d> after;   ///< likewise
};

/// Scans of two depth cameras, one over the dig and one over the heap, placed by camera_above().
/// They have the errors, image and field of view of `camera`; its place is not used.
///
/// @throws Error (bad_input) as scan_surface()
SceneScans scan_scene(const DigScene& scene, const DepthCamera& camera, std::uint64_t seed);

}  // namespace excavplan
