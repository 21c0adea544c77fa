// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "experiments/study_survey.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/sensing/depth_camera.hpp>

namespace excavplan {
namespace {

constexpr double camera_height = 3.0;  // above the ground [m]; ours
constexpr double poor_share = 3.0;     // of the errors of a poor sensor; ours

/// Half the pixels of the sensor in both directions, which make a study ten times faster and its
/// surveys no better.
DepthCamera study_camera(const StudyScan& scan) {
  DepthCamera camera = with_errors_of(sensor_of_word("d435i"), {});
  camera.width /= 2;
  camera.height /= 2;
  camera.pattern_length /= 2.0;
  camera.frames = scan.frames;
  if (scan.sensor == StudySensor::poor) {
    camera.noise *= poor_share;
    camera.pattern_noise *= poor_share;
    camera.disparity_step *= poor_share;
  }
  return camera;
}

Scan scan_of(std::vector<Eigen::Vector3d> points, const char* name) {
  auto cloud = std::make_shared<Cloud>();
  cloud->points = std::move(points);
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {std::move(cloud)};
  scan.z_is_up = true;
  scan.name = name;
  return scan;
}

std::vector<CameraPlace> places_above(const std::vector<Eigen::Vector2d>& points,
                                      const HeightMap& ground) {
  std::vector<CameraPlace> places;
  for (const Eigen::Vector2d& at : points) {
    const double z = height_at(ground, at.x(), at.y());
    const DepthCamera above = camera_above(at, z);
    CameraPlace place{above.position, above.target};
    place.position.z() = z + camera_height;
    places.push_back(place);
  }
  return places;
}

/// Where cameras stand above a dig: one for every so much of its drag.
std::vector<Eigen::Vector2d> points_along(const DigPath& path) {
  constexpr double seen_by_one = 2.0;  // [m]; ours
  const double drag = path.parameters.drag_length;
  const int cameras = std::max(1, static_cast<int>(std::ceil(drag / seen_by_one)));
  std::vector<Eigen::Vector2d> points;
  points.reserve(static_cast<std::size_t>(cameras));
  for (int i = 0; i < cameras; ++i) {
    points.emplace_back(path.start_x - drag * (i + 0.5) / cameras, 0.0);
  }
  return points;
}

SceneScans scans_of(const DigScene& scene, const StudyScan& scan) {
  if (scan.sensor != StudySensor::lidar) {
    std::vector<Eigen::Vector2d> above = points_along(scene.path);
    above.push_back(scene.dump_at);
    return scan_scene(scene, study_camera(scan), scan.seed,
                      places_above(above, scene.before.surface()));
  }
  const Lidar lidar;
  return {scan_surface(scene.before.surface(), lidar, 2 * scan.seed),
          scan_surface(scene.after.surface(), lidar, 2 * scan.seed + 1)};
}

}  // namespace

DensityEstimate surveyed_dig(const DigScene& scene, const StudyScan& scan, const SoilKind& soil,
                             const DensityLaw& law) {
  SceneScans points = scans_of(scene, scan);
  DigScans scans{scan_of(std::move(points.before), "before"),
                 scan_of(std::move(points.after), "after"), std::nullopt};
  if (scan.sensor == StudySensor::lidar) {
    for (Scan* each : {&scans.before, &scans.after}) each->sensor_origin = Lidar().position;
  }
  DensityOptions options;
  options.registered = false;
  options.soil.kind = soil;
  options.threads = 1;
  DensityEstimate estimate = estimate_density(scans, law, options);
  if (!estimate.density) throw Error(ErrorKind::bad_input, "the scans give no density");
  return estimate;
}

RelativeDensity surveyed_density(const DigScene& scene, const StudyScan& scan, const SoilKind& soil,
                                 const DensityLaw& law) {
  if (scan.sensor == StudySensor::none) {
    return relative_density(law, {scene.volumes.bulking_factor, 0.0});
  }
  const DensityEstimate estimate = surveyed_dig(scene, scan, soil, law);
  RelativeDensity density = *estimate.density;
  density.trustworthy = estimate.trustworthy;
  return density;
}

Terrain surveyed_ground(const Terrain& ground, const Machine& machine, const StudyScan& scan) {
  if (scan.sensor == StudySensor::none) return ground;
  const HeightMap surface = ground.surface();
  std::vector<Eigen::Vector3d> points;
  if (scan.sensor == StudySensor::lidar) {
    points = scan_surface(surface, Lidar(), scan.seed);
  } else {
    const DepthCamera camera = study_camera(scan);
    for (const double x : {3.5, 5.5, 7.5}) {  // all of the reach [m]; ours
      DepthCamera placed = camera;
      const CameraPlace place = places_above({{x, 0.0}}, surface).front();
      placed.position = place.position;
      placed.target = place.target;
      const auto seen = scan_surface(surface, placed, scan.seed + static_cast<std::uint64_t>(x));
      points.insert(points.end(), seen.begin(), seen.end());
    }
  }
  return terrain_from_scan(scan_of(std::move(points), "ground"), planning_extent(machine),
                           ground.bank.cell_size)
      .terrain;
}

}  // namespace excavplan
