// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/fallback.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <excavplan/error.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double least_seen = 0.5;
constexpr int samples_per_cell = 8;  // of the tip's line

/// Sums over the swept ground.
struct Swept {
  double cut = 0.0;
  double in_pit = 0.0;
  double area = 0.0;
  double seen = 0.0;  ///< share of `area`, as area [m^2]
};

/// Ground between the tip's line and the surface before, and what of it is filled after.
void add_cell(double floor, double before, double after, double area, Swept& sum) {
  if (std::isnan(before) || !(before > floor)) {
    if (std::isnan(before)) sum.area += area;
    return;
  }
  sum.area += area;
  if (std::isnan(after)) return;
  sum.seen += area;
  sum.cut += area * (before - floor);
  sum.in_pit += area * (after - floor);
}

}  // namespace

Fallback measure_fallback(const Machine& machine, const DigPath& path, const HeightMap& before,
                          const HeightMap& after, double tracking_sd) {
  if (!same_grid(before, after)) {
    throw Error(ErrorKind::bad_input,
                "fallback: the maps before and after must be on one grid: same origin, cell and "
                "size");
  }
  // A scan blurs the walls of the cut over a cell: the floor between them stands for all of it.
  const double whole = 0.5 * machine.bucket.width_outside;
  const double half = whole > 2.0 * before.cell_size ? whole - before.cell_size : whole;
  Swept sum;
  for (Eigen::Index col = 0; col < before.z.cols(); ++col) {
    for (int i = 0; i < samples_per_cell; ++i) {
      const double x = before.x(col) + before.cell_size * ((i + 0.5) / samples_per_cell - 0.5);
      const double floor = swept_height(path, x);
      if (std::isnan(floor)) continue;
      for (Eigen::Index row = 0; row < before.z.rows(); ++row) {
        const double low = before.y(row) - 0.5 * before.cell_size;
        const double cover = std::min(half, low + before.cell_size) - std::max(-half, low);
        if (!(cover > 0.0)) continue;
        add_cell(floor, before.z(row, col), after.z(row, col),
                 cover * before.cell_size / samples_per_cell, sum);
      }
    }
  }
  const double seen_share = sum.area > 0.0 ? sum.seen / sum.area : 0.0;
  if (!(sum.cut > 0.0) || seen_share < least_seen) {
    throw Error(ErrorKind::bad_input,
                "fallback: the path from x = " + readable(path.start_x) + " m swept " +
                    readable(sum.area) + " m2 of the surveyed ground, of which " +
                    readable(100.0 * seen_share) + " % is known in both scans; at least " +
                    readable(100.0 * least_seen) +
                    " % must be: are path and scans in the site frame?");
  }
  Fallback fallback;
  fallback.seen_share = seen_share;
  fallback.cut = sum.cut / seen_share * whole / half;
  fallback.in_pit = sum.in_pit / seen_share * whole / half;
  // A path that lay deeper than thought by d cut d * area more and left as much more in the pit.
  const double fraction = sum.in_pit / sum.cut;
  fallback.fraction.value = std::clamp(fraction, 0.0, 1.0);
  fallback.fraction.sd = tracking_sd * sum.seen / sum.cut * std::abs(1.0 - fraction);
  return fallback;
}

}  // namespace excavplan
