// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/scan_surface.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <excavplan/scans/scan_pose.hpp>

#include "base/random.hpp"

#include "base/non_finite.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"
#include "support/survey_scenes.hpp"

namespace excavplan {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using Shape = std::function<double(double x, double y)>;

const Rectangle field{0.0, 0.0, 3.0, 2.0};

double level(double, double) { return 0.0; }

/// Points spread evenly over the plan, with noise in height.
Points sampled(const Shape& shape, const Rectangle& area, std::size_t count, double noise,
               std::uint64_t seed) {
  Random random(seed);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(area.x_min, area.x_max);
    const double y = random.uniform(area.y_min, area.y_max);
    points.emplace_back(x, y, shape(x, y) + noise * random.normal());
  }
  return points;
}

class Folder : public test::TemporaryFolder {
 public:
  /// @return the file's path
  std::string write(const std::string& name, const Points& points,
                    CloudFormat format = CloudFormat{"pcd"}) const {
    Cloud cloud;
    cloud.points = points;
    cloud.width = points.size();
    write_cloud(file(name), cloud, format);
    return file(name);
  }
};

Scan scan_of(std::vector<std::string> files) {
  Scan scan;
  scan.files = std::move(files);
  return scan;
}

Surface surface_of(const Points& points, const Rectangle& extent, double cell) {
  const Folder folder;
  RasterOptions options;
  options.cell_size = cell;
  return survey_surface(scan_of({folder.write("a.pcd", points)}), extent, options);
}

template <typename Array>
bool same_bytes(const Array& a, const Array& b) {
  const auto bytes = static_cast<std::size_t>(a.size()) * sizeof(typename Array::Scalar);
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), bytes) == 0;
}

bool same_surface(const Surface& a, const Surface& b) {
  return same_grid(a.height, b.height) && same_bytes(a.height.z, b.height.z) &&
         same_bytes(a.variance, b.variance) && same_bytes(a.points, b.points);
}

double mean_known(const Eigen::ArrayXXd& z) {
  return z.isNaN().select(0.0, z).sum() / static_cast<double>(z.size() - z.isNaN().count());
}

// ---- Streams ----------------------------------------------------------------------------------

TEST(ScanSurface, IsThatOfTheWholeCloudToTheByteHoweverItIsRead) {
  const Folder folder;
  const Points points = sampled([](double x, double y) { return 0.2 * x - std::abs(y - 1.0); },
                                field, 30000, 0.005, 1);
  Cloud cloud;
  cloud.points = points;
  folder.write("all.pcd", points);
  folder.write("all.ply", points, CloudFormat{"ply", true});
  folder.write("a.xyz", {points.begin(), points.begin() + 12345}, CloudFormat{"xyz"});
  folder.write("b.ply", {points.begin() + 12345, points.end()}, CloudFormat{"ply", true});
  const Surface whole = survey_surface(scan_of({folder.file("all.ply")}), field);
  EXPECT_TRUE(same_bytes(whole.height.z, rasterise(cloud, field).z));
  EXPECT_TRUE(same_surface(
      whole, survey_surface(scan_of({folder.file("a.xyz"), folder.file("b.ply")}), field)));
  for (const std::uint64_t memory : {20000U, 80000U, 200000U}) {
    RasterOptions options;
    options.memory = memory;
    EXPECT_TRUE(
        same_surface(whole, survey_surface(scan_of({folder.file("all.ply")}), field, options)))
        << memory;
  }
}

TEST(ScanSurface, KeepsAnEvenChoiceOfManyPointsOfACell) {
  const Rectangle patch{0.0, 0.0, 0.3, 0.2};
  Points points = sampled(level, patch, 60000, 0.005, 3);
  for (std::size_t i = 0; i < points.size(); ++i) {  // a drift along the file
    points[i].z() += 0.01 * static_cast<double>(i) / 60000.0;
  }
  const Folder folder;
  folder.write("all.ply", points, CloudFormat{"ply", true});
  folder.write("a.ply", {points.begin(), points.begin() + 777}, CloudFormat{"ply", true});
  folder.write("b.ply", {points.begin() + 777, points.end()}, CloudFormat{"ply", true});
  const Surface whole = survey_surface(scan_of({folder.file("all.ply")}), patch);
  EXPECT_TRUE(same_surface(
      whole, survey_surface(scan_of({folder.file("a.ply"), folder.file("b.ply")}), patch)));
  RasterOptions options;
  options.memory = 10000;
  EXPECT_TRUE(
      same_surface(whole, survey_surface(scan_of({folder.file("all.ply")}), patch, options)));
  EXPECT_NEAR(whole.points.sum(), 60000, 300);  // all but outliers count
  for (Eigen::Index i = 0; i < whole.height.z.size(); ++i) {
    EXPECT_NEAR(whole.height.z(i), 0.005, 4.0 * std::sqrt(whole.variance(i)));
  }
}

