// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "design/design_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <excavplan/machine/kinematics.hpp>

#include "base/plan_geometry.hpp"
#include "base/text.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

// Ours:
constexpr double most_beyond = 0.01;   // of a design's area, beyond the scan
constexpr double most_above = 0.02;    // of its cut, to be filled
constexpr double most_covered = 0.01;  // of its area, under places for soil
constexpr double widest = 0.5;         // tolerance, over the mean depth

/// How the design lies to the ground.
struct Extent {
  double area = 0.0;     ///< that lies below the ground [m^2]
  double cut = 0.0;      ///< [m^3]
  double fill = 0.0;     ///< beyond the tolerance [m^3]
  double deepest = 0.0;  ///< below the ground [m]
  double covered = 0.0;  ///< of the area, by places for soil [m^2]
};

bool is_for_soil(const JobDesign& job, const Eigen::Vector2d& at) {
  return std::any_of(job.dump_areas.begin(), job.dump_areas.end(),
                     [&](const DumpArea& each) { return is_inside(each.polygon, at); });
}

Extent extent_of_work(const JobDesign& job, const DesignCover& cover, const HeightMap& ground) {
  const double cell = ground.cell_size * ground.cell_size;
  Extent extent;
  for_each_cell(ground.z, [&](Cell at) {
    const double depth = ground.z(at.row, at.col) - cover.height(at.row, at.col);
    if (std::isnan(depth)) return;
    const double area = cell * cover.share(at.row, at.col);
    if (depth < 0.0) extent.fill += area * std::max(0.0, -depth - job.tolerance);
    if (!(depth > job.tolerance)) return;
    extent.area += area;
    extent.cut += area * depth;
    extent.deepest = std::max(extent.deepest, depth);
    if (is_for_soil(job, {ground.x(at.col), ground.y(at.row)})) extent.covered += area;
  });
  return extent;
}

std::string percent(double share) { return readable(100.0 * share, 2) + " %"; }

}  // namespace

double area_beyond(const DesignSurface& design, const DesignCover& cover, const HeightMap& ground) {
  const double all = area_in_plan(design);
  const double within = ground.cell_size * ground.cell_size * cover.share.sum();
  constexpr double rounding = 1e-3;
  return all - within > rounding * all ? all - within : 0.0;
}

std::vector<Warning> design_warnings(const JobDesign& job, const DesignSurface& design,
                                     const HeightMap& ground, const Machine& machine) {
  const DesignCover cover = cover_of(design, ground);
  const Extent extent = extent_of_work(job, cover, ground);
  const std::string of = "design " + in_quotes(design.name) + ": ";
  std::vector<Warning> warnings;
  const double beyond = area_beyond(design, cover, ground);
  if (beyond > most_beyond * area_in_plan(design)) {
    warnings.emplace_back(WarningCode::design_beyond_scan,
                          of + percent(beyond / area_in_plan(design)) +
                              " of its area lies beyond what the first scan shows: that part is "
                              "not dug, and the job does not end as finished");
  }
  if (!design.cuts_only && extent.fill > most_above * extent.cut) {
    warnings.emplace_back(WarningCode::design_above_ground,
                          of + readable(extent.fill, 2) +
                              " m3 of it lie above the ground, against a cut of " +
                              readable(extent.cut, 3) + " m3: a job digs, it fills nothing");
  }
  if (const double reach = digging_depth(machine); extent.deepest > reach) {
    warnings.emplace_back(WarningCode::design_out_of_reach,
                          of + "it lies up to " + readable(extent.deepest, 3) +
                              " m below the ground, deeper than the machine digs, " +
                              readable(reach, 3) + " m");
  }
  if (extent.covered > most_covered * extent.area) {
    warnings.emplace_back(WarningCode::dump_on_design,
                          of + percent(extent.covered / extent.area) +
                              " of it lies under places for soil: soil laid there is in the way");
  }
  if (extent.area > 0.0 && job.tolerance > widest * extent.cut / extent.area) {
    warnings.emplace_back(WarningCode::wide_tolerance,
                          of + "its tolerance, " + readable(job.tolerance, 3) +
                              " m, is more than half of its mean depth, " +
                              readable(extent.cut / extent.area, 3) +
                              " m: it is finished with hardly any of it dug");
  }
  return warnings;
}

}  // namespace excavplan
