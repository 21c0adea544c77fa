// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/true_site.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <excavplan/base/error.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/simulation/dig_along.hpp>
#include <excavplan/trial/job_score.hpp>
#include <excavplan/trial/site_scan.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/random.hpp"
#include "base/text.hpp"
#include "ground/grid_cells.hpp"
#include "simulation/across_tracks.hpp"
#include "trial/dump_places.hpp"
#include "trial/plan_polygon.hpp"
#include "trial/seen_first.hpp"
#include "trial/tracked_path.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Vector2d;

// Numbers of our own choice [m].
constexpr double spare_reach = 0.3;    // for what a move landed off
constexpr double least_noise = 1e-12;  // of a sensor: no scan has the very points of another

// Streams of a step.
constexpr std::uint64_t tracking_stream = 1;
constexpr std::uint64_t scale_stream = 2;
constexpr std::uint64_t landing_stream = 3;
constexpr std::uint64_t scan_stream = 4;

/// The poses that the machine came to.
DigPath driven(const DigPath& path, const DigResult& dig) {
  DigPath part = path;
  if (!dig.stall) return part;
  const std::size_t poses = std::max<std::size_t>(2, dig.torques.size() + 1);
  if (poses < part.poses.size()) part.poses.resize(poses);
  return part;
}

/// Takes what a pose is known to be to where it is.
struct PoseError {
  BasePose known, real;

  Vector2d moved(const Vector2d& place) const {
    const double turn = real.heading - known.heading;
    const Vector2d off = place - Vector2d(known.x, known.y);
    return {real.x + std::cos(turn) * off.x() - std::sin(turn) * off.y(),
            real.y + std::sin(turn) * off.x() + std::cos(turn) * off.y()};
  }
};

/// Dry mass of the layers of a ground above any level, up to a constant [kg].
struct Solids {
  Solids(const Terrain& ground, const SoilKind& soil) : ground_(ground), soil_(soil) {}
  /// Of the bank that an earlier state had more, with its void ratios.
  double cut_since(const ArrayXXd& bank, const ArrayXXd& void_ratio) const {
    const ArrayXXd solids = (bank - ground_.bank.z) / (1.0 + void_ratio);
    return per_height() * solids.isNaN().select(0.0, solids).sum();
  }
  double lying_since(const ArrayXXd& loose) const {
    return per_height() * (ground_.loose - loose).sum() / (1.0 + soil_.void_ratio_loose);
  }

 private:
  double per_height() const {
    const double cell = ground_.bank.cell_size;
    return cell * cell * soil_.specific_gravity * water_density;
  }
  const Terrain& ground_;
  const SoilKind& soil_;
};

/// Time and energy of a dig and all that follows it until the next.
CycleShare cycle_cost(const Machine& machine, const DigPath& path, const DigResult& dig,
                      const CycleOptions& options) {
  PlannedDig planned;
  planned.payload_mass = dig.payload_mass;
  planned.payload_volume = dig.payload_volume;
  planned.energy = dig.energy.total;
  planned.duration = time_dig_path(machine, driven(path, dig), {}, dig.torques).dig_duration();
  const auto cycle = cycle_of(machine, path, planned, options);
  return cycle ? cycle->total : CycleShare{planned.energy, planned.duration};
}

}  // namespace

struct TrueSite::State {
  State(const HiddenSite& of, Machine digger, TruthOptions how)
      : site(of), machine(std::move(digger)), options(std::move(how)), ground(of.ground) {
    density = mean_density(site);
    const Machine beside = looking(machine, 0.5 * pi);
    simulator = options.simulator.make(machine, site.soil, density);
    simulator_beside = options.simulator.make(beside, site.soil, density);
    seen_at = seen_at_first(site, trial_begin);
    const HeightMap surface = ground.surface();
    seen_height = seen_at.isNaN().select(seen_at, surface.z);
    real = *site.known.job.start;
    real.z = height_under(real);
    known = real;
  }