TEST(ScanSurface, GridStartsAtTheNode) {
  RasterOptions options;
  options.cell_size = 0.1;
  options.node = {0.03, -0.04};
  const Folder folder;
  const Scan scan = scan_of({folder.write("a.pcd", sampled(level, field, 20000, 0.0, 1))});
  const Surface surface = survey_surface(scan, {0.03, 0.06, 1.0, 1.0}, options);
  EXPECT_NEAR(surface.height.origin.x(), 0.03, 1e-12);
  EXPECT_NEAR(surface.height.origin.y(), 0.06, 1e-12);
  EXPECT_EQ(surface.height.z.cols(), 10);
}

TEST(ScanSurface, OutliersAreFoundWhereCellsHoldTwoPoints) {
  Points points = sampled(level, field, 1200, 0.005, 5);
  for (std::size_t i = 0; i < points.size(); i += 60) points[i].z() += 0.5;
  const Surface surface = surface_of(points, field, 0.1);
  EXPECT_LT(surface.height.z.isNaN().select(0.0, surface.height.z).abs().maxCoeff(), 0.05);
}

TEST(ScanSurface, DoesNotDependOnTheNumberOfThreads) {
  const Folder folder;
  std::vector<Scan> scans;
  for (int i = 0; i < 5; ++i) {
    scans.push_back(
        scan_of({folder.write(std::to_string(i) + ".pcd",
                              sampled(level, field, 20000, 0.01, static_cast<std::uint64_t>(i)))}));
  }
  const std::vector<Surface> one = survey_surfaces(scans, field, {}, 1);
  for (const unsigned threads : {0U, 2U, 7U}) {
    const std::vector<Surface> many = survey_surfaces(scans, field, {}, threads);
    ASSERT_EQ(many.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_TRUE(same_surface(one[i], many[i]));
  }
}

TEST(ScanSurface, FrameAndAreaHoldWhileItIsRead) {
  const Folder folder;
  Points points = sampled([](double x, double) { return 0.1 * x; }, field, 30000, 0.005, 2);
  Eigen::Isometry3d site_from_scan(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  site_from_scan.translation() = Eigen::Vector3d(30.0, -7.0, 2.0);
  Points moved;
  for (const auto& p : points) moved.push_back(site_from_scan.inverse() * p);
  Scan scan = scan_of({folder.write("moved.ply", moved, CloudFormat{"ply", true})});
  scan.site_from_scan = site_from_scan.matrix();
  const Surface straight = surface_of(points, field, 0.1);
  RasterOptions options;
  options.cell_size = 0.1;
  const Surface turned = survey_surface(scan, field, options);
  EXPECT_LT((turned.height.z - straight.height.z).abs().maxCoeff(), 1e-5);

  scan.area = Rectangle{1.0, 0.5, 2.0, 1.0};
  EXPECT_EQ(survey_surface(scan, field, options).height.z.isNaN().count(), 30 * 20 - 10 * 5);
  const ScanOutline seen = outline(scan);
  EXPECT_NEAR(static_cast<double>(seen.finite_points), 30000.0 / 12.0, 150.0);
  EXPECT_EQ(seen.points, seen.finite_points);
  EXPECT_NEAR(seen.extent->x_min, 1.0, 0.01);
  EXPECT_NEAR(seen.extent->y_max, 1.0, 0.01);
}

TEST(ScanSurface, TellsWhichFileIsBad) {
  const Folder folder;
  const std::string good = folder.write("good.pcd", {{0.0, 0.0, 0.0}});
  const std::string bad = folder.file("bad.xyz");
  std::ofstream(bad) << "1 2 3\n1 2\n";
  EXPECT_EQ(test::error_about(
                [&] {
                  survey_surface(scan_of({good, bad}), field);
                },
                bad),
            "line 2: found 2 columns, expected x, y and z");
  EXPECT_EQ(test::error_about(
                [&] {
                  outline(scan_of({bad, good}));
                },
                bad),
            "line 2: found 2 columns, expected x, y and z");
  RasterOptions options;
  options.cell_size = -1.0;
  EXPECT_EQ(test::error_of([&] { survey_surface(scan_of({good}), field, options); }),
            "rasterise: cell is -1 m, must be > 0");
}

// ---- Heights ----------------------------------------------------------------------------------

TEST(ScanSurface, UnseenCellsAreUnknown) {
  const Surface surface =
      surface_of({{0.05, 0.05, 0.7}, {0.15, 0.05, nan}, {0.25, 0.05, 1.0}, {0.26, 0.05, 1.2}},
                 {0.0, 0.0, 0.3, 0.2}, 0.1);
  EXPECT_EQ(surface.height.z.isNaN().count(), 4);
  EXPECT_NEAR(surface.height.z(0, 0), 0.7, 1e-6);
  EXPECT_NEAR(surface.height.z(0, 2), 1.1, 1e-6);
  EXPECT_TRUE(std::isnan(surface.variance(0, 0)));  // one point has no scatter
  EXPECT_NEAR(surface.variance(0, 2), 0.01, 1e-6);  // 0.2^2 / 2 / 2
  EXPECT_TRUE(std::isnan(surface.variance(0, 1)));
  EXPECT_EQ(surface.points.sum(), 3);
}

TEST(ScanSurface, APlaneIsExactFromTwoPointsPerCellUp) {
  const auto plane = [](double x, double y) { return 0.4 * x - 0.6 * y + 3.0; };
  for (const double per_cell : {2.0, 5.0, 12.0, 50.0, 400.0}) {
    const auto count = static_cast<std::size_t>(per_cell * 600.0);
    const Surface surface = surface_of(sampled(plane, field, count, 0.0, 3), field, 0.1);
    double worst = 0.0;
    double sum = 0.0;
    int known = 0;
    for (Eigen::Index c = 2; c < 28; ++c) {
      for (Eigen::Index r = 2; r < 18; ++r) {
        if (std::isnan(surface.height.z(r, c))) continue;
        const double off = surface.height.z(r, c) - plane(surface.height.x(c), surface.height.y(r));
        worst = std::max(worst, std::abs(off));
        sum += off * off;
        ++known;
      }
    }
    EXPECT_GT(known, 300) << per_cell;
    // Plain means would be off by 0.021 m / sqrt(per_cell) in the mean square.
    EXPECT_LT(std::sqrt(sum / 416.0), per_cell < 8.0 ? 0.008 / std::sqrt(per_cell) : 2e-3)
        << per_cell;
    if (per_cell >= 50.0) {
      EXPECT_LT(worst, 2e-6) << per_cell;
    }
  }
}

TEST(ScanSurface, VarianceIsThatOfTheHeight) {
  const Shape slope = [](double x, double y) { return 0.5 * x + 0.2 * y; };
  const Rectangle wide{0.0, 0.0, 10.0, 10.0};
  for (const double per_cell : {4.0, 12.0, 30.0, 100.0}) {
    const auto count = static_cast<std::size_t>(per_cell * 10000.0);
    const Surface surface = surface_of(sampled(slope, wide, count, 0.02, 4), wide, 0.1);
    double squares = 0.0;
    double variances = 0.0;
    double cells = 0.0;
    for (Eigen::Index c = 1; c < 99; ++c) {
      for (Eigen::Index r = 1; r < 99; ++r) {
        if (std::isnan(surface.variance(r, c))) continue;
        const double off = surface.height.z(r, c) - slope(surface.height.x(c), surface.height.y(r));
        squares += off * off;
        variances += surface.variance(r, c);
        cells += 1.0;
      }
    }
    // Chi-square over some 9600 cells: 1.4 % each way, more where cells have few points.
    EXPECT_NEAR(squares / variances, 1.0, per_cell < 5.0 ? 0.15 : 0.08) << per_cell;
    EXPECT_NEAR(variances / cells * per_cell / (0.02 * 0.02), 1.1, 0.25) << per_cell;
  }
}

TEST(ScanSurface, NoScanIsBetterThanATenthOfAMillimetre) {
  const Surface surface = surface_of(sampled(level, field, 60000, 0.0, 5), field, 0.1);
  EXPECT_EQ(surface.variance.minCoeff(), 1e-8);
  EXPECT_EQ(surface.variance.maxCoeff(), 1e-8);
}

TEST(ScanSurface, OutliersAreLeftOutAtAnyDensity) {
  for (const double per_cell : {2.0, 4.0, 20.0, 200.0}) {
    const auto count = static_cast<std::size_t>(per_cell * 2400.0);
    Points points = sampled(level, field, count, 0.005, 6);
    Random random(7);
    for (std::size_t i = 0; i < points.size(); i += 100) {
      points[i].z() += random.uniform(0.1, 1.0);
    }
    const Surface surface = surface_of(points, field, 0.05);
    const Eigen::ArrayXXd& z = surface.height.z;
    EXPECT_LT((z.abs() > 0.05).count(), 5) << per_cell;
    EXPECT_NEAR(mean_known(z), 0.0, per_cell < 3.0 ? 4e-4 : 2e-4) << per_cell;  // 5.5 mm else
  }
}

/// A pit with vertical walls whose floor the sensor sees a third as often as the ground around.
Points pit_seen_from_its_rim(double off, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Points points;
  while (points.size() < count) {
    const double x = random.uniform(0.0, 3.0);
    const double y = random.uniform(0.0, 2.0);
    const bool in_pit = x > 1.0 + off && x < 2.0 + off && y > 0.7 + off && y < 1.3 + off;
    if (in_pit && random.uniform() > 1.0 / 3.0) continue;
    points.emplace_back(x, y, (in_pit ? -0.25 : 0.0) + 0.004 * random.normal());
  }
  return points;
}

// 1 m x 0.6 m x 0.25 m: 0.15 m^3. By their points the 64 cells at the walls would be off by 0.11 m
// times the cell's edge on the average (integral of f - f / (3 - 2 f), times the depth): 4.7 %.
TEST(ScanSurface, AWallCountsByItsAreaNotByItsPoints) {
  for (const double per_cell : {30.0, 120.0, 400.0}) {
    double sum = 0.0;
    for (int i = 0; i < 10; ++i) {
      const auto count = static_cast<std::size_t>(per_cell * 2400.0);
      const Points points =
          pit_seen_from_its_rim(0.005 * i, count, static_cast<std::uint64_t>(10 + i));
      sum -= surface_of(points, field, 0.05).height.z.sum() * 0.0025;
    }
    EXPECT_NEAR(sum / 10.0, 0.15, (per_cell < 100.0 ? 0.02 : 0.012) * 0.15) << per_cell;
  }
}

TEST(ScanSurface, LargeCoordinatesLoseNothing) {
  const Shape shape = [](double x, double y) { return 0.2 * x - 0.1 * y; };
  Points points = sampled(shape, field, 40000, 0.005, 8);
  const Surface near = surface_of(points, field, 0.25);
  const Eigen::Vector3d far(4e6, 5e6, 4000.0);
  for (auto& point : points) point += far;
  const Surface moved = surface_of(points, {4e6, 5e6, 4e6 + 3.0, 5e6 + 2.0}, 0.25);
  EXPECT_LT((near.height.z + 4000.0 - moved.height.z).abs().maxCoeff(), 1e-6);
  EXPECT_LT((near.variance / moved.variance - 1.0).abs().maxCoeff(), 1e-3);
}

// ---- Two levels -------------------------------------------------------------------------------

/// Ground with plants 10 to 40 cm high on half of it, which hide `cover` of it.
Points with_plants(double cover, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Points points = sampled(level, field, count, 0.004, seed);
  for (auto& p : points) {
    if (p.x() > 1.5 && random.uniform() < cover) p.z() = random.uniform(0.10, 0.40);
  }
  return points;
}

TEST(ScanSurface, GroundIsUnderThePlantsThatStandOnIt) {
  for (const double cover : {0.2, 0.5, 0.7}) {
    const Surface surface = surface_of(with_plants(cover, 72000, 9), field, 0.05);
    const Eigen::ArrayXXd planted = surface.height.z.rightCols(29);
    EXPECT_LT((planted.abs() > 0.01).count(), planted.size() / 100) << cover;
    EXPECT_NEAR(planted.mean(), 0.0, 2e-3) << cover;  // 0.05 to 0.18 m else
  }
}

TEST(ScanSurface, AKerbAndASlotNarrowerThanACellAreNoPlants) {
  for (const double height : {0.15, -0.15}) {
    double sum = 0.0;
    for (int i = 0; i < 10; ++i) {
      const double y0 = 1.0 + 0.005 * i;
      const auto strip = [&](double x, double y) {
        return x > 0.5 && x < 2.5 && y > y0 && y < y0 + 0.08 ? height : 0.0;
      };
      const Points points = sampled(strip, field, 72000, 0.003, static_cast<std::uint64_t>(20 + i));
      sum += surface_of(points, field, 0.05).height.z.sum() * 0.0025;
    }
    EXPECT_NEAR(sum / 10.0, 2.0 * 0.08 * height, 0.015 * 0.16 * 0.15) << height;
  }
}

// The cell of the apex is the highest of all around, and its highest points lie in the middle,
// among the others in plan.
TEST(ScanSurface, TheTopOfAHeapIsNeitherPlantNorOutlier) {
  const Shape heap = [](double x, double y) {
    return std::max(0.0, 0.6 - 0.7 * std::hypot(x - 1.5, y - 1.0));
  };
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const double noise = seed % 2 == 0 ? 0.0 : 0.002;
    const Surface surface = surface_of(sampled(heap, field, 6000, noise, seed), field, 0.125);
    EXPECT_EQ(surface.height.z.isNaN().count(), 0) << seed;
    sum += surface.height.z.sum() * 0.125 * 0.125;
  }
  EXPECT_NEAR(sum / 40.0, 0.4616, 0.003 * 0.4616);  // pi / 3 (0.6 / 0.7)^2 0.6
}

TEST(ScanSurface, VolumeBetweenWallsStaysUnbiasedAtAnyHeadingAndDensity) {
  for (const std::size_t count : {24000u, 240000u}) {
    double sum = 0.0;
    double truth = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      scenes::Dig dig = scenes::random_dig(seed);
      dig.wall_angle = 89.0 * scenes::degree;
      const scenes::ScanErrors errors = scenes::errors_of("noise");
      const auto map = [&](bool after) {
        const Points points = scenes::scan(dig, scenes::Part::dig, errors, count, seed, after);
        return surface_of(points, scenes::dig_extent, count > 100000 ? 0.05 : 0.10).height.z;
      };
      const Eigen::ArrayXXd change = map(true) - map(false);
      sum += change.isNaN().select(0.0, change).sum() * (count > 100000 ? 0.0025 : 0.01);
      truth += dig.ridge_volume() - dig.pit_volume();
    }
    EXPECT_NEAR(sum, truth, (count > 100000 ? 0.001 : 0.006) * std::abs(truth)) << count;
  }
}

