// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/maps/ground_maps.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/non_finite.hpp"

namespace excavplan {
namespace {

/// A layer with its name on the command line.
struct Shown {
  std::string name;
  MapLayer layer;
};

/// Each layer alone, after all of them. A PLY file shows a height by itself and all else on the
/// ground after.
/// @param prefix  of the names, "" or "dump-"
std::vector<NamedMap> maps_of(const std::string& prefix, const HeightMap& before,
                              const Eigen::ArrayXXd& after, const std::vector<Shown>& layers) {
  HeightMap ground = before;
  ground.z = after;
  NamedMap all = {prefix.empty() ? "all" : prefix.substr(0, prefix.size() - 1), {ground, {}}};
  std::vector<NamedMap> single;
  for (const Shown& each : layers) {
    all.map.layers.push_back(each.layer);
    single.push_back({prefix + each.name, {each.name == "before" ? before : ground, {each.layer}}});
  }
  single.insert(single.begin(), std::move(all));
  return single;
}

std::vector<Shown> ground_layers(const Eigen::ArrayXXd& before, const Eigen::ArrayXXd& after,
                                 const Eigen::ArrayXXd& change) {
  return {{"before", {"height_before_m", "height of the ground before the dig", before}},
          {"after", {"height_after_m", "height of the ground after the dig", after}},
          {"change", {"change_m", "height after less before", change}}};
}

/// 0 for unchanged ground, 1 hole, 2 spill, 3 heap, 4 other changes and objects; NaN where that is
/// unknown.
Eigen::ArrayXXd kinds_of(const AreaChange& area, const std::vector<ChangeZone>& zones) {
  Eigen::ArrayXXd kinds =
      area.difference.z.unaryExpr([](double z) { return std::isnan(z) ? nan : 0.0; });
  for (Eigen::Index i = 0; i < kinds.size(); ++i) {
    const int zone = area.zone(i);
    if (zone >= 0) kinds(i) = 1.0 + static_cast<double>(zones[static_cast<std::size_t>(zone)].kind);
  }
  return kinds;
}

/// 1 where the dig lowers the ground.
Eigen::ArrayXXd footprint_of(const Eigen::ArrayXXd& change) {
  constexpr double least = 1e-9;  // rounding [m]
  return change.unaryExpr([](double z) { return z < -least ? 1.0 : z >= -least ? 0.0 : nan; });
}

std::vector<DigPose> poses_of(const DigPath& path) {
  std::vector<DigPose> poses = path.approach;
  poses.insert(poses.end(), path.poses.begin(), path.poses.end());
  return poses;
}

MapLine tip_path(const DigPath& path) {
  MapLine line{"tip_path", {}};
  for (const DigPose& pose : poses_of(path)) {
    line.points.emplace_back(pose.bucket.x, 0.0, pose.bucket.z);
  }
  return line;
}

/// What the bucket passes below the ground, as wide as it cuts, at the height of the ground.
MapLine cut_outline(const Machine& machine, const DigPath& path, const HeightMap& ground) {
  const GroundProfile height = boom_plane_profile(ground);
  double first = path.start_x;
  double last = path.start_x;
  for (const DigPose& pose : path.poses) {
    if (!(pose.bucket.z < height(pose.bucket.x))) continue;
    first = std::min(first, pose.bucket.x);
    last = std::max(last, pose.bucket.x);
  }
  const double half = 0.5 * machine.bucket.width_outside;
  MapLine line{"footprint", {}, true};
  for (const auto& [x, y] : {std::pair(first, -half), {last, -half}, {last, half}, {first, half}}) {
    const double z = height_at(ground, x, y);
    line.points.emplace_back(x, y, std::isfinite(z) ? z : path.ground_z);
  }
  return line;
}

}  // namespace

std::vector<NamedMap> survey_maps(const VolumeChange& change,
                                  const std::vector<HeightMap>& before) {
  std::vector<NamedMap> maps;
  for (std::size_t i = 0; i < change.areas.size(); ++i) {
    const AreaChange& area = change.areas[i];
    const Eigen::ArrayXXd after = before[i].z + area.difference.z;
    std::vector<Shown> layers = ground_layers(before[i].z, after, area.difference.z);
    layers.push_back({"sd", {"change_sd_m", "standard deviation of the change", area.sd}});
    layers.push_back(
        {"zones",
         {"zone", "0 none, 1 hole, 2 spill, 3 heap, 4 other", kinds_of(area, change.zones)}});
    for (NamedMap& map : maps_of(i == 0 ? "" : "dump-", before[i], after, layers)) {
      maps.push_back(std::move(map));
    }
  }
  return maps;
}

std::vector<NamedMap> scene_maps(const DigScene& scene) {
  const HeightMap before = scene.blocks ? scene.blocks->before : scene.before.surface();
  const HeightMap after = scene.blocks ? scene.blocks->after : scene.after.surface();
  return maps_of("", before, after.z, ground_layers(before.z, after.z, after.z - before.z));
}

std::vector<NamedMap> plan_maps(const Machine& machine, const DigPlan& plan, const PlanSite& site) {
  const HeightMap before = site.ground.surface();
  if (!plan.dig) {
    return maps_of("", before, before.z, {ground_layers(before.z, before.z, before.z).front()});
  }
  const Eigen::ArrayXXd after = rehearse(machine, plan, site).after(site.ground).surface().z;
  const Eigen::ArrayXXd change = after - before.z;
  std::vector<Shown> layers = ground_layers(before.z, after, change);
  layers.push_back(
      {"footprint", {"footprint", "1 where the dig lowers the ground", footprint_of(change)}});
  std::vector<NamedMap> maps = maps_of("", before, after, layers);
  NamedMap path;
  path.name = "path";
  path.lines = {tip_path(plan.path), cut_outline(machine, plan.path, before)};
  maps.push_back(std::move(path));
  return maps;
}

}  // namespace excavplan
