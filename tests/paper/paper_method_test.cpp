// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/paper_method.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "base/random.hpp"

#include "support/errors.hpp"

namespace excavplan {
namespace {

using test::error_of;

using Surface = std::function<double(double x, double y)>;

Cloud scan(const Surface& surface, const Rectangle& area, std::size_t count, double noise,
           std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(area.x_min, area.x_max);
    const double y = random.uniform(area.y_min, area.y_max);
    cloud.points.emplace_back(x, y, surface(x, y) + noise * random.normal());
  }
  cloud.width = count;
  return cloud;
}

double level(double, double) { return 0.0; }

/// A plane of some steepness towards some direction [rad], 10 m above the ground.
Surface plane(double slope, double azimuth) {
  const double gx = std::tan(slope) * std::cos(azimuth);
  const double gy = std::tan(slope) * std::sin(azimuth);
  return [=](double x, double y) { return 10.0 + gx * x + gy * y; };
}

TEST(PaperVolume, AColumnCountsOnceHoweverSteepTheGround) {
  for (const double slope : {5.0, 35.0, 70.0}) {
    const Surface surface = plane(slope * degree, 0.3);
    const Cloud cloud = scan(surface, {0.0, 0.0, 2.0, 1.0}, 200000, 0.0, 1);
    const double volume = 2.0 * surface(1.0, 0.5);
    EXPECT_NEAR(paper_volume(cloud, +1.0, 0.05), volume, 1e-3 * volume) << slope;
  }
}

TEST(PaperVolume, AColumnBelowTheGroundAndOneAcrossItCountOnce) {
  const Cloud cloud =
      scan([](double x, double) { return x - 0.5; }, {0.0, 0.0, 1.0, 1.0}, 100000, 0.0, 6);
  EXPECT_NEAR(paper_volume(cloud, +1.0, 0.1), 0.125, 1e-3);
  EXPECT_NEAR(paper_volume(cloud, -1.0, 0.1), 0.125, 1e-3);
  const Cloud odd =
      scan([](double x, double) { return x - 0.05; }, {0.0, 0.0, 0.1, 0.1}, 10000, 0.0, 7);
  EXPECT_NEAR(paper_volume(odd, +1.0, 0.1), 0.0, 1e-5);  // one column, on average on the ground
  EXPECT_GT(paper_volume(odd, +1.0, 0.1, PaperVoxels::cubes), 2e-4);
}

// A plane of gradient (gx, gy) occupies 1 + |gx| + |gy| voxels per column. The counts are those of
// PCL 1.13 with 5 cm voxels; random points miss a few corner voxels that the formula counts.
TEST(PaperVolume, CubesCountASlopeOncePerVoxelItCrosses) {
  struct Case {
    double slope;
    double azimuth;
    double tolerance;
  };
  const Rectangle area{0.0, 0.0, 8.0, 0.4};  // long: most columns are not at an end
  for (const auto& [slope, azimuth, tolerance] :
       {Case{5, 0, 0.01}, Case{20, 0, 0.01}, Case{35, 0, 0.01}, Case{20, 45, 0.04}}) {
    const double gx = std::tan(slope * degree) * std::cos(azimuth * degree);
    const double gy = std::tan(slope * degree) * std::sin(azimuth * degree);
    const Cloud cloud = scan(plane(slope * degree, azimuth * degree), area, 800000, 0.0, 1);
    const double volume = 3.2 * (10.0 + 4.0 * gx + 0.2 * gy);
    const double counted = 1.0 + gx + gy;
    EXPECT_NEAR(paper_volume(cloud, +1.0, 0.05, PaperVoxels::cubes) / volume, counted,
                tolerance * counted)
        << slope << " degrees towards " << azimuth;
    EXPECT_EQ(paper_volume(cloud, -1.0, 0.05, PaperVoxels::cubes), 0.0);
  }
}

// Ground at z = 0 lies on a face of the lattice: two voxels a column, at +-0.798 sigma.
TEST(PaperVolume, InCubesNoiseOnLevelGroundMakesSoil) {
  const Cloud cloud = scan(level, {0.0, 0.0, 4.0, 4.0}, 400000, 0.005, 2);
  EXPECT_NEAR(paper_volume(cloud, +1.0, 0.05, PaperVoxels::cubes), 0.0638, 0.0006);
  EXPECT_NEAR(paper_volume(cloud, -1.0, 0.05, PaperVoxels::cubes), 0.0638, 0.0006);
}

// 62.5 points a column: the noise of their mean, clipped, 0.399 sigma / sqrt(62.5) m^3 per m^2.
TEST(PaperVolume, InColumnsOnlyTheNoiseOfTheMeanMakesSoil) {
  const Cloud cloud = scan(level, {0.0, 0.0, 4.0, 4.0}, 400000, 0.005, 2);
  EXPECT_NEAR(paper_volume(cloud, +1.0, 0.05), 0.00405, 0.0004);
  EXPECT_NEAR(paper_volume(cloud, -1.0, 0.05), 0.00405, 0.0004);
}

TEST(PaperVolume, LevelSlabWithinOneLayerOfVoxelsIsExact) {
  const Cloud cloud =
      scan([](double, double) { return -0.224; }, {0.0, 0.0, 2.0, 1.0}, 100000, 0.0, 3);
  EXPECT_NEAR(paper_volume(cloud, -1.0, 0.05), 0.448, 1e-5);
}

TEST(PaperVolume, MapCoordinatesLoseNothing) {
  Cloud cloud =
      scan([](double x, double) { return 0.1 + 0.3 * x; }, {0.0, 0.0, 2.0, 2.0}, 100000, 0.0, 4);
  const double here = paper_volume(cloud, +1.0, 0.05);
  for (auto& point : cloud.points) point += Eigen::Vector3d(5e5, 5e6, 0.0);
  EXPECT_NEAR(paper_volume(cloud, +1.0, 0.05), here, 0.002 * here);
}

TEST(PaperVolume, PointsThatAreNotFiniteCarryNothing) {
  Cloud cloud;
  cloud.points = {{nan, 0.0, 1.0}, {0.0, 0.0, std::numeric_limits<double>::infinity()}};
  EXPECT_EQ(paper_volume(cloud, +1.0, 0.05), 0.0);
  cloud.points.push_back({0.01, 0.01, 0.02});
  EXPECT_NEAR(paper_volume(cloud, +1.0, 0.05), 0.02 * 0.0025, 1e-9);
}

/// A pit of 2 x 1 x 0.226 m and a slab of 1 x 1 x 0.124 m, walls and levels inside voxels.
struct Scene {
  CloudPair dig = {
      scan(level, {-1.0, -1.0, 4.0, 3.0}, 100000, 0.0, 10),
      scan([](double x,
              double y) { return x > 0.0 && x < 2.0 && y > 0.0 && y < 1.0 ? -0.226 : 0.0; },
           {-1.0, -1.0, 4.0, 3.0}, 100000, 0.0, 11)};
  CloudPair dump = {
      scan(level, {-1.0, -1.0, 3.0, 3.0}, 100000, 0.0, 12),
      scan(
          [](double x, double y) { return x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0 ? 0.124 : 0.0; },
          {-1.0, -1.0, 3.0, 3.0}, 100000, 0.0, 13)};

