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
constexpr double surely_beyond = 1.0 + 1e-9;  // whatever is rounded
constexpr double farthest = 5.0;  // that soil is sought a place from the level top [m]; ours

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
  const double cell = ground_.cell_size();
  const double rim = 1.5 * cell;
  const Index lip = swath_.nearest_column(lip_x_);
  for (double reach = foot_ + 2.0 * rim;; reach *= 1.5) {
    places_.clear();
    foot_ = 0.0;
    const auto around = static_cast<Index>(std::ceil(reach / cell));
    const auto ahead = static_cast<Index>(std::ceil(level_length_ / cell));
    const CellBlock level = {swath_.first_row(), swath_.end_row(), lip - ahead, lip + 1};
    seen_ = ground_.widened(level, around);
    ground_.cover(seen_);
    across_.clear();
    for (Index row = seen_.row_begin; row < seen_.row_end; ++row) {
      across_.push_back(std::max(0.0, std::abs(ground_.before().bank.y(row)) - half_width_));
    }
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
  if (along > reach) return;
  const double beside = std::sqrt(reach * reach - along * along);
  const auto rows = static_cast<Index>(std::ceil(beside / map.cell_size));
  const Index first = std::max(seen_.row_begin, swath_.first_row() - rows);
  const Index end = std::min(seen_.row_end, swath_.end_row() + rows);
  const double ahead = behind ? 0.0 : std::min(1.0, (lip_x_ - left) / map.cell_size);
  const ColumnAhead column = {col, along, reach};
  look_at_rows(first, swath_.first_row(), column, 1.0);
  if (ahead > 0.0) look_at_rows(swath_.first_row(), swath_.end_row(), column, ahead);
  look_at_rows(swath_.end_row(), end, column, 1.0);
}

/// `share`: of each cell that is ahead of the lip.
void PileAhead::look_at_rows(Index begin, Index end, const ColumnAhead& column, double share) {
  const double along_square = column.along * column.along;
  const double slope_square = slope_ * slope_;
  const double seen_to = seen_to_;
  const std::size_t first = ground_.at(begin, column.col);
  const double* across = across_.data() + (begin - seen_.row_begin);
  for (Index i = 0; i < end - begin; ++i) {
    const std::size_t cell = first + static_cast<std::size_t>(i);
    const double height = ground_.height(cell);
    const double square = along_square + across[i] * across[i];
    const double room = seen_to - height;
    if (slope_square * square > surely_beyond * room * room) continue;  // spares most roots
    const double distance = across[i] > 0.0 ? std::sqrt(square) : column.along;
    const double base = height + slope_ * distance;
    if (distance > column.reach || !(base < seen_to)) continue;  // also on unknown ground
    // Written in place: a copy of a whole Place waits for each of its members.
    Place& place = places_.emplace_back();
    place.cell = cell;
    place.base = base;
    place.share = share;
    foot_ = std::max(foot_, distance);
  }
}

PileAhead::Size PileAhead::size(double top) const {
  double volume = 0.0;
  double area = 0.0;
  for (const Place& place : places_) {
    volume += place.share * std::max(0.0, top - place.base);
    area += top > place.base ? place.share : 0.0;
  }
  const double cell_area = ground_.cell_size() * ground_.cell_size();
  return {volume * cell_area, area * cell_area};
}

CellBlock PileAhead::lay(double top, double share) {
  for (const Place& place : places_) {
    if (!(top > place.base)) continue;
    ground_.raise_loose(place.cell, share * place.share * (top - place.base));
  }
  return seen_;
}

}  // namespace excavplan
