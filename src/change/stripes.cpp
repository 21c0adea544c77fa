// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/stripes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angles.hpp"
#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

struct StableCell {
  double x;  // [cell]
  double y;
  double residual;
};

/// The strips of one cell's width across a map, normal to a direction.
class Strips {
 public:
  Strips(double angle, const Eigen::ArrayXXd& map) : x_(std::cos(angle)), y_(std::sin(angle)) {
    const double across = x_ * static_cast<double>(map.cols() - 1);
    const double up = y_ * static_cast<double>(map.rows() - 1);
    first_ = std::min({0.0, across, up, across + up});
    const double last = std::max({0.0, across, up, across + up});
    sums_.assign(static_cast<std::size_t>(last - first_) + 1, 0.0);
    counts_ = sums_;
  }

  void add(const std::vector<StableCell>& cells, std::size_t stride) {
    for (std::size_t i = 0; i < cells.size(); i += stride) {
      const std::size_t strip = at(cells[i].x, cells[i].y);
      sums_[strip] += cells[i].residual;
      counts_[strip] += 1.0;
    }
  }

  std::size_t at(double x, double y) const {
    const double place = x_ * x + y_ * y - first_;
    return std::min(static_cast<std::size_t>(std::max(place, 0.0)), sums_.size() - 1);
  }
  std::size_t size() const { return sums_.size(); }
  double count(std::size_t strip) const { return counts_[strip]; }
  double mean(std::size_t strip) const {
    return counts_[strip] > 0.0 ? sums_[strip] / counts_[strip] : 0.0;
  }
  /// Part of the squares that means over strips explain.
  double explained() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < size(); ++i) sum += counts_[i] * mean(i) * mean(i);
    return sum;
  }

 private:
  double x_;
  double y_;
  double first_ = 0.0;
  std::vector<double> sums_;
  std::vector<double> counts_;
};

std::vector<StableCell> stable_cells(const Eigen::ArrayXXd& residual) {
  std::vector<StableCell> cells;
  double sum = 0.0;
  for_each_cell(residual, [&](Cell at) {
    const double value = residual(at.row, at.col);
    if (std::isnan(value)) return;
    cells.push_back({static_cast<double>(at.col), static_cast<double>(at.row), value});
    sum += value;
  });
  for (StableCell& cell : cells) cell.residual -= sum / static_cast<double>(cells.size());
  return cells;
}

/// The angle of the normal of the stripes, if there are any.
std::optional<double> find_stripes(const std::vector<StableCell>& cells,
                                   const Eigen::ArrayXXd& map) {
  constexpr int directions = 120;
  constexpr double to_usual = 2.0;  // ours: what strips explain, to the median of all directions
  constexpr double finest = 1e-3;   // [rad], a cell in a thousand
  constexpr std::size_t most_cells = 40000;
  const std::size_t stride = cells.size() / most_cells + 1;
  const auto explained = [&](double angle) {
    Strips strips(angle, map);
    strips.add(cells, stride);
    return strips.explained();
  };
  std::vector<double> values;
  for (int i = 0; i < directions; ++i) values.push_back(explained(pi * i / directions));
  const auto best = std::max_element(values.begin(), values.end());
  double angle = pi * static_cast<double>(best - values.begin()) / directions;
  double most = *best;
  for (double step = 0.5 * pi / directions; step > finest; step *= 0.5) {
    for (const double other : {angle - step, angle + step}) {
      const double value = explained(other);
      if (value <= most) continue;
      most = value;
      angle = other;
      break;
    }
  }
  if (!(most > to_usual * median(values))) return std::nullopt;
  return angle;
}

/// Subtracts the stripes of one direction and adds what is left of them to the variance.
void take_off(const std::vector<StableCell>& cells, double angle, ChangedGround& ground,
              std::vector<double>& variance) {
  Strips strips(angle, ground.residual);
  strips.add(cells, 1);
  double squares = 0.0;
  for (const StableCell& cell : cells) squares += cell.residual * cell.residual;
  const auto count = static_cast<double>(cells.size());
  const auto size = static_cast<double>(strips.size());
  const double within = (squares - strips.explained()) / std::max(1.0, count - size);
  const double between = std::max(0.0, (strips.explained() - size * within) / count);
  if (between == 0.0) return;
  const auto share = [&](std::size_t strip) {
    return strips.count(strip) * between / (strips.count(strip) * between + within);
  };
  std::vector<std::vector<double>> in_zone(variance.size(),
                                           std::vector<double>(strips.size(), 0.0));
  for_each_cell(ground.difference, [&](Cell at) {
    const std::size_t strip = strips.at(static_cast<double>(at.col), static_cast<double>(at.row));
    const double error = share(strip) * strips.mean(strip);
    ground.difference(at.row, at.col) -= error;
    ground.residual(at.row, at.col) -= error;
    const int zone = ground.zone(at.row, at.col);
    if (zone >= 0) in_zone[static_cast<std::size_t>(zone)][strip] += 1.0;
  });
  for (std::size_t i = 0; i < variance.size(); ++i) {
    for (std::size_t strip = 0; strip < strips.size(); ++strip) {
      variance[i] += std::pow(in_zone[i][strip], 2) * (1.0 - share(strip)) * between;
    }
  }
}

}  // namespace

std::vector<double> take_stripes_off(ChangedGround& ground) {
  constexpr int most_directions = 4;         // ours
  constexpr std::size_t fewest_cells = 400;  // ours
  std::vector<double> variance(ground.zone_is_cut.size(), 0.0);
  for (int i = 0; i < most_directions; ++i) {
    const std::vector<StableCell> cells = stable_cells(ground.residual);
    if (cells.size() < fewest_cells) break;
    const std::optional<double> angle = find_stripes(cells, ground.residual);
    if (!angle) break;
    take_off(cells, *angle, ground, variance);
  }
  return variance;
}

}  // namespace excavplan
