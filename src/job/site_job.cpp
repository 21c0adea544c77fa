// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/site_job.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include <excavplan/planning/dig_cycle.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/soil/soil.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "design/design_checks.hpp"
#include "design/design_walls.hpp"
#include "ground/slopes.hpp"
#include "job/dump_place.hpp"
#include "job/job_ground.hpp"
#include "job/job_log.hpp"
#include "job/job_map.hpp"
#include "job/job_record.hpp"
#include "job/job_stations.hpp"
#include "job/lookout.hpp"
#include "job/station_place.hpp"
#include "job/step_motion.hpp"
#include "job/step_search.hpp"
#include "simulation/across_tracks.hpp"

namespace excavplan {
namespace {

// Numbers of our own choice.
constexpr std::size_t most_unseen = 5;           // digs between two scans
constexpr std::size_t most_unseen_passes = 2;    // likewise of passes
constexpr std::size_t most_unseen_on_steps = 4;  // likewise along faces, each in its lane
constexpr double allowance = 0.5;       // over the design, in tolerances: what is too deep stays so
constexpr double middle = 0.1;          // of what passes leave, over the design, in tolerances:
                                        // the lowest of some passes stays
constexpr double most_allowance = 0.8;  // of passes to that end, likewise
constexpr double floor_reading_sd = 0.005;   // of that middle at one place [m]
constexpr double least_allowance = -0.4;     // likewise
constexpr double most_of_floor = 0.5;        // in tolerances: else passes did not come so far
constexpr std::size_t least_of_floor = 100;  // cells that tell it
constexpr int most_passes = 8;               // along the floor from one station
constexpr int most_passes_of_shape = 16;     // likewise of a wide design, or one with faces
constexpr int most_passes_of_steps = 30;     // likewise where lanes along faces leave steps
constexpr int most_fruitless = 4;            // passes in succession that took nothing off
constexpr int most_fruitless_on_steps = 16;  // likewise: what they cut falls aside
constexpr int most_fruitless_digs = 8;       // likewise of digs for volume
constexpr int most_fruitless_wide = 12;      // likewise where many places are left to dig from
constexpr int rounds_of_ends = 2;            // of a wide design, after each was dug from once
constexpr double far_end = 0.8;              // that may slope until it is dug from beyond [m]
constexpr double as_good_as_there = 0.3;     // of the machine: to move there changes nothing [m]
constexpr int hard_from_stalls = 2;          // in a job: its soil is harder than its machine likes
constexpr double move_in_hard = 1.5;         // at most along a row there, of the zx120 [m]
constexpr int most_moves_to_dump = 3;        // from one station, in succession without a dig
constexpr double bench_height = 0.4;         // of the layers of a wide design [m]
constexpr double thin_bench = 0.15;          // likewise where its sides are faces along the lanes
constexpr double undug = 4.0;                // over the design, in tolerances: not dug yet
constexpr double most_undug = 0.3;           // share of such cells where passes pay
constexpr double most_carried = 0.4;         // of a heaped bucket, through a pass
constexpr double load_of_passes = 0.5;       // likewise, to find a place for it
constexpr double least_again = 0.04;         // of a pass along a face, to come back for more [m^3]
constexpr double empty_bucket = 0.006;       // less is not worth a dump [m^3]
constexpr double least_mass = 15.0;          // in a bucket that was worth it [kg]
constexpr double least_taken = 0.3;          // of what a pass is to take off, else it is fruitless
constexpr double poor_dig = 0.4;             // of what was foretold: the ground is not as expected
constexpr double high_share = 1.0;           // of the tolerance: higher cells call for a pass
constexpr double most_off_shape = 0.042;     // share of cells that may stay so, or too low
constexpr double heap_share = 1.6;           // likewise of cells of which hardly any may stay so
constexpr double most_heaps = 0.006;         // share of these
constexpr double surely_in_shape = 0.9;      // share of what is allowed, of a wide design
constexpr double nearly_sure = 0.94;         // likewise of others
constexpr double surely_within = 0.6;        // likewise of what lies beyond twice the tolerance
constexpr int most_not_taken = 3;            // scans in succession, before the job ends
constexpr double well_seen = 0.9905;         // of it, so that no more is looked for
constexpr int most_blocked = 4;   // digs from one place whose way is blocked, before it is left
constexpr int most_doubtful = 2;  // digs not to be trusted, before the first of them is offered
constexpr int most_softer = 4;    // deviations of the strength below its mean that are tried
constexpr int softer_again = 1;   // likewise where the last dig stalled or lifted hardly any
constexpr std::size_t looks_at_end = 4;      // at the end, and once more
constexpr std::size_t looks_on_way = 3;      // to a place beyond the far end
constexpr double near_well_seen = 0.996;     // then, as the far end will hide something too
constexpr double least_newly_seen = 0.0005;  // by a look, or others will see no more
constexpr double beside_wall = 0.25;         // of the bucket, so that it digs at the wall [m]
constexpr double after_stall = 0.7;          // of the depth of a cut
constexpr double after_success = 1.1;        // likewise
constexpr double shallowest_cut = 0.06;      // [m]

/// Whether all are dug from one line.
bool is_one_group(const std::vector<JobStation>& stations) {
  return std::all_of(stations.begin(), stations.end(), [&](const JobStation& each) {
    return each.beside == stations.front().beside;
  });
}

/// The places of rows that were gone along twice already, from the last one back, for what little
/// is left there.
std::vector<JobStation> once_more(const std::vector<JobStation>& stations) {
  std::vector<JobStation> again;
  std::copy_if(stations.rbegin(), stations.rend(), std::back_inserter(again),
               [](const JobStation& each) { return each.is_again && !each.is_wide; });
  for (JobStation& each : again) each.has_others_beside = false;
  // Those beside a design in their order, in which its floor comes after its ends.
  if (!again.empty() && again.front().is_across) std::reverse(again.begin(), again.end());
  return again;
}

/// Whether the next ones of its row lie behind it on the same line.
bool is_alone_in_row(const JobStation& station) {
  return !station.is_lookout() && !station.is_wide && !station.has_others_beside &&
         !station.is_beyond && !station.is_across && !station.is_again;
}

/// What a dig is for.
enum class Work { volume, faces, shape };

/// A scan that tells the ground alone.
SiteEvent event_of(const Scan& scan, double time, const BasePose& base) {
  SiteEvent event;
  event.scan = scan;
  event.dug = false;
  event.time = time;
  event.base = base;
  return event;
}

}  // namespace

struct SiteJob::State {
  State(std::string where, JobSettings of_job)
      : folder(std::move(where)), settings(std::move(of_job)), ground(folder, settings) {}

