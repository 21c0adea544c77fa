// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/clouds/cloud.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "base/random.hpp"

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

using test::error_of;

using HeightAt = std::function<double(double x, double y)>;

Cloud cloud_of(std::vector<Eigen::Vector3d> points) {
  Cloud cloud;
  cloud.width = points.size();
  cloud.points = std::move(points);
  return cloud;
}

/// Points spread evenly over the plan, with noise in height.
Cloud scan(const HeightAt& surface, const Rectangle& area, std::size_t count, double noise,
           std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(area.x_min, area.x_max);
    const double y = random.uniform(area.y_min, area.y_max);
    points.emplace_back(x, y, surface(x, y) + noise * random.normal());
  }
  return cloud_of(std::move(points));
}

double volume_between(const HeightMap& before, const HeightMap& after) {
  const Eigen::ArrayXXd difference = after.z - before.z;
  return difference.isNaN().select(0.0, difference).sum() * before.cell_size * before.cell_size;
}

double level(double, double) { return 0.0; }

TEST(Rasterise, PlaneIsExactAtCellCentresWhereverThePointsLie) {
  const auto plane = [](double x, double y) { return 0.3 * x - 0.7 * y + 12.0; };
  const Rectangle area{-1.0, 2.0, 1.0, 3.0};
  const HeightMap map = rasterise(scan(plane, area, 40000, 0.0, 1), area, {0.1});
  ASSERT_EQ(map.z.cols(), 20);
  ASSERT_EQ(map.z.rows(), 10);
  for (Eigen::Index c = 1; c < 19; ++c) {
    for (Eigen::Index r = 1; r < 9; ++r) {
      ASSERT_NEAR(map.z(r, c), plane(map.x(c), map.y(r)), 1e-6);  // float32 offsets in the cell
    }
  }
}

TEST(Rasterise, CloudsOfOneExtentShareOneGrid) {
  const Rectangle extent{0.513, -0.321, 1.2, 0.4};
  const HeightMap one = rasterise(scan(level, {0.0, -1.0, 2.0, 2.0}, 1000, 0.0, 1), extent);
  const HeightMap two = rasterise(scan(level, {0.6, 0.0, 0.7, 0.1}, 10, 0.0, 2), extent);
  EXPECT_TRUE(same_grid(one, two));
  EXPECT_NEAR(one.origin.x(), 0.50, 1e-12);
  EXPECT_NEAR(one.origin.y(), -0.35, 1e-12);
  EXPECT_GE(one.extent().x_max, extent.x_max - 1e-9);
  EXPECT_GE(one.extent().y_max, extent.y_max - 1e-9);
  EXPECT_EQ(one.z.cols(), 14);
  EXPECT_EQ(one.z.rows(), 15);
}

TEST(Rasterise, ExtentOnTheLatticeAddsNoCells) {
  for (int i = -40; i < 40; ++i) {
    const double low = 0.05 * i;
    const HeightMap map = rasterise(cloud_of({}), {low, low, low + 0.35, low + 0.7});
    ASSERT_EQ(map.z.cols(), 7) << low;
    ASSERT_EQ(map.z.rows(), 14) << low;
  }
}

TEST(Rasterise, CellsWithoutPointsStayUnknownAndSinglePointsCount) {
  const HeightMap map =
      rasterise(cloud_of({{0.05, 0.05, 0.7}, {0.15, 0.05, nan}, {nan, 0.05, 1.0}, {9.0, 9.0, 1.0}}),
                {0.0, 0.0, 0.3, 0.2}, {0.1});
  EXPECT_DOUBLE_EQ(map.z(0, 0), 0.7);
  EXPECT_EQ(map.z.isNaN().count(), 5);
}

TEST(Rasterise, OutliersDoNotMoveTheGround) {
  const Rectangle area{0.0, 0.0, 3.0, 3.0};
  Cloud cloud = scan(level, area, 100000, 0.005, 3);
  const HeightMap clean = rasterise(cloud, area);
  Random random(4);
  for (std::size_t i = 0; i < cloud.points.size(); i += 50) {
    cloud.points[i].z() += random.uniform(0.1, 1.0);
  }
  const HeightMap map = rasterise(cloud, area);
  EXPECT_LT((map.z - clean.z).abs().maxCoeff(), 0.01);
  EXPECT_NEAR(map.z.mean(), 0.0, 1e-4);  // plain means would rise by 11 mm
  const HeightMap open = rasterise(cloud, area, {0.05, 1e6});
  EXPECT_GT(open.z.mean(), 0.009);
}