// ---- Summary and conversion -------------------------------------------------------------------

/// Of 300 x 200 points, some of which are not finite, seen from a place.
Cloud organised_cloud() {
  Cloud cloud;
  cloud.points = sampled([](double x, double y) { return 0.2 * x * y; }, field, 60000, 0.01, 4);
  for (std::size_t i = 0; i < cloud.points.size(); i += 100) cloud.points[i].z() = nan;
  cloud.width = 300;
  cloud.height = 200;
  cloud.sensor_origin = Eigen::Vector3d(0.5, -1.25, 2.0);
  return cloud;
}

void expect_same(const CloudSummary& a, const CloudSummary& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.finite_points, b.finite_points);
  EXPECT_EQ(a.left_out, b.left_out);
  EXPECT_EQ(a.centroid, b.centroid);
  EXPECT_EQ(a.min, b.min);
  EXPECT_EQ(a.max, b.max);
  EXPECT_EQ(a.extent->x_min, b.extent->x_min);
  EXPECT_EQ(a.extent->y_max, b.extent->y_max);
  EXPECT_EQ(a.density, b.density);
  EXPECT_EQ(a.frame_guess, b.frame_guess);
}

TEST(ScanSummary, IsThatOfTheWholeCloudToTheByte) {
  const Folder folder;
  Cloud cloud = organised_cloud();
  const Eigen::Matrix4d pose = pose_of_quaternion({1.0, 2.0, 0.5}, {0.0, 0.36, 0.48, 0.8});
  const std::pair<const char*, CloudFormat> files[] = {
      {"a.pcd", {"pcd", true}}, {"a.ply", {"ply", true}}, {"a.xyz", {"xyz"}}};
  for (const auto& [name, format] : files) write_cloud(folder.file(name), cloud, format);
  for (const bool is_moved : {false, true}) {
    if (is_moved) transform(cloud, pose);
    const CloudSummary whole = summarise(cloud);
    EXPECT_EQ(whole.extent->x_max, plan_extent(cloud).x_max);
    for (const auto& [name, format] : files) {
      Scan scan = scan_of({folder.file(name)});
      if (is_moved) scan.site_from_scan = pose;
      const CloudSummary seen = summarise(scan);
      expect_same(seen, whole);
      EXPECT_EQ(seen.width, format.name == "pcd" ? 300U : 60000U);
      EXPECT_EQ(seen.height, format.name == "pcd" ? 200U : 1U);
    }
  }
}

