// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/systematic_errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angles.hpp"
#include "base/normal_equations.hpp"
#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/noise_model.hpp"

namespace excavplan {
namespace {

// ---- Stripes ------------------------------------------------------------------------------------

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
  values.reserve(directions);
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

// ---- Doming -------------------------------------------------------------------------------------

using Eigen::Index;
using Terms = Eigen::Matrix<double, 6, 1>;

/// A quadratic surface over a map, or a plane: least squares of the values that are known.
class Trend {
 public:
  Trend(const Eigen::ArrayXXd& values, Index terms)
      : rows_(static_cast<double>(values.rows())),
        columns_(static_cast<double>(values.cols())),
        count_(terms) {
    NormalEquations<Eigen::Dynamic> equations(terms);
    for_each_cell(values, [&](Cell at) {
      const double value = values(at.row, at.col);
      if (std::isnan(value)) return;
      equations.add(this->terms(at), value);
    });
    found_ = equations.solution();
    unit_covariance_ = equations.covariance();
  }

  double at(Cell cell) const { return found_.dot(terms(cell)); }
  Eigen::VectorXd terms(Cell at) const {
    const double x = (static_cast<double>(at.col) + 0.5) / columns_ - 0.5;
    const double y = (static_cast<double>(at.row) + 0.5) / rows_ - 0.5;
    return (Terms() << 1.0, x, y, x * x, x * y, y * y).finished().head(count_);
  }
  /// Of sums of terms, a column each, for values that err independently by `variance`.
  Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& sums, double variance) const {
    return variance * (sums.transpose() * unit_covariance_ * sums);
  }
  /// Of values less the trend.
  double mean_square(const Eigen::ArrayXXd& values) const {
    double squares = 0.0;
    double known = 0.0;
    for_each_cell(values, [&](Cell cell) {
      const double rest = values(cell.row, cell.col) - at(cell);
      if (std::isnan(rest)) return;
      squares += rest * rest;
      known += 1.0;
    });
    return squares / std::max(1.0, known - static_cast<double>(count_));
  }

 private:
  double rows_;
  double columns_;
  Index count_;
  Eigen::VectorXd found_;
  Eigen::MatrixXd unit_covariance_;
};

/// Means over square patches; NaN where less than half of one is known.
Eigen::ArrayXXd patches_of(const Eigen::ArrayXXd& values, Index side) {
  Eigen::ArrayXXd sums = Eigen::ArrayXXd::Zero(values.rows() / side, values.cols() / side);
  Eigen::ArrayXXd counts = sums;
  for_each_cell(values, [&](Cell at) {
    const double value = values(at.row, at.col);
    const Cell patch{at.row / side, at.col / side};
    if (std::isnan(value) || patch.row >= sums.rows() || patch.col >= sums.cols()) return;
    sums(patch.row, patch.col) += value;
    counts(patch.row, patch.col) += 1.0;
  });
  const double half = 0.5 * static_cast<double>(side * side);
  return (counts >= half).select(sums / counts, std::nan(""));
}

/// True if the patches of a map lie on a quadratic surface, and not on a plane.
bool is_bent(const Eigen::ArrayXXd& patches) {
  constexpr Index fewest = 24;        // ours: four for each term
  constexpr double explained = 0.85;  // ours: of the variance that a plane leaves
  if (patches.size() - patches.isNaN().count() < fewest) return false;
  const double flat = Trend(patches, 3).mean_square(patches);
  const double bent = Trend(patches, 6).mean_square(patches);
  return bent < (1.0 - explained) * flat;
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

Eigen::MatrixXd take_doming_off(ChangedGround& ground, double cell_size) {
  constexpr double patch = 0.4;  // [m], ours
  const auto zones = static_cast<Index>(ground.zone_is_cut.size());
  const auto side = std::max<Index>(1, static_cast<Index>(std::lround(patch / cell_size)));
  if (!is_bent(patches_of(ground.residual, side))) {
    return Eigen::MatrixXd::Zero(zones, zones);
  }
  const Trend dome(ground.residual, 6);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(6, zones);
  for_each_cell(ground.difference, [&](Cell at) {
    const double error = dome.at(at);
    ground.difference(at.row, at.col) -= error;
    ground.residual(at.row, at.col) -= error;
    const int zone = ground.zone(at.row, at.col);
    if (zone >= 0) sums.col(zone) += dome.terms(at);
  });
  const double of_cell = find_noise(ground.residual, cell_size).large_area_variance(cell_size);
  return dome.covariance_of(sums, of_cell);
}

Systematic take_systematic_off(ChangedGround& ground, double cell_size) {
  const Eigen::ArrayXXd before = ground.residual;
  Systematic errors{take_doming_off(ground, cell_size)};
  const std::vector<double> of_stripes = take_stripes_off(ground);
  for (std::size_t i = 0; i < of_stripes.size(); ++i) {
    errors.left(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += of_stripes[i];
  }
  const Eigen::ArrayXXd taken = before - ground.residual;
  const auto known = static_cast<double>(taken.size() - taken.isNaN().count());
  errors.rms = std::sqrt(taken.isNaN().select(0.0, taken.square()).sum() / std::max(1.0, known));
  return errors;
}

}  // namespace excavplan
