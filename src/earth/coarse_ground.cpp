// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "earth/coarse_ground.hpp"

#include <algorithm>
#include <cmath>

#include "base/non_finite.hpp"

namespace excavplan {

void CoarseGround::lay_out(const CellBlock& finer, double finer_cell_size, double wall) {
  cell_size_ = 2.0 * finer_cell_size;
  wall_ = wall;
  const CellBlock cells = half(finer);
  if (cells_.contains(cells) && cells.contains(cells_)) return;
  cells_ = cells;
  stride_ = cells.rows() + 2;
  const auto size = static_cast<std::size_t>(stride_ * (cells.cols() + 2));
  bank_.assign(size, nan);
  loose_.assign(size, 0.0);
  before_.assign(size, 0.0);
  height_.assign(size, nan);
  awake_.assign(size, 0);
  slides_.assign(size, 0);
}

void CoarseGround::take_in(const std::array<Part, 4>& parts, std::size_t cell) {
  double low = parts.front().bank;
  double high = low;
  double top = parts.front().height;
  double height = 0.0;
  double bank = 0.0;
  double loose = 0.0;
  bool awake = false;
  bool slides = false;
  for (const Part& part : parts) {
    low = std::min(low, part.bank);
    high = std::max(high, part.bank);
    top = std::max(top, part.height);
    height += 0.25 * part.height;
    bank += 0.25 * part.bank;
    loose += 0.25 * part.loose;
    awake = awake || part.awake;
    slides = slides || part.slides;
  }
  const bool even = !std::isnan(bank) && high - low <= wall_;
  bank_[cell] = even ? bank : nan;
  height_[cell] = even || std::isnan(height) ? height : top;
  loose_[cell] = before_[cell] = even ? loose : 0.0;
  awake_[cell] = awake ? 1 : 0;
  slides_[cell] = slides ? 1 : 0;
}

}  // namespace excavplan
