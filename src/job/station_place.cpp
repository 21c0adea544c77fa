// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/station_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/angles.hpp"
#include "base/plan_geometry.hpp"
#include "job/dump_place.hpp"
#include "simulation/across_tracks.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

// Numbers of our own choice [m].
constexpr double off_cut = 0.3;                    // of the tracks from ground that was dug
constexpr double deepest_rut = 0.15;               // more is dug
constexpr std::array off_drops = {0.5, 0.8, 1.1};  // from ground that is deeper than that
constexpr double highest_soil = 0.2;               // under the tracks
constexpr double reach_to_spare = 0.5;             // to the dump, since what is laid there grows
constexpr double spare_turn = 0.3;                 // to it [rad], likewise
constexpr double off_place = 0.1;          // where the machine comes to stand along the line
constexpr double shift_step = 0.4;         // between the places that are looked at
constexpr double farthest_for_room = 1.3;  // to a place from which dump areas are not full [m]
constexpr int most_along = 3;              // steps
constexpr int most_beside = 9;             // likewise
constexpr double step_along = 0.1;         // likewise along a line of stations [m]
constexpr double most_shift = 1.5;         // along it
constexpr double most_back_at_end = 0.8;   // of the first, which still reaches the far end
constexpr double most_gap = 0.1;           // between what is dug from two places in succession

double distance_to(const SitePolygon& polygon, const Vector2d& from) {
  double least = is_inside(polygon, from) ? 0.0 : (polygon.front() - from).norm();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    least = std::min(least, distance_to_side(from, polygon[i], polygon[(i + 1) % polygon.size()]));
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

/// Its swing goes there, and it stands on the sides of its tracks.
bool can_look_across(const Machine& machine, double swung) {
  const bool turns = machine.swing && machine.swing->lower < swung && swung < machine.swing->upper;
  const bool stands =
      !machine.body || std::abs(machine.body->centre.x()) < side_edge * machine.body->front_edge;
  return turns && stands;
}

}  // namespace

bool stands_clear(const JobStation& station, const JobFrame& frame, const JobSettings& settings,
                  const JobMap& map, const Terrain& ground) {
  const BasePose base = ahead_of(base_at(frame, station, ground, settings.site.machine), frame);
  const auto dump =
      dump_place(settings, map, ground, base, {0.0, frame.is_beside(), 1.0, frame.tracks});
  if (!dump) return false;
  const double swing = dump->swing + std::copysign(spare_turn, dump->swing);
  bool clear = true;
  for (const double off : {-off_place, off_place}) {
    BasePose near = base;
    near.x += off * std::cos(base.heading);
    near.y += off * std::sin(base.heading);
    clear &= turns_clear(settings, near, swing);
  }
  return clear;
}

std::optional<PlacesBeside> places_beside(const JobSettings& settings, const JobMap& map,
                                          const Terrain& first, const JobFrame& frame) {
  if (!frame.has_faces_across()) return std::nullopt;
  const Machine& machine = settings.site.machine;
  Terrain dug = first;
  dug.bank.z = map.target.z.isNaN().select(first.bank.z, first.bank.z.min(map.target.z));
  std::optional<PlacesBeside> best;
  for (const double turned : {0.5 * pi, -0.5 * pi}) {
    PlacesBeside beside = {frame_of(settings, map, turned), {}};
    beside.line.tracks = -turned;
    const auto all = stations_beside(beside.line, settings);
    if (!leaves_fewer_faces(beside.line, frame) || !can_look_across(machine, -beside.line.tracks) ||
        !reaches_across(beside.line, all.front(), machine))
      continue;
    for (const JobStation& each : all) {
      if (can_stand(beside.line, each, machine, map) &&
          can_stand_now({settings, map, first, dug}, beside.line, each) &&
          stands_clear(each, beside.line, settings, map, first))
        beside.places.push_back(each);
    }
    if (beside.places.size() > (best ? best->places.size() : 0)) best = std::move(beside);
  }
  return best;
}

