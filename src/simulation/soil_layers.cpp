// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "soil_layers.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

using Eigen::Index;

/// Slopes whose fall over a cell is too high by less than this are at rest [m]; ours: well under
/// any scan's resolution.
constexpr double at_rest = 1e-4;

/// The lower neighbour of a cell along one axis and how far it lies below, 0 if none does.
struct Fall {
  Index row = 0;
  Index col = 0;
  double height = 0.0;
};

/// Soil slides along the gradient of the surface, taken on each axis to the lower of the two
/// neighbours (upwind, Rouy and Tourin 1992), so that heaps are as steep in every direction, not
/// only along the grid.
class Slump {
 public:
  Slump(Terrain& terrain, const SlopeLimits& limits, const CellBlock& wall)
      : bank_(terrain.bank.z),
        loose_(terrain.loose),
        cell_(terrain.bank.cell),
        limits_(limits),
        wall_(wall) {}

  /// One pass over the block; returns the cells that moved.
  CellBlock sweep(const CellBlock& block, int order) {
    CellBlock moved;
    const Index rows = block.row_end - block.row_begin;
    const Index cols = block.col_end - block.col_begin;
    for (Index i = 0; i < cols; ++i) {
      const Index col = block.col_begin + ((order & 1) != 0 ? cols - 1 - i : i);
      for (Index j = 0; j < rows; ++j) {
        relax(block.row_begin + ((order & 2) != 0 ? rows - 1 - j : j), col, moved);
      }
    }
    return moved;
  }

 private:
  double height(Index row, Index col) const { return bank_(row, col) + loose_(row, col); }

  void relax(Index row, Index col, CellBlock& moved) {
    if (wall_.contains(row, col)) return;
    if (loose_(row, col) > 0.0) slide_loose(row, col, moved);
    if (std::isfinite(limits_.critical_height)) fail_bank(row, col, moved);
  }

  /// From height `top` in a cell to the lower neighbour on an axis. On a flank, where the other
  /// neighbour is higher, the fall is the mean over both sides: the lower side alone looks too
  /// steep where contours are curved (by 0.35 cells / radius on a cone's diagonal). But never much
  /// less than that side, or stairs could stand.
  Fall fall(double top, Index row, Index col, Index row_step, Index col_step) const {
    constexpr double least = 0.85;  // of the fall on the lower side; ours
    const double before = drop(top, row - row_step, col - col_step);
    const double after = drop(top, row + row_step, col + col_step);
    const bool down_before = before >= after;
    const double lower = down_before ? before : after;
    const double other = down_before ? after : before;
    if (!(lower > 0.0)) return {row, col, 0.0};
    const double height = other < 0.0 ? std::max(0.5 * (lower - other), least * lower) : lower;
    return {down_before ? row - row_step : row + row_step,
            down_before ? col - col_step : col + col_step, std::min(height, lower)};
  }

  /// From height `top` down to a cell; 0 to cells that are unknown, walled or off the map.
  double drop(double top, Index row, Index col) const {
    if (row < 0 || col < 0 || row >= bank_.rows() || col >= bank_.cols()) return 0.0;
    const double drop = top - height(row, col);
    return std::isnan(drop) || wall_.contains(row, col) ? 0.0 : drop;
  }

  /// How much has to leave a cell so that it falls no steeper than `slope`, if the share of each
  /// axis arrives swollen by `swell` below; 0 if it does not.
  double excess(const Fall& x, const Fall& y, double slope, double swell) const {
    const double steepness = std::hypot(x.height, y.height);
    const double too_steep = steepness - slope * cell_;
    if (!(too_steep > at_rest)) return 0.0;
    const double sum = x.height + y.height;
    const double closing =
        x.height * (1.0 + swell * x.height / sum) + y.height * (1.0 + swell * y.height / sum);
    return too_steep * steepness / closing;
  }

  void slide_loose(Index row, Index col, CellBlock& moved) {
    const double top = height(row, col);
    const Fall x = fall(top, row, col, 0, 1);
    const Fall y = fall(top, row, col, 1, 0);
    const double leaving = std::min(loose_(row, col), excess(x, y, limits_.loose_slope, 1.0));
    if (!(leaving > 0.0)) return;
    for (const Fall& to : {x, y}) {
      if (to.height == 0.0) continue;
      const double share = leaving * to.height / (x.height + y.height);
      loose_(to.row, to.col) += share;
      loose_(row, col) -= share;
      moved.include(to.row, to.col);
    }
    loose_(row, col) = std::max(0.0, loose_(row, col));
    moved.include(row, col);
  }