  VolumeChange volumes(const PaperOptions& options = {}, double leaf = 0.05) const {
    return paper_volumes(dig, dump, leaf, options);
  }
};

TEST(PaperVolumes, LevelSoilWithoutNoiseIsFound) {
  // Outlier removal takes the sparsest points off the rims, which the voxels mostly survive.
  const VolumeChange change = Scene().volumes();
  EXPECT_NEAR(change.excavated.value, 0.452, 0.02 * 0.452);
  EXPECT_NEAR(change.dumped.value, 0.124, 0.03 * 0.124);
  EXPECT_EQ(change.spilled.value, 0.0);
  EXPECT_EQ(change.before.value, change.excavated.value);
  EXPECT_EQ(change.after.value, change.spilled.value + change.dumped.value);
}

TEST(PaperVolumes, KnowNoStandardDeviation) {
  const VolumeChange change = Scene().volumes();
  for (const Measured& volume :
       {change.excavated, change.spilled, change.dumped, change.before, change.after}) {
    EXPECT_TRUE(std::isnan(volume.sd));
  }
  EXPECT_TRUE(std::isnan(change.covariance_before_after));
}

TEST(PaperVolumes, GroundThatDidNotChangeCarriesNothing) {
  Scene scene;
  scene.dig.after = scene.dig.before;
  scene.dump.after = scene.dump.before;
  const VolumeChange change = scene.volumes();
  EXPECT_EQ(change.before.value, 0.0);
  EXPECT_EQ(change.after.value, 0.0);
}

TEST(PaperVolumes, StrayPointsAreRemoved) {
  Scene scene;
  const double clean = scene.volumes().spilled.value;
  for (int i = 0; i < 20; ++i) scene.dig.after.points.push_back({-0.9 + 0.2 * i, 2.5, 1.0});
  EXPECT_NEAR(scene.volumes().spilled.value, clean, 1e-9);
  PaperOptions lenient;
  lenient.outlier_deviations = 1000.0;
  EXPECT_NEAR(scene.volumes(lenient).spilled.value, clean + 20 * 1.0 * 0.0025, 1e-5);
}

TEST(PaperVolumes, FewChangedPointsAreEnough) {
  Scene scene;
  scene.dig.after = scene.dig.before;
  scene.dig.after.points.push_back({0.01, 0.01, -0.52});
  EXPECT_NEAR(scene.volumes().excavated.value, 0.52 * 0.0025, 1e-6);
  for (int i = 0; i < 5; ++i) scene.dig.after.points.push_back({0.3 + 0.1 * i, 0.01, -0.52});
  EXPECT_GT(scene.volumes().excavated.value, 0.0);
}

/// A pit with walls of 70 degrees, 2 x 1 m at the top and 0.4 m deep, and a cone of 35 degrees.
struct SteepScene {
  static double pit(double x, double y) {
    const double inside = std::min({x, 2.0 - x, y, 1.0 - y});
    return -std::clamp(std::tan(70.0 * degree) * inside, 0.0, 0.4);
  }
  static double cone(double x, double y) {
    return std::max(0.0, std::tan(35.0 * degree) * (0.9 - std::hypot(x, y)));
  }
  Rectangle area = {-1.5, -1.5, 3.5, 2.5};
  CloudPair dig = {scan(level, area, 400000, 0.003, 20), scan(pit, area, 400000, 0.003, 21)};
  CloudPair dump = {scan(level, area, 400000, 0.003, 22), scan(cone, area, 400000, 0.003, 23)};
  double hole = 2.0 * 0.4 - 0.4 * 0.4 / std::tan(70.0 * degree) * 3.0 +
                4.0 / 3.0 * std::pow(0.4, 3) / std::pow(std::tan(70.0 * degree), 2);
  double heap = 3.14159265358979 / 3.0 * std::pow(0.9, 3) * std::tan(35.0 * degree);
};

// Walls of 70 degrees cross eight cubes a column.
TEST(PaperVolumes, WallsAreCountedOnceInColumnsAndOftenInCubes) {
  const SteepScene scene;
  const VolumeChange columns = paper_volumes(scene.dig, scene.dump, 0.05);
  EXPECT_NEAR(columns.excavated.value, scene.hole, 0.05 * scene.hole);
  EXPECT_NEAR(columns.dumped.value, scene.heap, 0.05 * scene.heap);
  PaperOptions options;
  options.voxels = PaperVoxels::cubes;
  const VolumeChange cubes = paper_volumes(scene.dig, scene.dump, 0.05, options);
  EXPECT_GT(cubes.excavated.value, 1.3 * scene.hole);
  EXPECT_GT(cubes.dumped.value, 1.3 * scene.heap);
}

TEST(PaperVolumes, EveryOptionActs) {
  const SteepScene scene;
  const auto hole = [&](const PaperOptions& options, double leaf = 0.05) {
    return paper_volumes(scene.dig, scene.dump, leaf, options).excavated.value;
  };
  PaperOptions options;
  const double standard = hole(options);
  EXPECT_GT(std::abs(hole(options, 0.2) - standard), 1e-4);
  options.outlier_deviations = 0.1;
  const double strict = hole(options);
  EXPECT_GT(std::abs(strict - standard), 1e-4);
  options.outlier_neighbours = 5;
  EXPECT_GT(std::abs(hole(options) - strict), 1e-4);
  options.outlier_neighbours = 0;
  EXPECT_GT(hole(options), standard);
}

TEST(PaperVolumes, RefuseWhatPclWouldGetWrong) {
  Scene scene;
  const auto error = [&](const PaperOptions& options) {
    return error_of([&] { scene.volumes(options); });
  };
  EXPECT_EQ(error_of([&] { scene.volumes({}, 0.0); }), "paper method: leaf is 0 m, must be > 0");
  PaperOptions options;
  options.outlier_neighbours = -1;
  EXPECT_EQ(error(options), "paper method: outlier_neighbours is -1, must be >= 0");
  options = {};
  options.outlier_deviations = nan;
  EXPECT_EQ(error(options), "paper method: outlier_deviations is nan, must be > 0");
  scene.dump.after.points.push_back({1e4, 1e4, 3.0});
  options = {};
  options.voxels = PaperVoxels::cubes;
  EXPECT_NE(error(options).find("m holds more than 2^31 voxels of 0.05 m"), std::string::npos);
  scene.dump.after.points = {{nan, 0.0, 0.0}};
  EXPECT_EQ(error({}), "paper method: the cloud dump.after has no finite point");
  EXPECT_EQ(error_of([&] { paper_volume(scene.dig.before, 1.0, -1.0); }),
            "paper method: leaf is -1 m, must be > 0");
}

}  // namespace
}  // namespace excavplan
