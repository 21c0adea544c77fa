// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/sensing/scene.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include <excavplan/change/bulking.hpp>
#include <excavplan/ground/resampling.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/soil/ground_in_soil.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/random.hpp"
#include "base/text.hpp"
#include "ground/terrain.hpp"
#include "sensing/block_heap.hpp"
#include "simulation/checked_dig.hpp"
#include "soil/density_doubt.hpp"

namespace excavplan {
namespace {

DigPath lay_out(const Machine& machine, const Terrain& ground, const SceneOptions& options) {
  const GroundProfile profile = start_profile(ground, machine);
  auto path = options.start_x
                  ? make_dig_path(machine, options.path, *options.start_x, profile, options.rules)
                  : make_dig_path_anywhere(machine, options.path, profile, options.rules);
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) {
    throw Error(ErrorKind::bad_input, "this dig cannot be driven: " + infeasible->message);
  }
  return std::get<DigPath>(std::move(path));
}

/// Foot of the cone in which a heaped bucket comes to rest [m].
double heap_radius(const Machine& machine, const SoilKind& soil) {
  return std::cbrt(3.0 * heaped_capacity(machine) / (pi * std::tan(soil.angle_of_repose)));
}

std::string text(const Eigen::Vector2d& point) {
  return number_text(point.x()) + "," + number_text(point.y());
}

std::string text(const Eigen::Vector3d& point) {
  return text(Eigen::Vector2d(point.head<2>())) + "," + number_text(point.z());
}

void require_clear_of_dig(const Eigen::Vector2d& dump_at, const Machine& machine,
                          const SoilKind& soil, const DigPath& path) {
  const Rectangle strip = swept_strip(machine, path);
  const double beside_x = std::max({strip.x_min - dump_at.x(), dump_at.x() - strip.x_max, 0.0});
  const double beside_y = std::max({strip.y_min - dump_at.y(), dump_at.y() - strip.y_max, 0.0});
  const double distance = std::hypot(beside_x, beside_y);
  const double radius = heap_radius(machine, soil);
  if (distance >= radius) return;
  throw Error(ErrorKind::bad_input,
              "the dump point " + text(dump_at) + " is " + readable(distance) +
                  " m from the strip of this dig (x = " + readable(strip.x_min) + " .. " +
                  readable(strip.x_max) + " m, y = " + readable(strip.y_min) + " .. " +
                  readable(strip.y_max) + " m); a heap of " + readable(heaped_capacity(machine)) +
                  " m3 needs at least " + readable(radius) + " m");
}

std::vector<Warning> reach_warnings(const Eigen::Vector2d& dump_at, const Machine& machine) {
  const double from_axis = dump_at.norm();
  const double reach = machine.boom_pin.x() + machine.full_length();
  if (from_axis >= machine.track_front && from_axis <= reach) return {};
  return {{WarningCode::dump_out_of_reach,
           "the dump point " + text(dump_at) + " is " + readable(from_axis) +
               " m from the swing axis; " + machine.name + " dumps from " +
               readable(machine.track_front) + " m (its tracks) to " + readable(reach) +
               " m (all links in one line)"}};
}

/// The middle of the cut, its scoop taken as 0.8 m; ours.
Eigen::Vector2d dig_centre(const DigPath& path) {
  return {path.start_x - 0.5 * (path.parameters.drag_length + 0.8), 0.0};
}

/// One camera over the dig and one over the heap.
std::vector<CameraPlace> places_above(const DigScene& scene, const HeightMap& surface) {
  std::vector<CameraPlace> places;
  for (const Eigen::Vector2d& at : {dig_centre(scene.path), scene.dump_at}) {
    const DepthCamera above = camera_above(at, height_at(surface, at.x(), at.y()));
    places.push_back({above.position, above.target});
  }
  return places;
}

/// A surface on cells fine enough for blocks.
HeightMap refined(const HeightMap& map) {
  constexpr double finest = 0.02;  // ours [m]
  const double parts = std::max(1.0, std::ceil(map.cell_size / finest));
  return resampled(map, map.extent(), map.cell_size / parts, 0.0);
}

/// The dug soil as blocks where the ground is hard.
void break_up(const BlockSettings& blocks, const SoilKind& soil, DigScene& scene) {
  require(blocks.swell >= 0.0 && blocks.swell <= 1.0, "blocks: swell", blocks.swell, "in 0 .. 1");
  if (scene.density_percent < blocks.least_density) {
    scene.warnings.emplace_back(WarningCode::no_blocks,
                                "ground of " + readable(scene.density_percent) +
                                    " % relative density crumbles; it breaks into blocks from " +
                                    readable(blocks.least_density) + " % on");
    return;
  }
  const double bulking = bulking_of_density(soil, scene.density_percent);
  const double swollen = (1.0 + blocks.swell * (bulking - 1.0)) / bulking;
  const double loose = scene.volumes.spilled + scene.volumes.dumped;
  scene.blocks = blocks_of_rise(refined(scene.before.surface()), refined(scene.after.surface()),
                                swollen * loose, blocks);
  scene.volumes = height_map_volumes(undisturbed(scene.blocks->before),
                                     undisturbed(scene.blocks->after), scene.dump_at);
}

void require_sight(const std::vector<Eigen::Vector3d>& seen, const HeightMap& surface,
                   const DepthCamera& camera) {
  if (!seen.empty()) return;
  const Eigen::Vector3d& at = camera.position;
  const double below = height_at(surface, at.x(), at.y()) - at.z();
  refuse("the camera at " + text(at) + " that faces " + text(camera.target) + " sees no ground: " +
         (below >= 0.0 ? "it stands " + readable(below) + " m below it, must be above"
                       : "none lies in its view within " + readable(camera.max_range) + " m"));
}

}  // namespace

