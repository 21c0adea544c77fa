// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/earlier_soil.hpp"

#include <cmath>
#include <string>

#include <excavplan/change/bulking.hpp>

#include "base/text.hpp"
#include "change/zone_shape.hpp"
#include "ground/grid_cells.hpp"
#include "ground/plane_fit.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

// All ours.
constexpr double ring_from = 0.1;       // around the hole [m]
constexpr double ring_to = 0.8;         // [m]
constexpr std::size_t least_ring = 50;  // cells
constexpr double least_height = 0.05;   // of a hump [m]
constexpr double least_excess = 3.0;    // of it, over the deviation of the ground around
constexpr double foot = 1.0;            // where it begins, likewise
constexpr double gentlest = 0.35;       // its slope: 19 degrees
constexpr double steepest = 1.2;        // 50 degrees; undisturbed walls are steeper
constexpr double least_share = 0.005;   // of the hole
constexpr double weight = 0.5;
constexpr double relative_sd = 0.2;  // of its volume
constexpr double telling = 0.03;     // of k

/// (column, row, height) of the ground around the hole.
std::vector<Eigen::Vector3d> ring_of(const HeightMap& before, const Area& area, const Mask& hole) {
  const Eigen::ArrayXXd away = distance_to(hole) * area.grid.cell_size;
  std::vector<Eigen::Vector3d> ring;
  for_each_cell(before.z, [&](Cell at) {
    const double distance = away(at.row, at.col);
    const double z = before.z(at.row, at.col);
    if (distance < ring_from || distance > ring_to || std::isnan(z)) return;
    if (area.ground.zone(at.row, at.col) >= 0) return;
    ring.emplace_back(static_cast<double>(at.col), static_cast<double>(at.row), z);
  });
  return ring;
}

/// Volume of the humps in the hole of one area [m^3].
double loose_volume(const HeightMap& before, const Area& area) {
  Mask hole = Mask::Constant(before.z.rows(), before.z.cols(), false);
  for_each_cell(hole, [&](Cell at) {
    const int zone = area.ground.zone(at.row, at.col);
    hole(at.row, at.col) = zone >= 0 && area.kinds[static_cast<std::size_t>(zone)] == ZoneKind::dig;
  });
  if (!hole.any()) return 0.0;
  const std::vector<Eigen::Vector3d> ring = ring_of(before, area, hole);
  if (ring.size() < least_ring) return 0.0;
  const RobustPlane fit = robust_plane(ring);
  Eigen::ArrayXXd above = Eigen::ArrayXXd::Zero(hole.rows(), hole.cols());
  std::vector<Cell> hump;
  for_each_cell(hole, [&](Cell at) {
    above(at.row, at.col) = before.z(at.row, at.col) -
                            fit.plane.at(static_cast<double>(at.col), static_cast<double>(at.row));
    if (hole(at.row, at.col) && above(at.row, at.col) > foot * fit.sd) hump.push_back(at);
  });
  const ZoneShape shape = shape_of(above, hump, area.grid.cell_size);
  const bool is_high = shape.height > std::max(least_height, least_excess * fit.sd);
  if (!is_high || shape.steepest < gentlest || shape.steepest > steepest) return 0.0;
  double volume = 0.0;
  for (const Cell at : hump) volume += above(at.row, at.col);
  return volume * area.grid.cell_size * area.grid.cell_size;
}

void state(double volume, double factor, double scans, VolumeChange& change) {
  const double hole = change.before.value;
  const double read = (change.after.value - volume) / (hole - volume);
  const double sd = std::hypot(scans, relative_sd * (read - factor));
  const std::string what = "loose soil of an earlier dig in the hole before";
  change.attribution.push_back(
      {ChangeKind::earlier_soil, what, {volume, relative_sd * volume}, true, 1.0 - weight});
  for (Reading& reading : change.readings) reading.weight *= 1.0 - weight;
  change.readings.push_back({{ChangeKind::earlier_soil}, "without " + what, weight, {read, sd}});
  const Eigen::Vector3d both(volume, 0.0, volume);
  change.errors.attribution += weight * both * both.transpose();
  change.warnings.emplace_back(
      WarningCode::earlier_soil,
      "the scan before shows " + readable(volume, 0.1 * volume) +
          " m^3 above the ground around, where the hole is, as steep as loose soil: if an earlier "
          "dig left it there, the bulking factor is " +
          readable(read, 0.01) + " instead of " + readable(factor, 0.01) +
          "; scan after loose soil was cleared, or dig beside it",
      std::abs(read - factor) > telling * factor);
}

}  // namespace

void state_earlier_soil(const std::vector<const HeightMap*>& before, const std::vector<Area>& areas,
                        VolumeChange& change) {
  const auto k = bulking_factor(change);
  if (!k || change.readings.empty()) return;
  double volume = 0.0;
  for (std::size_t i = 0; i < areas.size(); ++i) volume += loose_volume(*before[i], areas[i]);
  const double hole = change.before.value;
  if (volume < least_share * hole || volume > 0.5 * std::min(hole, change.after.value)) return;
  state(volume, k->value, bulking_errors(change).scans, change);
}

}  // namespace excavplan
