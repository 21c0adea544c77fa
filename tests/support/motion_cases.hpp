// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/random.hpp"
#include "support/motion_check.hpp"

/// @file
/// Random motions of random machines.

namespace excavplan::test {

Machine shipped_machine(const std::string& name);

/// The paper's path of the shipped machine on level ground, with its way down.
DigPath fixed_path();

/// A shipped machine with other limits.
Machine any_machine(Random& random);

MotionOptions any_options(Random& random);

/// Level, or a slope with a round heap or hollow somewhere, in a terrain all around the machine.
struct AnyGround {
  double slope = 0.0, rise = 0.0, x = 0.0, y = 0.0, radius = 1.0;

  AnyGround(const Machine& machine, Random& random) : radius(0.2 * machine.full_length()) {
    if (random.uniform() < 0.3) return;
    slope = random.uniform(-0.2, 0.2);
    rise = random.uniform(-0.1, 0.2) * radius;
    x = random.uniform(0.3, 0.9) * machine.full_length();
    y = random.uniform(-0.5, 0.5) * machine.full_length();
  }

  double height(double at_x, double at_y) const {
    const double away = std::hypot(at_x - x, at_y - y) / radius;
    return slope * std::max(0.0, at_x - 2.0 * radius) + rise * std::max(0.0, 1.0 - away);
  }

  /// Over this width about y = 0.
  double highest(double at_x, double width) const {
    double z = height(at_x, 0.0);
    for (const double share : {-0.5, -0.25, 0.25, 0.5}) {
      z = std::max(z, height(at_x, share * width));
    }
    return z;
  }

  Terrain terrain(const Machine& machine) const {
    HeightMap map;
    map.cell_size = 0.01 * machine.full_length();
    const double half = 1.2 * machine.full_length();
    const auto cells = static_cast<Eigen::Index>(2.0 * half / map.cell_size);
    map.origin = Eigen::Vector2d(-half, -half);
    map.z.resize(cells, cells);
    for (Eigen::Index row = 0; row < cells; ++row) {
      for (Eigen::Index col = 0; col < cells; ++col) {
        map.z(row, col) = height(map.x(col), map.y(row));
      }
    }
    return undisturbed(map);
  }
};

/// A dig anywhere on this ground. Nothing if it cannot be driven.
std::optional<DigPath> any_path(const Machine& machine, const AnyGround& ground, Random& random);

CycleWayOptions any_cycle(const Machine& machine, Random& random);

/// Of a random machine on random ground, from a random posture or none, with or without the rest of
/// the cycle. Nothing if it cannot be driven.
std::optional<MotionCase> any_motion(Random& random);

}  // namespace excavplan::test
