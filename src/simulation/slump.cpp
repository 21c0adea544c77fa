// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/slump.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <excavplan/error.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

/// A cell: its row and column on the map and its index in the layers.
struct Place {
  Index row = 0;
  Index col = 0;
  std::size_t cell = 0;
};

/// How far the lower neighbour of a cell along one axis lies below, 0 if none does.
struct Fall {
  bool onwards = false;  ///< to the next row or column, else to the previous one
  double height = 0.0;
};

/// Soil slides along the gradient of the surface, taken on each axis to the lower of the two
/// neighbours (upwind, Rouy and Tourin 1992), so that heaps are as steep in every direction, not
/// only along the grid.
class Slump {
 public:
  Slump(GroundWindow& ground, const SlopeLimits& limits)
      : ground_(ground),
        limits_(limits),
        bank_{std::tan(ground.soil().bank.friction_angle), critical_height(ground.soil().bank)} {}

  /// One pass over the cells of the block that are awake; returns the cells that moved.
  CellBlock sweep(const CellBlock& block, int order) {
    moved_ = {};
    const Index first = (order & 2) != 0 ? block.row_end - 1 : block.row_begin;
    const Index along = (order & 2) != 0 ? -1 : 1;
    for (Index i = 0; i < block.cols(); ++i) {
      const Index col = (order & 1) != 0 ? block.col_end - 1 - i : block.col_begin + i;
      Place at = {first, col, ground_.at(first, col)};
      for (Index j = 0; j < block.rows(); ++j) {
        if (ground_.awake(at.cell)) relax(at);
        at.row += along;
        at.cell += static_cast<std::size_t>(along);
      }
    }
    return moved_;
  }

 private:
  struct BankLimits {
    double slope = 0.0;            ///< tangent of the friction angle
    double critical_height = 0.0;  ///< of a vertical wall [m]
  };

  void relax(const Place& at) {
    ground_.let_sleep(at.cell);
    if (std::isnan(ground_.height(at.cell))) return;
    if (ground_.loose(at.cell) > 0.0) slide_loose(at);
    if (!limits_.bank_stands) fail_bank(at);
  }

  /// From height `top` in a cell to the lower neighbour on an axis, `step` away. On a flank, where
  /// the other neighbour is higher, the fall is the mean over both sides: the lower side alone
  /// appears too steep where contours are curved (by 0.35 cells / radius on a cone's diagonal). But
  /// never much less than on that side, or steps could remain.
  Fall fall(double top, std::size_t cell, std::size_t step) const {
    constexpr double least = 0.85;  // of the fall on the lower side; ours
    const double before = drop(top, cell - step);
    const double after = drop(top, cell + step);
    const bool onwards = !(before >= after);
    const double lower = onwards ? after : before;
    const double other = onwards ? before : after;
    if (!(lower > 0.0)) return {};
    const double height = other < 0.0 ? std::max(0.5 * (lower - other), least * lower) : lower;
    return {onwards, std::min(height, lower)};
  }

  /// From height `top` down to a cell; 0 to cells that are unknown, walled or off the map.
  double drop(double top, std::size_t cell) const {
    const double drop = top - ground_.height(cell);
    return std::isnan(drop) ? 0.0 : drop;
  }

  /// How much has to leave a cell so that it falls no steeper than `slope`, if the share of each
  /// axis arrives swollen by `swell` below; 0 if it does not.
  double excess(const Fall& x, const Fall& y, double slope, double swell) const {
    const double stable = slope * ground_.cell_size();
    const double squared = x.height * x.height + y.height * y.height;
    if (!(squared > (stable + limits_.at_rest) * (stable + limits_.at_rest))) return 0.0;
    const double steepness = std::sqrt(squared);
    const double too_steep = steepness - stable;
    const double sum = x.height + y.height;
    const double closing =
        x.height * (1.0 + swell * x.height / sum) + y.height * (1.0 + swell * y.height / sum);
    return too_steep * steepness / closing;
  }

  void slide_loose(const Place& at) {
    const double top = ground_.height(at.cell);
    const Fall x = fall(top, at.cell, ground_.column_step());
    const Fall y = fall(top, at.cell, 1);
    const double swell = ground_.swollen_loose(at.cell, 1.0);
    const double leaving =
        std::min(ground_.loose(at.cell), excess(x, y, limits_.loose_slope, swell));
    if (!(leaving > 0.0)) return;
    ground_.lower_loose(at.cell, leaving);
    arrive(leaving * swell, at, x, y);
  }

