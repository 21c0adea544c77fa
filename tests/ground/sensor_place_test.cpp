// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/sensor_place.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

/// Height and gradient of the ground at a place.
struct Facet {
  double height;
  Eigen::Vector2d slope;
};
using Facets = std::function<Facet(double x, double y)>;

/// Ridges of 0.25 m along x and y: strips of a metre that are level, rise or fall.
Facet ridges(double x, double y) {
  constexpr double slope = 0.25;
  const auto strip = [&](double way) {
    const double in = std::fmod(way, 3.0);
    if (in < 1.0) return std::pair(0.0, 0.0);
    return in < 2.0 ? std::pair(slope * (in - 1.0), slope) : std::pair(slope * (3.0 - in), -slope);
  };
  const auto [along, slope_x] = strip(x);
  const auto [across, slope_y] = strip(y);
  return {along + across, {slope_x, slope_y}};
}

/// A heap of 0.8 m at 45 degrees.
Facet steep_heap(double x, double y) {
  const Eigen::Vector2d from(x - 3.75, y - 3.0);
  const double height = 0.8 - from.norm();
  return height > 0.0 ? Facet{height, -from.normalized()} : Facet{0.0, {0.0, 0.0}};
}

/// Points per area in the direction of a ray, on level ground.
using Density = std::function<double(const Eigen::Vector3d& ray)>;
/// The points that a cell holds where so many are expected.
using Draw = std::function<int(double expected)>;

/// On a slope 1 + g.v of the points of level ground hit: the geometry of rays. What faces away is
/// not seen.
Surface scan_of(const Facets& ground, const Eigen::Vector3d& sensor, const Density& density,
                const Draw& draw) {
  Surface surface;
  HeightMap& map = surface.height;
  map = flat_ground({0.0, 0.0, 7.5, 6.0}, 0.05);
  surface.points.setZero(map.z.rows(), map.z.cols());
  for_each_cell(map.z, [&](Cell at) {
    const Facet facet = ground(map.x(at.col), map.y(at.row));
    const Eigen::Vector3d ray =
        sensor - Eigen::Vector3d(map.x(at.col), map.y(at.row), facet.height);
    const double facing = 1.0 - facet.slope.dot(ray.head<2>()) / ray.z();
    map.z(at.row, at.col) = facing > 0.0 ? facet.height : std::numeric_limits<double>::quiet_NaN();
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

/// A scan of equal angles whose points come `together` at random.
Surface random_scan(const Facets& ground, const Eigen::Vector3d& sensor, int together,
                    std::uint64_t seed) {
  Random random(seed);
  return scan_of(
      ground, sensor, [](const Eigen::Vector3d& ray) { return 200.0 * of_equal_angles(ray); },
      [&](double expected) { return together * poisson(expected / together, random); });
}

const Eigen::Vector3d beside(-1.0, 3.0, 4.0);

/// Tangents to one point, v, the way of a ray by its fall, from repeated scans.
struct Tangents {
  int scans = 0;
  double mean = 0.0;
  double sd_told_to_found = 0.0;  ///< by the points alone
};

constexpr double of_model = 0.07;  // docs/methods.md#sight-lines

Tangents tangents_of(const Eigen::Vector3d& point, int together, std::uint64_t scans) {
  Tangents tangents;
  double squares = 0.0;
  double told = 0.0;
  for (std::uint64_t seed = 1; seed <= scans; ++seed) {
    const auto found = infer_sensor(random_scan(ridges, beside, together, seed));
    if (!found) continue;
    ++tangents.scans;
    const Eigen::Vector3d ray = found->place() - point;
    const double tangent = ray.head<2>().norm() / ray.z();
    tangents.mean += tangent;
    squares += tangent * tangent;
    told += std::pow(found->tangent_sd(point), 2) - std::pow(of_model * tangent, 2);
  }
  tangents.mean /= tangents.scans;
  const double variance = squares / tangents.scans - std::pow(tangents.mean, 2);
  tangents.sd_told_to_found = std::sqrt(told / tangents.scans / variance);
  return tangents;
}

/// v is right to 7 %, which its standard deviation contains (docs/methods.md#sight-lines); the rest
/// is that of the points. That of 40 scans is known to 11 %.
TEST(SensorPlace, ErrorByThePointsIsThatOfRepeatedScansHoweverTheyScatter) {
  const Eigen::Vector3d point(5.0, 2.0, 0.0);
  const double right = (beside - point).head<2>().norm() / (beside - point).z();
  for (const int together : {1, 4}) {
    const Tangents found = tangents_of(point, together, 40);
    EXPECT_EQ(found.scans, 40) << together;
    EXPECT_NEAR(found.mean, right, of_model * right) << together;
    EXPECT_NEAR(found.sd_told_to_found, 1.0, 0.3) << together;
  }
}

/// That of 12 scans is known to 21 %; without the scatter it would be told as half.
TEST(SensorPlace, ErrorByPointsThatComeInFoursIsThatOfAFewScans) {
  const double ratio = tangents_of({5.0, 2.0, 0.0}, 4, 12).sd_told_to_found;
  EXPECT_NEAR(std::log(ratio), 0.0, 0.5 * std::log(2.0)) << ratio;
}

/// Points that are thinned evenly thin out less with range than rays do.
TEST(SensorPlace, IsToldByNoPointsThatScatterLessThanRandomOnesAndThinOutLittleWithRange) {
  for (const double power : {1.0, 0.7}) {
    double rest = 0.0;
    const Surface thinned = scan_of(
        ridges, beside,
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

/// Cones of up to half the height of the sensor.
TEST(SensorPlace, BesideHeapsItIsSeldomWrong) {
  Random random(11);
  int told = 0;
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const double height = random.uniform(1.0, 3.0);
    const Eigen::Vector3d sensor(random.uniform(-2.0, 9.5), random.uniform(-3.0, 0.0), height);
    const double top = random.uniform(0.2, 0.5) * height;
    const double slope = random.uniform(0.5, 1.0);
    const Eigen::Vector2d centre(random.uniform(2.5, 5.0), random.uniform(2.0, 4.0));
    const Facets cone = [&](double x, double y) {
      const Eigen::Vector2d from = Eigen::Vector2d(x, y) - centre;
      const double z = top - slope * from.norm();
      return z > 0.0 ? Facet{z, -slope * from.normalized()} : Facet{0.0, {0.0, 0.0}};
    };
    const Surface scan = random_scan(cone, sensor, 1, seed);
    const auto found = infer_sensor(scan);
    if (!found) continue;
    ++told;
    wrong += found->misfit(sensor, scan.height.extent()) > 6.0 ? 1 : 0;
  }
  EXPECT_GT(told, 100);
  EXPECT_LE(wrong, told / 10);
}

/// No place inside the heap is taken for it, and the place where it stood is not doubted.
TEST(SensorPlace, OfALowSensorBesideASteepHeapIsAboveTheHeap) {
  for (int heading = 0; heading < 360; heading += 45) {
    const double angle = heading * pi / 180.0;
    const Eigen::Vector3d place(3.75 + 1.6 * std::cos(angle), 3.0 + 1.6 * std::sin(angle), 1.3);
    Surface scan = random_scan(steep_heap, place, 1, 1);
    scan.sensors = {place};
    const auto found = infer_sensor(scan);
    ASSERT_TRUE(found) << heading;
    EXPECT_GT(found->place().z(), 0.8) << heading;
    EXPECT_FALSE(doubt_of_place(scan)) << heading;
  }
}

}  // namespace
}  // namespace excavplan
