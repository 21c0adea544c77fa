// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/doming.hpp"

#include <algorithm>
#include <cmath>

#include "base/normal_equations.hpp"
#include "ground/grid_cells.hpp"
#include "ground/noise_model.hpp"

namespace excavplan {
namespace {

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

}  // namespace excavplan
