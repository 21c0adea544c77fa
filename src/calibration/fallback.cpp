// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/calibration/fallback.hpp>

#include <algorithm>
#include <cmath>

#include <excavplan/base/error.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "ground/map_check.hpp"

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

/// Rows between the walls of the cut. A scan blurs a wall over a cell: the strip along it, as wide
/// as a cell, stands as high as the row beside it.
struct Rows {
  Eigen::Index first = 0;
  Eigen::Index end = 0;
  double half = 0.0;    ///< of the width that they cover [m]
  double beside = 0.0;  ///< width of the strip along each wall [m]

  double cover(Eigen::Index row, const HeightMap& map) const {
    const double low = map.y(row) - 0.5 * map.cell_size;
    return std::max(0.0, std::min(half, low + map.cell_size) - std::max(-half, low));
  }
};

Rows rows_between_walls(const HeightMap& map, double half_width) {
  Rows rows;
  const bool wide = half_width > 3.0 * map.cell_size;
  rows.beside = wide ? map.cell_size : 0.0;
  rows.half = half_width - rows.beside;
  rows.end = map.z.rows();
  while (rows.first < rows.end && !(rows.cover(rows.first, map) > 0.0)) ++rows.first;
  while (rows.end > rows.first && !(rows.cover(rows.end - 1, map) > 0.0)) --rows.end;
  if (rows.end - rows.first < 4) rows.beside = 0.0;
  return rows;
}

}  // namespace

Fallback measure_fallback(const Machine& machine, const DigPath& path, const HeightMap& before,
                          const HeightMap& after, double tracking_sd) {
  require_machine(machine);
  require_map(before, "fallback, map before");
  require_map(after, "fallback, map after");
  require(tracking_sd >= 0.0 && std::isfinite(tracking_sd), "fallback: tracking_sd", tracking_sd,
          "at least 0 m and finite");
  if (!same_grid(before, after)) {
    throw Error(ErrorKind::bad_input,
                "fallback: the maps before and after must be on one grid: same origin, cell and "
                "size");
  }
  const Rows rows = rows_between_walls(before, 0.5 * machine.bucket.width_outside);
  Swept sum;
  for (Eigen::Index col = 0; col < before.z.cols(); ++col) {
    for (int i = 0; i < samples_per_cell; ++i) {
      const double x = before.x(col) + before.cell_size * ((i + 0.5) / samples_per_cell - 0.5);
      const double floor = swept_height(path, x);
      if (std::isnan(floor)) continue;
      const double length = before.cell_size / samples_per_cell;
      for (Eigen::Index row = rows.first; row < rows.end; ++row) {
        add_cell(floor, before.z(row, col), after.z(row, col), rows.cover(row, before) * length,
                 sum);
      }
      if (!(rows.beside > 0.0)) continue;
      for (const Eigen::Index edge : {rows.first, rows.end - 1}) {
        add_cell(floor, before.z(edge, col), after.z(edge, col), rows.beside * length, sum);
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
  fallback.cut = sum.cut / seen_share;
  fallback.in_pit = sum.in_pit / seen_share;
  // A path that lay deeper than thought by d cut d * area more and left as much more in the pit.
  const double fraction = sum.in_pit / sum.cut;
  fallback.fraction.value = std::clamp(fraction, 0.0, 1.0);
  fallback.fraction.sd = tracking_sd * sum.seen / sum.cut * std::abs(1.0 - fraction);
  return fallback;
}

}  // namespace excavplan