TEST(ScanSummary, PointsThatAreLeftOutAreOutOfOrder) {
  Cloud cloud = organised_cloud();
  cloud.left_out = 3;
  Scan scan;
  scan.clouds = {std::make_shared<const Cloud>(cloud)};
  EXPECT_EQ(summarise(scan).width, 300U);
  scan.area = Rectangle{0.0, 0.0, 1.5, 2.0};
  const CloudSummary half = summarise(scan);
  EXPECT_LT(half.points, 35000U);
  EXPECT_EQ(half.width, half.points);
  EXPECT_EQ(half.height, 1U);
  scan.area.reset();
  scan.clouds.push_back(scan.clouds.front());
  const CloudSummary both = summarise(scan);
  EXPECT_EQ(both.width, 120000U);
  EXPECT_EQ(both.height, 1U);
  EXPECT_EQ(both.left_out, 6U);
}

TEST(WriteScan, GivesTheBytesOfTheWholeCloud) {
  const Folder folder;
  const Cloud near = organised_cloud();
  Cloud far = near;
  transform(far, pose_of_quaternion({5e5, 5.7e6, 100.0}, {0.0, 0.0, 0.0, 1.0}));
  for (const Cloud& cloud : {near, far}) {
    write_cloud(folder.file("source.pcd"), cloud, {"pcd", true});
    for (const CloudFormat& format :
         {CloudFormat{"pcd"}, {"pcd", true}, {"ply"}, {"ply", true}, {"xyz"}}) {
      Scan scan = scan_of({folder.file("source.pcd")});
      write_cloud(folder.file("streamed"), scan, format);
      write_cloud(folder.file("whole"), cloud, format);
      EXPECT_EQ(test::content_of(folder.file("streamed")), test::content_of(folder.file("whole")));
      scan.site_from_scan = pose_of_quaternion({1.0, 2.0, 0.5}, {0.0, 0.36, 0.48, 0.8});
      Cloud moved = cloud;
      transform(moved, scan.site_from_scan);
      write_cloud(folder.file("streamed"), scan, format);
      write_cloud(folder.file("whole"), moved, format);
      EXPECT_EQ(test::content_of(folder.file("streamed")), test::content_of(folder.file("whole")));
    }
  }
}

