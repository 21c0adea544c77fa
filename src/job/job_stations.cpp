// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/job_stations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/angles.hpp"
#include "job/dump_place.hpp"

namespace excavplan {
namespace {

// Numbers of our own choice.
constexpr double nearest_work = 1.15;  // before the tracks, so that the bucket has room to curl [m]
constexpr double nearest_rim = 0.9;    // likewise beside a design, so that it curls over the rim
constexpr double end_of_sweeps = 0.15;  // of the design, to each side, that they need not reach [m]
constexpr double lane_of_sweeps = 0.33;    // between lanes across it [m]
constexpr double farthest_work = 0.78;     // of the reach of the front from its pin
constexpr double farthest_of_wide = 0.86;  // likewise where two ends meet
constexpr double end_wall = 0.67;     // of that reach to the far end: nearer the bucket opens too
                                      // little for a steep cut
constexpr double end_of_wide = 0.74;  // likewise of a wide design: its face leans back, and takes
                                      // up what is within reach of a nearer place
// Of what is dug from two places in succession, of the zx120 [m]: ends of passes are rough, and a
// flat bucket begins nearer than it digs.
constexpr double overlap = 1.3;
constexpr double overlap_of_wide = 0.25;   // likewise of a wide design, whose rows reach farther
constexpr double overlap_of_faces = 0.7;   // likewise of passes that begin on their way down
constexpr double most_shared = 0.7;        // likewise, of all that is dug from a place
constexpr double side_margin = 0.04;       // to the sides of the design, as no machine is exact [m]
constexpr double end_margin = 0.03;        // to the ends of the design, half a cell at least [m]
constexpr double lane_overlap = 0.1;       // of two lanes [m]
constexpr double beside_edge = 0.6;        // of tracks that stand beside the design [m]
constexpr double batter_step = 0.1;        // of passes that leave a face in steps [m]
constexpr std::size_t passes_of_lane = 3;  // that far apart are lanes for volume there
constexpr double most_left = 0.5;          // of such faces, for another line of work
constexpr double widest_lane =
    0.33;  // beside the swing axis, so that the bucket is hardly yawed [m]

constexpr double widest_between = 0.47;    // likewise of passes over the ridges between lanes [m]
constexpr double widest_for_volume = 1.6;  // likewise of a wide design [m]
constexpr double widest_at_wall = 1.0;     // likewise of its passes: a bucket that is yawed further
                                           // turns its back into the wall as it curls [m]
constexpr double widest_straight = 1.1;    // of both, at most, where no machine is exact [m]
constexpr double least_wider = 0.05;       // of a bench than the floor, to dig along its side [m]
constexpr double least_of_benches = 2.0;   // between the outermost lanes [m]
constexpr std::ptrdiff_t lanes_of_foot = 3;  // of the other face, that the last side passes too
constexpr double onto_face = 0.05;           // of a lane that does not lean yet [m]
constexpr double off_wall = 0.05;            // of passes beside it [m]
constexpr double fan_step = 0.1;             // between planes through the swing axis [rad]

/// Both ends and what lies between, at most so far apart.
std::vector<double> evenly(double from, double to, double step) {
  const int more = static_cast<int>(std::ceil((to - from) / step - 1e-9));
  std::vector<double> lanes;
  for (int i = 0; i <= more; ++i) lanes.push_back(more == 0 ? from : from + (to - from) * i / more);
  return lanes;
}

/// Across the faces beside the floor, and in steps along those at its ends.
std::vector<double> lanes_beside(const JobFrame& frame, const AcrossLine& all, double half) {
  const double first = std::clamp(frame.floor.right + half, all.right, all.left);
  const double last = std::clamp(frame.floor.left - half, first, all.left);
  std::vector<double> lanes = evenly(all.right, first, batter_step);
  for (const auto& [from, to, step] :
       {std::array{first, last, lane_of_sweeps}, std::array{last, all.left, batter_step}}) {
    const auto more = evenly(from, to, step);
    lanes.insert(lanes.end(), more.begin() + 1, more.end());
  }
  return lanes;
}

std::vector<double> lanes_of(const JobFrame& frame, double bucket_width) {
  const double half = 0.5 * bucket_width + side_margin;
  const double right = frame.right + half;
  const double left = frame.left - half;
  if (left <= right) return {0.5 * (frame.left + frame.right)};
  if (frame.is_beside()) return lanes_beside(frame, {right, left}, half);
  return evenly(right, left, frame.has_faces_across() ? batter_step : bucket_width - lane_overlap);
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
  if (!frame.has_faces_across()) return station;
  station.passes = lanes;
  station.lanes.clear();
  for (std::size_t i = 0; i < lanes.size(); i += passes_of_lane) station.lanes.push_back(lanes[i]);
  if (station.lanes.back() != lanes.back()) station.lanes.push_back(lanes.back());
  return station;
}

/// As few groups as are all so near aside.
std::vector<std::vector<double>> groups_within(double widest_lane_beside,
                                               const std::vector<double>& lanes) {
  for (std::size_t count = 1;; ++count) {
    std::vector<std::vector<double>> groups;
    double widest = 0.0;
    for (std::size_t g = 0; g < count; ++g) {
      groups.emplace_back(
          lanes.begin() + static_cast<std::ptrdiff_t>(g * lanes.size() / count),
          lanes.begin() + static_cast<std::ptrdiff_t>((g + 1) * lanes.size() / count));
      widest = std::max(widest, groups.back().back() - groups.back().front());
    }
    if (widest <= 2.0 * widest_lane_beside) return groups;
  }
}

/// Whether a design is dug in benches from few places: not where all lanes run along its faces.
bool wants_benches(const JobFrame& frame, const std::vector<double>& lanes) {
  const bool runs_on_faces = frame.is_battered && !frame.has_faces_across();
  return !runs_on_faces && lanes.back() - lanes.front() > least_of_benches;
}

/// Whether the right side of a bucket in a lane cuts along a face.
bool leans_right(const JobFrame& frame, double bucket_width, double lane) {
  return frame.has_faces_across() && lane - 0.5 * bucket_width < frame.floor.right - onto_face;
}

/// Lanes that passes are made in from one place: first those that lean to the right, if the others
/// can all be reached from one place, with the lowest of the first, whose soil is dug from there.
std::vector<std::vector<double>> sides_of(const JobFrame& frame, double bucket_width,
                                          const std::vector<double>& lanes) {
  auto sides = groups_within(widest_at_wall, lanes);
  const auto other = std::find_if_not(lanes.begin(), lanes.end(), [&](double lane) {
    return leans_right(frame, bucket_width, lane);
  });
  if (sides.size() != 2 || other == lanes.begin() || other == lanes.end()) return sides;
  const auto from = other - std::min(other - lanes.begin(), lanes_of_foot);
  const double widest = std::max(lanes.back() - *from, *(other - 1) - lanes.front());
  if (widest > 2.0 * widest_at_wall) return sides;
  return {{lanes.begin(), other}, {from, lanes.end()}};
}

/// From the middle of a wide group its soil is dug evenly; walls and floor are cut from nearer to
/// each side. The soil that falls off the faces of one side is left to the other one.
void add_wide(const JobFrame& frame, double bucket_width, double along,
              const std::vector<double>& lanes, std::vector<JobStation>& stations) {
  const auto sides = sides_of(frame, bucket_width, lanes);
  stations.push_back(station_at(frame, along, lanes));
  stations.back().is_wide = true;
  stations.back().leaves_passes = sides.size() > 1;
  if (sides.size() < 2) return;
  for (const auto& side : sides) {
    stations.push_back(station_at(frame, along, side));
    stations.back().is_wide = true;
    stations.back().is_again = true;
    stations.back().leaves_floor =
        &side != &sides.back() && leans_right(frame, bucket_width, side.back());
  }
}

/// With lanes over the ridges between them, unless these lie within the next lane: such a pass
/// would only push soil against both walls.
std::vector<double> over_ridges(const std::vector<double>& lanes, double bucket_width) {
  std::vector<double> all;
  for (const double lane : lanes) {
    const bool leaves_ridge = !all.empty() && lane - all.back() >= 0.5 * bucket_width;
    if (leaves_ridge) all.push_back(0.5 * (all.back() + lane));
    all.push_back(lane);
  }
  return all;
}

/// Passes also run a little off the walls, as one that stands too far inside would stop them.
std::vector<double> lanes_of(const JobStation& station, double bucket_width, bool finishing) {
  if (!finishing) return station.lanes;
  if (!station.passes.empty()) return station.passes;
  std::vector<double> all = over_ridges(station.lanes, bucket_width);
  if (all.size() > 1) all.insert(all.end(), {all.front() + off_wall, all.back() - off_wall});
  return all;
}

/// On which side of the design the soil goes, so that the other is dug first, while what is laid is
/// low and within reach: 1 to the left, -1 to the right, 0 on both or ahead.
double side_of_soil(const JobFrame& frame, const JobDesign& design) {
  Eigen::AlignedBox1d beside;
  const auto look = [&](const SitePolygon& area) {
    for (const Eigen::Vector2d& corner : area) beside.extend(frame.of(corner).tail<1>());
  };
  for (const DumpArea& area : design.dump_areas) look(area.polygon);
  if (design.truck) look(design.truck->bed);
  if (beside.isEmpty()) return 0.0;
  const double middle = 0.5 * (frame.left + frame.right);
  if (beside.min()(0) > middle) return 1.0;
  return beside.max()(0) < middle ? -1.0 : 0.0;
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

double nearest_of(const JobFrame& frame, const Machine& machine) {
  if (!frame.is_beside()) return machine.track_front + nearest_work;
  return 0.5 * machine.undercarriage_width() + nearest_rim;
}
double at_reach(const Machine& machine, double share) {
  return machine.boom_pin.x() + share * machine.full_length();
}
double farthest_of(const Machine& machine, bool is_wide = false) {
  return at_reach(machine, is_wide ? farthest_of_wide : farthest_work);
}

/// Of what is dug from two places in succession [m].
double shared_of(const JobFrame& frame, const Machine& machine, bool is_wide) {
  const double wanted = frame.has_faces_across() ? overlap_of_faces
                        : is_wide                ? overlap_of_wide
                                                 : overlap;
  const double all = farthest_of(machine) - nearest_of(frame, machine);
  return std::min(wanted * dig_size(machine), most_shared * all);
}

/// Along the line, from where all that is near is reached.
double last_of(const JobFrame& frame, const Machine& machine) {
  return std::min(frame.far - at_reach(machine, end_wall), frame.near - nearest_of(frame, machine));
}

/// A row of places once more, between where they were, where all lanes run up or down the faces:
/// what a bucket loses beside its lanes lies where those of two places meet. So only the second
/// time passes are made, over the ridges too.
void add_between(const JobFrame& frame, const Machine& machine, std::size_t first_of_row,
                 std::vector<JobStation>& stations) {
  const std::vector<double> lanes = lanes_of(frame, machine.bucket.width_outside);
  if (!frame.is_battered || frame.has_faces_across() || groups_of(lanes).size() < 2) return;
  for (std::size_t i = first_of_row; i < stations.size(); ++i) stations[i].leaves_passes = true;
  const JobStation last = stations.back();
  auto groups = groups_within(widest_between, over_ridges(lanes, machine.bucket.width_outside));
  if (last.beside > 0.5 * (frame.left + frame.right)) std::reverse(groups.begin(), groups.end());
  for (const auto& group : groups) {
    JobStation station = station_at(frame, last.along, group);
    station.passes = group;
    if (group.front() == lanes.front()) station.passes.push_back(lanes.front() + off_wall);
    if (group.back() == lanes.back()) station.passes.push_back(lanes.back() - off_wall);
    station.is_again = true;
    station.has_others_beside = true;
    station.shapes_from = last.shapes_from;
    stations.push_back(station);
  }
}

/// Whether a bucket lies on the floor alone in some of these lanes.
bool is_on_floor(const JobFrame& frame, const std::vector<double>& lanes, double half) {
  return std::any_of(lanes.begin(), lanes.end(), [&](double lane) {
    return lane - half > frame.floor.right && lane + half < frame.floor.left;
  });
}

/// Whether all that is dug from a place lies within half a bucket of sweeps.
bool is_swept(const JobFrame& frame, const WorkRange& range, double along,
              const std::vector<double>& swept, double bucket_width) {
  const double to = std::min(along + range.far, frame.far - end_of_sweeps);
  double reached = std::max(along + range.near, frame.near + end_of_sweeps);
  for (const double at : swept) {
    if (at - 0.5 * bucket_width > reached) break;
    reached = std::max(reached, at + 0.5 * bucket_width);
  }
  return !swept.empty() && reached >= to;
}

}  // namespace

bool leaves_fewer_faces(const JobFrame& turned, const JobFrame& straight) {
  return turned.faces_across <= most_left * straight.faces_across;
}

JobFrame work_frame(const JobSettings& settings, const JobMap& map, const Terrain& first) {
  JobFrame straight = frame_of(settings, map);
  if (!straight.has_faces_across()) return straight;
  JobFrame best = straight;
  for (const double turned : {0.5 * pi, -0.5 * pi}) {
    const JobFrame frame = frame_of(settings, map, turned);
    if (!leaves_fewer_faces(frame, straight)) continue;
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

WorkRange work_range(const JobFrame& frame, const Machine& machine, double along, bool is_wide) {
  const double end = frame.far - end_margin - along;
  WorkRange range;
  range.near = std::max(nearest_of(frame, machine), frame.near + end_margin - along);
  range.far = std::min(farthest_of(machine, is_wide), end);
  range.ends_at_wall = range.far == end && !frame.is_battered;
  return range;
}

std::vector<JobStation> stations_of(const JobFrame& frame, const JobSettings& settings,
                                    const std::vector<double>& swept) {
  const Machine& machine = settings.site.machine;
  const auto lanes_of_all = lanes_of(frame, machine.bucket.width_outside);
  const bool is_wide = wants_benches(frame, lanes_of_all);
  const double first =
      frame.far - at_reach(machine, is_wide && frame.is_battered ? end_of_wide : end_wall);
  const double last = last_of(frame, machine);
  const double shared = shared_of(frame, machine, is_wide);
  const double most_back = farthest_of(machine) - nearest_of(frame, machine) - shared;
  const int more = static_cast<int>(std::ceil((first - last) / most_back - 1e-9));
  const double soil = side_of_soil(frame, settings.design);
  // Else every other time from the other side: the machine need not go back across.
  const auto starts_left = [&](int row) { return soil == 0.0 ? row % 2 == 1 : soil < 0.0; };
  std::vector<JobStation> stations;
  for (int i = 0; i <= more; ++i) {
    const double step = more == 0 ? 0.0 : (last - first) / more;
    const double along = first + step * i;
    const bool leaves_faces = is_swept(frame, work_range(frame, machine, along, is_wide), along,
                                       swept, machine.bucket.width_outside);
    const auto groups = is_wide || leaves_faces ? groups_within(widest_for_volume, lanes_of_all)
                                                : groups_of(lanes_of_all);
    const std::size_t first_of_row = stations.size();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const auto& lanes = groups[starts_left(i) ? groups.size() - 1 - g : g];
      const std::size_t first_of_group = stations.size();
      if (is_wide)
        add_wide(frame, machine.bucket.width_outside, along, lanes, stations);
      else
        stations.push_back(station_at(frame, along, lanes));
      if (leaves_faces) stations.resize(first_of_group + 1);
      stations.back().leaves_passes |= leaves_faces;
      stations[first_of_group].has_others_beside = groups.size() > 1;
      if (!is_wide && groups.size() > 1 && i < more)
        stations.back().shapes_from = along + step + farthest_of(machine) - shared;
    }
    add_between(frame, machine, first_of_row, stations);
  }
  return stations;
}

std::vector<JobStation> stations_beside(const JobFrame& across, const JobSettings& settings) {
  const Machine& machine = settings.site.machine;
  const double along = across.near - nearest_of(across, machine);
  std::vector<JobStation> stations;
  for (const auto& lanes : groups_of(lanes_of(across, machine.bucket.width_outside))) {
    JobStation station = {along, 0.5 * (lanes.front() + lanes.back()), lanes};
    station.turned = across.tracks;
    station.passes = lanes;
    station.has_others_beside = true;
    station.is_across = true;
    station.is_again = true;
    stations.push_back(station);
  }
  if (across.tracks < 0.0) std::reverse(stations.begin(), stations.end());  // to the near end first
  // What falls off the far end is taken with the floor before it, as at the near one.
  const auto on_floor = [&](const JobStation& each) {
    return is_on_floor(across, each.lanes, 0.5 * machine.bucket.width_outside);
  };
  const auto last = std::find_if(stations.rbegin(), stations.rend(), on_floor);
  if (last != stations.rend()) std::rotate(last.base() - 1, last.base(), stations.end());
  return stations;
}

bool reaches_across(const JobFrame& across, const JobStation& place, const Machine& machine) {
  return place.along + work_range(across, machine, place.along).far > across.far - end_of_sweeps;
}

std::vector<double> swept_from(const std::vector<JobStation>& places, const JobFrame& across,
                               const JobFrame& frame) {
  std::vector<double> swept;
  for (const JobStation& place : places) {
    for (const double lane : place.passes) swept.push_back(frame.of(across.place(0.0, lane)).x());
  }
  std::sort(swept.begin(), swept.end());
  return swept;
}

std::vector<JobStation> stations_beyond(const JobFrame& frame, const JobSettings& settings) {
  const JobFrame back = reversed(frame);
  const Machine& machine = settings.site.machine;
  const auto lanes_of_all = lanes_of(back, machine.bucket.width_outside);
  const double along = back.near - nearest_of(back, machine);
  std::vector<JobStation> stations;
  if (wants_benches(frame, lanes_of_all)) {
    for (const auto& lanes : groups_within(widest_for_volume, lanes_of_all))
      add_wide(back, machine.bucket.width_outside, along, lanes, stations);
  } else {
    for (const auto& lanes : groups_of(lanes_of_all))
      stations.push_back(station_at(back, along, lanes));
  }
  for (JobStation& each : stations) each.is_beyond = true;
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

std::vector<WorkLine> work_lines(const JobFrame& frame, const JobStation& station,
                                 const Machine& machine, const Eigen::Vector2d& at,
                                 bool finishing) {
  WorkRange range = work_range(frame, machine, at.x(), station.is_wide);
  const double shaped = station.shapes_to - at.x();
  range.ends_at_wall &= shaped >= range.far;
  if (finishing) range.far = std::min(range.far, shaped);
  std::vector<WorkLine> lines;
  Eigen::AlignedBox1d fan;
  for (const double lane : lanes_of(station, machine.bucket.width_outside, finishing)) {
    const double beside = lane - at.y();
    if (!station.is_wide || std::abs(beside) <= widest_straight) {
      lines.push_back({0.0, beside, range.near, range.far, range.ends_at_wall});
    } else {
      for (const double ahead : {range.near, range.far})
        fan.extend(Eigen::Matrix<double, 1, 1>(std::atan2(beside, ahead)));
    }
  }
  if (fan.isEmpty()) return lines;
  const double widest = fan.sizes()(0);
  const int more = static_cast<int>(std::ceil(widest / fan_step));
  for (int i = 0; i <= more; ++i) {
    const double turned = fan.min()(0) + (more > 0 ? widest * i / more : 0.0);
    const double near = range.near / std::cos(turned);
    const double far = farthest_of(machine, station.is_wide);
    if (near < far) lines.push_back({turned, 0.0, near, far});
  }
  return lines;
}

JobStation on_bench(JobStation station, const JobFrame& frame, const AcrossLine& below,
                    const Machine& machine) {
  const double half = 0.5 * machine.bucket.width_outside + side_margin;
  const double right = below.right + half, left = below.left - half;
  std::vector<double>& lanes = station.lanes;
  if (lanes.front() < frame.right + half + 1e-6 && right < lanes.front() - least_wider)
    lanes.insert(lanes.begin(), right);
  if (lanes.back() > frame.left - half - 1e-6 && left > lanes.back() + least_wider)
    lanes.push_back(left);
  return station;
}

double volume_lane_step(const JobFrame& frame) {
  return frame.has_faces_across() ? batter_step * static_cast<double>(passes_of_lane) : 0.0;
}

BasePose ahead_of(BasePose base, const JobFrame& frame) {
  base.heading = frame.heading;
  return base;
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