  /// Of the ground under the tracks.
  double height_under(const BasePose& base) const {
    const double half = 0.5 * machine.undercarriage_width(), front = machine.track_front;
    const HeightMap surface = ground.surface();
    double sum = 0.0;
    int count = 0;
    constexpr int places = 9;
    for (int i = 0; i < places; ++i) {
      for (int k = 0; k < places; ++k) {
        const double along = front * (2.0 * i / (places - 1) - 1.0);
        const double left = half * (2.0 * k / (places - 1) - 1.0);
        const double c = std::cos(base.heading), s = std::sin(base.heading);
        const double z =
            height_at(surface, base.x + c * along - s * left, base.y + s * along + c * left);
        if (std::isnan(z)) continue;
        sum += z;
        ++count;
      }
    }
    require(count > 0, "the machine stands beside the ground of the site");
    return sum / count;
  }

  Random random(std::uint64_t stream) const { return Random(options.seed, stream, step); }

  /// Marks all cells of a square as seen.
  void see(const HeightMap& surface, double x, double y, double half) {
    const auto first = cell_at(surface, x - half, y - half);
    const auto last = cell_at(surface, x + half, y + half);
    if (!first || !last) return;
    const auto rows = last->row - first->row + 1, cols = last->col - first->col + 1;
    seen_height.block(first->row, first->col, rows, cols) =
        surface.z.block(first->row, first->col, rows, cols);
    seen_at.block(first->row, first->col, rows, cols).setConstant(time);
  }

  void require_reach(const JobStep& job, const Vector2d& at) const {
    const double away = std::hypot(at.x() - real.x, at.y() - real.y);
    const double reach = pin_reach(machine, job.dump.z() - real.z);
    require(away <= reach + spare_reach, "distance of its dump from the swing axis [m]", away,
            "at most " + readable(reach) + " at that height");
  }

  double as_the_scale_reads(double mass) const {
    return mass * (1.0 + site.errors.payload_scale) *
           (1.0 + site.errors.payload_noise * random(scale_stream).normal());
  }
  TrueStep dig(const JobStep& job);
  CycleShare dump_first(const JobStep& job);
  CycleOptions cycle_after(const JobStep& job, double from, const Vector2d& dump) const;
  void fill(const DigResult& dig, const Vector2d& end);
  void dump(const JobStep& job, const Vector2d& at);
  /// Dry mass of so much loose soil [kg].
  double solids_of(double volume) const {
    return volume * site.soil.specific_gravity * water_density / (1.0 + site.soil.void_ratio_loose);
  }
  TrueStep move(const JobStep& job);
  TrueStep dump_and_scan(const JobStep& job) {
    const CycleShare first = dump_first(job);
    TrueStep done;
    done.time = first.time;
    done.energy = first.energy;
    if (job.dumps_first) done.report.joint_work = first.energy;
    take_scan(done, job.swung);
    return done;
  }
  DigResult dug_along(const DigLine& line, const DigPath& path, double swung) const {
    return dig_along(is_across(swung) ? *simulator_beside : *simulator, looking(machine, swung),
                     ground, {line, soil_voids(site.soil, density), path});
  }
  /// @param swung  of the upper structure from the tracks, as it looks ahead [rad]
  Scan scan(double swung = 0.0);
  void take_scan(TrueStep& done, double swung) {
    done.report.scan = scan(swung);
    done.scan_time = options.scan_time;
    done.time += options.scan_time;
  }

  HiddenSite site;
  Machine machine;
  TruthOptions options;
  Terrain ground;
  double density = 0.0;
  std::unique_ptr<const SoilSimulator> simulator;
  std::unique_ptr<const SoilSimulator> simulator_beside;  ///< of digs across the tracks
  BasePose known, real;
  double time = trial_begin;
  std::uint64_t step = 0;   ///< steps done
  std::uint64_t scans = 0;  ///< made
  SolidsLedger solids;
  double held = 0.0;     ///< loose, by the bucket [m^3]
  ArrayXXd seen_at;      ///< when a cell was last seen [s]; NaN: never
  ArrayXXd seen_height;  ///< of the true surface when a cell was last seen; NaN: never [m]
};