TEST(WriteScan, TakesTheFileItReads) {
  const Folder folder;
  const Cloud cloud = organised_cloud();
  write_cloud(folder.file("a.pcd"), cloud, {"pcd", true});
  write_cloud(folder.file("a.pcd"), scan_of({folder.file("a.pcd")}), {"xyz"});
  const Cloud read = read_cloud(folder.file("a.pcd"));
  ASSERT_EQ(read.points.size(), cloud.points.size());
  EXPECT_EQ(read.points[1], cloud.points[1]);
}

// ---- Outline ----------------------------------------------------------------------------------

TEST(ScanOutline, OfASmallScanIsThatOfTheCloud) {
  const Folder folder;
  Cloud cloud;
  cloud.points = sampled(level, field, 20000, 0.01, 1);
  cloud.points.push_back({nan, 0.0, 0.0});
  const ScanOutline seen =
      outline(scan_of({folder.write("a.ply", cloud.points, CloudFormat{"ply", true})}));
  const Rectangle extent = plan_extent(cloud);
  EXPECT_EQ(seen.points, 20001u);
  EXPECT_EQ(seen.finite_points, 20000u);
  EXPECT_EQ(seen.extent->x_min, extent.x_min);
  EXPECT_EQ(seen.extent->y_max, extent.y_max);
  EXPECT_DOUBLE_EQ(seen.density, summarise(cloud).density);
}