  void look_at_design() {
    map = map_of(settings, first.bank);
    design = map.target.z;
    frame = work_frame(settings, map, first);
    side = places_beside(settings, map, first, frame);
    const Gradient slope = gradient_of(map.target);
    const Eigen::ArrayXXd rise = (slope.x.square() + slope.y.square()).sqrt();
    steps = volume_lane_step(frame) * rise.isNaN().select(0.0, rise);
    stations = stations_of(frame, settings);
    const bool is_swept = leave_faces_to_side();
    const std::vector<JobStation> beyond = is_swept ? std::vector<JobStation>() : places_beyond();
    if (is_one_group(stations)) {
      can_leave_end = !beyond.empty();
      stations = clear_of_obstacles(std::move(stations), frame, settings, map, first);
    }
    if (side) stations.insert(stations.end(), side->places.begin(), side->places.end());
    const JobStation last = stations.back(), lookout;
    std::vector<JobStation> ends = beyond;
    // What the near end hides is seen on the way to the far one.
    if (!beyond.empty() && !last.is_wide) ends.insert(ends.begin(), looks_on_way, lookout);
    if (last.is_wide) {  // each again, when the other is dug
      std::vector<JobStation> near;
      std::copy_if(stations.begin(), stations.end(), std::back_inserter(near),
                   [&](const JobStation& each) { return each.along == last.along; });
      for (JobStation& each : near) each.is_again = true;
      const int rounds = has_steps() ? 0 : rounds_of_ends;
      for (int round = 0; round < rounds; ++round) {
        ends.insert(ends.end(), near.begin(), near.end());
        ends.insert(ends.end(), beyond.begin(), beyond.end());
      }
    }
    const std::vector<JobStation> looks(looks_at_end, lookout);
    std::vector<JobStation> again = once_more(stations);
    if (again.empty()) again.push_back(last);
    for (const auto& more : {ends, looks, again, looks})
      stations.insert(stations.end(), more.begin(), more.end());
  }

  /// Where a row leaves passes to places beside, if one does. @return whether all do
  bool leave_faces_to_side() {
    if (!side) return false;
    auto rows = stations_of(frame, settings, swept_from(side->places, side->line, frame));
    if (rows.size() == stations.size()) {
      side.reset();
      return false;
    }
    stations = std::move(rows);
    return std::none_of(stations.begin(), stations.end(),
                        [](const JobStation& each) { return each.is_again; });
  }

  /// In the frame of the ground as it is known.
  void hang_design() {
    if (settings.surface.hangs_on_scan) return;
    map.target.z = raised(design, map.target, record.learning.datum.plane());
  }

  JobFrame frame_at(const JobStation& station) const {
    return station.is_across ? side->line : line_of(frame, station);
  }

  /// The present station. Where the soil has proved hard the far end is left to a place beyond:
  /// steep cuts down its wall stall.
  JobStation here() const {
    JobStation station = stations[record.station];
    if (can_leave_end && !station.is_beyond && record.progress.stalls > 0)
      station.shapes_to = frame.far - far_end;
    return station;
  }

  /// From which the far end of a design can be dug, if it is upright or wide.
  std::vector<JobStation> places_beyond() const {
    std::vector<JobStation> places;
    const std::vector<JobStation> all = stations_beyond(frame, settings);
    if (frame.is_battered && !all.front().is_wide) return places;
    std::copy_if(all.begin(), all.end(), std::back_inserter(places),
                 [&](const JobStation& each) { return can_dig_from(each); });
    if (all.front().is_wide && places.size() < all.size()) places.clear();
    return places;
  }

  /// Stand there before the job, and dump.
  bool can_dig_from(const JobStation& station) const {
    const JobFrame line = frame_at(station);
    const Machine& machine = settings.site.machine;
    std::optional<JobStation> place;
    if (station.is_wide)
      place = nearest_place({settings, map, first, first}, line, station);
    else if (can_stand(line, station, machine, map))
      place = station;
    return place &&
           dump_place(settings, map, first, ahead_of(base_at(line, *place, first, machine), line));
  }

  JobProgress progress() const {
    return measured(record.progress, map, {ground.expected(), ground.seen()},
                    settings.design.tolerance);
  }

