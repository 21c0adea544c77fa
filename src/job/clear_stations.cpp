// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/clear_stations.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "base/plan_geometry.hpp"
#include "job/dump_place.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

// Numbers of our own choice.
constexpr double off_tail = 0.25;         // of what stands there [m]
constexpr double shift_step = 0.1;        // between the places that are tried [m]
constexpr double most_shift = 1.5;        // [m]
constexpr double most_back_at_end = 0.8;  // of the first, which still reaches the far end [m]
constexpr double edge_step = 0.1;         // of an obstacle's outline [m]
constexpr double most_gap = 0.1;          // between what is dug from two places in succession [m]

/// Points of an outline.
template <typename Visit>
void for_each_on(const SitePolygon& polygon, Visit visit) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d way = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double steps = std::max(1.0, std::ceil(way.norm() / edge_step));
    for (double k = 0.0; k < steps; ++k) visit(Vector2d(polygon[i] + k / steps * way));
  }
}

bool stands_clear(const JobStation& station, const JobFrame& frame, const JobSettings& settings,
                  const JobMap& map, const Terrain& ground) {
  const BasePose base = base_at(frame, station, ground, settings.site.machine);
  const auto dump = dump_place(settings, map, ground, base);
  return dump && turns_clear(settings, base, dump->swing);
}

}  // namespace

bool turns_clear(const JobSettings& settings, const BasePose& base, double swing) {
  const Machine& machine = settings.site.machine;
  const double reach = machine.tail_swing_radius() + off_tail;
  const double half = std::asin(std::min(1.0, 0.5 * machine.undercarriage_width() / reach));
  const PlanFrame frame(Vector2d(base.x, base.y), base.heading);
  bool clear = true;
  for (const JobObstacle& obstacle : settings.design.obstacles) {
    for_each_on(obstacle.polygon, [&](const Vector2d& place) {
      const Vector2d at = frame.of(place);
      const double away = at.norm();
      if (away >= reach) return;
      // From where the tail is as the machine looks ahead, in the sense of the swing.
      const double turned = wrapped(std::atan2(at.y(), at.x()) - pi);
      const double margin = half + off_tail / std::max(away, off_tail);
      clear &= turned < std::min(0.0, swing) - margin || turned > std::max(0.0, swing) + margin;
    });
  }
  return clear;
}

std::vector<JobStation> clear_of_obstacles(std::vector<JobStation> stations, const JobFrame& frame,
                                           const JobSettings& settings, const JobMap& map,
                                           const Terrain& ground) {
  if (settings.design.obstacles.empty() || stations.empty()) return stations;
  const JobStation last = stations.back();
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const WorkRange range = work_range(frame, settings.site.machine, stations[i].along);
    // So far forward that the next one reaches on from here, so far back as it reaches on itself.
    double most_back = i == 0 ? -most_back_at_end : -most_shift;
    if (i > 0) {
      const WorkRange before = work_range(frame, settings.site.machine, stations[i - 1].along);
      const double dug_to = stations[i - 1].along + before.near;
      most_back = std::max(most_back, dug_to - most_gap - stations[i].along - range.far);
    }
    for (double away = 0.0; away <= most_shift; away += shift_step) {
      bool found = false;
      for (const double shift : {away, -away}) {
        if (shift < most_back) continue;
        JobStation moved = stations[i];
        moved.along += shift;
        if (!stands_clear(moved, frame, settings, map, ground)) continue;
        stations[i] = moved;
        found = true;
        break;
      }
      if (found) break;
    }
  }
  if (stations.back().along > last.along) stations.push_back(last);  // it reaches the near end
  return stations;
}

}  // namespace excavplan