TEST(ScanOutline, OfALargeScanComesFromAChoiceOfItsPoints) {
  const Folder folder;
  Cloud cloud;
  cloud.points = sampled(level, field, 400000, 0.01, 1);
  for (int i = 0; i < 300; ++i) cloud.points.push_back({1e4, -1e4, 50.0});
  const ScanOutline seen = outline(scan_of({folder.write("a.pcd", cloud.points)}));
  EXPECT_EQ(seen.finite_points, 400300u);
  EXPECT_NEAR(seen.extent->x_min, 0.0, 0.01);
  EXPECT_NEAR(seen.extent->x_max, 3.0, 0.01);
  EXPECT_NEAR(seen.extent->y_min, 0.0, 0.01);
  EXPECT_NEAR(seen.density, 400000.0 / 6.0, 0.05 * 400000.0 / 6.0);
}

TEST(ScanOutline, PointsHalfAMetreBeforeADepthCameraAreAheadAlongZ) {
  const Folder folder;
  for (const double ahead : {0.5, -0.5}) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 400; ++i) points.emplace_back(0.01 * (i % 20), 0.01 * (i / 20), ahead);
    const ScanOutline seen = outline(scan_of({folder.write("a.pcd", points)}));
    EXPECT_EQ(seen.seen_along_z, ahead > 0.0 ? 1.0 : 0.0);
  }
}

TEST(ScanOutline, OfNothingIsUnknown) {
  const Folder folder;
  const ScanOutline seen = outline(scan_of({folder.write("a.pcd", {{nan, nan, nan}})}));
  EXPECT_EQ(seen.points, 1u);
  EXPECT_EQ(seen.finite_points, 0u);
  EXPECT_FALSE(seen.extent);
  EXPECT_TRUE(std::isnan(seen.density));
}

