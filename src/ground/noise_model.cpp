// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/angles.hpp"
#include "base/normal_equations.hpp"

namespace excavplan {
namespace {

struct Products {
  double sum = 0.0;
  double count = 0.0;
  double mean() const { return count > 0.0 ? sum / count : 0.0; }
};

Products products(const Eigen::ArrayXXd& field, Eigen::Index lag) {
  Products found;
  const auto add = [&](double product) {
    if (std::isnan(product)) return;
    found.sum += product;
    found.count += 1.0;
  };
  for (Eigen::Index col = 0; col < field.cols(); ++col) {
    for (Eigen::Index row = 0; row < field.rows(); ++row) {
      const double here = field(row, col);
      if (std::isnan(here)) continue;
      if (row + lag < field.rows()) add(here * field(row + lag, col));
      if (col + lag < field.cols()) add(here * field(row, col + lag));
    }
  }
  return found;
}

/// Empirical covariance by lag [cell], up to twice the first lag at which it is not significant.
struct Covariances {
  std::vector<Products> at_lag;
  std::size_t told = 1;  // lags before that one
};

Covariances empirical(const Eigen::ArrayXXd& residual) {
  constexpr double significant = 3.0;  // sd; ours
  Covariances found;
  found.at_lag.push_back(products(residual, 0));
  const double variance = found.at_lag[0].mean();
  const Eigen::Index farthest = std::min(residual.rows(), residual.cols()) / 3;
  double squares = 1.0;
  bool telling = variance > 0.0;
  for (Eigen::Index lag = 1; lag <= farthest; ++lag) {
    if (!telling && static_cast<std::size_t>(lag) > 2 * found.told) break;
    found.at_lag.push_back(products(residual, lag));
    const Products& here = found.at_lag.back();
    if (!telling || here.count == 0.0) continue;
    const double rho = here.mean() / variance;
    telling = rho > significant * std::sqrt(squares / here.count);
    if (!telling) continue;
    squares += 2.0 * pi * static_cast<double>(lag) * rho * rho;
    found.told = static_cast<std::size_t>(lag) + 1;
  }
  return found;
}

/// Weighted least squares on the variogram (Cressie 1985): its values at short lags, which
/// determine the shape, have small errors, and it does not depend on the mean of the residuals.
NoiseModel fit(const Covariances& covariances, double cell_size) {
  const double variance = covariances.at_lag[0].mean();
  const double longest = cell_size * static_cast<double>(covariances.at_lag.size());
  NoiseModel best;
  double least = std::numeric_limits<double>::infinity();
  for (const double power : {1.0, 1.25, 1.5, 1.75, 2.0}) {  // this grid is ours
    for (double length = 0.4 * cell_size; length < longest; length *= 1.06) {
      const NoiseModel shape{0.0, 1.0, length, power};
      NormalEquations<2> equations;
      for (std::size_t lag = 1; lag < covariances.at_lag.size(); ++lag) {
        const double value = variance - covariances.at_lag[lag].mean();
        equations.add({1.0, 1.0 - shape.at(cell_size * static_cast<double>(lag))}, value,
                      1.0 / std::max(value * value, 1e-4 * variance * variance));
      }
      const Eigen::Matrix2d& normal = equations.matrix();
      const Eigen::Vector2d& right = equations.right();
      Eigen::Vector2d sills = equations.solution();
      if (sills.x() < 0.0) sills = {0.0, right.y() / normal(1, 1)};
      if (!(sills.y() > 0.0)) continue;
      const double error = equations.squares() - 2.0 * sills.dot(right) + sills.dot(normal * sills);
      if (error >= least) continue;
      least = error;
      best = {sills.x(), sills.y(), length, power};
    }
  }
  return best;
}

}  // namespace

double NoiseModel::at(double distance) const {
  if (correlated == 0.0) return 0.0;
  const double ratio = distance / length;
  if (power == 2.0) return correlated * std::exp(-ratio * ratio);
  if (power == 1.0) return correlated * std::exp(-ratio);
  return correlated * std::exp(-std::pow(ratio, power));
}

double NoiseModel::integral() const {
  if (correlated == 0.0) return 0.0;
  return correlated * 2.0 * pi * length * length * std::tgamma(2.0 / power) / power;
}

NoiseModel find_noise(const Eigen::ArrayXXd& residual, double cell_size) {
  const Covariances covariances = empirical(residual);
  NoiseModel model;
  model.white = covariances.at_lag[0].mean();
  if (covariances.told < 2) return model;
  const NoiseModel fitted = fit(covariances, cell_size);
  return fitted.correlated > 0.0 ? fitted : model;
}

}  // namespace excavplan