TEST(Rasterise, OutlierDistanceIsTheGate) {
  const Rectangle area{0.0, 0.0, 2.0, 2.0};
  Cloud cloud = scan(level, area, 64000, 0.005, 5);
  cloud.points.push_back({1.025, 1.025, 0.1});
  const auto at_point = [&](double distance) {
    return rasterise(cloud, area, {0.05, distance}).z(20, 20);
  };
  EXPECT_GT(at_point(40.0) - at_point(4.0), 0.1 / 80.0);
}

struct Pit {
  double x0, y0;
  double operator()(double x, double y) const {
    return x > x0 && x < x0 + 2.0 && y > y0 && y < y0 + 0.7 ? -0.25 : 0.0;
  }
};

// A pit of 2 x 0.7 x 0.25 m: 0.35 m^3.
TEST(Rasterise, VolumeOfAPitWithVerticalWallsIsUnbiased) {
  const Rectangle area{0.0, 0.0, 4.0, 2.5};
  const HeightMap before = rasterise(scan(level, area, 200000, 0.01, 100), area);
  double sum = 0.0;
  int cases = 0;
  for (const double off : {0.0, 0.011, 0.025, 0.037, 0.049}) {
    const Pit pit{1.0 + off, 0.9 + 0.7 * off};
    const auto seed = static_cast<std::uint64_t>(200 + cases);
    const HeightMap after = rasterise(scan(pit, area, 200000, 0.01, seed), area);
    const double volume = -volume_between(before, after);
    EXPECT_NEAR(volume, 0.35, 0.005 * 0.35) << "walls " << off << " m off the cells";
    sum += volume;
    ++cases;
  }
  EXPECT_NEAR(sum / cases, 0.35, 0.0025 * 0.35);
}

// Walls seen by a camera are full of points; they lie evenly on both sides of a cell's border.
TEST(Rasterise, PointsOnTheWallsLeaveTheVolumeUnbiased) {
  const Rectangle area{0.0, 0.0, 4.0, 2.5};
  const HeightMap before = rasterise(scan(level, area, 200000, 0.01, 1), area);
  double sum = 0.0;
  constexpr int cases = 10;
  for (int i = 0; i < cases; ++i) {
    const double off = 0.005 * i;
    const Pit pit{1.0 + off, 0.9 + off};
    Cloud cloud = scan(pit, area, 200000, 0.01, static_cast<std::uint64_t>(10 + i));
    Random random(static_cast<std::uint64_t>(50 + i));
    for (int n = 0; n < 27000; ++n) {  // 20000 per m^2, as on the ground
      const double along = random.uniform(0.0, 5.4);
      const double z = random.uniform(-0.25, 0.0);
      const double side = random.uniform() < 0.5 ? 0.0 : 1.0;
      const double x = along < 4.0 ? pit.x0 + 0.5 * along : pit.x0 + 2.0 * side;
      const double y = along < 4.0 ? pit.y0 + 0.7 * side : pit.y0 + 0.5 * (along - 4.0);
      cloud.points.push_back({x + 0.005 * random.normal(), y + 0.005 * random.normal(), z});
    }
    sum -= volume_between(before, rasterise(cloud, area));
  }
  EXPECT_NEAR(sum / cases, 0.35, 0.01 * 0.35);
}

// Cone of 35 degrees and radius 0.9466 m: 0.62203 m^3.
TEST(Rasterise, VolumeOfAHeapIsUnbiased) {
  const double radius = 0.9466;
  const double slope = std::tan(35.0 * degree);
  const auto heap = [&](double x, double y) {
    return std::max(0.0, slope * (radius - std::hypot(x + 0.021, y - 0.034)));
  };
  const Rectangle area{-2.0, -2.0, 2.0, 2.0};
  for (const double noise : {0.0, 0.005, 0.02}) {
    const HeightMap before = rasterise(scan(level, area, 100000, noise, 7), area);
    const HeightMap after = rasterise(scan(heap, area, 100000, noise, 8), area);
    const double sampling = 16.0 * noise * std::sqrt(2.0 / 100000.0);  // sd of the volume [m^3]
    EXPECT_NEAR(volume_between(before, after), 0.62203, 0.001 + 3.0 * sampling) << noise;
  }
}

// Ridge of 35 degrees, 0.1 m high and 2 m long on level ground: 2 * 0.1^2 / tan 35 = 0.02856 m^3.
TEST(Rasterise, TheCrestOfARidgeIsNoOutlier) {
  const double slope = std::tan(35.0 * degree);
  const auto ridge = [&](double x, double y) {
    return x > 1.0 && x < 3.0 ? std::max(0.0, 0.1 - slope * std::abs(y - 1.525)) : 0.0;
  };
  const Rectangle area{0.0, 0.0, 4.0, 3.0};
  const HeightMap before = rasterise(scan(level, area, 120000, 0.0, 7), area);
  const HeightMap after = rasterise(scan(ridge, area, 120000, 0.0, 8), area);
  EXPECT_NEAR(volume_between(before, after), 0.02856, 0.003 * 0.02856);
}