  void begin(const Scan& scan, double time);
  JobStep decide();
  std::optional<JobStep> dig_step(Work work);
  std::optional<JobStep> best_step(Work work);
  bool has_steps() const { return volume_lane_step(frame) > 0.0; }
  bool may_pass() const;
  double held() const { return record.carried ? record.carried->volume : 0.0; }  ///< loose [m^3]
  /// Whether the bucket holds what is worth a dump.
  bool has_load() const { return held() >= empty_bucket; }
  DigStart start_of(const JobStep& dig) const;
  std::optional<DumpPlace> dump_from(double load) const;
  void lay_aside(const JobStep& dig);
  void drop_present();
  void close_present();
  std::vector<double> benches_below() const;
  std::vector<WorkLine> lines_on(double bench, const BasePose& straight) const;
  std::optional<StepDig> best_dig_of(StepTask& task, const std::vector<double>& benches);
  StepTask task_of(Work work, const DumpPlace& dump, const BasePose& straight) const;
  JobStep move_step(const JobStation& station);
  JobStep leave();
  JobStep go_to(const JobStation& place);
  void forget_failures();
  std::optional<JobStation> place_to_dump_from();
  std::optional<JobStation> missed_place(const JobProgress& now) const;
  std::optional<JobStation> next_place(const JobProgress& now) const;
  double way_in_hard() const;
  JobStation not_too_far() const;
  std::optional<JobStation> rest_of_way() const;
  LookTask look_task(const JobProgress& now) const;
  bool has_shape(const JobProgress& now, double share = 1.0) const {
    return now.p95 <= share * settings.design.tolerance &&
           now.beyond_twice <= share * most_beyond_twice;
  }
  /// So that passes from other places are not worth their moves.
  bool is_shaped(const JobProgress& now) const {
    return has_shape(now, stations.front().is_wide ? surely_in_shape : nearly_sure) &&
           now.beyond_twice <= surely_within * most_beyond_twice;
  }
  BasePose base_of(const JobStation& station) const;
  bool stands_well() const;
  bool wants_passes(const BasePose& base) const;
  bool is_dug_out(const BasePose& base) const;
  template <typename Visit>
  void for_each_in_reach(const BasePose& base, Visit visit) const;
  void learn_floor();
  double allowance_of_passes() const;
  void foretell(JobStep& step, const DumpPlace& dump, StepDig& dig) const;
  bool check_motion(JobStep& step);
  JobStep with_walls_checked(JobStep step) const;
  WallTask wall_task() const {
    const SoilKind& soil = settings.site.soil;
    const WallSoil bank = wall_soil(soil, settings.density_percent, record.learning);
    return {map.target, map.before,        ground.expected(),
            bank,       loose_state(soil), settings.site.machine,
            record.base};
  }
  bool may_keep(double more) const;
  int most_passes_here() const {
    if (has_steps()) return most_passes_of_steps;
    const bool has_shape_to_cut = frame.is_battered || stations[record.station].is_wide;
    return has_shape_to_cut ? most_passes_of_shape : most_passes;
  }
  std::size_t most_unseen_passes_here() const {
    return has_steps() ? most_unseen_on_steps : most_unseen_passes;
  }
  int most_fruitless_here() const { return has_steps() ? most_fruitless_on_steps : most_fruitless; }
  std::optional<JobStep> dump_step();
  JobStep step_of(JobAction what, const std::string& reason = {});
  void end_step(const StepReport& report);
  void end_dig(const JobStep& step, const StepReport& report);
  void take_scan(const StepReport& report);
  void save();
  void save_changed(const JobRecord& before, const JobStep& step, const StepReport& report);
  void log_from(const GroundState& of_first);
  void restore();
  /// What fails, or cannot be written, changes nothing.
  template <typename Change>
  void keep_whole(Change change) {
    require_whole();
    try {
      change();
    } catch (...) {
      go_back();
      throw;
    }
  }
  void go_back() noexcept;
  void require_whole() const;
  void require_record() const;
  std::string first_file() const { return folder + '/' + first_ground_file; }

