// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/random.hpp"

/// @file
/// Functions to try optimisers on, with known maxima. For tests and benchmarks.

namespace excavplan::functions {

/// To be maximised over the unit cube; 0 where a dig is impossible.
struct Function {
  std::string name;
  std::function<double(const Eigen::VectorXd&)> value;
  double maximum = 0.0;
  int dimensions = 3;
  /// What the optimiser sees, if that is not the value: its noise.
  std::function<double(const Eigen::VectorXd&)> seen = nullptr;
  /// How far from feasible a point is that costs no evaluation; nothing for all others.
  std::function<std::optional<double>(const Eigen::VectorXd&)> refused = nullptr;
};

/// Hartmann's function in three dimensions; maximum 3.86278 at (0.114614, 0.555649, 0.852547)
/// (Hartmann 1972; Dixon and Szegoe 1978).
double hartmann(const Eigen::VectorXd& x);

/// A broad hump of 0.94 and a narrow one of 1, each a Gaussian.
double two_humps(const Eigen::VectorXd& x);

/// An excavation-like model over penetration angle 0.2-1.4 rad, penetration length 0.1-0.9 m and
/// drag length 0.3-3.0 m: what the bucket lifts per energy. Ours; the numbers make its shape, not a
/// soil: a bucket that spills when over-full (a cliff of 8 %), too shallow, too deep, out of reach
/// and heel on the ground (a plateau of zero over 40 % of the box).
struct Dig {
  double density = 0.1;    ///< 0 .. 1
  bool full_limit = true;  ///< the bucket has a volume
  bool in_steps = false;   ///< 0.02 rad, 2 cm, 5 cm, as a coarse machine or simulator has it

  double efficiency(double angle, double length, double drag) const {
    if (in_steps) {
      angle = 0.02 * std::round(angle / 0.02);
      length = 0.02 * std::round(length / 0.02);
      drag = 0.05 * std::round(drag / 0.05);
    }
    const double depth = length * std::sin(angle);
    const bool heel = angle < 0.17 + 0.22 * drag;
    const bool out_of_reach = length * std::cos(angle) + drag > 2.9;
    if (depth < 0.06 || depth > 0.65 || heel || out_of_reach || drag <= 0.0) return 0.0;
    const double swept = depth * drag + 0.5 * depth * length * std::cos(angle);
    double volume = swept;
    if (full_limit) {
      constexpr double bucket = 0.45;
      volume = std::min(swept, bucket);
      if (swept > 1.1 * bucket) volume *= 0.92;
    }
    const double strength = 1.0 + 4.0 * density;
    const double blade = 1.0 + 1.5 * (angle - 0.75) * (angle - 0.75);
    const double energy = 5.0 + strength * blade * (9.0 * length * depth + 22.0 * depth * swept) +
                          (2.0 + 2.0 * density) * drag + 9.0 * swept;
    return 1700.0 * volume / energy;
  }
};

/// A dig model as one seed sees it: axes flipped, warped and shifted, so that no optimiser profits
/// from where its points happen to lie.
class Warp {
 public:
  explicit Warp(std::uint64_t seed) {
    Random random(seed, 77);
    for (int i = 0; i < 3; ++i) {
      flip_[i] = random.uniform() < 0.5;
      power_[i] = std::exp(random.uniform(std::log(0.55), std::log(1.8)));
      shift_[i] = random.uniform(-0.08, 0.08);
    }
  }
  Eigen::Vector3d operator()(const Eigen::VectorXd& u) const {
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i) {
      const double x = std::clamp(u(i), 0.0, 1.0);
      v(i) = std::pow(flip_[i] ? 1.0 - x : x, power_[i]) + shift_[i];
    }
    return v;
  }

 private:
  bool flip_[3] = {};
  double power_[3] = {};
  double shift_[3] = {};
};

double efficiency(const Dig& dig, const Eigen::Vector3d& share);

/// The maximum over all shifted boxes: a dense scan, refined around the best of it.
double maximum_of(const Dig& dig);

/// White noise that is the same at the same point: `sd` as a share of the value.
double noise_at(const Eigen::VectorXd& u, double sd, std::uint64_t seed);

/// The five dig models, as functions of a seed.
struct DigFamily {
  std::string name;
  Dig dig;
  double noise = 0.0;
  double maximum = maximum_of(dig);

  Function function(std::uint64_t seed) const {
    const auto value = [model = dig, warp = Warp(seed)](const Eigen::VectorXd& u) {
      return efficiency(model, warp(u));
    };
    Function result{name, value, maximum};
    if (noise > 0.0) {
      result.seen = [value, sd = noise, seed](const Eigen::VectorXd& u) {
        return value(u) * noise_at(u, sd, seed);
      };
    }
    return result;
  }
};

std::vector<DigFamily> dig_families();

}  // namespace excavplan::functions
