// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "optimisation/evolution_polish.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace excavplan {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Numbers of Arnold and Hansen 2012, table 1, for n dimensions.
constexpr double aim = 2.0 / 11.0;  // share of steps that succeed
constexpr double fading_of_success = 1.0 / 12.0;
double damping(double n) { return 1.0 + 0.5 * n; }
double fading_of_path(double n) { return 2.0 / (n + 2.0); }
double growth(double n) { return 2.0 / (n * n + 6.0); }
double most_shrinking(double n) { return 0.4 / (std::pow(n, 1.6) + 1.0); }
double fading_of_constraints(double n) { return 1.0 / (n + 2.0); }
double retreat(double n) { return 0.1 / (n + 2.0); }
constexpr std::size_t generations_back = 5;

// Ours.
constexpr double longest = 0.3;           // steps, of the box
constexpr double shortest = 1e-3;         // steps that matter
constexpr int most_steps = 1500;          // those that are refused or known cost no evaluation
constexpr double most_constraints = 1e6;  // that are told apart

}  // namespace

EvolutionPolish::EvolutionPolish(const UnitCube& cube, const SearchRecord& start, int place,
                                 double step, std::uint64_t seed)
    : cube_(cube),
      random_(seed, static_cast<std::uint64_t>(place), 1),
      place_(place),
      at_(cube.inside(start.point)),
      outcome_(start.outcome),
      length_(step),
      shape_(MatrixXd::Identity(at_.size(), at_.size())),
      path_(VectorXd::Zero(at_.size())),
      success_(aim) {}

void EvolutionPolish::operator()(SearchLog::Strand& strand) {
  for (int i = 0; i < most_steps && length_ > shortest; ++i) {
    const Step step = draw();
    if (!(step.taken.norm() > 0.0)) continue;
    const auto found = strand.ask({cube_.point(step.to), SearchRecord::Origin::polish, {place_}});
    if (!found) return;
    if (!found->ok() && outcome_.ok()) {
      meet(step, found->violation);
    } else if (!better(outcome_, *found)) {
      succeed(step, *found);
    } else {
      fail(step, *found);
    }
  }
}

EvolutionPolish::Step EvolutionPolish::draw() {
  Step step;
  step.drawn.resize(at_.size());
  for (Eigen::Index i = 0; i < at_.size(); ++i) step.drawn(i) = random_.normal();
  step.to = (at_ + length_ * (shape_ * step.drawn)).cwiseMax(0.0).cwiseMin(1.0);
  for (Eigen::Index i = 0; i < at_.size(); ++i) {
    if (cube_.is_flat(i)) step.to(i) = at_(i);
  }
  step.taken = (step.to - at_) / length_;
  step.drawn = shape_.partialPivLu().solve(step.taken);
  return step;
}

void EvolutionPolish::meet(const Step& step, double violation) {
  const auto n = static_cast<double>(at_.size());
  VectorXd& met = constraints_
                      .try_emplace(static_cast<int>(std::min(violation, most_constraints)),
                                   VectorXd::Zero(at_.size()))
                      .first->second;
  met += fading_of_constraints(n) * (step.taken - met);
  const VectorXd drawn = shape_.partialPivLu().solve(met);
  shape_ -= retreat(n) / drawn.squaredNorm() * met * drawn.transpose();
}

void EvolutionPolish::succeed(const Step& step, const Evaluation& outcome) {
  const auto n = static_cast<double>(at_.size());
  adapt_length(true);
  const double fading = fading_of_path(n);
  path_ = (1.0 - fading) * path_ + std::sqrt(fading * (2.0 - fading)) * step.taken;
  change_along(path_, shape_.partialPivLu().solve(path_), growth(n));
  if (outcome_.ok()) earlier_.push_back(outcome_.fitness);
  at_ = step.to;
  outcome_ = outcome;
}

void EvolutionPolish::fail(const Step& step, const Evaluation& outcome) {
  adapt_length(false);
  const bool far_worse = earlier_.size() > generations_back &&
                         outcome.fitness < earlier_[earlier_.size() - generations_back];
  if (!far_worse) return;
  const double square = step.drawn.squaredNorm();
  double share = most_shrinking(static_cast<double>(at_.size()));
  if (square > 1.0) share = std::min(share, 1.0 / (2.0 * square - 1.0));
  change_along(shape_ * step.drawn, step.drawn, -share);
}

// NOLINTNEXTLINE(bugprone-easily-swappable-parameters)
void EvolutionPolish::change_along(const VectorXd& direction, const VectorXd& drawn, double share) {
  const double square = drawn.squaredNorm();
  const double all = std::sqrt(1.0 - share);
  const double along = 1.0 + share * square / (1.0 - share);
  if (!(along > 0.0) || !(square > 0.0)) return;
  shape_ = all * shape_ + all / square * (std::sqrt(along) - 1.0) * direction * drawn.transpose();
}

void EvolutionPolish::adapt_length(bool succeeded) {
  success_ += fading_of_success * ((succeeded ? 1.0 : 0.0) - success_);
  length_ *= std::exp((success_ - aim) / (1.0 - aim) / damping(static_cast<double>(at_.size())));
  length_ = std::min(length_, longest);
}

}  // namespace excavplan