DigPath scene_path(const Machine& machine, const SoilKind& soil, const Terrain& ground,
                   const SceneOptions& options) {
  require_machine(machine);
  require_soil(soil);
  require_terrain(ground, "ground of a scene");
  if (!options.dump_at.allFinite()) refuse("scene: the dump point must be finite");
  DigPath path = lay_out(machine, ground, options);
  if (options.dumps) require_clear_of_dig(options.dump_at, machine, soil, path);
  return path;
}

DigScene run_scene(const Machine& machine, const SoilKind& soil, double density_percent,
                   const Terrain& ground, const SceneOptions& options) {
  DigScene scene;
  scene.soil = soil.name;
  scene.density_percent = density_percent;
  scene.dump_at = options.dump_at;
  scene.dumped = options.dumps;
  scene.before = ground;
  scene.path = scene_path(machine, soil, ground, options);
  scene.density_percent = bank_density_percent(ground, soil, swept_strip(machine, scene.path))
                              .value_or(density_percent);
  if (scene.dumped) scene.warnings = reach_warnings(scene.dump_at, machine);
  if (auto doubt = doubt_of_density(density_percent)) scene.warnings.push_back(*doubt);
  DigOptions dig;
  dig.history = options.history;
  if (scene.dumped) dig.dump_at = scene.dump_at;
  const auto simulator = make_simulator(options.simulator, machine, soil, density_percent);
  scene.dig = checked_dig(*simulator, machine, ground, scene.path, dig);
  scene.after = scene.dig.after(ground);
  scene.volumes = height_map_volumes(ground, scene.after, scene.dump_at);
  if (options.blocks) break_up(*options.blocks, soil, scene);
  scene.bulking_factor_true = bulking_of_density(soil, scene.density_percent);
  scene.duration = time_dig_path(machine, scene.path, {}, scene.dig.torques).dig_duration();
  return scene;
}

SceneLooks look_at_scene(const DigScene& scene, const DepthCamera& camera, std::uint64_t seed,
                         const std::vector<CameraPlace>& places) {
  const auto look = [&](const HeightMap& surface, std::uint64_t epoch) {
    std::vector<PlacedScan> looks;
    for (const CameraPlace& place : places.empty() ? places_above(scene, surface) : places) {
      DepthCamera placed = camera;
      placed.position = place.position;
      placed.target = place.target;
      auto seen = scan_surface(surface, placed, Random(seed, epoch, looks.size()).bits());
      require_sight(seen, surface, placed);
      looks.push_back({place.position, std::move(seen)});
    }
    return looks;
  };
  return {look(scene.ground_before(), 0), look(scene.ground_after(), 1)};
}

SceneScans scan_scene(const DigScene& scene, const DepthCamera& camera, std::uint64_t seed,
                      const std::vector<CameraPlace>& places) {
  return points_of(look_at_scene(scene, camera, seed, places));
}

std::vector<Eigen::Vector3d> points_of(const std::vector<PlacedScan>& looks) {
  std::vector<Eigen::Vector3d> all;
  for (const PlacedScan& look : looks) {
    all.insert(all.end(), look.points.begin(), look.points.end());
  }
  return all;
}

SceneScans points_of(const SceneLooks& looks) {
  return {points_of(looks.before), points_of(looks.after)};
}

}  // namespace excavplan
