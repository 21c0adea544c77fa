// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "belief/belief_refit.hpp"

#include <cmath>
#include <functional>

#include <Eigen/Eigenvalues>

#include <excavplan/optimisation/search.hpp>

#include "belief/dual_form.hpp"

namespace excavplan {
namespace {

/// Deviations of the logarithms of spread, length and length over depth before anything is read:
/// 95 % of the spreads are then in 2.2 .. 23 points, of the lengths in 0.8 .. 19 m, of those over
/// depth in 0.4 .. 2.7 m. Ours.
const Eigen::Vector3d log_sds(0.6, 0.8, 0.5);
constexpr double reach = 3.0;  // of the search, in these deviations; ours
constexpr double step = 0.2;   // of the curvature, likewise; ours

/// The variance of a spread of log-normal distribution over the square of its median.
double mean_square(double log_variance) { return std::exp(2.0 * log_variance); }

BeliefSettings settings_at(BeliefSettings settings, const Eigen::Vector3d& deviations) {
  const Eigen::Vector3d factor = log_sds.cwiseProduct(deviations).array().exp();
  const BeliefSettings usual;
  settings.spread_percent =
      usual.spread_percent / std::sqrt(mean_square(log_sds(0) * log_sds(0))) * factor(0);
  settings.length = usual.length * factor(1);
  settings.depth_length = usual.depth_length * factor(2);
  return settings;
}

/// Variance of ln(spread) by the curvature of the posterior at its mode, at most that before.
double log_variance(const std::function<double(const Eigen::Vector3d&)>& log_posterior,
                    const Eigen::Vector3d& mode) {
  Eigen::Matrix3d curvature;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (const double a : {-step, step}) {
        for (const double b : {-step, step}) {
          sum += a * b *
                 log_posterior(mode + a * Eigen::Vector3d::Unit(i) + b * Eigen::Vector3d::Unit(j));
        }
      }
      curvature(i, j) = curvature(j, i) = -sum / (4.0 * std::pow(step, 4));
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(curvature);
  const Eigen::Array3d variances = 1.0 / solver.eigenvalues().array().max(1.0);
  const Eigen::Array3d parts = solver.eigenvectors().row(0).transpose().array().square();
  return log_sds(0) * log_sds(0) * (parts * variances).sum();
}

}  // namespace

BeliefSettings refitted(const BeliefSettings& settings, const std::vector<DigEvidence>& digs) {
  const auto log_posterior = [&](const Eigen::Vector3d& deviations) {
    DualForm dual(settings_at(settings, deviations));
    for (const DigEvidence& dig : digs) dual.add(dig);
    return dual.log_likelihood() - 0.5 * deviations.squaredNorm();
  };
  SearchProblem problem;
  problem.box = {Eigen::VectorXd::Constant(3, -reach), Eigen::VectorXd::Constant(3, reach)};
  problem.objective = [&](const Eigen::VectorXd& deviations) {
    return Evaluation(log_posterior(deviations));
  };
  MemeticSearch method;
  method.first_generation = 8;
  method.generations = 0;
  method.basins = 1;
  SearchOptions options;
  options.method = method;
  options.threads = 1;
  options.start = {Eigen::VectorXd::Zero(3)};
  const Eigen::Vector3d mode = search(problem, options).best;
  BeliefSettings result = settings_at(settings, mode);
  result.spread_percent *= std::sqrt(mean_square(log_variance(log_posterior, mode)));
  return result;
}

}  // namespace excavplan
