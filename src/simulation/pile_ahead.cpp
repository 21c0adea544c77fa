// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/pile_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "earth/dig_kernels.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double spare_top = 0.03;  // seen beyond a pile, as the next may be higher [m]; ours
constexpr double farthest = 5.0;    // that soil is sought a place from the level top [m]; ours

}  // namespace

void PileAhead::move_to(double lip_x, double level_length) {
  level_length_ = level_length;
  lip_x_ = lip_x;
  runs_.clear();
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
    runs_.clear();
    partly_ = {};
    kept_ = 0;
    foot_square_ = 0.0;
    const auto around = static_cast<Index>(std::ceil(reach / cell));
    const auto ahead = static_cast<Index>(std::ceil(level_length_ / cell));
    const CellBlock level = {swath_.first_row(), swath_.end_row(), lip - ahead, lip + 1};
    seen_ = ground_.widened(level, around);
    ground_.cover(seen_);
    find_rows();
    for (Index col = seen_.col_begin; col < seen_.col_end; ++col) look_at_column(col, reach);
    foot_ = std::sqrt(foot_square_);
    if (foot_ + rim < reach || reach > farthest) return true;
  }
}

void PileAhead::find_rows() {
  const auto all = static_cast<std::size_t>(seen_.rows() * seen_.cols()) + most_cells_of_a_line;
  if (bases_.size() < all) bases_.resize(all);
  across_.clear();
  for (Index row = seen_.row_begin; row < seen_.row_end; ++row) {
    across_.push_back(std::max(0.0, std::abs(ground_.before().bank.y(row)) - half_width_));
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
  const double beside = along > 0.0 ? std::sqrt(reach * reach - along * along) : reach;
  const auto rows = static_cast<Index>(beside / map.cell_size) + 1;
  const Index first = std::max(seen_.row_begin, swath_.first_row() - rows);
  const Index end = std::min(seen_.row_end, swath_.end_row() + rows);
  const Column column = {col, along, reach};
  const double passed = lip_x_ - left;
  if (!behind && passed >= map.cell_size) {
    look_at_rows(column, first, end, 1.0);
    return;
  }
  look_at_rows(column, first, swath_.first_row(), 1.0);
  if (!behind) look_at_rows(column, swath_.first_row(), swath_.end_row(), passed / map.cell_size);
  look_at_rows(column, swath_.end_row(), end, 1.0);
}

/// Keeps what the pile may cover of the rows.
///
/// @param share  of each cell that is ahead of the lip
void PileAhead::look_at_rows(const Column& column, Index first, Index end, double share) {
  const auto most = static_cast<Index>(most_cells_of_a_line);
  for (Index begin = first; begin < end; begin += most) {
    const auto count = static_cast<std::size_t>(std::min(end - begin, most));
    const std::size_t cell = ground_.at(begin, column.col);
    double* bases = bases_.data() + kept_;
    const CoveredCells covered =
        find_bases({column.along, column.reach, slope_, seen_to_, count,
                    ground_.heights(cell, count), across_.data() + (begin - seen_.row_begin)},
                   bases);
    if (covered.first == covered.end) continue;
    std::copy(bases + covered.first, bases + covered.end, bases);
    // Across the pile distances fall and rise: the farthest cell is one of the ends.
    foot_square_ =
        std::max({foot_square_, square(column, begin + static_cast<Index>(covered.first)),
                  square(column, begin + static_cast<Index>(covered.end) - 1)});
    Run& run = runs_.emplace_back();  // written in place: a copy waits for each of its members
    run.cell = cell + covered.first;
    run.bases = kept_;
    run.count = covered.end - covered.first;
    run.share = share;
    kept_ += run.count;
    if (share < 1.0) partly_ = run;
  }
}

/// Of the distance from the level top to a cell [m^2].
double PileAhead::square(const Column& column, Index row) const {
  const double across = across_[static_cast<std::size_t>(row - seen_.row_begin)];
  return column.along * column.along + across * across;
}

double PileAhead::volume(double top) const {
  const double* bases = bases_.data();
  const std::size_t end = partly_.bases + partly_.count;
  double volume = 0.0;
  for (std::size_t i = 0; i < partly_.bases; ++i) volume += std::max(0.0, top - bases[i]);
  for (std::size_t i = partly_.bases; i < end; ++i) {
    volume += partly_.share * std::max(0.0, top - bases[i]);
  }
  for (std::size_t i = end; i < kept_; ++i) volume += std::max(0.0, top - bases[i]);
  return volume * (ground_.cell_size() * ground_.cell_size());
}

double PileAhead::area(double top) const {
  double area = 0.0;
  for (const Run& run : runs_) {
    const double* bases = bases_.data() + run.bases;
    for (std::size_t i = 0; i < run.count; ++i) area += top > bases[i] ? run.share : 0.0;
  }
  return area * (ground_.cell_size() * ground_.cell_size());
}

CellBlock PileAhead::lay(double top, double share) {
  for (const Run& run : runs_) {
    ground_.raise_to({top, share * run.share}, run.cell, run.count, bases_.data() + run.bases);
  }
  return seen_;
}

}  // namespace excavplan