  /// Breaks undisturbed soil off a wall that is too high; it falls to the foot as loose soil.
  void fail_bank(const Place& at) {
    const BankLimits bank = bank_limits(at);
    const double top = ground_.bank(at.cell) - bank.critical_height;
    const Fall x = fall(top, at.cell, ground_.column_step());
    const Fall y = fall(top, at.cell, 1);
    if (x.height + y.height == 0.0) return;
    const double swell = ground_.swollen_bank(at.row, at.col, 1.0);
    const double broken = excess(x, y, bank.slope, swell);
    if (!(broken > 0.0)) return;
    ground_.lower_bank(at.cell, broken);
    arrive(broken * swell, at, x, y);
  }

  /// Distributes the soil that has left a cell over both axes.
  void arrive(double thickness, const Place& from, const Fall& x, const Fall& y) {
    const double sum = x.height + y.height;
    CellBlock touched = {from.row, from.row + 1, from.col, from.col + 1};
    if (x.height != 0.0) {
      const std::size_t step = ground_.column_step();
      ground_.raise_loose(x.onwards ? from.cell + step : from.cell - step,
                          thickness * x.height / sum);
      (x.onwards ? touched.col_end : touched.col_begin) += x.onwards ? 1 : -1;
    }
    if (y.height != 0.0) {
      ground_.raise_loose(y.onwards ? from.cell + 1 : from.cell - 1, thickness * y.height / sum);
      (y.onwards ? touched.row_end : touched.row_begin) += y.onwards ? 1 : -1;
    }
    moved_.include(touched);
  }

  BankLimits bank_limits(const Place& at) const {
    if (ground_.bank_is_even()) return bank_;
    const SoilState state = ground_.bank_state(at.row, at.col);
    return {std::tan(state.friction_angle), critical_height(state)};
  }

  GroundWindow& ground_;
  SlopeLimits limits_;
  BankLimits bank_;
  CellBlock moved_;
};

}  // namespace

CellBlock slump(GroundWindow& ground, CellBlock block, const SlopeLimits& limits, int sweeps) {
  Slump slide(ground, limits);
  for (int i = 0; i < sweeps && !block.empty(); ++i) {
    block = ground.widened(block, 1);
    ground.cover(ground.widened(block, 1));
    block = slide.sweep(block, i % 4);
  }
  return block;
}

void pour(GroundWindow& ground, const Eigen::Vector2d& at, double volume, double slope) {
  const HeightMap& map = ground.before().bank;
  const double row_at = std::floor((at.y() - map.origin.y()) / map.cell_size);
  const double col_at = std::floor((at.x() - map.origin.x()) / map.cell_size);
  const bool on_map = row_at >= 0.0 && col_at >= 0.0 &&
                      row_at < static_cast<double>(map.z.rows()) &&
                      col_at < static_cast<double>(map.z.cols());
  const auto row = static_cast<Index>(on_map ? row_at : 0.0);
  const auto col = static_cast<Index>(on_map ? col_at : 0.0);
  if (!on_map || std::isnan(map.z(row, col))) {
    throw Error(ErrorKind::bad_input, "dump point (" + number_text(at.x()) + ", " +
                                          number_text(at.y()) +
                                          ") m must lie on known ground of the map");
  }
  // On ground up to nearly as steep as the cone, the heap stays within a few radii of level
  // ground's.
  const double radius = std::cbrt(3.0 * volume / (pi * slope));
  const CellBlock axis = {row, row + 1, col, col + 1};
  const CellBlock block =
      ground.widened(axis, static_cast<Index>(3.0 * radius / map.cell_size) + 2);
  ground.cover(block);
  const auto raised = [&](Index r, Index c, double apex) {
    const double distance = std::hypot(map.x(c) - at.x(), map.y(r) - at.y());
    const double rise = apex - slope * distance - ground.height(r, c);
    return rise > 0.0 ? rise : 0.0;  // 0 also on unknown cells
  };
  const auto poured = [&](double apex) {
    double sum = 0.0;
    for (Index c = block.col_begin; c < block.col_end; ++c) {
      for (Index r = block.row_begin; r < block.row_end; ++r) sum += raised(r, c, apex);
    }
    return sum * map.cell_size * map.cell_size;
  };
  double low = ground.height(row, col);
  double high = low + 1.0;
  while (poured(high) < volume) high += high - low;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (poured(middle) < volume ? low : high) = middle;
  }
  const double exact = volume > 0.0 ? volume / poured(high) : 0.0;  // corrects the rounding
  for (Index c = block.col_begin; c < block.col_end; ++c) {
    for (Index r = block.row_begin; r < block.row_end; ++r) {
      if (const double rise = raised(r, c, high); rise > 0.0) {
        ground.raise_loose(r, c, exact * rise);
      }
    }
  }
}

}  // namespace excavplan
