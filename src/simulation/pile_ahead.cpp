// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/pile_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double spare_top = 0.03;  // seen beyond a pile, as the next may be higher [m]; ours
constexpr double farthest = 5.0;    // that soil is sought a place from the level top [m]; ours

}  // namespace

void PileAhead::move_to(double lip_x, double level_length) {
  level_length_ = level_length;
  lip_x_ = lip_x;
  places_.clear();
  seen_to_ = -std::numeric_limits<double>::infinity();
}

/// Finds all places of a pile with this top: farther and farther out, until none is at the rim.
bool PileAhead::look(double top) {
  if (top <= seen_to_) return false;
  seen_to_ = top + spare_top;
  const double rim = 1.5 * ground_.cell_size();
  const Index lip = swath_.column(lip_x_);
  const CellBlock strip = {swath_.first_row(), swath_.end_row(), lip, lip + 1};
  for (double reach = foot_ + 2.0 * rim;; reach *= 1.5) {
    places_.clear();
    foot_ = 0.0;
    const double cells = (level_length_ + reach) / ground_.cell_size();
    seen_ = ground_.widened(strip, static_cast<Index>(std::ceil(cells)));
    ground_.cover(seen_);
    for (Index col = seen_.col_begin; col < seen_.col_end; ++col) look_at_column(col, reach);
    if (foot_ + rim < reach || reach > farthest) return true;
  }
}

void PileAhead::look_at_column(Index col, double reach) {
  const HeightMap& map = ground_.before().bank;
  const double left = map.origin.x() + map.cell_size * static_cast<double>(col);
  const double right = left + map.cell_size;
  // The bucket stands behind the lip; beside it there is room.
  const bool behind = left >= lip_x_;
  const double centre = 0.5 * (left + (behind ? right : std::min(right, lip_x_)));
  const double along = behind ? centre - lip_x_ : std::max(0.0, lip_x_ - centre - level_length_);
  const double ahead = behind ? 0.0 : std::min(1.0, (lip_x_ - left) / map.cell_size);
  if (along > reach) return;
  for (Index row = seen_.row_begin; row < seen_.row_end; ++row) {
    const bool beside = row < swath_.first_row() || row >= swath_.end_row();
    const double share = beside ? 1.0 : ahead;
    if (!(share > 0.0)) continue;
    const std::size_t cell = ground_.at(row, col);
    const double height = ground_.height(cell);
    if (std::isnan(height)) continue;
    const double across = beside ? std::abs(map.y(row)) - half_width_ : 0.0;
    const double distance = across > 0.0 ? std::sqrt(along * along + across * across) : along;
    if (distance > reach) continue;
    const double base = height + slope_ * distance;
    if (!(base < seen_to_)) continue;
    places_.push_back({cell, base, share});
    foot_ = std::max(foot_, distance);
  }
}

PileAhead::Size PileAhead::size(double top) const {
  const double cell_area = ground_.cell_size() * ground_.cell_size();
  Size size;
  for (const Place& place : places_) {
    const double thickness = top - place.base;
    if (!(thickness > 0.0)) continue;
    size.volume += place.share * thickness;
    size.area += place.share;
  }
  return {size.volume * cell_area, size.area * cell_area};
}

CellBlock PileAhead::lay(double top) {
  for (const Place& place : places_) {
    if (top > place.base) ground_.raise_loose(place.cell, place.share * (top - place.base));
  }
  return seen_;
}

}  // namespace excavplan