TEST(SurveyCell, HoldsTwoPointsOfTheSparsestScan) {
  ScanOutline sparse;
  sparse.extent = Rectangle{0.0, 0.0, 10.0, 6.0};
  sparse.density = 200.0;
  EXPECT_DOUBLE_EQ(survey_cell({sparse}), 0.1);
  sparse.density = 1e5;
  EXPECT_DOUBLE_EQ(survey_cell({sparse}), 0.05);
}

TEST(CellFor, HoldsTwelvePointsOfTheSparsestScan) {
  ScanOutline dense;
  dense.extent = Rectangle{0.0, 0.0, 10.0, 6.0};
  dense.density = 1e5;
  ScanOutline sparse = dense;
  sparse.density = 300.0;
  EXPECT_DOUBLE_EQ(cell_for({dense, sparse}), 0.2);
  EXPECT_DOUBLE_EQ(cell_for({dense, dense}), 0.05);
  dense.extent = Rectangle{0.0, 0.0, 2.0, 1.0};  // a heap on a table
  EXPECT_DOUBLE_EQ(cell_for({dense}), std::sqrt(12.0 / 1e5));
  dense.density = 1e7;
  EXPECT_DOUBLE_EQ(cell_for({dense}), 0.01);
}

TEST(ScanSurface, PointsOnTwoSurfacesMakeTheHeightDoubtful) {
  const Rectangle patch{0.0, 0.0, 1.0, 1.0};
  const auto doubt = [&](const Shape& shape, double above, std::size_t more) {
    Points points = sampled(shape, patch, 8000, 0.003, 1);
    const Points others =
        sampled([&](double x, double y) { return shape(x, y) + above; }, patch, more, 0.003, 2);
    points.insert(points.end(), others.begin(), others.end());
    return surface_of(points, patch, 0.05).doubt.mean();
  };
  const Shape slope = [](double x, double y) { return 0.8 * x - 0.5 * y; };
  const Shape wall = [](double x, double) { return x > 0.52 ? 0.3 : 0.0; };
  for (const Shape& shape : {Shape(level), slope}) {
    EXPECT_EQ(doubt(shape, 0.0, 0), 0.0);
    EXPECT_EQ(doubt(shape, 0.01, 2000), 0.0);                // as rough ground
    EXPECT_NEAR(doubt(shape, 0.2, 2000), 0.2 * 0.2, 0.005);  // a fifth lies above
    EXPECT_GT(doubt(shape, -0.2, 2000), 0.03);  // by which one counts: of a fifth or of the rest
    EXPECT_LT(doubt(shape, -0.2, 2000), 0.17);
    EXPECT_NEAR(doubt(shape, 0.2, 8000), 0.2 * 0.47, 0.012);  // of 40 a half, or the smaller
  }
  EXPECT_LT(doubt(wall, 0.0, 0), 0.002);
  const Shape oblique = [](double x, double y) { return x + 0.36 * y > 0.71 ? 0.5 : 0.0; };
  for (const std::size_t points : {400u, 2000u, 8000u}) {  // of cells with 1 to 20 points
    const Surface surface = surface_of(sampled(oblique, patch, points, 0.003, 3), patch, 0.05);
    EXPECT_LT(surface.doubt.mean(), 0.002) << points;
  }
}

TEST(ScanSurface, OutliersOnASlopeAreTold) {
  const Rectangle patch{0.0, 0.0, 2.0, 2.0};
  const Shape steep = [](double x, double y) { return 0.8 * x - 0.5 * y; };
  for (const double off : {-0.1, 0.1}) {
    Points points = sampled(steep, patch, 16000, 0.003, 1);
    for (std::size_t i = 0; i < points.size(); i += 20) points[i].z() += off;
    const Surface surface = surface_of(points, patch, 0.05);
    const Eigen::ArrayXXd inside = surface.height.z.block(2, 2, 36, 36);
    double miss = 0.0;
    for (Eigen::Index col = 2; col < 38; ++col) {
      for (Eigen::Index row = 2; row < 38; ++row) {
        miss += surface.height.z(row, col) - steep(surface.height.x(col), surface.height.y(row));
      }
    }
    EXPECT_NEAR(miss / static_cast<double>(inside.size()), 0.0, 0.0005) << off;
    EXPECT_LT(std::abs(surface.outlier_bias.block(2, 2, 36, 36).mean()), 0.0005F) << off;
  }
}

