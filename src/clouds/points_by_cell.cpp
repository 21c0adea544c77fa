// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/points_by_cell.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "base/statistics.hpp"
#include "clouds/stream_sample.hpp"

namespace excavplan {
namespace {

/// Points that are kept of a cell: more make its mean no better than a scan is. Ours.
constexpr std::size_t most_kept = most_points_of_cell;
constexpr double enough_in_group = 12.0;  // points, for a level that outliers do not move; ours
constexpr double largest_side = 4.0;      // ours

/// An even random choice of the points of a cell as they stream by: one of each of `kept`
/// stretches.
struct Choice {
  /// Which point of the cell stretch `number` keeps.
  std::size_t operator()(std::size_t number) const {
    if (kept == count) return number;
    const std::size_t first = number * count / kept;
    const std::size_t length = (number + 1) * count / kept - first;
    return first + Random(cell, number).index(length);
  }

  std::size_t cell;
  std::size_t count;
  std::size_t kept;
};

std::uint16_t within(double place) {
  return static_cast<std::uint16_t>(65536.0 * (place - std::floor(place)));
}

}  // namespace

PointsByCell::PointsByCell(const PointSource& source, const HeightMap& map, std::uint64_t memory)
    : source_(source),
      origin_(map.origin),
      per_cell_(1.0 / map.cell_size),
      rows_(map.z.rows()),
      columns_(map.z.cols()),
      counts_(static_cast<std::size_t>(map.z.size())) {
  count();
  choose_groups();
  part(std::max<std::uint64_t>(memory / sizeof(CellPoint), 1));
}

std::size_t PointsByCell::in_group(Eigen::Index group) const {
  std::size_t sum = 0;
  const Eigen::Index row = group % group_rows() * side_;
  const Eigen::Index column = group / group_rows() * side_;
  for (Eigen::Index c = column; c < std::min(column + side_, columns_); ++c) {
    for (Eigen::Index r = row; r < std::min(row + side_, rows_); ++r) {
      sum += kept(static_cast<std::size_t>(r + rows_ * c));
    }
  }
  return sum;
}

std::size_t PointsByCell::kept(std::size_t cell) const {
  return std::min<std::size_t>(counts_[cell], most_kept);
}

void PointsByCell::count() {
  StreamSample<double> heights(1024);
  source_([&](const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& point : points) {
      const Place place = locate(point);
      if (place.cell == outside) continue;
      ++counts_[place.cell];
      heights.add(point.z());
    }
  });
  std::vector<double> sample = heights.values();
  base_ = sample.empty() ? 0.0 : median(sample);
}

/// Groups of so many cells that they hold enough points.
void PointsByCell::choose_groups() {
  double points = 0.0;
  double cells = 0.0;
  for (const std::uint32_t count : counts_) {
    points += count;
    cells += count > 0 ? 1.0 : 0.0;
  }
  if (cells == 0.0) return;
  const double side = std::round(std::sqrt(enough_in_group * cells / points));
  side_ = static_cast<Eigen::Index>(std::clamp(side, 1.0, largest_side));
}

/// Bands of at most so many points, but of one cell or, with groups, their columns at least.
void PointsByCell::part(std::uint64_t most_points) {
  const std::size_t unit = side_ == 1 ? 1 : static_cast<std::size_t>(rows_ * side_);
  bands_.assign(1, 0);
  std::uint64_t points = 0;
  std::uint64_t most = 0;
  for (std::size_t first = 0; first < counts_.size(); first += unit) {
    std::uint64_t more = 0;
    for (std::size_t i = first; i < std::min(first + unit, counts_.size()); ++i) more += kept(i);
    if (points > 0 && points + more > most_points) {
      bands_.push_back(first);
      points = 0;
    }
    points += more;
    most = std::max(most, points);
  }
  bands_.push_back(counts_.size());
  // make_unique would write zeros over the whole block first.
  points_.reset(new CellPoint[most]);  // NOLINT(modernize-make-unique)
}

void PointsByCell::load(std::size_t band) {
  const std::size_t first = bands_[band];
  const std::size_t cells = bands_[band + 1] - first;
  begin_.assign(cells + 1, 0);
  for (std::size_t i = 0; i < cells; ++i) begin_[i + 1] = begin_[i] + kept(first + i);
  struct Cursor {
    std::uint32_t left;   // points of the cell that are still to come
    std::uint32_t until;  // left when the next one to keep comes
    std::uint64_t place;  // of that one
  };
  std::vector<Cursor> cursors(cells);
  const auto choose = [&](std::size_t i) {
    const std::uint32_t count = counts_[first + i];
    const Choice choice = {first + i, count, kept(first + i)};
    Cursor& cursor = cursors[i];
    cursor.until = cursor.place < begin_[i + 1]
                       ? count - static_cast<std::uint32_t>(choice(cursor.place - begin_[i]))
                       : 0;
  };
  for (std::size_t i = 0; i < cells; ++i) {
    cursors[i] = {counts_[first + i], 0, begin_[i]};
    choose(i);
  }
  source_([&](const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& point : points) {
      const Place place = locate(point);
      const std::size_t i = place.cell - first;
      if (i >= cells) continue;  // outside wraps to the largest number
      Cursor& cursor = cursors[i];
      if (cursor.left == 0) refuse_change();
      if (cursor.left-- != cursor.until) continue;
      points_[cursor.place++] = {within(place.column), within(place.row),
                                 static_cast<float>(point.z() - base_)};
      choose(i);
    }
  });
  for (const Cursor& cursor : cursors) {
    if (cursor.left != 0) refuse_change();
  }
  loaded_ = band;
}

void PointsByCell::gather(Eigen::Index group) {
  gathered_.clear();
  const Eigen::Index row = group % group_rows() * side_;
  const Eigen::Index column = group / group_rows() * side_;
  const auto scaled = [this](std::uint16_t v, Eigen::Index part) {
    const auto whole = static_cast<std::uint32_t>(part) * 65536U + v;
    return static_cast<std::uint16_t>(whole / static_cast<std::uint32_t>(side_));
  };
  for (Eigen::Index c = 0; c < std::min(side_, columns_ - column); ++c) {
    for (Eigen::Index r = 0; r < std::min(side_, rows_ - row); ++r) {
      const auto cell = static_cast<std::size_t>(row + r + rows_ * (column + c));
      if (counts_[cell] == 0) continue;
      for (const CellPoint& point : points_of(cell)) {
        gathered_.push_back({scaled(point.x, c), scaled(point.y, r), point.z});
      }
    }
  }
}

}  // namespace excavplan
