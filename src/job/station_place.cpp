// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/station_place.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/angles.hpp"
#include "base/plan_geometry.hpp"
#include "job/dump_place.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

// Numbers of our own choice [m].
constexpr double off_cut = 0.3;           // of the tracks from ground that was dug
constexpr double deepest_rut = 0.15;      // more is dug
constexpr double highest_soil = 0.2;      // under the tracks
constexpr double off_tail = 0.3;          // of what stands there
constexpr double spare_reach = 0.5;       // to the dump, since what is laid there grows
constexpr double shift_step = 0.4;        // between the places that are looked at
constexpr int most_along = 3;             // steps
constexpr int most_beside = 9;            // likewise
constexpr double step_along = 0.1;        // likewise along a line of stations [m]
constexpr double most_shift = 1.5;        // along it
constexpr double most_back_at_end = 0.8;  // of the first, which still reaches the far end
constexpr double edge_step = 0.1;         // of an obstacle's outline
constexpr double most_gap = 0.1;          // between what is dug from two places in succession

double distance_to(const SitePolygon& polygon, const Vector2d& from) {
  double least = is_inside(polygon, from) ? 0.0 : (polygon.front() - from).norm();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d along = polygon[(i + 1) % polygon.size()] - a;
    const double share = along.dot(from - a) / std::max(along.squaredNorm(), 1e-12);
    least = std::min(least, (a + std::clamp(share, 0.0, 1.0) * along - from).norm());
  }
  return least;
}

bool is_tail_clear(const JobSettings& settings, const Vector2d& at) {
  const double tail = settings.site.machine.tail_swing_radius() + off_tail;
  const auto& obstacles = settings.design.obstacles;
  if (settings.design.truck && distance_to(settings.design.truck->bed, at) < tail) return false;
  return std::all_of(obstacles.begin(), obstacles.end(), [&](const JobObstacle& each) {
    return distance_to(each.polygon, at) >= tail;
  });
}

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

bool can_stand_now(const Standing& on, const JobFrame& frame, const JobStation& station) {
  if (!is_tail_clear(on.settings, frame.place(station.along, station.beside))) return false;
  bool free = true;
  const auto& machine = on.settings.site.machine;
  for_each_under({frame, station, machine, off_cut}, on.map.target, [&](const auto& cell) {
    if (!cell) return;
    free &= !(surface_of(on.first, *cell) - surface_of(on.now, *cell) > deepest_rut);
  });
  for_each_under({frame, station, machine}, on.map.target, [&](const auto& cell) {
    free &= cell && !on.map.untouched(cell->row, cell->col) &&
            !(surface_of(on.now, *cell) - surface_of(on.first, *cell) > highest_soil);
  });
  return free;
}

std::optional<JobStation> nearest_place(const Standing& on, const JobFrame& frame,
                                        const JobStation& station) {
  std::vector<std::pair<double, Vector2d>> shifts;
  for (int i = -most_along; i <= most_along; ++i) {
    for (int k = -most_beside; k <= most_beside; ++k) {
      const Vector2d shift = shift_step * Vector2d(i, k);
      shifts.emplace_back(shift.norm(), shift);
    }
  }
  std::stable_sort(shifts.begin(), shifts.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::optional<JobStation> meagre;
  for (const auto& [away, shift] : shifts) {
    JobStation moved = station;
    moved.along += shift.x();
    moved.beside += shift.y();
    if (!can_stand_now(on, frame, moved)) continue;
    const BasePose base = base_at(frame, moved, on.now, on.settings.site.machine);
    if (dump_place(on.settings, on.map, on.now, base, spare_reach)) return moved;
    if (!meagre && dump_place(on.settings, on.map, on.now, base)) meagre = moved;
  }
  return meagre;
}

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
    for (double away = 0.0; away <= most_shift; away += step_along) {
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