/// What the bucket holds before the step.
CycleShare TrueSite::State::dump_first(const JobStep& job) {
  if (!job.dumps_first) return {};
  require(job.carried.has_value(), "it dumps first, and does not say from where");
  const Vector2d at = PoseError{known, real}.moved(job.dump.head<2>());
  require_reach(job, at);
  const FrontJoints& from = job.carried->joints;
  CycleOptions cycle = cycle_after(job, real.heading + from[3], at);
  cycle.carried = loose_mass(site.soil, held);
  cycle.keeps_load = false;
  const auto cost = dump_of(machine, from.head<3>(), cycle);
  const Solids after(ground, site.soil);
  const ArrayXXd loose = ground.loose;
  dump(job, at);
  solids.lying += after.lying_since(loose);
  solids.held = solids_of(held);
  return cost.value_or(CycleShare{});
}

TrueStep TrueSite::State::dig(const JobStep& job) {
  require(job.path.poses.size() >= 2, "its path has fewer than two poses");
  const CycleShare first = dump_first(job);
  Random tracking = random(tracking_stream);
  const double aside = site.errors.side_sd * tracking.normal();
  std::vector<double> shift = height_errors(job.path, site.errors, tracking);
  for (double& z : shift) z += job.base.z - real.z;
  const PoseError error = {known, real};
  DigLine line = dig_line(job.base, job.swung, job.lane);
  line.heading += real.heading - known.heading;
  line.origin =
      error.moved(line.origin) + aside * Vector2d(-std::sin(line.heading), std::cos(line.heading));
  line.z = real.z;
  const HeightMap surface = ground.surface();
  const DigPath path = tracked_path(machine, job.path, shift, [&](double x) {
    const Vector2d at = line.place(x, 0.0);
    return height_at(surface, at.x(), at.y()) - line.z;
  });
  const Terrain before = ground;
  const DigResult dug = dug_along(line, path, job.swung);
  apply(dug.patch, ground);
  const Vector2d dump_at = error.moved(job.dump.head<2>());
  const double carried = held;
  fill(dug, line.place(path.poses.back().bucket.x, 0.0));
  if (!job.keeps_load) {
    require_reach(job, dump_at);
    dump(job, dump_at);
  }
  const Solids after(ground, site.soil);
  solids.cut += after.cut_since(before.bank.z, before.bank_void_ratio);
  solids.lying += after.lying_since(before.loose);
  solids.held = solids_of(held);
  if (site.density.gradient != 0.0) set_void_ratios(site.density, site.soil, ground);

  const double from = line.heading + std::atan2(job.lane, path.poses.back().bucket.x);
  CycleOptions after_dig = cycle_after(job, from, dump_at);
  after_dig.carried = loose_mass(site.soil, carried);
  const CycleShare cost = cycle_cost(machine, path, dug, after_dig);
  TrueStep done;
  done.time = first.time + cost.time;
  done.energy = first.energy + cost.energy;
  done.payload_mass = dug.payload_mass;
  done.stall = dug.stall;
  done.report.stalled = dug.stall.has_value();
  done.report.joint_work = done.energy;
  done.report.payload_mass = as_the_scale_reads(dug.payload_mass);
  if (options.scans_each_dig) take_scan(done, job.swung);
  return done;
}

/// @param from  heading in which the dig ends [rad]
CycleOptions TrueSite::State::cycle_after(const JobStep& job, double from,
                                          const Vector2d& dump) const {
  CycleOptions cycle;
  cycle.swing = wrapped(std::atan2(dump.y() - real.y, dump.x() - real.x) - from);
  cycle.dump_height = std::max(0.0, job.dump.z() - real.z);
  cycle.keeps_load = job.keeps_load;
  return cycle;
}

/// What was dug comes on top of what the bucket holds.
void TrueSite::State::fill(const DigResult& dig, const Vector2d& end) {
  held += dig.payload_volume;
  const double over = held - heaped_capacity(machine);
  if (!(over > 0.0)) return;
  heap_soil(ground, site.soil, density, end, over);
  held -= over;
}