TEST(ScanSurface, OutliersOfEvenGroundAreExpectedWhereItIsUneven) {
  const Rectangle patch{0.0, 0.0, 2.0, 2.0};
  const Shape half_rough = [](double x, double y) {
    return x < 1.0 ? 0.0 : 0.2 * std::sin(40.0 * x) * std::sin(40.0 * y);
  };
  const auto bias = [&](double off) {
    Points points = sampled(half_rough, patch, 16000, 0.003, 1);
    for (std::size_t i = 0; i < points.size(); i += 20) points[i].z() += off;
    const Surface surface = surface_of(points, patch, 0.05);
    return std::pair(surface.outlier_bias.block(2, 2, 36, 15).mean(),
                     surface.outlier_bias.block(2, 24, 36, 14).mean());
  };
  for (const double off : {-0.1, 0.1}) {
    const auto [even, rough] = bias(off);
    EXPECT_NEAR(even, 0.0, 0.0002);
    EXPECT_NEAR(rough, 0.05 * off, 0.2 * std::abs(0.05 * off));  // a twentieth of the points
  }
  EXPECT_NEAR(bias(0.0).second, 0.0, 0.0002);
}

TEST(ScanSurface, OutliersOfFewPointsOnGroundThatIsNowhereEvenAreExpectedToo) {
  const Rectangle patch{0.0, 0.0, 6.0, 4.0};
  const Shape half_rough = [](double x, double y) {
    const double relief =
        std::sin(7.0 * x) * std::cos(9.0 * y) + 0.7 * std::sin(15.0 * x + 4.0 * y);
    return x < 4.0 ? 0.015 * relief : 0.2 * std::sin(20.0 * x) * std::sin(20.0 * y);
  };
  for (const double off : {-0.08, 0.08}) {
    Points points = sampled(half_rough, patch, 24000, 0.003, 1);
    for (std::size_t i = 0; i < points.size(); i += 20) points[i].z() += off;
    const Surface surface = surface_of(points, patch, 0.1);
    const auto rough = static_cast<double>(surface.outlier_bias.block(2, 42, 36, 16).mean());
    EXPECT_NEAR(rough, 0.05 * off, 0.3 * std::abs(0.05 * off));
  }
}

TEST(ScanSurface, RoundingCutsNoPoints) {
  const Rectangle patch{0.0, 0.0, 2.0, 2.0};
  Points points = sampled(level, patch, 16000, 0.003, 1);
  const int kept = surface_of(points, patch, 0.05).points.sum();
  for (Eigen::Vector3d& p : points) p.z() = 0.01 * std::round(p.z() / 0.01);
  EXPECT_GT(surface_of(points, patch, 0.05).points.sum(), 0.995 * kept);
}

TEST(ScanSurface, KnowsTheLowestPointOfEachCell) {
  const Rectangle patch{0.0, 0.0, 0.5, 0.5};
  Points points = sampled(level, patch, 2000, 0.003, 1);
  for (Eigen::Vector3d& p : points) p.z() = std::max(p.z(), -0.002);
  const Surface surface = surface_of(points, patch, 0.05);
  EXPECT_NEAR((surface.height.z - surface.below.cast<double>()).minCoeff(), -0.002, 1e-6);
  EXPECT_TRUE((surface.below > 0.0F).all());
}

TEST(ScanSurface, RoundedHeightsAreTold) {
  const Folder folder;
  const auto step_of = [&](double step, std::size_t apart = 0) {
    Points points =
        sampled([](double x, double y) { return 0.3 * x + 0.1 * y; }, field, 4000, 0.005, 1);
    for (std::size_t i = apart; i < points.size(); ++i) {
      if (step > 0.0) points[i].z() = step * std::round(points[i].z() / step);
    }
    return outline(scan_of({folder.write("rounded.pcd", points)})).height_step;
  };
  EXPECT_EQ(step_of(0.0), 0.0);
  for (const double step : {0.01, 0.03, 0.1}) EXPECT_NEAR(step_of(step), step, 1e-6);
  EXPECT_NEAR(step_of(0.03, 40), 0.03, 1e-6) << "but for 40 points";
}

/// Steps of a drawing are heights that a few points share each.
TEST(ScanSurface, HeightsThatFewPointsShareAreNotRounded) {
  const Folder folder;
  const auto step_of = [&](int points_at_each) {
    Points points;
    for (int i = 0; i < 10 * points_at_each; ++i) {
      const double along = 0.07 * i;
      points.emplace_back(along, std::fmod(0.31 * i, 1.0), 0.02 * (i / points_at_each));
    }
    return outline(scan_of({folder.write("steps.pcd", points)})).height_step;
  };
  EXPECT_EQ(step_of(5), 0.0);
  EXPECT_NEAR(step_of(12), 0.02, 1e-6);
}

}  // namespace
}  // namespace excavplan