  std::string folder;
  JobSettings settings;
  JobGround ground;
  Terrain first;  ///< before the job
  JobMap map;
  Eigen::ArrayXXd design;  ///< JobMap::target as told
  JobFrame frame;
  std::optional<PlacesBeside> side;  ///< places_beside()
  Eigen::ArrayXXd steps;             ///< heights of those that lanes for volume leave of faces [m]
  std::vector<JobStation> stations;
  bool can_leave_end = false;  ///< to a place beyond
  JobRecord record;
  std::optional<JobLog> log;
  bool is_whole = true;  ///< all of it is as the folder holds it
};

JobStep SiteJob::State::step_of(JobAction what, const std::string& reason) {
  JobStep step;
  step.id = record.last_step + 1;
  step.what = what;
  step.base = record.base;
  step.reason = reason;
  const JobStation& station = stations[record.station];
  if (what == JobAction::scan && station.is_across)
    step.swung = wrapped(frame_at(station).heading - record.base.heading);
  return step;
}

/// @param straight  the machine as it looks along the design
StepTask SiteJob::State::task_of(Work work, const DumpPlace& dump, const BasePose& straight) const {
  const bool finishing = work != Work::volume;
  const JobStation station = here();
  const JobFrame line = frame_at(station);
  const Eigen::Vector2d at = line.of({straight.x, straight.y});
  StepTask task{settings, map, ground.expected(), straight, dump, record.barren};
  task.lines = work_lines(line, station, settings.site.machine, at, finishing);
  task.may_risk = record.progress.stalls == 0;
  const bool passes_follow = station.leaves_passes && !station.is_wide;
  task.may_bite = !passes_follow && !is_dug_out(record.base);
  task.finishing = finishing;
  task.has_others_beside = station.has_others_beside;
  task.has_faces = frame.is_battered;
  task.has_steps = has_steps();
  task.tracks = line.tracks;
  task.leaves_floor = work == Work::faces;
  task.keeps_load = finishing && may_keep(0.0);
  task.allowance = finishing ? allowance_of_passes() : allowance * settings.design.tolerance;
  task.density_percent = settings.density_percent;
  task.strength_factor = record.learning.strength_factor();
  task.hard_factor = record.learning.hard_factor();
  task.deepest_cut = record.deepest_cut;
  task.carried = finishing && has_load() ? held() : 0.0;
  task.slack = 0.5 * settings.design.tolerance;
  return task;
}

/// Heights of the layers that a wide design is dug in from here, all but the lowest [m].
std::vector<double> SiteJob::State::benches_below() const {
  std::vector<double> benches;
  if (!stations[record.station].is_wide) return benches;
  double top = -std::numeric_limits<double>::infinity(), low = -top;
  for_each_in_reach(record.base, [&](Cell cell) {
    const double z = first.bank.z(cell.row, cell.col);
    if (!std::isnan(z)) top = std::max(top, z);
    low = std::min(low, map.target.z(cell.row, cell.col));
  });
  if (!(top > low)) return benches;
  const double height = has_steps() ? thin_bench : bench_height;
  const int count = static_cast<int>(std::round((top - low) / height));
  for (int i = 1; i < count; ++i) benches.push_back(top - (top - low) * i / count);
  return benches;
}

std::vector<WorkLine> SiteJob::State::lines_on(double bench, const BasePose& straight) const {
  const Machine& machine = settings.site.machine;
  const JobFrame line = frame_at(stations[record.station]);
  const JobStation station = on_bench(here(), line, across_below(map, line, bench), machine);
  return work_lines(line, station, machine, line.of({straight.x, straight.y}), false);
}

/// From the bench that was dug last, down to the design. What lies deeper can come with what only a
/// bite would take off a bench.
std::optional<StepDig> SiteJob::State::best_dig_of(StepTask& task,
                                                   const std::vector<double>& benches) {
  const int count = static_cast<int>(benches.size());
  const bool may_bite = std::exchange(task.may_bite, false);
  const auto over_floor = task.lines;
  for (int bench = std::min(record.bench, count); bench < count; ++bench) {
    task.bench = benches[static_cast<std::size_t>(bench)];
    task.lines = lines_on(*task.bench, task.base);
    record.bench = bench + 1;
    auto dig = best_dig(task);
    if (!dig) continue;
    record.bench = bench;
    return dig;
  }
  task.bench.reset();
  task.lines = over_floor;
  task.may_bite = may_bite;
  return best_dig(task);
}

/// From where the machine stands. @param load  share of a heaped bucket
std::optional<DumpPlace> SiteJob::State::dump_from(double load) const {
  const JobFrame line = frame_at(stations[record.station]);
  DumpRules rules = {0.0, true, load, wrapped(record.base.heading - line.heading)};
  if (side && !line.is_beside()) {
    const double here_is = side->line.of({record.base.x, record.base.y}).x();
    rules.off_line = beyond_later_soil(settings.site.machine, here_is - side->places.front().along);
  }
  return dump_place(settings, map, ground.expected(), ahead_of(record.base, line), rules);
}

/// What would be driven into something is laid aside for another dig from here, and so is what is
/// not to be trusted, if there is another one.
std::optional<JobStep> SiteJob::State::dig_step(Work work) {
  std::optional<JobStep> first_doubtful;
  JobRecord with_it;
  int doubtful = 0;
  for (int tries = 0; tries < most_blocked && doubtful < most_doubtful; ++tries) {
    auto step = best_step(work);
    if (!step) break;
    const bool is_blocked = !step->reason.empty();
    if (step->trustworthy && !is_blocked) {
      // What falls down from a lane is dug from the one below it.
      if (work == Work::faces && record.planned->payload_volume < least_again) lay_aside(*step);
      return step;
    }
    if (!is_blocked && doubtful++ == 0) {
      first_doubtful = step;
      with_it = record;
    }
    lay_aside(*step);
  }
  if (!first_doubtful) return first_doubtful;
  record = std::move(with_it);
  if (work == Work::faces) lay_aside(*first_doubtful);
  return first_doubtful;
}

std::optional<JobStep> SiteJob::State::best_step(Work work) {
  const bool finishing = work != Work::volume;
  auto dump = dump_from(finishing ? load_of_passes : 1.0);
  if (!dump) return std::nullopt;
  BasePose straight = ahead_of(record.base, frame_at(stations[record.station]));
  straight.z += record.learning.height_bias.mean;
  StepTask task = task_of(work, *dump, straight);
  const std::vector<double> benches = finishing ? std::vector<double>() : benches_below();
  auto dig = best_dig_of(task, benches);
  const int softest = finishing ? 0 : record.fruitless_digs > 0 ? softer_again : most_softer;
  for (int softer = 1; !dig && softer <= softest; ++softer) {
    task.hard_factor = task.strength_factor;
    task.strength_factor = record.learning.strength_factor(-softer);
    dig = best_dig(task);
  }
  if (!dig) return std::nullopt;
  const double load = held() + dig->dig.payload_volume;
  if (finishing && load > load_of_passes * heaped_capacity(settings.site.machine)) {
    if (const auto for_more = dump_from(1.0)) dump = for_more;
  }
  JobStep step = step_of(finishing ? JobAction::finish : JobAction::dig);
  step.swung = wrapped(straight.heading + dig->turned - record.base.heading);
  step.lane = dig->lane;
  step.path = std::move(dig->path);
  step.dump = dump->place;
  if (dump->in_truck) step.truck = record.trucks;
  step.carried = record.carried;
  step.dumps_first = has_load() && !finishing;
  const bool is_empty = held() + dig->dig.payload_volume < empty_bucket;
  step.keeps_load = task.keeps_load && may_keep(dig->dig.payload_volume) &&
                    (is_empty || can_hold_load(settings.site.soil, step.path));
  const DumpPlace beside = seen_from(*dump, dig->turned);
  foretell(step, beside, *dig);
  if (!check_motion(step) && step.keeps_load) {
    step.keeps_load = false;
    step.reason.clear();
    foretell(step, beside, *dig);
    (void)check_motion(step);
  }
  const auto more = dump_warnings(*dump);
  step.warnings.insert(step.warnings.end(), more.begin(), more.end());
  record.planned = dig->dig;
  record.signs = dig->signs;
  return step;
}

/// With all that the step does before and after the dig.
void SiteJob::State::foretell(JobStep& step, const DumpPlace& dump, StepDig& dig) const {
  const Machine machine = looking(settings.site.machine, step.swung);
  const double carried = step.carried ? loose_mass(settings.site.soil, step.carried->volume) : 0.0;
  const auto after = cycle_of(machine, step.path, dig.dig,
                              cycle_after(dump, step.keeps_load, step.dumps_first ? 0.0 : carried));
  if (after) {
    dig.dig.cycle_energy = after->total.energy;
    dig.dig.cycle_time = after->total.time;
  }
  step.predicted = record.learning.foretell(dig.dig, dig.signs);
  if (!step.dumps_first) return;
  const auto before =
      dump_of(machine, step.carried->joints.head<3>(), cycle_after(dump, false, carried));
  if (!before) return;
  for (double* energy : {&step.predicted.energy, &step.predicted.energy_interval[0],
                         &step.predicted.energy_interval[1]})
    *energy += before->energy;
  step.predicted.time += before->time;
  dig.dig.cycle_energy += before->energy;  // as will be reported
  dig.dig.cycle_time += before->time;
}

/// @return whether it can be trusted
bool SiteJob::State::check_motion(JobStep& step) {
  const StepMotion motion = checked_motion(settings, ground.expected(), step);
  step.warnings = motion.warnings;
  step.trustworthy = motion.is_trustworthy;
  if (!motion.blocked.empty()) step.reason = motion.blocked;
  record.rests_at = motion.rests_at;
  return step.trustworthy;
}

/// A dig at a wall that will not stand is not to be trusted.
JobStep SiteJob::State::with_walls_checked(JobStep step) const {
  const DigLine line = dig_line(step.base, step.swung, step.lane);
  std::vector<Eigen::Vector2d> dug;
  for (const DigPose& pose : step.path.poses) {
    if (pose.phase == DigPhase::lift) break;
    dug.push_back(line.place(pose.bucket.x, 0.0));
  }
  if (dug.empty()) return step;
  const double within = beside_wall + 0.5 * settings.site.machine.bucket.width_outside;
  if (const auto wall = weakest_wall(wall_task(), {dug.front(), dug.back()}, within)) {
    step.warnings.push_back(warning_of(*wall));
    step.trustworthy = false;
  }
  return step;
}

/// Whether another pass can follow before the bucket is dumped.
bool SiteJob::State::may_keep(double more) const {
  return !settings.design.truck &&
         held() + more <= most_carried * heaped_capacity(settings.site.machine) &&
         record.passes_here + 1 < most_passes_here();
}

/// What passes left in the bucket is dumped, and its last ones are seen.
std::optional<JobStep> SiteJob::State::dump_step() {
  if (!has_load()) return std::nullopt;
  const auto dump = dump_from(load_of_passes);
  if (!dump) return std::nullopt;
  JobStep step =
      step_of(JobAction::scan, "to dump what passes left in the bucket, and to see them");
  step.swung = wrapped(frame_at(stations[record.station]).heading - record.base.heading);
  step.carried = record.carried;
  step.dumps_first = true;
  step.dump = dump->place;
  (void)check_motion(step);
  return step;
}

JobStep SiteJob::State::move_step(const JobStation& station) {
  JobStep step = step_of(JobAction::move);
  step.base = base_of(station);
  step.warnings = standing_warnings(settings, ground.expected(), step.base);
  step.trustworthy = !any_ends_trust(step.warnings);
  return step;
}

BasePose SiteJob::State::base_of(const JobStation& station) const {
  return base_at(frame_at(station), station, ground.expected(), settings.site.machine);
}

/// The cells that count and are dug from there.
template <typename Visit>
void SiteJob::State::for_each_in_reach(const BasePose& base, Visit visit) const {
  const JobStation station = here();
  const JobFrame line = frame_at(station);
  const Eigen::Vector2d at = line.of({base.x, base.y});
  const WorkRange range = work_range(line, settings.site.machine, at.x(), station.is_wide);
  const double half = 0.5 * settings.site.machine.bucket.width_outside;
  for_each_cell(map.counts, [&](Cell cell) {
    if (!map.counts(cell.row, cell.col)) return;
    const Eigen::Vector2d place = line.of({map.target.x(cell.col), map.target.y(cell.row)}) - at;
    if (place.x() < range.near || place.x() > range.far) return;
    const double along = place.x() + at.x();
    if (along < station.shapes_from || along > station.shapes_to) return;
    if (place.y() < station.lanes.front() - at.y() - half) return;
    if (place.y() <= station.lanes.back() - at.y() + half) visit(cell);
  });
}

/// Whether too much of what is within reach lies above the design.
bool SiteJob::State::wants_passes(const BasePose& base) const {
  const double tolerance = settings.design.tolerance;
  int count = 0;
  int high = 0;
  int low = 0;
  int heaps = 0;
  for_each_in_reach(base, [&](Cell cell) {
    if (std::isnan(above_design(map, ground.expected(), cell))) return;
    const auto around = above_design_around(map, ground.expected(), cell);
    const double above =
        std::accumulate(around.begin(), around.end(), 0.0) / static_cast<double>(around.size());
    const double sure = above - ground.sd_at(cell);
    ++count;
    if (sure > high_share * tolerance) ++high;
    if (-above > tolerance) ++low;
    if (sure > heap_share * tolerance) ++heaps;
  });
  return high + low > most_off_shape * count || heaps > most_heaps * count;
}

/// Whether little of what is within reach still stands, but for the steps of a face that lanes for
/// volume leave.
bool SiteJob::State::is_dug_out(const BasePose& base) const {
  int count = 0;
  int high = 0;
  for_each_in_reach(base, [&](Cell cell) {
    ++count;
    const double most = undug * settings.design.tolerance + steps(cell.row, cell.col);
    if (above_design(map, ground.expected(), cell) > most) ++high;
  });
  return high <= most_undug * count;
}

/// How the ground lies that passes from here left.
void SiteJob::State::learn_floor() {
  if (record.passes_here == 0 || stations[record.station].is_lookout()) return;
  std::vector<double> above;
  for_each_in_reach(record.base, [&](Cell cell) {
    const double error = above_design(map, ground.expected(), cell);
    if (!std::isnan(error) && !std::isnan(ground.seen()(cell.row, cell.col)))
      above.push_back(error);
  });
  if (above.size() < least_of_floor) return;
  const double lies = median(above);
  if (lies > most_of_floor * settings.design.tolerance) return;  // it is not in shape
  record.learning.floor.learn(lies - allowance_of_passes(), floor_reading_sd * floor_reading_sd);
}

/// So that the middle of what they leave lies where it should.
double SiteJob::State::allowance_of_passes() const {
  const double tolerance = settings.design.tolerance;
  return std::clamp(middle * tolerance - record.learning.floor.mean, least_allowance * tolerance,
                    most_allowance * tolerance);
}

/// Its own digs may have brought the edge too near.
bool SiteJob::State::stands_well() const {
  const JobFrame line = frame_at(stations[record.station]);
  const Eigen::Vector2d at = line.of({record.base.x, record.base.y});
  return can_stand_now({settings, map, first, ground.expected()}, line, {at.x(), at.y()});
}

/// Whether passes from here are worth their while.
bool SiteJob::State::may_pass() const {
  const JobStation station = here();
  return !station.leaves_passes && record.passes_here < most_passes_here() &&
         record.fruitless < most_fruitless_here() && wants_passes(record.base) &&
         (!station.is_wide || is_dug_out(record.base));
}

JobStep SiteJob::State::decide() {
  if (!record.has_arrived) {
    const auto place = next_place(progress());
    return place ? move_step(*place) : leave();
  }
  if (record.scans_not_taken >= most_not_taken) {
    return step_of(JobAction::stop, "the ground cannot be seen: the last " +
                                        std::to_string(record.scans_not_taken) +
                                        " scans do not fit it where it did not change");
  }
  if (record.scans_not_taken > 0) {
    return step_of(JobAction::scan,
                   "the last scan does not fit the ground where that did not change");
  }
  if (record.wants_scan) return step_of(JobAction::scan, "to see the ground as it is");
  if (stations[record.station].is_lookout()) return leave();
  if (ground.unseen_digs() >= most_unseen) return step_of(JobAction::scan, "to see what was dug");
  const bool is_wide = stations[record.station].is_wide;
  if (is_wide && !has_load() && !stands_well()) return leave();
  if (has_steps() && ground.unseen_digs(JobAction::finish) >= most_unseen_passes_here())
    return step_of(JobAction::scan, "to see what is left");
  if (has_steps() && may_pass() && is_dug_out(record.base)) {
    if (auto step = dig_step(Work::faces)) return with_walls_checked(*std::move(step));
  }
  const bool leaves_floor = here().leaves_floor;
  const int most_in_vain = is_wide ? most_fruitless_wide : most_fruitless_digs;
  if (!leaves_floor && record.fruitless_digs < most_in_vain) {
    if (auto step = dig_step(Work::volume)) return with_walls_checked(*std::move(step));
  }
  const std::size_t passes = ground.unseen_digs(JobAction::finish);
  if (ground.unseen_digs() > passes || passes >= most_unseen_passes_here())
    return step_of(JobAction::scan, "to see what is left");
  if (!leaves_floor && may_pass()) {
    if (auto step = dig_step(Work::shape)) return with_walls_checked(*std::move(step));
  }
  if (auto step = dump_step()) return *std::move(step);
  if (passes > 0) return step_of(JobAction::scan, "to see what is left");
  return leave();
}

LookTask SiteJob::State::look_task(const JobProgress& now) const {
  LookTask task{frame, settings, map, ground.expected(), ground.seen(), record.looks, record.base};
  if (task.looks.empty()) task.looks = usual_looks();
  const auto from = stations.begin() + static_cast<std::ptrdiff_t>(record.station);
  const auto next = std::find_if_not(from, stations.end(), std::mem_fn(&JobStation::is_lookout));
  task.most = static_cast<std::size_t>(next - from);
  if (next != stations.end() && next->is_beyond && !is_shaped(now)) task.next = *next;
  task.may_stay = 1.0 - (task.next ? near_well_seen : well_seen);
  return task;
}

/// Where the present station is; nothing if there is nothing to do.
std::optional<JobStation> SiteJob::State::next_place(const JobProgress& now) const {
  const JobStation& station = stations[record.station];
  if ((station.is_beyond || station.is_again) && is_shaped(now)) return std::nullopt;
  if (station.is_lookout()) {
    return best_lookout(look_task(now));
  }
  const bool is_again = record.station > 0 && stations[record.station - 1].is_lookout();
  if ((is_again || station.is_again || station.is_beyond) && !wants_passes(base_of(station)))
    return std::nullopt;
  const Standing on = {settings, map, first, ground.expected()};
  if (station.is_wide) return nearest_place(on, frame_at(station), station);
  if (station.is_again && !can_stand_now(on, frame_at(station), station)) return std::nullopt;
  return not_too_far();
}

/// How far the machine still has to go along its row to the present place [m]; 0 if it does not
/// come from the one before, or if its soil has not proved hard.
double SiteJob::State::way_in_hard() const {
  if (record.station == 0 || record.progress.stalls < hard_from_stalls) return 0.0;
  const JobStation &from = stations[record.station - 1], &to = stations[record.station];
  if (!is_alone_in_row(from) || !is_alone_in_row(to)) return 0.0;
  const Eigen::Vector2d at = frame_at(to).of({record.base.x, record.base.y});
  const bool is_between = at.x() < from.along + as_good_as_there &&
                          at.x() > to.along + as_good_as_there &&
                          std::abs(at.y() - to.beside) < as_good_as_there;
  return is_between ? at.x() - to.along : 0.0;
}

/// The place of a row, or one before it in soil that has proved hard: far digs stall there, and
/// what they leave is beyond reach from the next place.
JobStation SiteJob::State::not_too_far() const {
  const JobStation& station = stations[record.station];
  const double way = way_in_hard();
  const double most = move_in_hard * dig_size(settings.site.machine);
  if (!(way > most + as_good_as_there)) return station;
  JobStation nearer = station;
  nearer.along += way * (1.0 - 1.0 / std::ceil(way / most));
  nearer = clear_of_obstacles({nearer}, frame, settings, map, first).front();
  if (!settings.design.obstacles.empty() && !stands_clear(nearer, frame, settings, map, first))
    return station;
  const bool goes_on = nearer.along < station.along + way - as_good_as_there;
  return goes_on && nearer.along > station.along ? nearer : station;
}

/// The present place of a row, if the machine went but a part of the way there.
std::optional<JobStation> SiteJob::State::rest_of_way() const {
  if (!(way_in_hard() > 0.0) || record.off_place > as_good_as_there) return std::nullopt;
  return not_too_far();
}

/// Another place for the present station, if its soil has no place any more.
std::optional<JobStation> SiteJob::State::place_to_dump_from() {
  const JobStation& station = stations[record.station];
  if (!record.has_arrived || !station.is_wide) return std::nullopt;
  if (dump_from(1.0)) return std::nullopt;
  if (record.moves_to_dump >= most_moves_to_dump) {
    record.lacks_dump = true;
    return std::nullopt;
  }
  const JobFrame line = frame_at(station);
  auto place = nearest_place({settings, map, first, ground.expected()}, line, station);
  if (!place) return place;
  const Eigen::Vector2d off =
      line.of({record.base.x, record.base.y}) - Eigen::Vector2d(place->along, place->beside);
  if (!(off.norm() > as_good_as_there)) return std::nullopt;
  ++record.moves_to_dump;
  record.is_sent_again = true;
  return place;
}

/// The present station once more, if the machine stands off it and leaves it undone.
std::optional<JobStation> SiteJob::State::missed_place(const JobProgress& now) const {
  const JobStation& station = stations[record.station];
  if (station.is_lookout() || record.is_sent_again) return std::nullopt;
  if (!(record.off_place > as_good_as_there)) return std::nullopt;
  const auto place = next_place(now);
  if (!place) return std::nullopt;
  const BasePose base = base_of(*place);
  const bool is_undone = station.leaves_passes ? !is_dug_out(base) : wants_passes(base);
  return is_undone ? place : std::nullopt;
}

/// Of digs from where the machine stood.
void SiteJob::State::forget_failures() {
  record.fruitless = 0;
  record.fruitless_digs = 0;
  record.barren.clear();
}

JobStep SiteJob::State::go_to(const JobStation& place) {
  record.passes_here = 0;
  record.bench = 0;
  forget_failures();
  record.wants_scan = place.is_lookout();
  return move_step(place);
}

/// To the next place from which there is something to do, or the end.
JobStep SiteJob::State::leave() {
  if (const auto place = place_to_dump_from()) {
    forget_failures();
    return move_step(*place);
  }
  const JobProgress now = progress();
  learn_floor();
  if (const auto place = missed_place(now)) {
    record.is_sent_again = true;
    return go_to(*place);
  }
  if (const auto place = rest_of_way()) return go_to(*place);
  const bool looked_in_vain = stations[record.station].is_lookout() &&
                              now.seen - record.seen_before_look < least_newly_seen;
  record.seen_before_look = now.seen;
  const bool needs_no_more = now.is_finished && is_shaped(now) && now.seen >= well_seen;
  while (!needs_no_more && record.station + 1 < stations.size()) {
    ++record.station;
    if (looked_in_vain && stations[record.station].is_lookout()) continue;
    const auto place = next_place(now);
    if (!place) continue;
    record.is_sent_again = false;
    record.moves_to_dump = 0;
    return go_to(*place);
  }
  if (has_load()) return step_of(JobAction::stop, "the soil in the bucket has no place");
  if (now.is_finished) return step_of(JobAction::stop, finished_reason);
  const std::string found = ": 95 % lie within " + readable(1e3 * now.p95, 2) + " mm, " +
                            readable(100.0 * now.beyond_twice, 2) +
                            " % beyond twice the tolerance, " + readable(100.0 * now.seen, 3) +
                            " % are seen";
  const std::string rest = std::string("what is left cannot be dug") +
                           (record.lacks_dump ? ", as its soil has no place within reach" : "");
  return step_of(JobAction::stop, (has_shape(now) ? "the rest cannot be seen" : rest) + found);
}

void SiteJob::State::take_scan(const StepReport& report) {
  const ScanNews news = ground.take_in(event_of(*report.scan, report.time, record.base));
  // Of the edge in one dig, and of what a scan's registration leaves (ours).
  constexpr double reading_sd = 0.012;
  if (news.cut_off) {
    LearntNumber& bias = record.learning.height_bias;
    bias.learn(bias.mean + *news.cut_off, reading_sd * reading_sd + news.cut_sd * news.cut_sd);
  }
  if (news.alignment) {
    record.learning.datum.learn(*news.alignment);
    hang_design();
  }
  record.scans_not_taken = news.taken ? 0 : record.scans_not_taken + 1;
  record.wants_scan = false;
  record.site_updates = ground.site().updates();
  ground.save(++record.grounds);
  ++record.progress.scans;
}

DigStart SiteJob::State::start_of(const JobStep& dig) const {
  const double view = frame_at(stations[record.station]).heading - dig.base.heading;
  return {dig.lane, dig.path.start_x, wrapped(dig.swung - view), dig.what == JobAction::finish};
}

/// Until the machine stands elsewhere.
void SiteJob::State::lay_aside(const JobStep& dig) { record.barren.push_back(start_of(dig)); }

/// The present step is not done: nor is its lane, if it was laid aside with it.
void SiteJob::State::drop_present() {
  if (record.present->digs() && !record.barren.empty()) {
    const DigStart start = start_of(*record.present), &last = record.barren.back();
    if (last.lane == start.lane && last.along == start.along && last.turned == start.turned)
      record.barren.pop_back();
  }
  close_present();
}

void SiteJob::State::close_present() {
  record.last_step = record.present->id;
  record.present.reset();
  record.planned.reset();
}

void SiteJob::State::end_dig(const JobStep& step, const StepReport& report) {
  record.learning.learn(*record.planned, record.signs, report);
  record.moves_to_dump = 0;
  JobProgress& progress = record.progress;
  const bool finishing = step.what == JobAction::finish;
  ++(finishing ? progress.finishing_passes : progress.digs);
  if (finishing) ++record.passes_here;
  const double lifted = report.payload_mass.value_or(step.predicted.payload_mass);
  const double least = std::max(least_taken * step.predicted.payload_mass, least_mass);
  int& fruitless = finishing ? record.fruitless : record.fruitless_digs;
  const bool is_fruitless = report.stalled || lifted < least;
  fruitless = is_fruitless ? fruitless + 1 : 0;
  // A single one may do with a new depth or strength.
  const bool is_again = finishing || stations[record.station].is_wide || fruitless > 1;
  if (is_fruitless && is_again) lay_aside(step);
  if (!finishing && lifted < poor_dig * step.predicted.payload_mass) record.wants_scan = true;
  progress.payload_mass += lifted;
  if (report.stalled) {
    ++progress.stalls;
    record.deepest_cut = std::max(shallowest_cut, after_stall * record.deepest_cut);
    record.wants_scan = true;
  }
  const double volume = report.payload_mass && record.planned->payload_mass > 0.0
                            ? lifted * record.planned->payload_volume / record.planned->payload_mass
                            : record.planned->payload_volume;
  const double before = held();
  record.carried.reset();
  if (step.keeps_load) record.carried = {before + std::max(0.0, volume), record.rests_at};
  if (step.truck) {
    record.truck_load += lifted;
    if (record.truck_load >= settings.design.truck->target_mass) {
      record.truck_load = 0.0;
      ++record.trucks;
    }
  }
  if (report.stalled && step.dumps_first) {
    JobStep dumped = step;
    dumped.what = JobAction::scan;
    ground.expect(dumped, record.learning.height_bias.mean);
  }
  if (!report.stalled) {
    record.deepest_cut = std::min(JobRecord{}.deepest_cut, after_success * record.deepest_cut);
    ground.expect(step, record.learning.height_bias.mean);
  }
}

void SiteJob::State::end_step(const StepReport& report) {
  const JobStep step = *record.present;
  if (step.dumps_first) record.carried.reset();
  if (step.digs()) {
    end_dig(step, report);
  } else {
    ground.expect(step, record.learning.height_bias.mean);
  }
  if (report.base) record.base = *report.base;
  if (step.what == JobAction::move) {
    if (!report.base) record.base = step.base;
    record.off_place = std::hypot(record.base.x - step.base.x, record.base.y - step.base.y);
    record.has_arrived = true;
    record.carried.reset();
    record.learning.move();
    ++record.progress.moves;
  }
  if (report.scan) {
    BasePose looking = record.base;
    looking.heading += step.what == JobAction::move ? 0.0 : step.swung;
    auto looks = looks_of(*report.scan, looking);
    if (!looks.empty()) record.looks = std::move(looks);
    take_scan(report);
  }
  close_present();
}

void SiteJob::State::save() {
  record.unseen = ground.unseen();
  save_record(folder, record);
}

void SiteJob::State::log_from(const GroundState& of_first) {
  const double volume = record.progress.design_volume;
  log.emplace(folder, history_start(settings.design, map.target, of_first, volume));
}

/// The log is never behind the record.
void SiteJob::State::save_changed(const JobRecord& before, const JobStep& step,
                                  const StepReport& report) {
  JobEvent event = timed(event_of(step, report), log->history());
  if (report.scan) {
    event.warnings.insert(event.warnings.end(), ground.warnings().begin(), ground.warnings().end());
  }
  event.left_volume = progress().left_volume;
  log->append(std::move(event), {ground.expected().surface(), ground.seen()}, record);
  save_earlier_record(folder, before);
  save();
}

/// The ground of the record.
void SiteJob::State::restore() {
  log->cut(record);
  ground.load(record.grounds, record.site_updates,
              {record.unseen, record.learning.height_bias.mean});
}

/// To what the folder holds. Where that cannot be read, or mended, nothing is done from then on.
void SiteJob::State::go_back() noexcept {
  is_whole = false;
  try {
    record = load_record(folder);
    hang_design();
    restore();
    is_whole = true;
  } catch (const std::exception&) {
    return;
  }
}

void SiteJob::State::require_whole() const {
  if (is_whole) return;
  throw Error(ErrorKind::bad_file,
              folder +
                  ": the last change failed, and what was there before cannot be restored: open "
                  "the job again once its folder can be written to");
}

/// That it can be of these settings.
void SiteJob::State::require_record() const {
  const auto& step = record.present;
  const bool is_dig_of_it = !step || !step->digs() || record.planned;
  const bool is_loaded = !step || !step->truck || settings.design.truck;
  require(record.station < stations.size() && is_dig_of_it && is_loaded,
          folder + ": its job is of another design, truck or machine than it is to go on with");
}

void SiteJob::State::begin(const Scan& scan, double time) {
  (void)ground.take_in(event_of(scan, time, *settings.design.start));
  first = ground.expected();
  save_ground(first_file(), ground.site().ground());
  look_at_design();
  record.base = base_at(frame, {}, first, settings.site.machine);
  record.site_updates = ground.site().updates();
  record.grounds = record.site_updates;
  ground.save(record.grounds);
  record.progress.design_volume = progress().left_volume;
  log_from(ground.site().ground());
  log->begin();
  save();
}

SiteJob::SiteJob(std::unique_ptr<State> state) : state_(std::move(state)) {}
SiteJob::~SiteJob() = default;
SiteJob::SiteJob(SiteJob&&) noexcept = default;
SiteJob& SiteJob::operator=(SiteJob&&) noexcept = default;

SiteJob SiteJob::begin(const std::string& folder, JobSettings settings, const Scan& first,
                       double time) {
  require_job_settings(settings);
  require(!holds_record(folder), folder +
                                     ": holds a job already: go on with it, or begin it in "
                                     "another folder");
  auto state = std::make_unique<State>(folder, std::move(settings));
  const bool is_new = state->ground.site().is_empty();
  try {
    state->begin(first, time);
  } catch (...) {
    if (is_new) state->ground.forget();
    throw;
  }
  return SiteJob(std::move(state));
}

SiteJob SiteJob::resume(const std::string& folder, JobSettings settings) {
  require_job_settings(settings);
  auto state = std::make_unique<State>(folder, std::move(settings));
  state->record = load_record(folder);
  const GroundState first = load_ground(state->first_file());
  state->first = first.terrain;
  state->look_at_design();
  state->require_record();
  state->log_from(first);
  state->hang_design();
  state->log->resume(state->record);
  state->restore();
  return SiteJob(std::move(state));
}

JobStep SiteJob::next() {
  State& state = *state_;
  state.require_whole();
  JobRecord& record = state.record;
  if (!record.present) {
    state.keep_whole([&] {
      record.present = state.decide();
      state.save();
    });
  }
  return *record.present;
}

std::optional<JobStep> SiteJob::present() const {
  state_->require_whole();
  return state_->record.present;
}

void SiteJob::done(long long step, const StepReport& report) {
  state_->require_whole();
  const std::optional<JobStep>& present = state_->record.present;
  if (!present || present->id != step || present->what == JobAction::stop) return;
  require_report(*present, report);
  require_plausible(*present, report, state_->settings.site.machine);
  const JobRecord before = state_->record;
  state_->keep_whole([&] {
    state_->end_step(report);
    state_->save_changed(before, *before.present, report);
  });
}

void SiteJob::look(const Scan& scan, double time) {
  State& state = *state_;
  JobRecord& record = state.record;
  const JobRecord before = record;
  StepReport report;
  report.scan = scan;
  report.time = time;
  state.keep_whole([&] {
    state.take_scan(report);
    if (record.present && record.present->what != JobAction::move) state.drop_present();
    JobStep unasked = state.step_of(JobAction::scan);
    unasked.id = 0;
    state.save_changed(before, unasked, report);
  });
}

void SiteJob::undo() {
  state_->keep_whole([&] {
    const JobRecord earlier = earlier_record(state_->folder);
    if (!state_->ground.can_load(earlier.grounds, earlier.site_updates))
      refuse_undo(state_->folder);
    go_to_earlier(state_->folder, earlier);
    state_->record = earlier;
    state_->hang_design();
    state_->restore();
  });
}

const std::vector<Warning>& SiteJob::scan_warnings() const { return state_->ground.warnings(); }

std::vector<Warning> SiteJob::wall_warnings() const {
  WallTask task = state_->wall_task();
  task.base.reset();
  const auto wall = weakest_wall(task);
  return wall ? std::vector<Warning>{warning_of(*wall)} : std::vector<Warning>();
}

std::vector<Warning> SiteJob::design_warnings() const {
  const JobSettings& settings = state_->settings;
  return excavplan::design_warnings(settings.design, settings.surface, state_->first.bank,
                                    settings.site.machine);
}

JobProgress SiteJob::progress() const { return state_->progress(); }

const JobHistory& SiteJob::history() const { return state_->log->history(); }

const Terrain& SiteJob::ground() const { return state_->ground.expected(); }

}  // namespace excavplan