TEST(Rasterise, ASlotOneCellWideIsKeptToItsEnds) {
  const auto slot = [](double x, double y) {
    return x > 1.0 && x < 1.5 && y > 1.0 && y < 1.05 ? -0.25 : 0.0;
  };
  const Rectangle area{0.0, 0.0, 3.0, 2.0};
  const HeightMap map = rasterise(scan(slot, area, 120000, 0.002, 9), area);
  for (Eigen::Index c = 20; c < 30; ++c) EXPECT_NEAR(map.z(20, c), -0.25, 0.005) << c;
  EXPECT_NEAR(map.z(20, 19), 0.0, 0.005);
  EXPECT_NEAR(map.z(20, 30), 0.0, 0.005);
}

TEST(Rasterise, LargeCoordinatesLoseNothing) {
  const Rectangle area{0.0, 0.0, 2.0, 2.0};
  Cloud cloud = scan([](double x, double) { return 0.2 * x; }, area, 20000, 0.005, 9);
  const HeightMap near = rasterise(cloud, area, {0.25});
  for (auto& point : cloud.points) point += Eigen::Vector3d(4e6, 5e6, 0.0);
  const HeightMap far = rasterise(cloud, {4e6, 5e6, 4e6 + 2.0, 5e6 + 2.0}, {0.25});
  EXPECT_LT((near.z - far.z).abs().maxCoeff(), 1e-6);
}

TEST(Rasterise, RefusesWhatMakesNoMap) {
  const Cloud cloud = cloud_of({{0.0, 0.0, 0.0}});
  const Rectangle area{0.0, 0.0, 1.0, 1.0};
  const auto error = [&](const Rectangle& extent, RasterOptions options) {
    return error_of([&] { rasterise(cloud, extent, options); });
  };
  EXPECT_EQ(error(area, {0.0}), "rasterise: cell is 0 m, must be > 0");
  EXPECT_EQ(error(area, {nan}), "rasterise: cell is nan m, must be > 0");
  EXPECT_EQ(error(area, {0.05, -1.0}), "rasterise: outlier_distance is -1, must be > 0");
  EXPECT_EQ(error(area, {0.05, 0.0}), "rasterise: outlier_distance is 0, must be > 0");
  EXPECT_EQ(error({0.0, 0.0, 0.0, 1.0}, {}), "rasterise: extent x 0 .. 0, y 0 .. 1 m is empty");
  EXPECT_NE(error({nan, 0.0, 1.0, 1.0}, {}).find("is empty"), std::string::npos);
  EXPECT_NE(error({0.0, 0.0, 1e4, 1e4}, {0.5}).find("at most 100 million cells"),
            std::string::npos);
  EXPECT_NE(error({-1e300, 0.0, 1e300, 1.0}, {}).find("at most 100 million cells"),
            std::string::npos);
}

TEST(PlanExtent, LeavesOutTheFarthestThousandthOnEachSide) {
  Cloud cloud = scan(level, {2.0, 3.0, 4.0, 7.0}, 10000, 0.0, 1);
  for (int i = 0; i < 5; ++i) cloud.points.push_back({1e6, -1e6, 0.0});
  cloud.points.push_back({nan, 0.0, 0.0});
  const Rectangle extent = plan_extent(cloud);
  EXPECT_NEAR(extent.x_min, 2.0, 0.01);
  EXPECT_NEAR(extent.y_min, 3.0, 0.02);
  EXPECT_NEAR(extent.x_max, 4.0, 0.01);
  EXPECT_NEAR(extent.y_max, 7.0, 0.02);
}

TEST(PlanExtent, IsThatOfTheSortedCoordinatesInWhateverOrderTheyCome) {
  Random random(5);
  for (const std::size_t count : {1U, 2U, 999U, 1000U, 1001U, 25000U}) {
    std::vector<double> values(count);
    for (double& value : values) value = std::round(random.uniform(-300.0, 300.0));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const std::vector<double> falling(sorted.rbegin(), sorted.rend());
    for (const std::vector<double>& order : {values, sorted, falling}) {
      Cloud cloud;
      for (const double value : order) cloud.points.emplace_back(value, -value, 0.0);
      const Rectangle extent = plan_extent(cloud);
      EXPECT_EQ(extent.x_min, sorted[count / 1000]);
      EXPECT_EQ(extent.x_max, std::nextafter(sorted[count - 1 - count / 1000], 1e9));
      EXPECT_EQ(extent.y_min, -sorted[count - 1 - count / 1000]);
      EXPECT_EQ(extent.y_max, std::nextafter(-sorted[count / 1000], 1e9));
    }
  }
}

