// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/strewn_soil.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/angles.hpp"
#include "base/normal_equations.hpp"
#include "ground/grid_cells.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

constexpr double near_soil = 0.6;        // ours: from hole, spill or heap [m]
constexpr double strewn_clip = 4.0;      // sd of a cell
constexpr double highest_strewn = 0.03;  // ours [m]
constexpr double fewest_far = 100.0;     // ours: cells
/// Share of digs with soil strewn too thin for a layer, ours: of those without layers, and of those
/// whose layers are more than so much of what rose.
constexpr double strewn_without = 0.3;
constexpr double strewn_by_layers = 0.95;
constexpr double least_layers = 0.002;

/// A volume and its variance by source [m^3, m^6].
struct OutsideSum {
  double volume = 0.0;
  double noise = 0.0;
  double correlated = 0.0;
  double datum = 0.0;

  double sd() const { return std::sqrt(noise + correlated + datum); }
};

/// Over stable ground near the zones of the dig above a plane through that farther away, whose
/// error is that of the datum.
OutsideSum outside_of(const Area& area) {
  const ChangedGround& ground = area.ground;
  Mask counted = Mask::Constant(ground.zone.rows(), ground.zone.cols(), false);
  for_each_cell(ground.zone, [&](Cell at) {
    const int zone = ground.zone(at.row, at.col);
    counted(at.row, at.col) =
        zone >= 0 && area.kinds[static_cast<std::size_t>(zone)] != ZoneKind::other;
  });
  if (!counted.any()) return {};
  const Eigen::ArrayXXd away = distance_to(counted) * area.grid.cell_size;
  const double bound = std::max(strewn_clip * ground.noise_sd, highest_strewn);
  using Terms = NormalEquations<3>::Vector;
  NormalEquations<3> far;
  Terms near = Terms::Zero();
  double change = 0.0;
  double far_cells = 0.0;
  for_each_cell(ground.zone, [&](Cell at) {
    if (std::isnan(ground.residual(at.row, at.col)) || area.unknown(at.row, at.col) != 0) return;
    const double here = std::clamp(ground.difference(at.row, at.col), -bound, bound);
    const Terms terms(1.0, static_cast<double>(at.col) / static_cast<double>(away.cols()) - 0.5,
                      static_cast<double>(at.row) / static_cast<double>(away.rows()) - 0.5);
    if (away(at.row, at.col) < near_soil) {
      near += terms;
      change += here;
    } else {
      far.add(terms, here);
      far_cells += 1.0;
    }
  });
  if (near(0) == 0.0 || far_cells < fewest_far) return {};
  const double noise = area.noise.large_area_variance(area.grid.cell_size);
  const double squared = std::pow(area.grid.cell_size, 4);
  return {area.grid.cell_size * area.grid.cell_size * (change - near.dot(far.solution())),
          squared * near(0) * area.noise.white, squared * near(0) * (noise - area.noise.white),
          squared * noise * near.dot(far.covariance() * near)};
}

double density_of_normal(double value, double sd) {
  return std::exp(-0.5 * std::pow(value / sd, 2)) / (sd * std::sqrt(2.0 * pi));
}

/// The soil in a sum, where a share of digs strews some.
struct StrewnSoil {
  double volume = 0.0;
  double by_sum = 0.0;     ///< variance by the error of the sum
  double by_chance = 0.0;  ///< and by not knowing whether there is any
};

StrewnSoil expected_soil(const OutsideSum& sum, double rose, double layers) {
  constexpr double usual = 0.01;  // ours: sd of what no layer is found of, of what rose
  constexpr double beside = 0.3;  // ours: and of what lies beside layers, of these
  const double strewn = layers > least_layers * rose ? strewn_by_layers : strewn_without;
  const double prior_sd = std::hypot(usual * rose, beside * layers);
  const double sd = sum.sd();
  if (!(sd > 0.0) || !(prior_sd > 0.0)) return {};
  const double variance = sd * sd + prior_sd * prior_sd;
  const double some = strewn * density_of_normal(sum.volume, std::sqrt(variance));
  const double none = (1.0 - strewn) * density_of_normal(sum.volume, sd);
  const double likely = some + none > 0.0 ? some / (some + none) : 1.0;
  const double mean = sum.volume * prior_sd * prior_sd / variance;
  const double within = sd * sd * prior_sd * prior_sd / variance;
  const double value = std::max(0.0, likely * mean);  // no soil is less than none
  return {value, likely * within, std::max(0.0, likely * mean * mean - value * value)};
}

/// What (hole, spill, heap) lack for each unit of soil that lies on ground taken for stable,
/// because it raises the datum.
Eigen::Vector3d lost_by_datum(const Area& area) {
  Eigen::Vector3d lost = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < area.zones.size(); ++i) {
    if (area.kinds[i] == ZoneKind::dig) lost(0) -= area.zones[i].area;
    if (area.kinds[i] == ZoneKind::spill) lost(1) += area.zones[i].area;
    if (area.kinds[i] == ZoneKind::dump) lost(2) += area.zones[i].area;
  }
  const double cells = static_cast<double>((!area.ground.residual.isNaN()).count());
  return lost / (cells * area.grid.cell_size * area.grid.cell_size);
}

/// Volume of the layers that were found and counted.
double layers_of(const Area& area) {
  double volume = 0.0;
  for (std::size_t i = 0; i < area.zones.size(); ++i) {
    const bool is_counted = area.kinds[i] != ZoneKind::other;
    if (is_counted && area.ground.zone_is_layer[i]) volume += area.zones[i].volume;
  }
  return volume;
}

}  // namespace

void add_strewn_soil(const std::vector<Area>& areas, VolumeChange& change) {
  OutsideSum sum;
  double layers = 0.0;
  Eigen::Vector3d lost = Eigen::Vector3d::Zero();
  for (const Area& area : areas) {
    layers += layers_of(area);
    const OutsideSum outside = outside_of(area);
    sum.volume += outside.volume;
    sum.noise += outside.noise;
    sum.correlated += outside.correlated;
    sum.datum += outside.datum;
    if (outside.volume != 0.0) lost += lost_by_datum(area) / static_cast<double>(areas.size());
  }
  const StrewnSoil soil = expected_soil(sum, change.after.value, layers);
  change.outside = {sum.volume, sum.sd()};
  change.strewn = {soil.volume, std::sqrt(soil.by_sum + soil.by_chance)};
  const Eigen::Vector3d effect = Eigen::Vector3d::UnitY() + lost;
  change.excavated.value += effect(0) * soil.volume;
  change.spilled.value += effect(1) * soil.volume;
  change.dumped.value += effect(2) * soil.volume;
  change.before.value = change.excavated.value;
  change.after.value = change.spilled.value + change.dumped.value;
  const Eigen::Matrix3d shape = effect * effect.transpose();
  change.errors.thin += soil.by_chance * shape;
  if (!(sum.sd() > 0.0)) return;
  const double share = soil.by_sum / (sum.sd() * sum.sd());
  change.errors.noise += share * sum.noise * shape;
  change.errors.correlated += share * sum.correlated * shape;
  change.errors.datum += share * sum.datum * shape;
}

}  // namespace excavplan
