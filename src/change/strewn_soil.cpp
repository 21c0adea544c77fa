// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/strewn_soil.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/angles.hpp"
#include "ground/grid_cells.hpp"
#include "ground/registration.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

constexpr double near_soil = 0.6;       // ours: from hole, spill or heap [m]
constexpr double clip = 4.0;            // sd of a cell
constexpr double highest_crumb = 0.03;  // ours [m]

/// Of some cells.
struct CellSum {
  double cells = 0.0;
  double change = 0.0;
  Motion effect = Motion::Zero();

  double mean() const { return change / cells; }
};

/// Over stable ground near the zones of the dig less that farther away, and its variance.
Measured outside_of(const Area& area) {
  const ChangedGround& ground = area.ground;
  Mask counted = Mask::Constant(ground.zone.rows(), ground.zone.cols(), false);
  for_each_cell(ground.zone, [&](Cell at) {
    const int zone = ground.zone(at.row, at.col);
    counted(at.row, at.col) =
        zone >= 0 && area.kinds[static_cast<std::size_t>(zone)] != ZoneKind::other;
  });
  if (!counted.any()) return {};
  const Eigen::ArrayXXd away = distance_to(counted) * area.grid.cell_size;
  const double bound = std::max(clip * ground.noise_sd, highest_crumb);
  CellSum near;
  CellSum far;
  for_each_cell(ground.zone, [&](Cell at) {
    if (std::isnan(ground.residual(at.row, at.col)) || area.unknown(at.row, at.col) != 0) return;
    CellSum& sum = away(at.row, at.col) < near_soil ? near : far;
    const Eigen::Vector3d place(area.grid.x(at.col), area.grid.y(at.row), area.left.centre.z());
    sum.cells += 1.0;
    sum.change += std::clamp(ground.difference(at.row, at.col), -bound, bound);
    sum.effect += motion_effect(place - area.left.centre, Eigen::Vector2d::Zero());
  });
  if (near.cells == 0.0 || far.cells == 0.0) return {};
  const double cell_area = area.grid.cell_size * area.grid.cell_size;
  const double share = near.cells / far.cells;
  const Motion effect = near.effect - share * far.effect;
  const double noise = area.noise.large_area_variance(area.grid.cell_size);
  const double variance = near.cells * (1.0 + share) * noise + effect.dot(area.left.left * effect);
  return {cell_area * near.cells * (near.mean() - far.mean()), cell_area * std::sqrt(variance)};
}

double density_of_normal(double value, double sd) {
  return std::exp(-0.5 * std::pow(value / sd, 2)) / (sd * std::sqrt(2.0 * pi));
}

/// The soil in a sum, where a share of digs strews some.
Measured expected_soil(const Measured& sum, double rose) {
  constexpr double strewn = 0.3;  // ours: of digs
  constexpr double usual = 0.02;  // ours: sd of what they strew, of what rose
  const double prior_sd = usual * rose;
  if (!(sum.sd > 0.0) || !(prior_sd > 0.0)) return {};
  const double variance = sum.sd * sum.sd + prior_sd * prior_sd;
  const double some = strewn * density_of_normal(sum.value, std::sqrt(variance));
  const double none = (1.0 - strewn) * density_of_normal(sum.value, sum.sd);
  const double likely = some + none > 0.0 ? some / (some + none) : 1.0;
  const double mean = sum.value * prior_sd * prior_sd / variance;
  const double within = sum.sd * sum.sd * prior_sd * prior_sd / variance;
  const double value = std::max(0.0, likely * mean);  // no soil is less than none
  return {value, std::sqrt(std::max(0.0, likely * (within + mean * mean) - value * value))};
}

}  // namespace

void add_strewn_soil(const std::vector<Area>& areas, VolumeChange& change) {
  double variance = 0.0;
  for (const Area& area : areas) {
    const Measured outside = outside_of(area);
    change.outside.value += outside.value;
    variance += outside.sd * outside.sd;
  }
  change.outside.sd = std::sqrt(variance);
  const Measured soil = expected_soil(change.outside, change.after.value);
  change.strewn = soil;
  change.spilled.value += soil.value;
  change.after.value += soil.value;
  change.errors.thin(1, 1) += soil.sd * soil.sd;
}

}  // namespace excavplan
