// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/noisy_scan.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <excavplan/scans/scan_terrain.hpp>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Vector3d;

constexpr double telling_sds = 3.0;  // deviations between what is known and a scan; ours

/// Calls visit(place, deviation of a height at 1 m^power) for the points of clouds that know their
/// sensor.
template <typename Visit>
void for_each_point(const Scan& scan, double range_power, Visit visit) {
  const Eigen::Isometry3d site_from_scan(scan.site_from_scan);
  for (const auto& cloud : scan.clouds) {
    if (!cloud->sensor_origin) continue;
    const Vector3d eye = site_from_scan * (scan.unit * *cloud->sensor_origin);
    for (const Vector3d& point : cloud->points) {
      if (!point.allFinite()) continue;
      const Vector3d at = site_from_scan * (scan.unit * point);
      const double range = (at - eye).norm();
      const double steep = range > 0.0 ? std::abs(at.z() - eye.z()) / range : 1.0;
      visit(at, steep * std::pow(range, range_power));
    }
  }
}

/// Soil comes onto the loose, or goes from it first.
void shift(Terrain& ground, Cell at, double by) {
  double& bank = ground.bank.z(at.row, at.col);
  double& loose = ground.loose(at.row, at.col);
  if (loose > 0.0) {
    const double to = std::max(0.0, loose + by);
    by -= to - loose;
    loose = to;
  }
  bank += by;
}

}  // namespace

double shared_height_sd(const Scan& scan, const SensorErrors& sensor) {
  std::vector<double> of_points;
  for_each_point(scan, sensor.range_power,
                 [&](const Vector3d&, double grown) { of_points.push_back(grown); });
  return of_points.empty() ? 0.0 : sensor.shared * median(of_points);
}

ScanHeights heights_of(const Scan& scan, const SensorErrors& sensor, const HeightMap& grid) {
  ArrayXXd sum = ArrayXXd::Zero(grid.z.rows(), grid.z.cols()), count = sum;
  for_each_point(scan, sensor.range_power, [&](const Vector3d& place, double grown) {
    const auto at = cell_at(grid, place.x(), place.y());
    if (!at) return;
    sum(at->row, at->col) += grown;
    count(at->row, at->col) += 1.0;
  });
  ScanHeights heights;
  heights.z = terrain_from_scan(scan, grid.extent(), grid.cell_size).terrain.bank.z;
  heights.z = (count > 0.0).select(heights.z, std::nan("")).eval();
  const ArrayXXd grown = sum / count;
  heights.sd = grown * (sensor.shared * sensor.shared + sensor.own * sensor.own / count).sqrt();
  return heights;
}

void fuse(const ScanHeights& scan, Terrain& ground, ArrayXXd& sd) {
  for_each_cell(scan.z, [&](Cell at) {
    const double z = scan.z(at.row, at.col), seen_sd = scan.sd(at.row, at.col);
    if (std::isnan(z)) return;
    double& known_sd = sd(at.row, at.col);
    double& bank = ground.bank.z(at.row, at.col);
    if (std::isnan(bank)) {
      bank = z;
      ground.loose(at.row, at.col) = 0.0;
      known_sd = seen_sd;
      return;
    }
    if (std::isnan(known_sd)) known_sd = seen_sd;
    const double off = z - bank - ground.loose(at.row, at.col);
    const double variance = known_sd * known_sd + seen_sd * seen_sd;
    const bool is_other = std::abs(off) > telling_sds * std::sqrt(variance);
    const double weight = is_other || !(variance > 0.0) ? 1.0 : known_sd * known_sd / variance;
    shift(ground, at, weight * off);
    known_sd = is_other ? seen_sd : std::sqrt(1.0 - weight) * known_sd;
  });
}

}  // namespace excavplan