void TrueSite::State::dump(const JobStep& job, const Vector2d& at) {
  const double volume = std::exchange(held, 0.0);
  if (!(volume > 0.0)) return;
  const auto& truck = site.known.job.truck;
  if (job.truck && truck && is_inside(truck->bed, at)) {
    solids.hauled += solids_of(volume);
    return;
  }
  heap_soil(ground, site.soil, density, at, volume);
}

TrueStep TrueSite::State::move(const JobStep& job) {
  const HiddenErrors& errors = site.errors;
  Random landing = random(landing_stream);
  const BasePose from = real;
  real = job.base;
  real.x += errors.landing_sd * landing.normal();
  real.y += errors.landing_sd * landing.normal();
  real.heading += errors.landing_turn_sd * landing.normal();
  real.z = height_under(real);
  known = real;
  known.x += errors.pose_sd * landing.normal();
  known.y += errors.pose_sd * landing.normal();
  known.heading += errors.pose_turn_sd * landing.normal();
  const double way = std::hypot(real.x - from.x, real.y - from.y);
  TrueStep done;
  done.time = options.move.time + options.move.time_per_metre * way;
  done.energy = options.move.energy + options.move.energy_per_metre * way;
  done.report.base = known;
  return done;
}

Scan TrueSite::State::scan(double swung) {
  BasePose looking_there = real;
  looking_there.heading = wrapped(real.heading + swung);
  const std::uint64_t seed = Random(options.seed, scan_stream, scans++).bits();
  const HeightMap surface = ground.surface();
  SiteSensor sensor = site.known.sensor;
  sensor.noise = std::max(sensor.noise, least_noise);
  Scan scan =
      scan_site(with_obstacles(surface, site.known.job.obstacles), sensor, looking_there, seed);
  scan.name = "scan " + std::to_string(scans);
  const HeightMap& cells = site.first_scan;
  for (const auto& cloud : scan.clouds) {
    for (const Eigen::Vector3d& point : cloud->points) {
      const auto cell = cell_at(cells, point.x(), point.y());
      if (cell) see(surface, cells.x(cell->col), cells.y(cell->row), 0.499 * cells.cell_size);
    }
  }
  return scan;
}

TrueSite::TrueSite(const HiddenSite& site, const Machine& machine, const TruthOptions& options)
    : state_(std::make_unique<State>(site, machine, options)) {}
TrueSite::~TrueSite() = default;
TrueSite::TrueSite(TrueSite&&) noexcept = default;
TrueSite& TrueSite::operator=(TrueSite&&) noexcept = default;

TrueStep TrueSite::execute(const JobStep& step) {
  ++state_->step;
  TrueStep done;
  try {
    switch (step.what) {
      case JobAction::dig:
      case JobAction::finish:
        done = state_->dig(step);
        break;
      case JobAction::move:
        done = state_->move(step);
        break;
      case JobAction::scan:
        done = state_->dump_and_scan(step);
        break;
      case JobAction::wait:
        done.time = state_->options.wait_time;
        break;
      case JobAction::stop:
        break;
    }
  } catch (const Error& error) {
    throw Error(error.kind(),
                "step " + std::to_string(step.id) + " (" + name(step.what) + "): " + error.what());
  }
  state_->time += done.time;
  done.report.time = state_->time;
  return done;
}

Scan TrueSite::scan() { return state_->scan(); }
const Terrain& TrueSite::ground() const { return state_->ground; }
const BasePose& TrueSite::known_base() const { return state_->known; }
const BasePose& TrueSite::true_base() const { return state_->real; }
double TrueSite::time() const { return state_->time; }
const SolidsLedger& TrueSite::solids() const { return state_->solids; }

const ArrayXXd& TrueSite::seen_at() const { return state_->seen_at; }

double TrueSite::seen_share(const HeightMap& area) const {
  const double tolerance = state_->site.known.job.tolerance;
  const HeightMap surface = state_->ground.surface();
  const auto all = (!area.z.isNaN()).count();
  const auto seen =
      (!area.z.isNaN() && (surface.z - state_->seen_height).abs() <= tolerance).count();
  return all > 0 ? static_cast<double>(seen) / static_cast<double>(all) : 0.0;
}

}  // namespace excavplan
