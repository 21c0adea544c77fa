// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/site_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "ground/grid_cells.hpp"
#include "scans/map_sampling.hpp"

namespace excavplan {
namespace {

// Numbers of this file, all ours.
constexpr double least_cut = 0.03;      ///< depth that tells a cut from two scans' errors [m]
constexpr double most_shared = 0.45;    ///< of a survey's variance by each of its two scans
constexpr double least_measured = 0.3;  ///< of a density's deviation, that no law explains
constexpr double law_sd = 4.2;          ///< of the law, as the belief takes it [points]
/// Of ln(work) with the density [1/%]: full buckets of the built-in simulator in loam of 20 .. 80
/// %.
constexpr double work_rise = 0.012;
constexpr double strength_share = 0.7;  ///< of the work that grows with the strength
constexpr double work_sd = 0.2;         ///< of ln(work): simulator and path
constexpr double stall_margin = -0.4;   ///< of ln(load / limit) in a plan that foretells no stall
constexpr double stall_sd = 0.3;        ///< of it

/// Density by the scans alone.
RelativeDensity by_scans(const DensityEstimate& estimate) {
  RelativeDensity density = *estimate.density;
  if (estimate.successive) density = estimate.successive->this_dig;
  if (estimate.loads) density = estimate.loads->by_scans;
  if (!estimate.payload) return density;
  const Measured& by_law = estimate.payload->law_density_percent;
  density.raw_percent = by_law.value;
  density.sd_given_law_percent = std::sqrt(
      std::max(by_law.sd * by_law.sd - law_sd * law_sd, std::pow(least_measured * by_law.sd, 2)));
  return density;
}

SurveyReading reading_of(const DensityEstimate& estimate, ScanNumbers scans) {
  const RelativeDensity density = by_scans(estimate);
  const double sd = density.sd_given_law_percent;
  const double shared = std::clamp(estimate.shared_with_before, 0.0, most_shared);
  const double effect = std::sqrt(shared) * sd;
  return {density.raw_percent,
          std::sqrt(1.0 - 2.0 * shared) * sd,
          {{scans.before, -effect}, {scans.after, effect}}};
}

void add_resistance(const SiteEvent& event, DigEvidence& evidence) {
  if (event.stalled) {
    const double at = event.foretold ? event.foretold->density_percent : 50.0;
    evidence.limits.push_back({true, stall_margin, stall_sd, {at, work_rise, strength_share}});
  }
  const auto& work = event.options.joint_work;
  if (!work || !event.foretold || event.stalled) return;
  const ForetoldDig& foretold = *event.foretold;
  evidence.resistance.push_back({std::log(work->value / foretold.joint_work),
                                 std::hypot(work->sd / work->value, work_sd),
                                 {foretold.density_percent, work_rise, strength_share}});
}

/// Height of the ground as it was first seen; that it has now where a cell is new.
double first_height(const Eigen::ArrayXXd& first, Cell at, double now) {
  const double height = first(at.row, at.col);
  return std::isnan(height) ? now : height;
}

}  // namespace

std::vector<BankPart> bank_cut(const GroundAtDig& ground) {
  const HeightMap& grid = ground.after.terrain.bank;
  const HeightMap& old = ground.before.terrain.bank;
  const HeightMap first = ground.first.terrain.surface();
  const Eigen::ArrayXXd before = layer_on(grid, old, old.z);
  const Eigen::ArrayXXd top = layer_on(grid, first, first.z);
  std::vector<BankPart> parts;
  for_each_cell(grid.z, [&](Cell at) {
    const double high = before(at.row, at.col);
    const double low = grid.z(at.row, at.col);
    if (!(high - low > least_cut)) return;
    const double depth = first_height(top, at, high) - 0.5 * (high + low);
    parts.push_back(
        {{grid.x(at.col), grid.y(at.row), depth}, (high - low) * grid.cell_size * grid.cell_size});
  });
  return parts;
}

DigEvidence evidence_of(const SiteEvent& event, const DensityEstimate& estimate,
                        const std::vector<BankPart>& bank, ScanNumbers scans) {
  DigEvidence evidence;
  if (!bank.empty()) evidence.bank = condensed(bank);
  if (estimate.change.cut) {
    evidence.bank_share = std::clamp(estimate.change.cut->bank_share(), 0.0, 1.0);
  }
  add_resistance(event, evidence);
  if (!estimate.trustworthy || !estimate.density) return evidence;
  if (estimate.bulking) evidence.survey = reading_of(estimate, scans);
  if (estimate.payload) evidence.payload_percent = estimate.payload->density_percent;
  return evidence;
}

std::vector<BankPart> bank_below(const GroundState& first, const GroundState& ground,
                                 const BasePose& base, const Rectangle& area, double depth) {
  const HeightMap grid = flat_ground(area, ground.terrain.bank.cell_size);
  const HeightMap old = first.terrain.surface();
  const Eigen::Isometry3d to_site = base.site_from_machine();
  std::vector<BankPart> parts;
  for_each_cell(grid.z, [&](Cell at) {
    const Eigen::Vector2d place =
        (to_site * Eigen::Vector3d(grid.x(at.col), grid.y(at.row), 0.0)).head<2>();
    const HeightMap& bank = ground.terrain.bank;
    const double loose = cell_value(bank, ground.terrain.loose, place);
    const double cut = depth - loose;
    const double top = cell_value(bank, bank.z, place);
    if (std::isnan(top) || !(cut > 0.0)) return;
    const double was = cell_value(old, old.z, place);
    const double below = (std::isnan(was) ? 0.0 : was - top) + 0.5 * cut;
    parts.push_back({{place.x(), place.y(), below}, cut * grid.cell_size * grid.cell_size});
  });
  return parts;
}

}  // namespace excavplan