bool can_stand_now(const Standing& on, const JobFrame& frame, const JobStation& station) {
  if (!is_tail_clear(on.settings, frame.place(station.along, station.beside))) return false;
  bool free = true;
  const auto& machine = on.settings.site.machine;
  const auto keep_off = [&](double around, double deepest) {
    for_each_under({frame, station, machine, around}, on.map.target, [&](const auto& cell) {
      if (!cell) return;
      free &= !(surface_of(on.first, *cell) - surface_of(on.now, *cell) > deepest);
    });
  };
  keep_off(off_cut, deepest_rut);
  for (const double away : off_drops) keep_off(away, away);
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
  std::optional<JobStation> overflowing;
  for (const auto& [away, shift] : shifts) {
    if (away > farthest_for_room && overflowing) break;
    JobStation moved = station;
    moved.along += shift.x();
    moved.beside += shift.y();
    if (!can_stand_now(on, frame, moved)) continue;
    const BasePose base = base_at(frame, moved, on.now, on.settings.site.machine);
    const auto dump = dump_place(on.settings, on.map, on.now, base, {0.0, true});
    if (!dump) continue;
    if (dump->overflows) {
      if (!overflowing) overflowing = moved;
      continue;
    }
    if (dump_place(on.settings, on.map, on.now, base, {reach_to_spare})) return moved;
    if (!meagre) meagre = moved;
  }
  return meagre ? meagre : overflowing;
}

namespace {

/// Stations of one line that were moved, from the far end back.
class ClearLine {
 public:
  ClearLine(const JobFrame& frame, const JobSettings& settings, const JobMap& map,
            const Terrain& ground)
      : frame_(frame), settings_(settings), map_(map), ground_(ground) {}

  /// The next one where it stands clear; where no place serves, on both sides of what is in the
  /// way; else as it is.
  void add(const JobStation& usual) {
    if (put(usual, most_shift)) return;
    const std::size_t before = placed_.size();
    const double room = placed_.empty() ? 0.0 : placed_.back().along - usual.along;
    for (double away = step_along; away < room; away += step_along) {
      if (!put(moved(usual, away), 0.0)) continue;
      if (put(usual, most_shift)) return;
      break;
    }
    placed_.resize(before);
    placed_.push_back(usual);
  }

  std::vector<JobStation> placed() && { return std::move(placed_); }

 private:
  static JobStation moved(JobStation station, double shift) {
    station.along += shift;
    return station;
  }

  /// So far forward that the next one reaches on from there, so far back as it reaches on itself.
  double most_back(const JobStation& usual) const {
    if (placed_.empty()) return -most_back_at_end;
    const Machine& machine = settings_.site.machine;
    const double last = placed_.back().along;
    const double dug_to = last + work_range(frame_, machine, last).near;
    const double reach = work_range(frame_, machine, usual.along).far;
    return std::max(-most_shift, dug_to - most_gap - usual.along - reach);
  }

  /// @return whether it stands clear so near to where it was
  bool put(const JobStation& usual, double widest) {
    const double back = most_back(usual);
    for (double away = 0.0; away <= widest; away += step_along) {
      for (const double shift : {away, -away}) {
        if (shift < back || !stands_clear(moved(usual, shift), frame_, settings_, map_, ground_))
          continue;
        placed_.push_back(moved(usual, shift));
        return true;
      }
    }
    return false;
  }

  const JobFrame& frame_;
  const JobSettings& settings_;
  const JobMap& map_;
  const Terrain& ground_;
  std::vector<JobStation> placed_;
};

}  // namespace

std::vector<JobStation> clear_of_obstacles(std::vector<JobStation> stations, const JobFrame& frame,
                                           const JobSettings& settings, const JobMap& map,
                                           const Terrain& ground) {
  if (settings.design.obstacles.empty() || stations.empty()) return stations;
  ClearLine line(frame, settings, map, ground);
  for (const JobStation& each : stations) line.add(each);
  std::vector<JobStation> clear = std::move(line).placed();
  // It reaches the near end.
  if (clear.back().along > stations.back().along) clear.push_back(stations.back());
  return clear;
}

}  // namespace excavplan
