// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/sensor_place.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

const Eigen::Vector3d sensor(-1.0, 3.0, 4.0);

/// Ridges of 0.25 m along x or y: strips of a metre that are level, rise or fall.
struct Strip {
  double height;
  double slope;
};
Strip strip_at(double way) {
  constexpr double slope = 0.25;
  const double in = std::fmod(way, 3.0);
  if (in < 1.0) return {0.0, 0.0};
  return in < 2.0 ? Strip{slope * (in - 1.0), slope} : Strip{slope * (3.0 - in), -slope};
}

/// Points per area in the direction of a ray, on level ground.
using Density = std::function<double(const Eigen::Vector3d& ray)>;
/// The points that a cell holds where so many are expected.
using Draw = std::function<int(double expected)>;

/// A scan from `sensor`. On a slope 1 + g.v of the points of level ground hit: the geometry of
/// rays.
Surface scan_of(const Density& density, const Draw& draw) {
  Surface surface;
  HeightMap& map = surface.height;
  map = flat_ground({0.0, 0.0, 7.5, 6.0}, 0.05);
  surface.points.setZero(map.z.rows(), map.z.cols());
  for_each_cell(map.z, [&](Cell at) {
    const Strip along = strip_at(map.x(at.col));
    const Strip across = strip_at(map.y(at.row));
    map.z(at.row, at.col) = along.height + across.height;
    const Eigen::Vector3d ray =
        sensor - Eigen::Vector3d(map.x(at.col), map.y(at.row), map.z(at.row, at.col));
    const double facing = 1.0 - (along.slope * ray.x() + across.slope * ray.y()) / ray.z();
    surface.points(at.row, at.col) = draw(std::max(0.0, facing) * density(ray));
  });
  return surface;
}

int poisson(double mean, Random& random) {
  int count = 0;
  for (double left = random.uniform(); left > std::exp(-mean); left *= random.uniform()) ++count;
  return count;
}

/// Equal angles between rays: h / r^3 points per area.
double of_equal_angles(const Eigen::Vector3d& ray) { return ray.z() / std::pow(ray.norm(), 3); }

/// The scan of equal angles whose points come `together` at random.
Surface scan_of_clusters(int together, std::uint64_t seed) {
  Random random(seed);
  return scan_of([](const Eigen::Vector3d& ray) { return 200.0 * of_equal_angles(ray); },
                 [&](double expected) { return together * poisson(expected / together, random); });
}

/// v, the way of a ray by its fall, is right to 7 %, which its standard deviation contains
/// (docs/methods.md#sight-lines); the rest is that of the points. That of 40 scans is known to
/// 11 %.
TEST(SensorPlace, ErrorByThePointsIsThatOfRepeatedScansHoweverTheyScatter) {
  const Eigen::Vector3d point(5.0, 2.0, 0.0);
  const double right = (sensor - point).head<2>().norm() / (sensor - point).z();
  for (const int together : {1, 4}) {
    double sum = 0.0;
    double squares = 0.0;
    double told = 0.0;
    int scans = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const auto found = infer_sensor(scan_of_clusters(together, seed));
      if (!found) continue;
      ++scans;
      const Eigen::Vector3d ray = found->place() - point;
      const double tangent = ray.head<2>().norm() / ray.z();
      sum += tangent;
      squares += tangent * tangent;
      told += std::pow(found->tangent_sd(point), 2) - std::pow(0.07 * tangent, 2);
    }
    EXPECT_EQ(scans, 40) << together;
    const double variance = squares / scans - std::pow(sum / scans, 2);
    EXPECT_NEAR(sum / scans, right, 0.07 * right) << together;
    EXPECT_NEAR(std::sqrt(told / scans / variance), 1.0, 0.3) << together;
  }
}

/// Points that are thinned evenly thin out less with range than rays do.
TEST(SensorPlace, IsToldByNoPointsThatScatterLessThanRandomOnesAndThinOutLittleWithRange) {
  for (const double power : {1.0, 0.7}) {
    double rest = 0.0;
    const Surface thinned = scan_of(
        [&](const Eigen::Vector3d& ray) { return 50.0 * std::pow(of_equal_angles(ray), power); },
        [&](double expected) {
          rest += expected;
          const int count = static_cast<int>(rest);
          rest -= count;
          return count;
        });
    EXPECT_EQ(infer_sensor(thinned).has_value(), power == 1.0) << power;
  }
}

}  // namespace
}  // namespace excavplan
