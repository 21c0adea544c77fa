// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "sensing/ray_target.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/non_finite.hpp"
#include "base/random.hpp"

namespace excavplan::test {
namespace {

/// Waves, a trench and cells that nobody saw.
HeightMap rough_ground(std::uint64_t seed) {
  Random random(seed, 0);
  HeightMap map;
  map.cell_size = 0.05;
  map.origin = {-3.0, -2.0};
  map.z.resize(83, 121);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      const double wave = 0.3 * std::sin(1.3 * map.x(col)) * std::cos(0.9 * map.y(row));
      const double trench = std::abs(map.y(row)) < 0.4 ? -0.8 : 0.0;
      map.z(row, col) = random.uniform() < 0.01 ? nan : wave + trench;
    }
  }
  return map;
}

/// By steps of half a cell over all of the way.
double met_by_steps(const HeightMap& map, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double before = nan;
  const double step = 0.5 * map.cell_size;
  for (double distance = 0.0; distance < 20.0; distance += step) {
    const Eigen::Vector3d at = from + distance * ray;
    const double above = at.z() - height_at(map, at.x(), at.y());
    if (above <= 0.0) {
      return before > 0.0 ? distance - step + step * before / (before - above) : nan;
    }
    before = above;
  }
  return nan;
}

TEST(RayTarget, RaysMeetTheGroundWhereStepsOverAllOfTheWayDo) {
  int met = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const HeightMap map = rough_ground(seed);
    const RayTarget target(map);
    // As high over its top as steps begin.
    const double top = map.z.isNaN().select(-1.0, map.z).maxCoeff() + map.cell_size;
    Random random(seed, 1);
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d from(random.uniform() * 4.0 - 2.0, random.uniform() * 3.0 - 1.5, top);
      const Eigen::Vector3d ray =
          Eigen::Vector3d(random.normal(), random.normal(), -0.05 - random.uniform()).normalized();
      const double expected = met_by_steps(map, from, ray);
      const double found = target.distance(from, ray, 20.0);
      ASSERT_EQ(std::isnan(found), std::isnan(expected)) << seed << ' ' << i;
      if (std::isnan(expected)) continue;
      EXPECT_NEAR(found, expected, 1e-9) << seed << ' ' << i;
      ++met;
    }
  }
  EXPECT_GT(met, 3000);
}

}  // namespace
}  // namespace excavplan::test
