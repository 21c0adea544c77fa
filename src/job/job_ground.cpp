// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/job_ground.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "job/step_search.hpp"
#include "scans/noisy_scan.hpp"
#include "simulation/across_tracks.hpp"
#include "site/site_survey.hpp"

namespace excavplan {
namespace {

// Numbers of our own choice.
constexpr std::size_t least_cells = 40;  // of a cut that tells its height
constexpr double least_cut = 0.01;       // of a cell that was cut [m]
constexpr double steeper = 0.98;         // than the angle of repose by its tangent
constexpr double most_off = 0.1;         // more is no error of tracking [m]
constexpr double usual_range = 5.0;      // of a scan's points [m]
constexpr double noisy = 0.5;            // of what they share, over the tolerance
constexpr double changed = 0.003;        // by a dig [m]
constexpr double dug_sd = 0.012;         // of what a bucket leaves [m]
constexpr double risen_share = 0.5;      // likewise of what rose, over its height
constexpr double softer = 0.5;           // than the soil before, the next that is tried
constexpr double softest = 0.05;         // over the soil as told

/// Of all that was cut, with the soil that lies on it again. @param scanned  NaN where not seen
std::optional<double> cut_above(const Terrain& expected, const Terrain& before,
                                const Terrain& scanned) {
  if (before.loose.size() == 0 || !same_grid(scanned.bank, expected.bank)) return std::nullopt;
  if (!same_grid(before.bank, expected.bank)) return std::nullopt;
  std::vector<double> off;
  for_each_cell(expected.bank.z, [&](Cell at) {
    const double bank = expected.bank.z(at.row, at.col);
    if (!(before.bank.z(at.row, at.col) - bank > least_cut)) return;
    const double surface = scanned.bank.z(at.row, at.col) + scanned.loose(at.row, at.col);
    const double above = surface - bank - expected.loose(at.row, at.col);
    if (std::abs(above) < most_off) off.push_back(above);
  });
  if (off.size() < least_cells) return std::nullopt;
  return median(off);
}

/// Loose soil lies no steeper than it can: what a scan shows as steeper, beside walls whose points
/// fall on both levels and where noise stands for relief, is held as if it were undisturbed, or all
/// of it would slide in the next simulated dig.
void hold_steep(const SoilKind& soil, Terrain& ground) {
  const double step = steeper * std::tan(soil.angle_of_repose) * ground.bank.cell_size;
  const Eigen::ArrayXXd top = ground.bank.z + ground.loose;
  for_each_cell(top, [&](Cell at) {
    if (!(ground.loose(at.row, at.col) > 0.0)) return;
    bool is_steep = false;
    for_each_neighbour(top, at, [&](Cell next) {
      is_steep |= top(at.row, at.col) - top(next.row, next.col) > step;
    });
    if (!is_steep) return;
    ground.bank.z(at.row, at.col) += ground.loose(at.row, at.col);
    ground.loose(at.row, at.col) = 0.0;
  });
}

/// Where a scan did not see what was dug, it is as foretold, and not seen since.
void keep_unseen(const Terrain& expected, const Eigen::ArrayXXd& seen, double time,
                 GroundState& scanned) {
  Terrain& terrain = scanned.terrain;
  for_each_cell(seen, [&](Cell at) {
    if (scanned.seen(at.row, at.col) >= time) return;
    scanned.seen(at.row, at.col) = seen(at.row, at.col);
    terrain.bank.z(at.row, at.col) = expected.bank.z(at.row, at.col);
    terrain.loose(at.row, at.col) = expected.loose(at.row, at.col);
    if (terrain.loose_void_ratio.size() == 0 || expected.loose_void_ratio.size() == 0) return;
    terrain.loose_void_ratio(at.row, at.col) = expected.loose_void_ratio(at.row, at.col);
  });
}

/// What lies between returns is known, and not seen.
void keep_between(const Mask& returns, const Eigen::ArrayXXd& seen, double time,
                  GroundState& scanned) {
  for_each_cell(returns, [&](Cell at) {
    double& when = scanned.seen(at.row, at.col);
    if (when >= time && !returns(at.row, at.col)) when = seen(at.row, at.col);
  });
}

/// What a dig changes is not seen.
void forget_changed(const Terrain& before, const TerrainPatch& patch, Eigen::ArrayXXd& seen) {
  for_each_cell(patch.bank, [&](Cell at) {
    const Cell cell = {at.row + patch.row, at.col + patch.col};
    const double change = patch.bank(at.row, at.col) + patch.loose(at.row, at.col) -
                          before.bank.z(cell.row, cell.col) - before.loose(cell.row, cell.col);
    if (std::abs(change) > least_cut) seen(cell.row, cell.col) = std::nan("");
  });
}

}  // namespace

DigResult whole_dig(const JobSettings& settings, const Terrain& ground, const DigLine& line,
                    const DigPath& path, double swung) {
  const Machine machine = looking(settings.site.machine, swung);
  const SoilVoids voids = soil_voids(settings.site.soil, settings.density_percent);
  for (double strength = 1.0;; strength *= softer) {
    const HeightMapSimulator simulator(machine, with_strength(settings.site.soil, strength),
                                       settings.density_percent);
    DigResult dig = dig_along(simulator, machine, ground, {line, voids, path});
    if (!dig.stall || strength < softest) return dig;
  }
}

JobGround::JobGround(const std::string& folder, const JobSettings& settings, SiteAccess access)
    : folder_(folder), settings_(settings), access_(access), site_(folder, settings.site, access) {}

void JobGround::expect(const JobStep& step, double height_bias) {
  if (!step.moves_front()) return;
  const Eigen::ArrayXXd before = expected_.bank.z + expected_.loose;
  if (step.dumps_first) heap(step, step.carried->volume);
  if (step.digs()) dig(step, height_bias);
  doubt_changed(before);
  unseen_.push_back(step);
}

/// What was foretold is not as sure as what is seen.
void JobGround::doubt_changed(const Eigen::ArrayXXd& before) {
  for_each_cell(before, [&](Cell at) {
    const double rise =
        expected_.bank.z(at.row, at.col) + expected_.loose(at.row, at.col) - before(at.row, at.col);
    if (!(std::abs(rise) > changed)) return;
    sd_(at.row, at.col) =
        std::fmax(sd_(at.row, at.col), dug_sd + risen_share * std::max(0.0, rise));
  });
}

void JobGround::dig(const JobStep& step, double height_bias) {
  DigLine line = dig_line(step.base, step.swung, step.lane);
  line.z += height_bias;
  const DigResult result = whole_dig(settings_, expected_, line, step.path, step.swung);
  forget_changed(expected_, result.patch, seen_);
  apply(result.patch, expected_);
  const bool carries = step.carried && !step.dumps_first;
  if (!step.keeps_load) heap(step, result.payload_volume + (carries ? step.carried->volume : 0.0));
}

void JobGround::heap(const JobStep& step, double volume) {
  if (step.truck) return;
  heap_soil(expected_, settings_.site.soil, settings_.density_percent, step.dump.head<2>(), volume);
}

std::size_t JobGround::unseen_digs(std::optional<JobAction> kind) const {
  return static_cast<std::size_t>(std::count_if(
      unseen_.begin(), unseen_.end(),
      [&](const JobStep& each) { return each.digs() && (!kind || each.what == *kind); }));
}

bool JobGround::is_noisy() const {
  const auto& sensor = settings_.design.sensor;
  return sensor && sensor->shared * std::pow(usual_range, sensor->range_power) >
                       noisy * settings_.design.tolerance;
}

double JobGround::sd_at(Cell at) const {
  const double sd = is_noisy() ? sd_(at.row, at.col) : 0.0;
  return std::isnan(sd) ? 0.0 : sd;
}

ScanNews JobGround::take_in(const SiteEvent& scanned) {
  SiteEvent event = scanned;
  const double shared = is_noisy() ? shared_height_sd(event.scan, *settings_.design.sensor) : 0.0;
  event.options.change.sensor_pattern_sd = shared;
  // A process that was killed left it.
  const bool is_known = scanned_.seen.size() == 0 && site_.was_last(event.scan);
  SiteUpdate update;
  update.taken = is_known;
  if (!is_known) update = site_.update(event);
  if (shared > 0.0 && scanned_.seen.size() > 0) return take_in_noisy(event, update);
  const Terrain expected = std::move(expected_);
  const GroundState before = std::move(scanned_);
  const bool is_first = before.seen.size() == 0;
  warnings_ = update.warnings;
  const HeightMap& cells = before.terrain.bank;
  const bool has_grown = !is_first && !same_grid(cells, site_.ground().terrain.bank);
  scanned_ = has_grown ? site_.ground_for({}, cells.extent(), cells.cell_size) : site_.ground();
  scanned_.terrain.doubts.clear();
  if (is_first) scanned_.deviation.setConstant(std::nan(""));
  Terrain alone = scanned_.terrain;
  alone.bank.z = (scanned_.seen >= event.time).select(alone.bank.z, std::nan(""));
  if (!is_first) {
    keep_unseen(expected, seen_, event.time, scanned_);
    keep_between(returns_in(event.scan, scanned_.terrain.bank), seen_, event.time, scanned_);
  }
  hold_steep(settings_.site.soil, scanned_.terrain);
  begin_at_scan();
  if (!update.taken) return {};
  return {cut_above(expected, before.terrain, alone), 0.0, update.alignment, true};
}

/// The site takes what changed little for noise, and the mean of many scans hardly follows it: what
/// was foretold is corrected by each scan instead.
ScanNews JobGround::take_in_noisy(const SiteEvent& event, const SiteUpdate& update) {
  warnings_ = update.warnings;
  scanned_.seen = seen_;
  scanned_.deviation = sd_;
  const Terrain before = std::exchange(scanned_.terrain, expected_);
  ScanNews news;
  if (update.taken) {
    Scan scan = event.scan;
    scan.site_from_scan = update.correction * scan.site_from_scan;
    const ScanHeights heights = heights_of(scan, *settings_.design.sensor, expected_.bank);
    Terrain alone = expected_;
    alone.bank.z = heights.z - expected_.loose;
    news = {cut_above(expected_, before, alone), event.options.change.sensor_pattern_sd,
            update.alignment, true};
    fuse(heights, scanned_.terrain, scanned_.deviation);
    scanned_.seen = heights.z.isNaN().select(scanned_.seen, event.time).eval();
  }
  hold_steep(settings_.site.soil, scanned_.terrain);
  begin_at_scan();
  return news;
}

void JobGround::begin_at_scan() {
  expected_ = scanned_.terrain;
  seen_ = scanned_.seen;
  sd_ = scanned_.deviation;
  unseen_.clear();
}

std::string JobGround::file_of(long long number) const {
  return folder_ + "/job-ground-" + std::to_string(number) + ".tif";
}

void JobGround::save(long long number) const {
  save_ground(file_of(number), scanned_);
  std::error_code none;
  std::filesystem::remove(file_of(number - 2), none);
}

bool JobGround::can_load(long long number, long long updates) const {
  const bool is_behind = site_.updates() == updates + 1 && site_.can_undo();
  return (site_.updates() == updates || is_behind) && std::filesystem::exists(file_of(number));
}

void JobGround::forget() noexcept {
  try {
    if (!site_.is_empty()) site_.undo();
  } catch (const std::exception&) {  // what is told is why the job does not begin
    return;
  }
}

void JobGround::load(long long number, long long updates, const UnseenDigs& since) {
  const bool is_reader = access_ == SiteAccess::read;
  if (site_.updates() == updates + 1 && !is_reader) site_.undo();
  const bool is_one_ahead = is_reader && site_.updates() == updates + 1;
  if (site_.updates() != updates && !is_one_ahead) {
    throw Error(ErrorKind::bad_file, folder_ + ": its site has taken in " +
                                         std::to_string(site_.updates()) + " scans, its job " +
                                         std::to_string(updates) +
                                         ": files of it are missing, or of another job");
  }
  scanned_ = load_ground(file_of(number));
  begin_at_scan();
  for (const JobStep& step : since.steps) expect(step, since.height_bias);
}

}  // namespace excavplan
