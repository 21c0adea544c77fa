// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/obstacle_judge.hpp"

#include <algorithm>
#include <utility>

#include <excavplan/base/data_files.hpp>
#include <excavplan/scans/scan_terrain.hpp>

#include "base/angles.hpp"
#include "base/random.hpp"

namespace excavplan::test {
namespace {

/// One sensor now, all of them earlier.
struct SceneScans {
  RayScan present, earlier;
  bool has_earlier = false;
  std::vector<int> hits;  ///< of both
};

SceneScans scans_of(const ObstacleScene& scene, std::uint64_t number) {
  const std::vector<RaySensor> sensors = any_sensors(number);
  SceneScans scans;
  scans.has_earlier = number % 2 == 1 && sensors.size() > 1;
  if (!scans.has_earlier) {
    scans.present = ray_scan(scene, sensors, number);
    scans.hits = scans.present.hits;
    return scans;
  }
  ObstacleScene before = scene;  // the people came since, from where the machine does not reach
  for (Shape& shape : before.shapes) {
    if (shape.name == "person") shape.at.head<2>() *= 20.0 / shape.at.head<2>().norm();
  }
  scans.present = ray_scan(scene, {sensors.front()}, number);
  scans.earlier = ray_scan(before, sensors, number + 1000000);
  scans.hits = scans.present.hits;
  for (std::size_t i = 0; i < scans.hits.size(); ++i) {
    if (scene.shapes[i].name != "person") scans.hits[i] += scans.earlier.hits[i];
  }
  return scans;
}

std::string text_of(const ObstacleScene& scene, const std::vector<double>& away,
                    const std::vector<int>& hits) {
  std::string text;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const Shape& shape = scene.shapes[i];
    char line[160];
    std::snprintf(line, sizeof line, " %s at (%.1f, %.1f) %.2f/%.2f/%.2f, %d rays, %.2f m;",
                  shape.name.c_str(), shape.at.x(), shape.at.y(), shape.size.x(), shape.size.y(),
                  shape.size.z(), hits[i], away.empty() ? -1.0 : away[i]);
    text += line;
  }
  return text;
}

}  // namespace

ObstacleJudge::ObstacleJudge()
    : machine_(load_machine(find_data_file("machines/zx120.json"))),
      plan_(plan_dig(machine_, load_soil(find_data_file("soils/loam.json")), GroundDensity{40.0})) {
}

SceneVerdict ObstacleJudge::judge(std::uint64_t number) const {
  Random random(34, number);
  CycleWayOptions way;
  way.whole_cycle = true;
  way.cycle.swing = (random.uniform() < 0.5 ? -1.0 : 1.0) * random.uniform(0.7, 2.6);
  way.cycle.dump_height = random.uniform(1.5, 3.2);
  MotionOptions motion;
  motion.rate = 50.0;
  const ObstacleScene scene = any_scene(number);
  const SceneScans scans = scans_of(scene, number);
  SceneVerdict verdict;
  const auto level = std::get<Trajectory>(plan_motion(machine_, plan_, way, motion));
  const std::vector<double> room = nearest(machine_, level, scene, true);
  const double least = room.empty() ? 1e9 : *std::min_element(room.begin(), room.end());
  Cloud all = *scans.present.cloud;
  all.points.insert(all.points.end(), scans.earlier.cloud->points.begin(),
                    scans.earlier.cloud->points.end());
  verdict.in_the_way = least < 0.0;
  verdict.clear = least >= 0.5 && seen_share(machine_, level, all) == 1.0;
  ScannedTerrain ground = swing_terrain_from_scan(scans.present.scan(), machine_);
  if (scans.has_earlier) {
    const Terrain earlier = swing_terrain_from_scan(scans.earlier.scan(), machine_).terrain;
    ground = with_surroundings(ground.terrain, earlier);
  }
  std::vector<Warning> warnings = ground.warnings;
  const auto made = plan_motion(machine_, ground.terrain, plan_, way, motion);
  std::vector<double> away;
  if (const auto* blocked = std::get_if<BlockedWay>(&made)) {
    verdict.text = blocked->message;
  } else {
    const auto& found = std::get<Trajectory>(made);
    warnings.insert(warnings.end(), found.warnings.begin(), found.warnings.end());
    away = nearest(machine_, found, scene);
    for (std::size_t i = 0; i < away.size(); ++i) {
      if (scans.hits[i] >= 3) verdict.nearest = std::min(verdict.nearest, away[i]);
    }
    verdict.trusted = std::none_of(warnings.begin(), warnings.end(),
                                   [](const Warning& each) { return each.ends_trust; });
  }
  for (const Warning& each : warnings) verdict.text += each.message + "; ";
  verdict.text += " |" + text_of(scene, away, scans.hits);
  return verdict;
}

}  // namespace excavplan::test
