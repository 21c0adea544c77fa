// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/sight_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/non_finite.hpp"
#include "base/statistics.hpp"

namespace excavplan {
namespace {

/// Points that a whole cell of level ground holds. Equal angles between rays give points per area
/// in proportion to height over range^3.
class PointsOfLevelCell {
 public:
  explicit PointsOfLevelCell(const Surface& surface) : surface_(surface) {
    std::vector<double> ratios;
    for_each_cell(surface.points, [&](Cell at) {
      const int points = surface.points(at.row, at.col);
      if (points > 0) ratios.push_back(points / shape(at));
    });
    if (!ratios.empty()) scale_ = median(ratios);
  }
  double operator()(Cell at) const { return scale_ * shape(at); }

 private:
  double shape(Cell at) const {
    const HeightMap& map = surface_.height;
    const Eigen::Vector3d ray =
        surface_.sensors[0] - Eigen::Vector3d(map.x(at.col), map.y(at.row), map.z(at.row, at.col));
    return std::max(0.05 * ray.norm(), ray.z()) / std::pow(ray.norm(), 3);
  }

  const Surface& surface_;
  double scale_ = 0.0;
};

int unknown_around(const Eigen::ArrayXXd& z, Cell at) {
  int unknown = 0;
  for (Eigen::Index c = at.col - 1; c <= at.col + 1; ++c) {
    for (Eigen::Index r = at.row - 1; r <= at.row + 1; ++r) {
      if (r < 0 || c < 0 || r >= z.rows() || c >= z.cols()) continue;
      unknown += std::isnan(z(r, c)) ? 1 : 0;
    }
  }
  return unknown;
}

}  // namespace

SightLines::SightLines(const HeightMap& map, const Eigen::Vector3d& sensor)
    : SightLines(map, sensor, map.z) {}

SightLines::SightLines(const HeightMap& map, const Eigen::Vector3d& sensor,
                       const Eigen::ArrayXXd& seen)
    : map_(map),
      sensor_(sensor),
      range_(map.z.rows(), map.z.cols()),
      tangent_(Eigen::ArrayXXd::Constant(map.z.rows(), map.z.cols(), infinity)) {
  struct Far {
    double range;
    Cell at;
  };
  std::vector<Far> cells;
  cells.reserve(static_cast<std::size_t>(map.z.size()));
  for_each_cell(map.z, [&](Cell at) {
    const double range = std::hypot(map.x(at.col) - sensor.x(), map.y(at.row) - sensor.y());
    range_(at.row, at.col) = range;
    cells.push_back({range, at});
  });
  std::sort(cells.begin(), cells.end(),
            [](const Far& a, const Far& b) { return a.range > b.range; });
  for (const Far& cell : cells) {
    const Cell at = cell.at;
    const Behind next = behind(at);
    const double one = tangent_at(next.one, seen);
    const double two = tangent_at(next.two, seen);
    const bool both = std::isfinite(one) && std::isfinite(two);
    tangent_(at.row, at.col) =
        both ? (1.0 - next.share) * one + next.share * two : std::min(one, two);
  }
}

double SightLines::ceiling(Cell at) const {
  return sensor_.z() + tangent_(at.row, at.col) * range(at);
}

Eigen::Vector2d SightLines::outward(Cell at) const {
  const Eigen::Vector2d way = Eigen::Vector2d(map_.x(at.col), map_.y(at.row)) - sensor_.head<2>();
  return way / std::max(way.norm(), 1e-9);
}

bool SightLines::faces_unseen(Cell at) const {
  const Behind next = behind(at);
  const auto unseen = [&](Cell n) { return is_inside(n) && std::isnan(map_.z(n.row, n.col)); };
  return unseen(next.one) && unseen(next.two);
}

double SightLines::cells_to_rim(Cell at) const {
  constexpr double least_fall = 0.02;  // ours: of a ray that is nearly level
  const double fall = std::max(least_fall, -tangent_(at.row, at.col)) * map_.cell_size;
  return (ceiling(at) - map_.z(at.row, at.col)) / fall;
}

bool SightLines::hides(Cell at) const {
  constexpr double most_share = 0.4;  // ours: of the way to what is seen next
  if (!faces_unseen(at)) return false;
  const Eigen::Vector2d way = outward(at);
  const Eigen::Vector2d step = way / way.lpNorm<Eigen::Infinity>();
  double unseen = 0.0;
  Cell next = at;
  do {
    unseen += 1.0;
    next = {at.row + std::lround(unseen * step.y()), at.col + std::lround(unseen * step.x())};
  } while (is_inside(next) && std::isnan(map_.z(next.row, next.col)));
  return cells_to_rim(at) < 1.0 + most_share * unseen * step.norm();
}

SightLines::Behind SightLines::behind(Cell at) const {
  const Eigen::Vector2d way = outward(at);
  const double longer = std::max({std::abs(way.x()), std::abs(way.y()), 1e-9});
  const auto step = [](double along) { return static_cast<Eigen::Index>(std::lround(along)); };
  const auto sign = [](double along) { return along < 0.0 ? Eigen::Index{-1} : Eigen::Index{1}; };
  if (std::abs(way.x()) >= std::abs(way.y())) {
    const Eigen::Index col = at.col + step(way.x() / longer);
    return {{at.row, col}, {at.row + sign(way.y()), col}, std::abs(way.y()) / longer};
  }
  const Eigen::Index row = at.row + step(way.y() / longer);
  return {{row, at.col}, {row, at.col + sign(way.x())}, std::abs(way.x()) / longer};
}

bool SightLines::is_inside(Cell at) const {
  return at.row >= 0 && at.col >= 0 && at.row < map_.z.rows() && at.col < map_.z.cols();
}

double SightLines::tangent_at(Cell at, const Eigen::ArrayXXd& seen) const {
  if (!is_inside(at)) return infinity;
  const double height = seen(at.row, at.col);
  const double own =
      std::isnan(height) ? infinity : (height - sensor_.z()) / std::max(range(at), map_.cell_size);
  return std::min(own, tangent_(at.row, at.col));
}

AllSightLines::AllSightLines(const HeightMap& map, const Surface& places)
    : seen_from_(places.seen_from) {
  lines_.reserve(places.sensors.size());
  for (std::size_t i = 0; i < places.sensors.size(); ++i) {
    Eigen::ArrayXXd seen = map.z;
    for_each_cell(seen, [&](Cell at) {
      if (!sees(i, at)) seen(at.row, at.col) = std::numeric_limits<double>::quiet_NaN();
    });
    lines_.emplace_back(map, places.sensors[i], seen);
  }
}

double AllSightLines::ceiling(Cell at) const {
  double lowest = infinity;
  for (const SightLines& lines : lines_) lowest = std::min(lowest, lines.ceiling(at));
  return lowest;
}

bool AllSightLines::faces_unseen(Cell at) const {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (sees(i, at) && lines_[i].faces_unseen(at)) return true;
  }
  return false;
}

