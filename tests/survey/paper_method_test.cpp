// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "survey/paper_method.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.hpp"

#include "support/errors.hpp"

namespace excavplan {
namespace {

using test::error_of;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = 3.14159265358979323846 / 180.0;

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

// A plane of gradient (gx, gy) occupies 1 + |gx| + |gy| voxels per column. The counts are those of
// PCL 1.13 with 5 cm voxels; random points miss a few corner voxels that the formula counts.
TEST(PaperVolume, SlopesAreCountedOncePerVoxelTheyCross) {
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
    const Cloud cloud =
        scan([&](double x, double y) { return 10.0 + gx * x + gy * y; }, area, 800000, 0.0, 1);
    const double volume = 3.2 * (10.0 + 4.0 * gx + 0.2 * gy);
    const double counted = 1.0 + gx + gy;
    EXPECT_NEAR(paper_volume(cloud, +1.0, 0.05) / volume, counted, tolerance * counted)
        << slope << " degrees towards " << azimuth;
    EXPECT_EQ(paper_volume(cloud, -1.0, 0.05), 0.0);
  }
}

// Ground at z = 0 lies on a face of the lattice: two voxels a column, at +-0.798 sigma.
TEST(PaperVolume, NoiseOnLevelGroundMakesSoil) {
  const Cloud cloud = scan(level, {0.0, 0.0, 4.0, 4.0}, 400000, 0.005, 2);
  EXPECT_NEAR(paper_volume(cloud, +1.0, 0.05), 0.0638, 0.0006);
  EXPECT_NEAR(paper_volume(cloud, -1.0, 0.05), 0.0638, 0.0006);
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
  Cloud dig_before = scan(level, {-1.0, -1.0, 4.0, 3.0}, 100000, 0.0, 10);
  Cloud dig_after = scan(
      [](double x, double y) { return x > 0.0 && x < 2.0 && y > 0.0 && y < 1.0 ? -0.226 : 0.0; },
      {-1.0, -1.0, 4.0, 3.0}, 100000, 0.0, 11);
  Cloud dump_before = scan(level, {-1.0, -1.0, 3.0, 3.0}, 100000, 0.0, 12);
  Cloud dump_after = scan(
      [](double x, double y) { return x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0 ? 0.124 : 0.0; },
      {-1.0, -1.0, 3.0, 3.0}, 100000, 0.0, 13);

  VolumeChange volumes(const PaperMethodOptions& options = {}) const {
    return paper_volumes(dig_before, dig_after, dump_before, dump_after, options);
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
  scene.dig_after = scene.dig_before;
  scene.dump_after = scene.dump_before;
  const VolumeChange change = scene.volumes();
  EXPECT_EQ(change.before.value, 0.0);
  EXPECT_EQ(change.after.value, 0.0);
}

TEST(PaperVolumes, StrayPointsAreRemoved) {
  Scene scene;
  const double clean = scene.volumes().spilled.value;
  for (int i = 0; i < 20; ++i) scene.dig_after.points.push_back({-0.9 + 0.2 * i, 2.5, 1.0});
  EXPECT_NEAR(scene.volumes().spilled.value, clean, 1e-9);
  PaperMethodOptions lenient;
  lenient.outlier_deviations = 1000.0;
  EXPECT_NEAR(scene.volumes(lenient).spilled.value, clean + 20 * 1.0 * 0.0025, 1e-5);
}

TEST(PaperVolumes, FewChangedPointsAreEnough) {
  Scene scene;
  scene.dig_after = scene.dig_before;
  scene.dig_after.points.push_back({0.01, 0.01, -0.52});
  EXPECT_NEAR(scene.volumes().excavated.value, 0.52 * 0.0025, 1e-6);
  for (int i = 0; i < 5; ++i) scene.dig_after.points.push_back({0.3 + 0.1 * i, 0.01, -0.52});
  EXPECT_GT(scene.volumes().excavated.value, 0.0);
}

TEST(PaperVolumes, EveryOptionActs) {
  const Scene scene;
  PaperMethodOptions options;
  options.outlier_deviations = 0.1;
  const double strict = scene.volumes(options).excavated.value;
  EXPECT_NE(strict, scene.volumes().excavated.value);
  options.outlier_neighbours = 2;
  EXPECT_NE(scene.volumes(options).excavated.value, strict);
  options = {};
  options.leaf = 0.07;
  EXPECT_NE(scene.volumes(options).excavated.value, scene.volumes().excavated.value);
}

TEST(PaperVolumes, RefuseWhatPclWouldGetWrong) {
  Scene scene;
  const auto error = [&](const PaperMethodOptions& options) {
    return error_of([&] { scene.volumes(options); });
  };
  PaperMethodOptions options;
  options.leaf = 0.0;
  EXPECT_EQ(error(options), "paper method: leaf is 0 m, must be > 0");
  options = {};
  options.outlier_neighbours = 0;
  EXPECT_EQ(error(options), "paper method: outlier_neighbours is 0, must be > 0");
  options = {};
  options.outlier_deviations = nan;
  EXPECT_EQ(error(options), "paper method: outlier_deviations is nan, must be > 0");
  scene.dump_after.points.push_back({1e4, 1e4, 3.0});
  EXPECT_NE(error({}).find("m holds more than 2^31 voxels of 0.05 m"), std::string::npos);
  scene.dump_after.points = {{nan, 0.0, 0.0}};
  EXPECT_EQ(error({}), "paper method: the cloud dump_after has no finite point");
  EXPECT_EQ(error_of([&] { paper_volume(scene.dig_before, 1.0, -1.0); }),
            "paper method: leaf is -1 m, must be > 0");
}

}  // namespace
}  // namespace excavplan
