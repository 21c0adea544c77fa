// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/site_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <excavplan/site/site_settings.hpp>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

constexpr double line_tolerance = 1e-6;  // of a cell; ours

/// The layers of a site's ground but the surface's two, which are interpolated.
template <typename Ground>
auto cell_layers(Ground& ground) {
  return std::array{&ground.terrain.loose_void_ratio, &ground.terrain.obstacles, &ground.seen,
                    &ground.deviation};
}

template <typename Ground>
auto all_layers(Ground& ground) {
  return std::array{
      &ground.terrain.bank.z,    &ground.terrain.loose, &ground.terrain.loose_void_ratio,
      &ground.terrain.obstacles, &ground.seen,          &ground.deviation};
}

/// Cells of another grid about a place: four to interpolate between, and the nearest.
struct Sample {
  Cell lowest{}, nearest{};
  double along_x = 0.0, along_y = 0.0;  ///< share of the way to the next cells
};

std::optional<Sample> sample_at(const HeightMap& grid, const Eigen::Vector2d& place) {
  const Eigen::Vector2d at = (place - grid.origin) / grid.cell_size - Eigen::Vector2d(0.5, 0.5);
  const auto snapped = [](double value) {
    const double line = std::round(value);
    return std::abs(value - line) < line_tolerance ? line : value;
  };
  const double col = snapped(at.x());
  const double row = snapped(at.y());
  const auto index = [](double value) { return static_cast<Eigen::Index>(value); };
  const Sample sample = {{index(std::floor(row)), index(std::floor(col))},
                         {index(std::round(row)), index(std::round(col))},
                         col - std::floor(col),
                         row - std::floor(row)};
  const bool inside = sample.nearest.row >= 0 && sample.nearest.col >= 0 &&
                      sample.nearest.row < grid.z.rows() && sample.nearest.col < grid.z.cols();
  return inside ? std::optional(sample) : std::nullopt;
}

/// Bilinear where all cells that count are known, else that of the nearest cell.
double value_at(const Eigen::ArrayXXd& layer, const Sample& sample) {
  double sum = 0.0;
  for (const Eigen::Index up : {0, 1}) {
    for (const Eigen::Index right : {0, 1}) {
      const double weight = (up == 1 ? sample.along_y : 1.0 - sample.along_y) *
                            (right == 1 ? sample.along_x : 1.0 - sample.along_x);
      if (weight == 0.0) continue;
      const Eigen::Index row = sample.lowest.row + up;
      const Eigen::Index col = sample.lowest.col + right;
      const bool inside = row >= 0 && col >= 0 && row < layer.rows() && col < layer.cols();
      const double value = inside ? layer(row, col) : nan;
      if (std::isnan(value)) return layer(sample.nearest.row, sample.nearest.col);
      sum += weight * value;
    }
  }
  return sum;
}

GroundState like(const GroundState& ground, const HeightMap& grid) {
  GroundState made;
  made.terrain.bank = grid;
  made.terrain.bank.z = Eigen::ArrayXXd::Constant(grid.z.rows(), grid.z.cols(), nan);
  for (Eigen::ArrayXXd* layer : cell_layers(made)) *layer = made.terrain.bank.z;
  made.terrain.loose = Eigen::ArrayXXd::Zero(grid.z.rows(), grid.z.cols());
  made.frame = ground.frame;
  made.soil = ground.soil;
  return made;
}

}  // namespace

Rectangle on_grid(const Rectangle& extent, double cell_size) {
  const auto line = [&](double value, bool up) {
    const double cells = value / cell_size;
    return cell_size *
           (up ? std::ceil(cells - line_tolerance) : std::floor(cells + line_tolerance));
  };
  return {line(extent.x_min, false), line(extent.y_min, false), line(extent.x_max, true),
          line(extent.y_max, true)};
}

GroundState unseen_ground(const Rectangle& extent, double cell_size, double loose_void_ratio) {
  const Rectangle whole = on_grid(extent, cell_size);
  const double cells = std::round((whole.x_max - whole.x_min) / cell_size) *
                       std::round((whole.y_max - whole.y_min) / cell_size);
  if (!(cells <= most_site_cells)) {
    refuse("the site would have " + plain_number(cells) + " cells of " + plain_number(cell_size) +
           " m with this scan, most are " + plain_number(most_site_cells) +
           ": leave out what lies far away, or begin a site of larger cells");
  }
  GroundState ground = like({}, flat_ground(whole, cell_size));
  ground.terrain.loose_void_ratio.setConstant(loose_void_ratio);
  return ground;
}

GroundState grown(const GroundState& ground, const Rectangle& extent, double loose_void_ratio) {
  const HeightMap& bank = ground.terrain.bank;
  const Rectangle old = bank.extent();
  const Rectangle whole = {std::min(old.x_min, extent.x_min), std::min(old.y_min, extent.y_min),
                           std::max(old.x_max, extent.x_max), std::max(old.y_max, extent.y_max)};
  GroundState larger = unseen_ground(whole, bank.cell_size, loose_void_ratio);
  const Eigen::Vector2d shift = (bank.origin - larger.terrain.bank.origin) / bank.cell_size;
  const auto from = all_layers(ground);
  const auto to = all_layers(larger);
  for (std::size_t i = 0; i < from.size(); ++i) {
    to[i]->block(std::lround(shift.y()), std::lround(shift.x()), bank.z.rows(), bank.z.cols()) =
        *from[i];
  }
  larger.frame = ground.frame;
  larger.soil = ground.soil;
  return larger;
}

GroundState seen_by(const GroundState& ground, const BasePose& base, const HeightMap& grid) {
  GroundState seen = like(ground, grid);
  const HeightMap& whole = ground.terrain.bank;
  const auto from = cell_layers(ground);
  const auto to = cell_layers(seen);
  const Eigen::Isometry3d site_from_machine = base.site_from_machine();
  for_each_cell(grid.z, [&](Cell cell) {
    const Eigen::Vector3d place =
        site_from_machine * Eigen::Vector3d(grid.x(cell.col), grid.y(cell.row), 0.0);
    const auto sample = sample_at(whole, place.head<2>());
    if (!sample) return;
    seen.terrain.bank.z(cell.row, cell.col) = value_at(whole.z, *sample) - base.z;
    seen.terrain.loose(cell.row, cell.col) = value_at(ground.terrain.loose, *sample);
    for (std::size_t i = 0; i < from.size(); ++i) {
      (*to[i])(cell.row, cell.col) = (*from[i])(sample->nearest.row, sample->nearest.col);
    }
  });
  seen.terrain.obstacles -= base.z;
  return seen;
}

}  // namespace excavplan
