// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/search_functions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace excavplan::functions {

double hartmann(const Eigen::VectorXd& x) {
  const double a[4][3] = {{3, 10, 30}, {0.1, 10, 35}, {3, 10, 30}, {0.1, 10, 35}};
  const double p[4][3] = {{0.3689, 0.1170, 0.2673},
                          {0.4699, 0.4387, 0.7470},
                          {0.1091, 0.8732, 0.5547},
                          {0.0381, 0.5743, 0.8828}};
  const double c[4] = {1.0, 1.2, 3.0, 3.2};
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    double distance = 0.0;
    for (int j = 0; j < 3; ++j) distance += a[i][j] * (x(j) - p[i][j]) * (x(j) - p[i][j]);
    sum += c[i] * std::exp(-distance);
  }
  return sum;
}

double two_humps(const Eigen::VectorXd& x) {
  const auto hump = [&](double height, double place, double sigma) {
    const double far = (x.array() - place).square().sum();
    return height * std::exp(-0.5 * far / (sigma * sigma));
  };
  return std::max(hump(0.94, 0.3, 0.3), hump(1.0, 0.75, 0.08));
}

double efficiency(const Dig& dig, const Eigen::Vector3d& share) {
  return dig.efficiency(0.2 + 1.2 * share(0), 0.1 + 0.8 * share(1), 0.3 + 2.7 * share(2));
}

double maximum_of(const Dig& dig) {
  Eigen::Vector3d centre = Eigen::Vector3d::Constant(0.5);
  double best = 0.0;
  double half = 0.58;
  for (int round = 0; round < 12; ++round, half *= 0.4) {
    const int steps = round == 0 ? 70 : 12;
    const Eigen::Vector3d around = centre;
    for (int i = -steps; i <= steps; ++i) {
      for (int j = -steps; j <= steps; ++j) {
        for (int k = -steps; k <= steps; ++k) {
          const Eigen::Vector3d share = around + half / steps * Eigen::Vector3d(i, j, k);
          const double value = efficiency(dig, share);
          if (value > best) {
            best = value;
            centre = share;
          }
        }
      }
    }
  }
  return best;
}

double noise_at(const Eigen::VectorXd& u, double sd, std::uint64_t seed) {
  std::uint64_t stream = 0;
  for (const double number : u) {
    stream = Random(stream, static_cast<std::uint64_t>(number * 0x1.0p52)).bits();
  }
  return 1.0 + sd * Random(seed, stream).normal();
}

std::vector<DigFamily> dig_families() {
  std::vector<DigFamily> families = {{"fill d10", {0.1}},
                                     {"fill d90", {0.9}},
                                     {"grid", {0.5, true, true}},
                                     {"noisy", {0.5}, 0.01},
                                     {"smooth", {0.5, false}}};
  return families;
}

}  // namespace excavplan::functions