const SightLines* AllSightLines::hidden_by(Cell at) const {
  const auto found = std::find_if(lines_.begin(), lines_.end(),
                                  [&](const SightLines& lines) { return lines.hides(at); });
  return found == lines_.end() ? nullptr : &*found;
}

bool AllSightLines::sees(std::size_t place, Cell at) const {
  return seen_from_.size() == 0 || ((seen_from_(at.row, at.col) >> place) & 1) != 0;
}

Eigen::ArrayXXi drop_mixed_returns(Surface& surface) {
  Eigen::ArrayXXd& z = surface.height.z;
  Eigen::ArrayXXi dropped = Eigen::ArrayXXi::Zero(z.rows(), z.cols());
  if (surface.sensors.size() != 1 || surface.points.size() == 0) return dropped;
  constexpr double least_share = 0.5;  // of the points: the rest ends at the rim on average
  constexpr double least_step = 0.35;  // ours: of a cell; mixed returns lie along one ray
  constexpr double fewest = 4.0;       // ours: points that tell a part of a cell from the whole
  constexpr int most_unseen = 2;       // ours: cells around a part of the ground
  const PointsOfLevelCell whole(surface);
  const SightLines sight(surface.height, surface.sensors[0]);
  std::vector<Cell> part;
  for_each_cell(z, [&](Cell at) {
    if (!(surface.points(at.row, at.col) < least_share * whole(at))) return;
    if (std::isnan(z(at.row, at.col))) return;
    if (sight.cells_to_rim(at) < least_step) dropped(at.row, at.col) = 1;
    if (whole(at) >= fewest) part.push_back(at);
  });
  const auto drop = [&] {
    z = (dropped != 0).select(std::numeric_limits<double>::quiet_NaN(), z);
    if (surface.variance.size() == 0) return;
    surface.variance =
        (dropped != 0).select(std::numeric_limits<double>::quiet_NaN(), surface.variance);
  };
  drop();
  for (const Cell at : part) {
    if (unknown_around(z, at) > most_unseen) dropped(at.row, at.col) = 1;
  }
  drop();
  return dropped;
}

}  // namespace excavplan
