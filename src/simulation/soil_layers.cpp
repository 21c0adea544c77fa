// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "soil_layers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

using Eigen::Index;

struct Neighbour {
  Index row;
  Index col;
  double distance;  ///< in cells
};
constexpr double diagonal = 1.4142135623730951;
constexpr std::array<Neighbour, 8> neighbours = {{{-1, 0, 1.0},
                                                  {1, 0, 1.0},
                                                  {0, -1, 1.0},
                                                  {0, 1, 1.0},
                                                  {-1, -1, diagonal},
                                                  {-1, 1, diagonal},
                                                  {1, -1, diagonal},
                                                  {1, 1, diagonal}}};

/// Height differences below this are at rest [m]; ours: well under any scan's resolution.
constexpr double at_rest = 1e-4;

class Slump {
 public:
  Slump(Terrain& terrain, const SlopeLimits& limits)
      : bank_(terrain.bank.z), loose_(terrain.loose), cell_(terrain.bank.cell), limits_(limits) {}

  /// One pass over the block; returns the cells that moved.
  CellBlock sweep(const CellBlock& block, bool reversed) {
    CellBlock moved;
    const Index rows = block.row_end - block.row_begin;
    const Index cols = block.col_end - block.col_begin;
    for (Index i = 0; i < rows * cols; ++i) {
      const Index k = reversed ? rows * cols - 1 - i : i;
      relax(block.row_begin + k % rows, block.col_begin + k / rows, moved);
    }
    return moved;
  }

 private:
  double height(Index row, Index col) const { return bank_(row, col) + loose_(row, col); }

  void relax(Index row, Index col, CellBlock& moved) {
    if (loose_(row, col) > 0.0) slide_loose(row, col, moved);
    if (bank_can_fail(row, col)) fail_bank(row, col, moved);
  }

  /// Moves loose soil to all lower neighbours in proportion to how far each is too low.
  void slide_loose(Index row, Index col, CellBlock& moved) {
    const double here = height(row, col);
    std::array<double, 8> excess{};
    double sum = 0.0;
    double largest = 0.0;
    for (std::size_t n = 0; n < neighbours.size(); ++n) {
      const Index r = row + neighbours[n].row;
      const Index c = col + neighbours[n].col;
      if (!inside(r, c)) continue;
      const double too_high =
          here - height(r, c) - limits_.loose_slope * neighbours[n].distance * cell_;
      if (!(too_high > at_rest)) continue;  // also where the neighbour is unknown
      excess[n] = too_high;
      sum += too_high;
      largest = std::max(largest, too_high);
    }
    if (largest == 0.0) return;
    const double leaving = std::min(loose_(row, col), 0.5 * largest);
    for (std::size_t n = 0; n < neighbours.size(); ++n) {
      if (excess[n] == 0.0) continue;
      const double share = leaving * excess[n] / sum;
      loose_(row + neighbours[n].row, col + neighbours[n].col) += share;
      loose_(row, col) -= share;
      moved.include(row + neighbours[n].row, col + neighbours[n].col);
    }
    loose_(row, col) = std::max(0.0, loose_(row, col));
    moved.include(row, col);
  }

  bool bank_can_fail(Index row, Index col) const {
    const double stands = limits_.critical_height + limits_.bank_slope * cell_;
    for (std::size_t n = 0; n < 4; ++n) {
      const Index r = row + neighbours[n].row;
      const Index c = col + neighbours[n].col;
      if (inside(r, c) && bank_(row, col) - height(r, c) > stands + at_rest) return true;
    }
    return false;
  }

  /// Breaks undisturbed soil off a wall that is too high; it falls to the foot as loose soil.
  void fail_bank(Index row, Index col, CellBlock& moved) {
    for (std::size_t n = 0; n < 4; ++n) {
      const Index r = row + neighbours[n].row;
      const Index c = col + neighbours[n].col;
      if (!inside(r, c)) continue;
      const double too_high =
          bank_(row, col) - height(r, c) - limits_.critical_height - limits_.bank_slope * cell_;
      if (!(too_high > at_rest)) continue;
      const double broken = too_high / (1.0 + limits_.swell);
      bank_(row, col) -= broken;
      loose_(r, c) += broken * limits_.swell;
      moved.include(row, col);
      moved.include(r, c);
    }
  }

  bool inside(Index row, Index col) const {
    return row >= 0 && col >= 0 && row < bank_.rows() && col < bank_.cols();
  }

  Eigen::ArrayXXd& bank_;
  Eigen::ArrayXXd& loose_;
  double cell_;
  SlopeLimits limits_;
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

CellBlock slump(Terrain& terrain, CellBlock block, const SlopeLimits& limits, int sweeps) {
  Slump slide(terrain, limits);
  for (int i = 0; i < sweeps && !block.empty(); ++i) {
    block = slide.sweep(widened(block, terrain), i % 2 == 1);
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