TEST(PlanExtent, HoldsEveryPointOfASmallCloud) {
  const Cloud cloud = cloud_of({{1.0, 5.0, 0.0}, {2.0, 4.0, 0.0}});
  const Rectangle extent = plan_extent(cloud);
  for (const auto& point : cloud.points) EXPECT_TRUE(extent.contains(point.x(), point.y()));
  EXPECT_EQ(error_of([] {
              plan_extent(cloud_of({{nan, 0.0, 0.0}}));
            }),
            "extent of a cloud: none of its 1 points is finite");
}

TEST(Transform, MovesThePointsAndKeepsUnknownOnes) {
  Cloud cloud = cloud_of({{1.0, 2.0, 3.0}, {nan, 0.0, 0.0}});
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.translate(Eigen::Vector3d(10.0, 0.0, 0.0));
  frame.rotate(Eigen::AngleAxisd(90.0 * degree, Eigen::Vector3d::UnitZ()));
  transform(cloud, frame.matrix());
  EXPECT_LT((cloud.points[0] - Eigen::Vector3d(8.0, 1.0, 3.0)).norm(), 1e-12);
  EXPECT_FALSE(cloud.points[1].allFinite());
}

TEST(Summarise, CountsAndMeasuresFinitePoints) {
  const CloudSummary summary = summarise(
      cloud_of({{1.0, 2.0, 3.0}, {nan, 0.0, 0.0}, {3.0, 6.0, -1.0}, {0.0, 0.0, HUGE_VAL}}));
  EXPECT_EQ(summary.points, 4u);
  EXPECT_EQ(summary.finite_points, 2u);
  EXPECT_EQ(summary.centroid, Eigen::Vector3d(2.0, 4.0, 1.0));
  EXPECT_EQ(summary.min, Eigen::Vector3d(1.0, 2.0, -1.0));
  EXPECT_EQ(summary.max, Eigen::Vector3d(3.0, 6.0, 3.0));
}

TEST(Summarise, CentroidOfMapCoordinatesKeepsItsDigits) {
  Cloud cloud;
  for (int i = 0; i < 100000; ++i) cloud.points.push_back({5e5 + 0.001 * (i % 2), 5.1e6, 312.1});
  EXPECT_NEAR(summarise(cloud).centroid.x(), 5e5 + 0.0005, 1e-9);
}

TEST(Summarise, DensityCountsOnlyGroundThatIsThere) {
  Cloud cloud = scan(level, {0.0, 0.0, 2.0, 2.0}, 20000, 0.0, 1);
  const Cloud other = scan(level, {18.0, 18.0, 20.0, 20.0}, 20000, 0.0, 2);
  cloud.points.insert(cloud.points.end(), other.points.begin(), other.points.end());
  EXPECT_NEAR(summarise(cloud).density, 5000.0, 250.0);
}

TEST(Summarise, NothingToMeasureIsUnknown) {
  for (const Cloud& cloud : {cloud_of({}), cloud_of({{nan, nan, nan}})}) {
    const CloudSummary summary = summarise(cloud);
    EXPECT_EQ(summary.finite_points, 0u);
    EXPECT_TRUE(summary.centroid.array().isNaN().all());
    EXPECT_TRUE(std::isnan(summary.density));
    EXPECT_EQ(summary.frame_guess, "unknown");
  }
  EXPECT_TRUE(std::isnan(summarise(cloud_of({{1.0, 1.0, 1.0}})).density));
  EXPECT_TRUE(std::isnan(summarise(cloud_of({{1.0, 1.0, 1.0}, {2.0, 1.0, 1.0}})).density));
}

TEST(Summarise, GuessesTheFrame) {
  Cloud cloud = scan(level, {1.0, -3.0, 7.0, 3.0}, 1000, 0.01, 1);
  EXPECT_EQ(summarise(cloud).frame_guess, "site (z up, ground near 0)");
  for (auto& point : cloud.points) point.x() += 4e5;
  EXPECT_EQ(summarise(cloud).frame_guess, "map (large coordinates)");
  const Cloud ahead =
      scan([](double, double) { return 3.0; }, {-2.0, -1.0, 2.0, 1.0}, 1000, 0.01, 2);
  EXPECT_EQ(summarise(ahead).frame_guess, "camera (z forward)");
  const Cloud high =
      scan([](double, double) { return -30.0; }, {0.0, 0.0, 9.0, 9.0}, 1000, 0.01, 2);
  EXPECT_EQ(summarise(high).frame_guess, "unknown");
}

}  // namespace
}  // namespace excavplan
