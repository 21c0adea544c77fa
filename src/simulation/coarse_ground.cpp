// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/coarse_ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simulation/ground_window.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The four cells of the finer ground in one of this, the first of them given.
template <typename Finer>
std::array<std::size_t, 4> parts_from(const Finer& finer, std::size_t first) {
  const std::size_t column = finer.column_step();
  return {first, first + 1, first + column, first + column + 1};
}

}  // namespace

void CoarseGround::lay_out(const CellBlock& cells) {
  if (cells_.contains(cells) && cells.contains(cells_)) return;
  cells_ = cells;
  stride_ = cells.rows() + 2;
  const auto size = static_cast<std::size_t>(stride_ * (cells.cols() + 2));
  bank_.assign(size, unknown);
  loose_.assign(size, 0.0);
  before_.assign(size, 0.0);
  height_.assign(size, unknown);
  awake_.assign(size, 0);
  slides_.assign(size, 0);
}

template <typename Finer>
void CoarseGround::look_at(const Finer& finer, const CellBlock& block, double wall) {
  lay_out(half(finer.cells()));
  cell_size_ = 2.0 * finer.cell_size();
  wall_ = wall;
  for (Index col = block.col_begin; col < block.col_end; ++col) {
    for (Index row = block.row_begin; row < block.row_end; ++row) {
      take_in(finer, finer.at(2 * row, 2 * col), at(row, col));
    }
  }
}

template <typename Finer>
void CoarseGround::take_in(const Finer& finer, std::size_t first, std::size_t i) {
  double low = finer.bank(first);
  double high = low;
  double top = finer.height(first);
  double height = 0.0;
  double bank = 0.0;
  double loose = 0.0;
  bool awake = false;
  bool slides = false;
  for (const std::size_t part : parts_from(finer, first)) {
    low = std::min(low, finer.bank(part));
    high = std::max(high, finer.bank(part));
    top = std::max(top, finer.height(part));
    height += 0.25 * finer.height(part);
    bank += 0.25 * finer.bank(part);
    if (finer.loose(part) > 0.0) loose += 0.25 * finer.swollen_loose(part, finer.loose(part));
    awake = awake || finer.awake(part);
    slides = slides || finer.slides(part);
  }
  const bool even = !std::isnan(bank) && high - low <= wall_;
  bank_[i] = even ? bank : unknown;
  height_[i] = even || std::isnan(height) ? height : top;
  loose_[i] = before_[i] = even ? loose : 0.0;
  awake_[i] = awake ? 1 : 0;
  slides_[i] = slides ? 1 : 0;
}

template <typename Finer>
CellBlock CoarseGround::give_back(Finer& finer, const CellBlock& block) const {
  CellBlock changed;
  for (Index col = block.col_begin; col < block.col_end; ++col) {
    for (Index row = block.row_begin; row < block.row_end; ++row) {
      const std::size_t i = at(row, col);
      const double gained = loose_[i] - before_[i];
      if (gained == 0.0) continue;
      for (const std::size_t part : parts_from(finer, finer.at(2 * row, 2 * col))) {
        if (gained > 0.0) {
          finer.raise_loose(part, gained);
        } else {
          finer.lower_loose(part, finer.loose(part) * (-gained / before_[i]));
        }
      }
      changed.include({2 * row, 2 * row + 2, 2 * col, 2 * col + 2});
    }
  }
  return changed;
}

template void CoarseGround::look_at(const GroundWindow&, const CellBlock&, double);
template void CoarseGround::look_at(const CoarseGround&, const CellBlock&, double);
template CellBlock CoarseGround::give_back(GroundWindow&, const CellBlock&) const;
template CellBlock CoarseGround::give_back(CoarseGround&, const CellBlock&) const;

}  // namespace excavplan
