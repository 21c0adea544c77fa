// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/ground_in_soil.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/input_file.hpp"
#include "base/text.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

/// Void ratios of relative densities; NaN stays.
Eigen::ArrayXXd void_ratios(const Eigen::ArrayXXd& density_percent, const SoilKind& soil,
                            double loosest) {
  const double range = soil.void_ratio_max - soil.void_ratio_min;
  return density_percent.unaryExpr([&](double density) {
    if (std::isnan(density)) return density;
    return std::clamp(soil.void_ratio_max - 0.01 * density * range, soil.void_ratio_min, loosest);
  });
}

void require_ratios(const std::string& file, const Eigen::ArrayXXd& ratios, const char* what,
                    std::pair<double, double> range) {
  for (const double ratio : ratios.reshaped()) {
    if (std::isnan(ratio) || (ratio >= range.first && ratio <= range.second)) continue;
    throw Error(ErrorKind::bad_file, file + ": a void ratio of the " + what + " is " +
                                         number_text(ratio) + ", those of the soil are in " +
                                         number_text(range.first) + " .. " +
                                         number_text(range.second));
  }
}

bool is_tiff(const std::string& path) {
  const InputFile file(path);
  std::array<char, 2> begin = {};
  if (file.size() < begin.size()) return false;
  file.read(0, begin.data(), begin.size());
  return begin[0] == begin[1] && (begin[0] == 'I' || begin[0] == 'M');
}

}  // namespace

GroundState ground_in_soil(const PlainGround& plain, const SoilKind& soil) {
  require_soil(soil);
  GroundState state = plain.ground;
  state.soil = soil.name;
  state.terrain.bank_void_ratio =
      void_ratios(plain.bank_density_percent, soil, soil.void_ratio_max);
  state.terrain.loose_void_ratio =
      void_ratios(plain.loose_density_percent, soil, soil.void_ratio_loose);
  return state;
}

GroundState load_ground(const std::string& file, const SoilKind& soil) {
  if (!is_tiff(file)) return ground_in_soil(load_plain_ground(file), soil);
  require_soil(soil);
  GroundState state = load_ground(file);
  const Terrain& terrain = state.terrain;
  const bool has_ratios = terrain.bank_void_ratio.size() + terrain.loose_void_ratio.size() > 0;
  if (has_ratios && !state.soil.empty() && state.soil != soil.name) {
    throw Error(ErrorKind::bad_file, file + ": its void ratios are of " + in_quotes(state.soil) +
                                         ", but the soil is " + in_quotes(soil.name));
  }
  require_ratios(file, terrain.bank_void_ratio, "bank", {soil.void_ratio_min, soil.void_ratio_max});
  require_ratios(file, terrain.loose_void_ratio, "loose layer",
                 {soil.void_ratio_min, soil.void_ratio_loose});
  return state;
}

Terrain terrain_to_dig(const GroundState& state, const SoilKind& soil, double density_percent) {
  const double of_bank = bank_state(soil, density_percent).void_ratio;
  Terrain terrain = state.terrain;
  Eigen::ArrayXXd& bank = terrain.bank_void_ratio;
  Eigen::ArrayXXd& loose = terrain.loose_void_ratio;
  bank = bank.isNaN().select(of_bank, bank).eval();
  if (loose.size() == 0)
    loose = Eigen::ArrayXXd::Constant(terrain.loose.rows(), terrain.loose.cols(),
                                      soil.void_ratio_loose);
  loose = loose.isNaN().select(soil.void_ratio_loose, loose).eval();
  return terrain;
}

std::optional<double> bank_density_percent(const Terrain& terrain, const SoilKind& soil,
                                           const Rectangle& where) {
  require_soil(soil);
  const Eigen::ArrayXXd& ratio = terrain.bank_void_ratio;
  double first = 0.0;
  double above = 0.0;  // what the others have more, so that even ground has its own number
  int cells = 0;
  for_each_cell(ratio, [&](Cell cell) {
    const bool is_there = where.contains(terrain.bank.x(cell.col), terrain.bank.y(cell.row)) &&
                          std::isfinite(terrain.bank.z(cell.row, cell.col));
    if (!is_there || std::isnan(ratio(cell.row, cell.col))) return;
    if (cells == 0) first = ratio(cell.row, cell.col);
    above += ratio(cell.row, cell.col) - first;
    ++cells;
  });
  if (cells == 0) return std::nullopt;
  const double range = soil.void_ratio_max - soil.void_ratio_min;
  return std::clamp(100.0 * (soil.void_ratio_max - first - above / cells) / range, 0.0, 100.0);
}

}  // namespace excavplan
