// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/job_stations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "base/angles.hpp"
#include "job/dump_place.hpp"

namespace excavplan {
namespace {

// Numbers of our own choice.
constexpr double nearest_work = 1.15;  // before the tracks, so that the bucket has room to curl [m]
constexpr double farthest_work = 0.78;  // of the reach of the front from its pin
constexpr double end_wall = 0.67;       // of that reach to the far end: nearer the bucket opens too
                                        // little for a steep cut
constexpr double overlap = 0.25;        // of what is dug from two places in succession [m]
constexpr double side_margin = 0.04;    // to the sides of the design, as no machine is exact [m]
constexpr double end_margin = 0.03;     // to the ends of the design, half a cell at least [m]
constexpr double lane_overlap = 0.1;    // of two lanes [m]
constexpr double standing_step = 0.2;   // of the ground under the tracks that is looked at [m]
constexpr double beside_edge = 0.6;     // of tracks that stand beside the design [m]
constexpr double batter_step = 0.1;     // of passes that leave a face in steps [m]
constexpr std::size_t passes_of_lane = 3;  // that far apart are lanes for volume there
constexpr double least_across = 0.1;       // share of the design, to cut it so
constexpr double most_left = 0.5;          // of such faces, for another line of work
constexpr double widest_lane =
    0.33;  // beside the swing axis, so that the bucket is hardly yawed [m]

std::vector<double> lanes_of(const JobFrame& frame, double bucket_width) {
  const double half = 0.5 * bucket_width + side_margin;
  const double right = frame.right + half;
  const double left = frame.left - half;
  if (left <= right) return {0.5 * (frame.left + frame.right)};
  const double step = frame.faces_across > least_across ? batter_step : bucket_width - lane_overlap;
  const int more = static_cast<int>(std::ceil((left - right) / step));
  std::vector<double> lanes;
  for (int i = 0; i <= more; ++i) lanes.push_back(right + (left - right) * i / more);
  return lanes;
}

/// Lanes that are dug from one place.
std::vector<std::vector<double>> groups_of(const std::vector<double>& lanes) {
  std::vector<std::vector<double>> groups;
  for (const double lane : lanes) {
    if (groups.empty() || lane - groups.back().front() > 2.0 * widest_lane) groups.emplace_back();
    groups.back().push_back(lane);
  }
  return groups;
}

/// Of a group of lanes.
JobStation station_at(const JobFrame& frame, double along, const std::vector<double>& lanes) {
  JobStation station = {along, 0.5 * (lanes.front() + lanes.back()), lanes};
  if (!(frame.faces_across > least_across)) return station;
  station.passes = lanes;
  station.lanes.clear();
  for (std::size_t i = 0; i < lanes.size(); i += passes_of_lane) station.lanes.push_back(lanes[i]);
  if (station.lanes.back() != lanes.back()) station.lanes.push_back(lanes.back());
  return station;
}

/// The tracks of a machine at a station, and so far around them.
struct TrackArea {
  const JobFrame& frame;
  const JobStation& station;
  const Machine& machine;
  double around = 0.0;  ///< [m]
};

/// The cells of a grid there.
template <typename Visit>
void for_each_under(const TrackArea& tracks, const HeightMap& grid, Visit visit) {
  const JobStation& station = tracks.station;
  const double front = tracks.machine.track_front + tracks.around;
  const double half = 0.5 * tracks.machine.undercarriage_width() + tracks.around;
  const Eigen::Rotation2Dd turn(station.turned);
  const double rows = std::ceil(front / standing_step), cols = std::ceil(half / standing_step);
  for (double i = -rows; i <= rows; ++i) {
    for (double k = -cols; k <= cols; ++k) {
      const Eigen::Vector2d off = turn * Eigen::Vector2d(front * i / rows, half * k / cols);
      const Eigen::Vector2d at =
          tracks.frame.place(station.along + off.x(), station.beside + off.y());
      visit(cell_at(grid, at.x(), at.y()));
    }
  }
}

/// Before the job the tracks may reach onto the rim of a place for soil, which is filled last.
bool can_begin(const JobFrame& frame, const JobStation& station, const Machine& machine,
               const JobMap& map) {
  bool free = true;
  for_each_under({frame, station, machine}, map.target,
                 [&](const auto& cell) { free &= cell && !map.untouched(cell->row, cell->col); });
  const Eigen::Vector2d at = frame.place(station.along, station.beside);
  const auto middle = cell_at(map.target, at.x(), at.y());
  return free && middle && !map.dump(middle->row, middle->col);
}

double nearest_of(const Machine& machine) { return machine.track_front + nearest_work; }
double at_reach(const Machine& machine, double share) {
  return machine.boom_pin.x() + share * machine.full_length();
}
double farthest_of(const Machine& machine) { return at_reach(machine, farthest_work); }

/// Along the line, from where all that is near is reached.
double last_of(const JobFrame& frame, const Machine& machine) {
  return std::min(frame.far - at_reach(machine, end_wall), frame.near - nearest_of(machine));
}

/// A row of places once more, between where they were, where all lanes run up or down the faces:
/// what a bucket loses beside its lanes lies where those of two places meet.
void add_between(const JobFrame& frame, const Machine& machine, std::vector<JobStation>& stations) {
  std::vector<double> lanes = lanes_of(frame, machine.bucket.width_outside);
  if (!frame.is_battered || frame.faces_across > least_across || groups_of(lanes).size() < 2)
    return;
  const JobStation last = stations.back();
  lanes.erase(lanes.begin(), lanes.begin() + 1);
  auto groups = groups_of(lanes);
  if (last.beside > 0.5 * (frame.left + frame.right)) std::reverse(groups.begin(), groups.end());
  for (const auto& group : groups) {
    stations.push_back(station_at(frame, last.along, group));
    stations.back().is_again = true;
    stations.back().shapes_from = last.shapes_from;
  }
}

}  // namespace

JobFrame work_frame(const JobSettings& settings, const JobMap& map, const Terrain& first) {
  const JobFrame straight = frame_of(settings, map);
  if (!(straight.faces_across > least_across)) return straight;
  JobFrame best = straight;
  for (const double turned : {0.5 * pi, -0.5 * pi}) {
    const JobFrame frame = frame_of(settings, map, turned);
    if (frame.faces_across > most_left * straight.faces_across) continue;
    if (best.heading != straight.heading && frame.near <= best.near) continue;
    const auto stations = stations_of(frame, settings);
    const Machine& machine = settings.site.machine;
    const bool can_work =
        std::all_of(stations.begin(), stations.end(), [&](const JobStation& each) {
          return can_begin(frame, each, machine, map) &&
                 dump_place(settings, map, first, base_at(frame, each, first, machine));
        });
    if (can_work) best = frame;
  }
  return best;
}

WorkRange work_range(const JobFrame& frame, const Machine& machine, double along) {
  const double end = frame.far - end_margin - along;
  WorkRange range;
  range.near = std::max(nearest_of(machine), frame.near + end_margin - along);
  range.far = std::min(farthest_of(machine), end);
  range.ends_at_wall = range.far == end && !frame.is_battered;
  return range;
}

std::vector<JobStation> stations_of(const JobFrame& frame, const JobSettings& settings) {
  const Machine& machine = settings.site.machine;
  const double first = frame.far - at_reach(machine, end_wall);
  const double last = last_of(frame, machine);
  const double most_back = farthest_of(machine) - nearest_of(machine) - overlap;
  const int more = static_cast<int>(std::ceil((first - last) / most_back - 1e-9));
  const auto groups = groups_of(lanes_of(frame, machine.bucket.width_outside));
  std::vector<JobStation> stations;
  for (int i = 0; i <= more; ++i) {
    const double step = more == 0 ? 0.0 : (last - first) / more;
    const double along = first + step * i;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      // Every other time from the other side: the machine need not go back across.
      const auto& lanes = groups[i % 2 == 0 ? g : groups.size() - 1 - g];
      stations.push_back(station_at(frame, along, lanes));
      if (groups.size() > 1 && i < more)
        stations.back().shapes_from = along + step + farthest_of(machine) - overlap;
    }
    add_between(frame, machine, stations);
  }
  return stations;
}

