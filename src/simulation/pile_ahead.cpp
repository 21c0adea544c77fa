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
    looked_at_ = 0;
    foot_ = 0.0;
    const auto around = static_cast<Index>(std::ceil(reach / cell));
    const auto ahead = static_cast<Index>(std::ceil(level_length_ / cell));
    const CellBlock level = {swath_.first_row(), swath_.end_row(), lip - ahead, lip + 1};
    seen_ = ground_.widened(level, around);
    ground_.cover(seen_);
    make_room();
    across_.clear();
    for (Index row = seen_.row_begin; row < seen_.row_end; ++row) {
      across_.push_back(std::max(0.0, std::abs(ground_.before().bank.y(row)) - half_width_));
    }
    for (Index col = seen_.col_begin; col < seen_.col_end; ++col) look_at_column(col, reach);
    if (foot_ + rim < reach || reach > farthest) return true;
  }
}

void PileAhead::make_room() {
  const auto all = static_cast<std::size_t>(seen_.rows() * seen_.cols());
  if (bases_.size() >= all) return;
  bases_.resize(all);
  distances_.resize(all);
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
  const double rows_beside = beside / map.cell_size;
  auto rows = static_cast<Index>(rows_beside);
  if (static_cast<double>(rows) < rows_beside) ++rows;
  Line line;
  line.first = std::max(seen_.row_begin, swath_.first_row() - rows);
  line.end = std::min(seen_.row_end, swath_.end_row() + rows);
  line.cell = ground_.at(line.first, col);
  line.bases = looked_at_;
  const auto count = static_cast<std::size_t>(line.end - line.first);
  looked_at_ += count;
  const std::size_t covered =
      find_bases({along, reach, slope_, seen_to_, count, ground_.heights(line.cell, count),
                  across_.data() + (line.first - seen_.row_begin)},
                 distances_.data() + line.bases, bases_.data() + line.bases);
  const double passed = lip_x_ - left;
  keep(line, covered, behind ? 0.0 : passed < map.cell_size ? passed / map.cell_size : 1.0);
}

/// Keeps what the pile may cover of a line.
///
/// @param covered  number of those cells
/// @param share_of_swath  of each cell before the bucket that is ahead of the lip
void PileAhead::keep(const Line& line, std::size_t covered, double share_of_swath) {
  if (covered == 0) return;
  constexpr double none = std::numeric_limits<double>::infinity();
  const double* bases = bases_.data() + line.bases - line.first;
  Index begin = line.first;
  Index last = line.end - 1;
  while (!(bases[last] < none)) --last;
  while (covered > 0) {
    while (!(bases[begin] < none)) ++begin;
    Index end = last + 1;
    if (end - begin > static_cast<Index>(covered)) {  // there are gaps
      for (end = begin + 1; bases[end] < none;) ++end;
    }
    covered -= static_cast<std::size_t>(end - begin);
    const Index swath = std::clamp(swath_.first_row(), begin, end);
    const Index beyond = std::clamp(swath_.end_row(), begin, end);
    keep_run(line, begin, swath, 1.0);
    keep_run(line, swath, beyond, share_of_swath);
    keep_run(line, beyond, end, 1.0);
    begin = end;
  }
}

/// Across the pile distances fall and rise: the farthest cell is one of the ends.
void PileAhead::keep_run(const Line& line, Index begin, Index end, double share) {
  if (begin == end || !(share > 0.0)) return;
  const auto from = static_cast<std::size_t>(begin - line.first);
  const auto count = static_cast<std::size_t>(end - begin);
  const double* distances = distances_.data() + line.bases + from;
  foot_ = std::max({foot_, distances[0], distances[count - 1]});
  Run& run = runs_.emplace_back();  // written in place: a copy waits for each of its members
  run.cell = line.cell + from;
  run.bases = line.bases + from;
  run.count = count;
  run.share = share;
}

double PileAhead::volume(double top) const {
  double volume = 0.0;
  for (const Run& run : runs_) {
    const double* bases = bases_.data() + run.bases;
    const double share = run.share;
    for (std::size_t i = 0; i < run.count; ++i) volume += share * std::max(0.0, top - bases[i]);
  }
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
    const double* bases = bases_.data() + run.bases;
    std::size_t i = 0;
    while (i < run.count) {
      while (i < run.count && !(top > bases[i])) ++i;
      const std::size_t begin = i;
      while (i < run.count && top > bases[i]) ++i;
      if (i == begin) break;
      ground_.raise_to(top, share * run.share, run.cell + begin, i - begin, bases + begin);
    }
  }
  return seen_;
}

}  // namespace excavplan
