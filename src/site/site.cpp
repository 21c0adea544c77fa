// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/site/site.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "site/scan_digest.hpp"
#include "site/site_evidence.hpp"
#include "site/site_grid.hpp"
#include "site/site_manifest.hpp"
#include "site/site_store.hpp"
#include "site/site_survey.hpp"

namespace excavplan {
namespace {

void require_same(const std::string& folder, const char* what, const std::string& of_site,
                  const std::string& told) {
  if (told.empty() || told == of_site) return;
  refuse(folder + ": the site is of " + what + ' ' + in_quotes(of_site) + ", not " +
         in_quotes(told) + ": begin another site for it");
}

/// @throws Error (bad_input) unless the site is of these settings
void require_settings(const std::string& folder, const SiteManifest& site,
                      const SiteSettings& settings) {
  require_same(folder, "soil", site.soil, settings.soil.name);
  require_same(folder, "machine", site.machine, settings.machine.name);
  require_same(folder, "law", site.law, settings.law.name);
  require_same(folder, "frame", site.frame, settings.frame);
  const double cell = settings.cell_size.value_or(site.cell_size);
  require(cell == site.cell_size, folder + ": the cells of the site are of " +
                                      number_text(site.cell_size) + " m, not " + number_text(cell) +
                                      " m");
}

SiteManifest new_manifest(const SiteSettings& settings) {
  SiteManifest manifest;
  manifest.soil = settings.soil.name;
  manifest.machine = settings.machine.name;
  manifest.law = settings.law.name;
  manifest.frame = settings.frame;
  manifest.cell_size = settings.cell_size.value_or(usual_cell(settings.machine));
  require_simulated_cell(manifest.cell_size);
  return manifest;
}

/// The heights of cells that were seen for the first time are those that they have now.
void add_first_heights(const GroundState& now, const SiteSettings& settings, GroundState& first) {
  if (!same_grid(first.terrain.bank, now.terrain.bank)) {
    first = grown(first, now.terrain.bank.extent(), settings.soil.void_ratio_loose);
  }
  const Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> is_new = first.terrain.bank.z.isNaN();
  if (!is_new.any()) return;
  first.terrain.bank.z = is_new.select(now.terrain.bank.z, first.terrain.bank.z).eval();
  first.terrain.loose = is_new.select(now.terrain.loose, first.terrain.loose).eval();
}

/// That is believed of soil; nothing of none.
std::optional<RelativeDensity> believed(const DensityBelief& belief,
                                        const std::vector<BankPart>& bank) {
  if (bank.empty()) return std::nullopt;
  const BelievedMeans means = belief.means_of({condensed(bank)});
  RelativeDensity density;
  density.raw_percent = means.raw_percent(0);
  density.percent = std::clamp(density.raw_percent, 0.0, 100.0);
  set_error(density, std::sqrt(means.covariance(0, 0)));
  return density;
}

/// The soil that a path was to cut in which a dig stalled: what held it is not seen.
std::vector<BankPart> bank_that_held(const SiteEvent& event, const StoredSite& before) {
  const auto& dug = event.options.dug_path;
  if (!event.stalled || !dug || !dug->start_x) return {};
  const DigParameters& path = dug->parameters;
  const double length =
      path.penetration_length * std::cos(path.penetration_angle) + path.drag_length;
  const double half = 0.5 * dug->machine.bucket.width_outside;
  const double cell = before.ground.terrain.bank.cell_size;
  const double depth = std::max(cell, path.penetration_length * std::sin(path.penetration_angle));
  const Rectangle strip = {*dug->start_x - std::max(length, cell), -half, *dug->start_x, half};
  return bank_below(before.first, before.ground, event.base, strip, depth);
}

/// Learns from a dig, of which `next` has the ground already.
void learn(const SiteEvent& event, const StoredSite& before, StoredSite& next, SiteUpdate& update) {
  std::vector<BankPart> bank = bank_cut({before.first, before.ground, next.ground});
  const bool has_held = bank.empty();
  if (has_held) bank = bank_that_held(event, before);
  const auto scan = static_cast<int>(before.manifest.generation);
  const ScanNumbers scans = {event.before ? -scan - 1 : scan, scan + 1};
  DigEvidence evidence = evidence_of(event, *update.estimate, bank, scans);
  if (has_held) evidence.bank_share = 1.0;
  const bool has_density = evidence.survey || evidence.payload_percent;
  const bool has_news = has_density || !evidence.resistance.empty() || !evidence.limits.empty();
  if (has_news && !bank.empty()) next.belief.add(evidence);
  if (has_density) ++next.manifest.digs;
  update.density = believed(next.belief, bank);
}

void judge(SiteUpdate& update, const std::string& folder) {
  if (!update.taken) {
    update.warnings.emplace_back(WarningCode::scan_not_taken,
                                 folder +
                                     ": the scan does not fit the ground of the site where "
                                     "that did not change: the site stays as it was");
  }
  update.trustworthy =
      (!update.estimate || update.estimate->trustworthy) && !any_ends_trust(update.warnings);
}

}  // namespace

/// What is in the folder, and in memory.
struct Site::State {
  SiteStore store;
  SiteSettings settings;
  SiteAccess access;
  StoredSite site;

