// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/job_score.hpp>

#include <cmath>

#include <excavplan/design/cut_and_fill.hpp>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "design/deviation.hpp"
#include "ground/grid_cells.hpp"
#include "ground/window.hpp"
#include "trial/plan_polygon.hpp"
#include "trial/scored_design.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;

constexpr double most_beyond_twice = 0.01;
constexpr double least_seen = 0.99;
constexpr double most_in_keep_out = 0.010;  // [m^3]

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// Volume of the positive heights, each cell by a weight [m^3].
double volume(const ArrayXXd& height, const ArrayXXd& weight, double cell) {
  return cell * cell * (height > 0.0).select(weight * height, 0.0).sum();
}

/// In the zone.
Deviation deviation_in_zone(const JobDesign& job, const ScoredDesign& design,
                            const HeightMap& after) {
  const Mask zone = inner_cells(design.gentle, after.cell_size, job.edge_margin);
  return deviation_of(zone.select(after.z - design.height.z, nan), after.cell_size, job.tolerance);
}

/// Volume that changed in a keep-out, of one with a depth what changed below it.
double changed_in(const KeepOut& keep_out, const HeightMap& before, const ArrayXXd& risen) {
  const ArrayXXd where = cells_in(keep_out.polygon, before).cast<double>();
  const double cell = before.cell_size;
  if (keep_out.depth) return volume(-risen - *keep_out.depth, where, cell);
  return volume(risen, where, cell) + volume(-risen, where, cell);
}

}  // namespace

double JobScore::left_percent() const { return 100.0 * share(left, design_cut); }
double JobScore::overdig_percent() const {
  return 100.0 * share(overdig_inside + overdig_beside, design_cut);
}
double JobScore::spill_percent() const {
  return 100.0 * share(spilled, by_truck ? removed : risen);
}

HeightMap footprint_of(const HiddenSite& site) {
  return scored_design(site.known, site.ground.surface()).height;
}

double mean_density(const HiddenSite& site) {
  const HeightMap& bank = site.ground.bank;
  const ScoredDesign scored = scored_design(site.known, bank);
  double sum = 0.0, volume = 0.0;
  for_each_cell(bank.z, [&](Cell at) {
    const double floor = scored.height.z(at.row, at.col), top = bank.z(at.row, at.col);
    const double thickness = scored.share(at.row, at.col) * (top - floor);
    if (!(thickness > 0.0)) return;
    sum += thickness * site.density.at(bank.x(at.col), bank.y(at.row), 0.5 * (floor + top));
    volume += thickness;
  });
  return share(sum, volume);
}

JobScore score_job(const HiddenSite& site, const HeightMap& after, double seen) {
  const HeightMap before = site.ground.surface();
  require(same_grid(before, after),
          "score of a job: the ground after is not on the grid of before");
  const ScoredDesign design = scored_design(site.known, before);
  require((design.share > 0.0).any(), "score of a job: the design lies nowhere below the ground");
  const double cell = before.cell_size;
  const ArrayXXd risen = after.z - before.z;
  const ArrayXXd everywhere = ArrayXXd::Ones(risen.rows(), risen.cols());
  Mask dump = Mask::Constant(risen.rows(), risen.cols(), false);
  for (const DumpArea& area : site.known.job.dump_areas) {
    dump = dump || cells_in(area.polygon, before);
  }

  JobScore score;
  const Deviation off = deviation_in_zone(site.known.job, design, after);
  score.rms = off.rms;
  score.p95 = off.p95;
  score.beyond_twice = off.beyond_twice;
  score.seen = seen;
  score.design_cut = design.below(before.z);
  score.left = design.below(after.z);
  score.overdig_inside = volume(design.height.z - after.z, design.share, cell);
  score.overdig_beside = volume(-risen, 1.0 - design.share, cell);
  score.risen = volume(risen, everywhere, cell);
  score.removed = volume(-risen, everywhere, cell);
  score.spilled = volume(risen, (!dump).cast<double>(), cell);
  score.by_truck = site.known.job.dump_areas.empty();
  for (const KeepOut& keep_out : site.known.job.keep_out) {
    score.keep_out += changed_in(keep_out, before, risen);
  }
  score.finished = score.p95 <= site.known.job.tolerance &&
                   score.beyond_twice <= most_beyond_twice && score.seen >= least_seen &&
                   score.keep_out <= most_in_keep_out;
  return score;
}

}  // namespace excavplan
