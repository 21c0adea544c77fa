// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "base/random.hpp"

namespace excavplan {

/// Space-filling points: the additive recurrence of Roberts ("The unreasonable effectiveness of
/// quasirandom sequences", 2018) from a random first point.
class SpaceFilling {
 public:
  SpaceFilling(Eigen::Index dimensions, std::uint64_t seed)
      : first_(dimensions), step_(dimensions) {
    double root = 2.0;  // of x^(n + 1) = x + 1
    const auto n = static_cast<double>(dimensions);
    for (int i = 0; i < 60; ++i) root = std::pow(1.0 + root, 1.0 / (1.0 + n));
    Random random(seed, 0);
    for (Eigen::Index i = 0; i < dimensions; ++i) {
      first_(i) = random.uniform();
      step_(i) = std::pow(root, -1.0 - static_cast<double>(i));
    }
  }
  Eigen::VectorXd next() {
    Eigen::VectorXd u = first_ + static_cast<double>(drawn_++) * step_;
    return u.array() - u.array().floor();
  }

 private:
  Eigen::VectorXd first_;
  Eigen::VectorXd step_;
  int drawn_ = 0;
};

}  // namespace excavplan