  bool is_empty() const { return site.manifest.generation == 0; }
  void require_writable() const {
    require(access != SiteAccess::read, store.path() + ": the site is open for reading");
  }
  void require_new(const SiteEvent& event, const std::string& digest) const;
  /// @return what became of it, and the site with it
  std::pair<SiteUpdate, StoredSite> answer(const SiteEvent& event) const;
};

void Site::State::require_new(const SiteEvent& event, const std::string& digest) const {
  require_in("time of the scan [s]", event.time, -latest_time, latest_time);
  const std::vector<SiteRecord>& latest = site.manifest.latest;
  const auto same = std::find_if(latest.begin(), latest.end(),
                                 [&](const SiteRecord& each) { return each.scan == digest; });
  if (same != latest.end()) {
    const long long number = site.manifest.generation - (latest.end() - same) + 1;
    refuse(store.path() + ": this scan is in the site already, as update " +
           std::to_string(number) + " of " + std::to_string(site.manifest.generation));
  }
  if (!latest.empty() && event.time < latest.back().time) {
    refuse(store.path() + ": the scan is of " + number_text(event.time) +
           " s, older than the last one of the site, of " + number_text(latest.back().time) + " s");
  }
}

std::pair<SiteUpdate, StoredSite> Site::State::answer(const SiteEvent& event) const {
  const std::string digest = scan_digest(event.scan);
  require_new(event, digest);
  SiteUpdate update;
  StoredSite next;
  next.manifest = site.manifest;
  next.belief = site.belief;
  if (is_empty()) {
    next.ground =
        first_ground(event.before.value_or(event.scan), event.time, settings, update.warnings);
    next.first = next.ground;
    update.taken = true;
  } else {
    next.first = site.first;
  }
  if (!is_empty() || event.before) {
    std::optional<StoredSite> begun;
    if (is_empty()) begun = next;
    const StoredSite& before = begun ? *begun : site;
    SurveyedEvent seen = surveyed(event, settings, before.ground);
    update.estimate = std::move(seen.estimate);
    update.warnings = std::move(seen.warnings);
    update.alignment = seen.alignment;
    update.correction = seen.correction;
    update.taken = seen.fits;
    next.ground = std::move(seen.ground);
    add_first_heights(next.ground, settings, next.first);
    if (update.taken && update.estimate) learn(event, before, next, update);
  }
  judge(update, store.path());
  update.digs = update.taken ? next.manifest.digs : site.manifest.digs;
  next.manifest.latest.push_back({digest, event.time, update.estimate.has_value()});
  return {std::move(update), std::move(next)};
}

namespace {

/// The scans of a job's site are taken in by the job.
const std::string& open_for(const std::string& folder, SiteAccess access) {
  if (access != SiteAccess::write || !std::filesystem::exists(folder + '/' + job_file))
    return folder;
  throw Error(ErrorKind::bad_file, folder +
                                       ": holds a job, which takes in the scans of its site "
                                       "itself (plan-site scan, SiteJob::look())");
}

}  // namespace

Site::Site(const std::string& folder, SiteSettings settings, SiteAccess access)
    : state_(new State{SiteStore(open_for(folder, access), access != SiteAccess::read),
                       std::move(settings),
                       access,
                       {}}) {
  if (state_->store.holds_site()) {
    state_->site = state_->store.load();
    require_settings(folder, state_->site.manifest, state_->settings);
  } else {
    if (access == SiteAccess::read) {
      throw Error(ErrorKind::bad_file, folder + ": holds no site: it has no " + site_manifest);
    }
    state_->site.manifest = new_manifest(state_->settings);
  }
  state_->settings.cell_size = state_->site.manifest.cell_size;
}

Site::~Site() = default;
Site::Site(Site&&) noexcept = default;
Site& Site::operator=(Site&&) noexcept = default;

SiteUpdate Site::update(const SiteEvent& event) {
  state_->require_writable();
  auto [update, next] = state_->answer(event);
  if (update.taken) state_->store.save(state_->site, next);
  if (update.taken) state_->site = std::move(next);
  return std::move(update);
}

SiteUpdate Site::look(const SiteEvent& event) const { return state_->answer(event).first; }

void Site::undo() {
  state_->require_writable();
  state_->site = state_->store.undo(state_->site.manifest);
}

bool Site::is_empty() const { return state_->is_empty(); }
bool Site::was_last(const Scan& scan) const {
  const std::vector<SiteRecord>& latest = state_->site.manifest.latest;
  return !latest.empty() && latest.back().scan == scan_digest(scan);
}
bool Site::can_undo() const { return state_->store.can_undo(state_->site.manifest); }
long long Site::updates() const { return state_->site.manifest.generation; }
long long Site::digs() const { return state_->site.manifest.digs; }
double Site::cell_size() const { return state_->site.manifest.cell_size; }
const SiteSettings& Site::settings() const { return state_->settings; }

const GroundState& Site::ground() const {
  require(!is_empty(), state_->store.path() + ": no scan was taken in");
  return state_->site.ground;
}

const DensityBelief& Site::belief() const { return state_->site.belief; }

GroundDensity Site::density_at(const BasePose& base, const Rectangle& area, double depth) const {
  const std::vector<BankPart> bank = bank_below(state_->site.first, ground(), base, area, depth);
  GroundDensity density = belief().ground_density(bank);
  density.soil = state_->site.manifest.soil;
  return density;
}

GroundState Site::ground_for(const BasePose& base, const Rectangle& extent,
                             double cell_size) const {
  return seen_by(ground(), base, flat_ground(extent, cell_size));
}

}  // namespace excavplan