  /// Breaks undisturbed soil off a wall that is too high; it falls to the foot as loose soil.
  void fail_bank(Index row, Index col, CellBlock& moved) {
    const double top = bank_(row, col) - limits_.critical_height;
    const Fall x = fall(top, row, col, 0, 1);
    const Fall y = fall(top, row, col, 1, 0);
    if (x.height + y.height == 0.0) return;
    const double broken = excess(x, y, limits_.bank_slope, limits_.swell);
    if (!(broken > 0.0)) return;
    bank_(row, col) -= broken;
    for (const Fall& to : {x, y}) {
      if (to.height == 0.0) continue;
      loose_(to.row, to.col) += limits_.swell * broken * to.height / (x.height + y.height);
      moved.include(to.row, to.col);
    }
    moved.include(row, col);
  }

  Eigen::ArrayXXd& bank_;
  Eigen::ArrayXXd& loose_;
  double cell_;
  SlopeLimits limits_;
  CellBlock wall_;
};

CellBlock widened(CellBlock block, const Terrain& terrain) {
  if (block.empty()) return block;
  block.row_begin = std::max<Index>(0, block.row_begin - 1);
  block.col_begin = std::max<Index>(0, block.col_begin - 1);
  block.row_end = std::min(terrain.loose.rows(), block.row_end + 1);
  block.col_end = std::min(terrain.loose.cols(), block.col_end + 1);
  return block;
}

}  // namespace

void CellBlock::include(Index row, Index col) {
  if (empty()) {
    *this = {row, row + 1, col, col + 1};
    return;
  }
  row_begin = std::min(row_begin, row);
  row_end = std::max(row_end, row + 1);
  col_begin = std::min(col_begin, col);
  col_end = std::max(col_end, col + 1);
}

CellBlock slump(Terrain& terrain, CellBlock block, const SlopeLimits& limits, int sweeps,
                const CellBlock& wall) {
  Slump slide(terrain, limits, wall);
  for (int i = 0; i < sweeps && !block.empty(); ++i) {
    block = slide.sweep(widened(block, terrain), i % 4);
  }
  return block;
}

void pour(Terrain& terrain, const Eigen::Vector2d& at, double volume, double slope) {
  const HeightMap& bank = terrain.bank;
  const auto row = static_cast<Index>(std::floor((at.y() - bank.origin.y()) / bank.cell));
  const auto col = static_cast<Index>(std::floor((at.x() - bank.origin.x()) / bank.cell));
  if (row < 0 || col < 0 || row >= bank.z.rows() || col >= bank.z.cols() ||
      std::isnan(bank.z(row, col))) {
    throw Error(ErrorKind::bad_input, "dump point (" + std::to_string(at.x()) + ", " +
                                          std::to_string(at.y()) +
                                          ") m must lie on known ground of the map");
  }
  // On ground up to nearly as steep as the cone, the heap stays within a few radii of level
  // ground's.
  const double radius = std::cbrt(3.0 * volume / (3.14159265358979323846 * slope));
  const auto reach = static_cast<Index>(3.0 * radius / bank.cell) + 2;
  const CellBlock block = {
      std::max<Index>(0, row - reach), std::min(bank.z.rows(), row + reach + 1),
      std::max<Index>(0, col - reach), std::min(bank.z.cols(), col + reach + 1)};
  const auto raised = [&](Index r, Index c, double apex) {
    const double distance = std::hypot(bank.x(c) - at.x(), bank.y(r) - at.y());
    const double rise = apex - slope * distance - bank.z(r, c) - terrain.loose(r, c);
    return rise > 0.0 ? rise : 0.0;  // 0 also on unknown cells
  };
  const auto poured = [&](double apex) {
    double sum = 0.0;
    for (Index c = block.col_begin; c < block.col_end; ++c) {
      for (Index r = block.row_begin; r < block.row_end; ++r) sum += raised(r, c, apex);
    }
    return sum * bank.cell * bank.cell;
  };
  double low = bank.z(row, col) + terrain.loose(row, col);
  double high = low + 1.0;
  while (poured(high) < volume) high += high - low;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (poured(middle) < volume ? low : high) = middle;
  }
  const double exact = volume > 0.0 ? volume / poured(high) : 0.0;  // takes up the last rounding
  for (Index c = block.col_begin; c < block.col_end; ++c) {
    for (Index r = block.row_begin; r < block.row_end; ++r) {
      if (const double rise = raised(r, c, high); rise > 0.0) terrain.loose(r, c) += exact * rise;
    }
  }
}

}  // namespace excavplan
