// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/site_shapes.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace excavplan::scenes {

double flat(double, double) { return 0.0; }

Height sum_of(std::vector<Height> parts) {
  return [parts = std::move(parts)](double x, double y) {
    double z = 0.0;
    for (const Height& part : parts) z += part(x, y);
    return z;
  };
}

Height largest_of(std::vector<Height> parts) {
  return [parts = std::move(parts)](double x, double y) {
    double z = 0.0;
    for (const Height& part : parts) {
      const double other = part(x, y);
      if (std::abs(other) > std::abs(z)) z = other;
    }
    return z;
  };
}

double volume_of(const Height& height, const Rectangle& extent) {
  constexpr double step = 0.01;
  double sum = 0.0;
  for (double x = extent.x_min + 0.5 * step; x < extent.x_max; x += step) {
    for (double y = extent.y_min + 0.5 * step; y < extent.y_max; y += step) sum += height(x, y);
  }
  return sum * step * step;
}

}  // namespace excavplan::scenes