std::vector<JobStation> stations_beyond(const JobFrame& frame, const JobSettings& settings) {
  const JobFrame back = reversed(frame);
  const Machine& machine = settings.site.machine;
  std::vector<JobStation> stations;
  for (const auto& lanes : groups_of(lanes_of(back, machine.bucket.width_outside))) {
    stations.push_back(station_at(back, back.near - nearest_of(machine), lanes));
    stations.back().is_beyond = true;
  }
  return stations;
}

bool can_stand(const JobFrame& frame, const JobStation& station, const Machine& machine,
               const JobMap& map) {
  bool free = true;
  const HeightMap& target = map.target;
  for_each_under({frame, station, machine, beside_edge}, target, [&](const auto& cell) {
    free &= !cell || std::isnan(target.z(cell->row, cell->col));
  });
  if (!free) return false;
  for_each_under({frame, station, machine}, target, [&](const auto& cell) {
    free &= cell && !map.dump(cell->row, cell->col) && !map.untouched(cell->row, cell->col);
  });
  return free;
}

BasePose base_at(const JobFrame& frame, const JobStation& station, const Terrain& ground,
                 const Machine& machine) {
  const Eigen::Vector2d place = frame.place(station.along, station.beside);
  BasePose base = {place.x(), place.y(), 0.0, frame.heading + station.turned};
  double sum = 0.0;
  int known = 0;
  for_each_under({frame, station, machine}, ground.bank, [&](const auto& cell) {
    const double z = cell ? ground.bank.z(cell->row, cell->col) : std::nan("");
    if (std::isnan(z)) return;
    sum += z + ground.loose(cell->row, cell->col);
    ++known;
  });
  if (known > 0) base.z = sum / known;
  return base;
}

}  // namespace excavplan
