// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/resampling.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/scans/scan_terrain.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/random.hpp"
#include "base/text.hpp"

#include "support/errors.hpp"
#include "support/machine_file.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using test::zx120;

const Rectangle extent{2.0, -1.0, 6.0, 1.0};

/// A slope of 0.1 that points show `per_area` times a square metre, but for a hole
/// a metre long.
Scan slope(double per_area, double gap_from = 0.0, double gap_to = 0.0) {
  Random random(3);
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < static_cast<int>(per_area * 9.0 * 5.0); ++i) {
    const double x = random.uniform(0.0, 9.0);
    const double y = random.uniform(-2.5, 2.5);
    if (x < gap_from || x >= gap_to || std::abs(y) > 0.5) cloud->points.emplace_back(x, y, 0.1 * x);
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  return scan;
}

std::vector<std::string> codes(const ScannedTerrain& ground) {
  std::vector<std::string> list;
  for (const Warning& warning : ground.warnings) list.push_back(code_text(warning.code));
  return list;
}

using Codes = std::vector<std::string>;

TEST(ScanTerrain, IsTheGroundOfTheScanOnTheGridAskedFor) {
  const ScannedTerrain ground = terrain_from_scan(slope(2000.0), extent, 0.05);
  EXPECT_EQ(ground.terrain.bank.cell_size, 0.05);
  EXPECT_NEAR(height_at(ground.terrain.bank, 4.0, 0.3), 0.4, 0.002);
  EXPECT_TRUE(ground.terrain.bank.z.allFinite());
  EXPECT_EQ(codes(ground), Codes{});
}

/// Level ground, x and y from -9 m in these steps, except where `hides`.
template <typename Hides>
Scan level(double step, double height, const Hides& hides) {
  auto cloud = std::make_shared<Cloud>();
  for (double x = -9.0; x < 9.0; x += step) {
    for (double y = -9.0; y < 9.0; y += step) {
      if (!hides(x, y)) cloud->points.emplace_back(x, y, height);
    }
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  return scan;
}
bool nothing(double /*x*/, double /*y*/) { return false; }
bool left(double /*x*/, double y) { return y > 0.0; }

double known_share(const Terrain& terrain) {
  return static_cast<double>(terrain.bank.z.isFinite().count()) /
         static_cast<double>(terrain.bank.z.size());
}

/// A wall may stand between the points.
TEST(SwingTerrain, KnowsNothingBetweenPointsThatAreFarApart) {
  EXPECT_GT(known_share(swing_terrain_from_scan(level(0.2, 0.0, nothing), zx120()).terrain), 0.8);
  const Scan sparse = level(1.2, 0.0, nothing);
  EXPECT_LT(known_share(swing_terrain_from_scan(sparse, zx120()).terrain), 0.1);
  EXPECT_GT(
      known_share(terrain_from_scan(sparse, swing_extent(zx120()), usual_cell(zx120())).terrain),
      0.8)
      << "ground to dig on is interpolated";
}

/// However dense it is along the lines.
TEST(SwingTerrain, SpacingOfLinesDecides) {
  const auto known = [](double apart) {
    auto cloud = std::make_shared<Cloud>();
    for (double x = -10.0; x < 10.0; x += 0.02) {
      for (double y = -10.0; y < 10.0; y += apart) cloud->points.emplace_back(x, y, 0.0);
    }
    cloud->width = cloud->points.size();
    Scan scan;
    scan.clouds = {cloud};
    return known_share(swing_terrain_from_scan(scan, zx120()).terrain);
  };
  EXPECT_GT(known(0.1), 0.99);
  EXPECT_GT(known(0.15), 0.99);
  EXPECT_GT(known(0.24), 0.99);
  EXPECT_LT(known(0.52), 0.2);
  EXPECT_LT(known(0.7), 0.2);
}

TEST(SwingTerrain, AnEarlierScanFillsWhatThePresentOneDoesNotSee) {
  const auto seen = [](const Scan& scan) { return swing_terrain_from_scan(scan, zx120()).terrain; };
  const Terrain present = seen(level(0.1, 0.5, left)), earlier = seen(level(0.1, 0.6, nothing));
  const ScannedTerrain both = with_surroundings(present, earlier);
  EXPECT_EQ(codes(both), Codes{});
  EXPECT_NEAR(height_at(both.terrain.bank, 4.0, -3.0), 0.5, 1e-9);
  EXPECT_NEAR(height_at(both.terrain.bank, 4.0, 3.0), 0.6, 1e-9);
  EXPECT_TRUE(std::isnan(height_at(with_surroundings(present, present).terrain.bank, 4.0, 3.0)));
  EXPECT_EQ(
      test::error_of([&] { with_surroundings(present, undisturbed(flat_ground(extent, 0.1))); }),
      "surroundings: must have the cells of the present ground");
}

TEST(SwingTerrain, OneInAnotherFrameIsToldByTheGroundThatBothSee) {
  const auto seen = [](const Scan& scan) { return swing_terrain_from_scan(scan, zx120()).terrain; };
  const Terrain present = seen(level(0.1, 0.0, left));
  const ScannedTerrain low = with_surroundings(present, seen(level(0.1, -0.4, nothing)));
  ASSERT_EQ(codes(low), Codes{"surroundings_differ"});
  EXPECT_TRUE(low.warnings[0].ends_trust);
  Terrain dug = present;
  dug.bank.z.leftCols(dug.bank.z.cols() / 3) -= 1.0;
  EXPECT_EQ(codes(with_surroundings(dug, seen(level(0.1, 0.0, nothing)))), Codes{})
      << "ground that was dug since";
}

TEST(ScanTerrain, ScanIsTakenIntoTheSiteFrame) {
  Scan scan = slope(2000.0);
  scan.site_from_scan(2, 3) = 1.5;
  EXPECT_NEAR(height_at(terrain_from_scan(scan, extent, 0.05).terrain.bank, 4.0, 0.3), 1.9, 0.002);
}

TEST(ScanTerrain, FewPointsAreInterpolatedAndSaidToBeFew) {
  const ScannedTerrain ground = terrain_from_scan(slope(40.0), extent, 0.05);
  EXPECT_EQ(codes(ground), Codes{"sparse_terrain"});
  EXPECT_NEAR(height_at(ground.terrain.bank, 4.0, 0.3), 0.4, 0.02);
}

/// A layer above the slope on a part of it, as of a second scan whose pose differs.
Scan two_layers(double apart, double up_to_x, double share = 0.5) {
  Scan scan = slope(1000.0);
  auto both = std::make_shared<Cloud>(*scan.clouds.front());
  Random random(11);
  const double upper = 1000.0 * share / (1.0 - share) * up_to_x * 5.0;
  for (double i = 0.0; i < upper; i += 1.0) {
    const double x = random.uniform(0.0, up_to_x);
    both->points.emplace_back(x, random.uniform(-2.5, 2.5), 0.1 * x + apart);
  }
  for (Eigen::Vector3d& p : both->points) p.z() += 0.005 * random.normal();
  both->width = both->points.size();
  scan.clouds = {both};
  return scan;
}

TEST(ScanTerrain, TwoSurfacesAreToldAndEndTrust) {
  for (const double apart : {0.15, 0.25, 0.4}) {
    for (const double share : {0.3, 0.5, 0.7}) {
      const ScannedTerrain all = terrain_from_scan(two_layers(apart, 9.0, share), extent, 0.05);
      ASSERT_EQ(codes(all), Codes{"two_surfaces"}) << apart << ' ' << share;
      EXPECT_TRUE(all.warnings[0].ends_trust) << all.warnings[0].message << share;
      ASSERT_EQ(all.terrain.doubts.size(), 1U);
    }
    EXPECT_EQ(codes(terrain_from_scan(two_layers(apart, 3.0), extent, 0.05)), Codes{"two_surfaces"})
        << "on a quarter of the ground, " << apart;
  }
  EXPECT_EQ(codes(terrain_from_scan(two_layers(0.0, 9.0), extent, 0.05)), Codes{});
  EXPECT_EQ(codes(terrain_from_scan(two_layers(0.01, 9.0), extent, 0.05)), Codes{});
}

TEST(ScanTerrain, TwoSurfacesEndTheTrustOfAPlan) {
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  Terrain ground = level_planning_ground(zx120(), 0.1);
  EXPECT_TRUE(plan_dig(zx120(), loam, GroundDensity{40.0}, ground).trustworthy);
  ground.doubts = terrain_from_scan(two_layers(0.2, 9.0), extent, 0.05).warnings;
  const DigPlan plan = plan_dig(zx120(), loam, GroundDensity{40.0}, ground);
  EXPECT_FALSE(plan.trustworthy);
  ASSERT_FALSE(plan.warnings.empty());
  EXPECT_EQ(plan.warnings.front().code, WarningCode::two_surfaces);
}

/// Some of the points at one height, which may be on no list.
Scan with_no_data(double height, double share) {
  Scan scan = slope(2000.0);
  auto cloud = std::make_shared<Cloud>(*scan.clouds.front());
  const auto every = static_cast<std::size_t>(std::lround(1.0 / share));
  for (std::size_t i = 0; i < cloud->points.size(); i += every) cloud->points[i].z() = height;
  scan.clouds = {cloud};
  return scan;
}

TEST(ScanTerrain, PointsWithoutDataAreNamedAndLeftOut) {
  for (const double height : {-9999.0, -10000.0, 65.535, -32.768, 1234.5}) {
    for (const double share : {0.05, 0.1, 0.34}) {
      const ScannedTerrain ground = terrain_from_scan(with_no_data(height, share), extent, 0.05);
      ASSERT_EQ(codes(ground), Codes{"outliers"}) << height << ' ' << share;
      const std::string& message = ground.warnings[0].message;
      EXPECT_NE(message.find("have z = " + number_text(height) + ", which stands for no data"),
                std::string::npos)
          << message;
      EXPECT_FALSE(ground.warnings[0].ends_trust);
      EXPECT_NEAR(height_at(ground.terrain.bank, 4.0, 0.3), 0.4, 0.002);
    }
  }
  const ScannedTerrain few = terrain_from_scan(with_no_data(-9999.0, 0.02), extent, 0.05);
  EXPECT_EQ(codes(few), Codes{"outliers"}) << "a known value needs few points";
  EXPECT_NE(few.warnings[0].message.find("% of the points, about 1"), std::string::npos)
      << few.warnings[0].message;
}

TEST(ScanTerrain, NarrowGapsAreFilledAndWideOnesStayUnknown) {
  const ScannedTerrain narrow = terrain_from_scan(slope(2000.0, 4.0, 4.2), extent, 0.05);
  EXPECT_EQ(codes(narrow), Codes{});
  EXPECT_NEAR(height_at(narrow.terrain.bank, 4.1, 0.0), 0.41, 0.01);
  const ScannedTerrain wide = terrain_from_scan(slope(2000.0, 4.0, 4.6), extent, 0.05);
  EXPECT_EQ(codes(wide), Codes{"unseen_ground"});
  EXPECT_TRUE(std::isnan(height_at(wide.terrain.bank, 4.3, 0.0)));
}

/// What the points within a metre of the extent show if they are held.
HeightMap held_ground(const Scan& scan, double cell_size) {
  Cloud near;
  for (const auto& cloud : scan.clouds) {
    for (const Eigen::Vector3d& p : cloud->points) {
      const Rectangle around{extent.x_min - 1.0, extent.y_min - 1.0, extent.x_max + 1.0,
                             extent.y_max + 1.0};
      if (p.allFinite() && around.contains(p.x(), p.y())) near.points.push_back(p);
    }
  }
  const double cell = std::max(cell_size, std::sqrt(2.0 / summarise(near).density));
  return resampled(rasterise(near, plan_extent(near), {cell}), extent, cell_size,
                   std::max(0.3, 3.0 * cell));
}

void expect_same_bytes(const HeightMap& a, const HeightMap& b) {
  ASSERT_TRUE(same_grid(a, b));
  const auto bytes = static_cast<std::size_t>(a.z.size()) * sizeof(double);
  EXPECT_EQ(std::memcmp(a.z.data(), b.z.data(), bytes), 0);
}

TEST(ScanTerrain, IsThatOfThePointsHeldToTheByte) {
  const test::TemporaryFolder folder;
  for (const double per_area : {40.0, 2000.0}) {
    Scan held = slope(per_area, 4.0, 4.4);
    auto noisy = std::make_shared<Cloud>(*held.clouds.front());
    Random random(7);
    for (Eigen::Vector3d& p : noisy->points) p.z() += 0.01 * random.normal();
    noisy->points.front().z() = std::nan("");
    noisy->sensor_origin = Eigen::Vector3d(-3.0, 0.0, 2.0);
    held.clouds.front() = noisy;
    const HeightMap ground = held_ground(held, 0.05);
    expect_same_bytes(terrain_from_scan(held, extent, 0.05).terrain.bank, ground);
    Scan streamed;
    streamed.files = {folder.file("a.pcd")};
    write_cloud(streamed.files.front(), *noisy, {"pcd", true});
    expect_same_bytes(terrain_from_scan(streamed, extent, 0.05).terrain.bank, ground);
    auto beside = std::make_shared<Cloud>(*noisy);
    beside->sensor_origin = Eigen::Vector3d(3.0, 5.0, 2.0);
    held.clouds.push_back(beside);
    expect_same_bytes(terrain_from_scan(held, extent, 0.05).terrain.bank, held_ground(held, 0.05));
  }
}

TEST(ScanTerrain, KnowsNothingOutsideTheAreaOfTheScan) {
  Scan scan = slope(2000.0);
  scan.area = Rectangle{0.0, -2.5, 4.0, 2.5};
  const ScannedTerrain ground = terrain_from_scan(scan, extent, 0.05);
  EXPECT_NEAR(height_at(ground.terrain.bank, 3.0, 0.3), 0.3, 0.002);
  EXPECT_TRUE(std::isnan(height_at(ground.terrain.bank, 5.0, 0.3)));
  scan.area = Rectangle{0.0, -2.5, 0.5, 2.5};
  EXPECT_THROW(terrain_from_scan(scan, extent, 0.05), FrameError);
}

TEST(ScanTerrain, ScanInAnotherUnitIsRefusedWithItsName) {
  Scan scan = slope(2000.0);
  Cloud in_mm = *scan.clouds.front();
  for (Eigen::Vector3d& point : in_mm.points) point *= 1000.0;
  const auto error = [&] {
    return test::error_of([&] { terrain_from_scan(scan, extent, 0.05); }, ErrorKind::bad_file);
  };
  scan.unit = 0.001;
  EXPECT_NE(error().find("with coordinates in m it"), std::string::npos) << error();
  scan.clouds = {std::make_shared<const Cloud>(in_mm)};
  EXPECT_NEAR(height_at(terrain_from_scan(scan, extent, 0.05).terrain.bank, 4.0, 0.3), 0.4, 0.002);
  scan.unit = 1.0;
  EXPECT_NE(error().find("with coordinates in mm it"), std::string::npos) << error();
}

TEST(ScanTerrain, ScanElsewhereIsRefused) {
  Scan scan = slope(2000.0);
  scan.site_from_scan(0, 3) = 50.0;
  EXPECT_THROW(terrain_from_scan(scan, extent, 0.05), FrameError);
  EXPECT_EQ(test::error_of([&] { terrain_from_scan(slope(2000.0), extent, 0.0); }),
            "terrain from a scan: cell_size is 0, must be > 0 m and finite");
}

/// The slope with one coordinate of all its points changed.
Scan slope_with(const std::string& name, Eigen::Index axis, double value) {
  Scan scan = slope(2000.0);
  scan.name = name;
  Cloud cloud = *scan.clouds.front();
  for (Eigen::Vector3d& point : cloud.points) point[axis] = value;
  scan.clouds = {std::make_shared<const Cloud>(cloud)};
  return scan;
}

TEST(ScanTerrain, PointsOnALineAreRefusedWithTheirName) {
  const Scan scan = slope_with("line.xyz", 1, 0.25);
  const auto refused = [&](auto read) { return test::error_of(read, ErrorKind::bad_file); };
  const std::string error = refused([&] { terrain_from_scan(scan, extent, 0.05); });
  EXPECT_EQ(error.find("line.xyz: the points within the machine's reach lie on a line, x = "), 0u)
      << error;
  EXPECT_NE(error.find("must spread over 0.00100 m or more"), std::string::npos) << error;
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  EXPECT_NE(refused([&] { swing_terrain_from_scan(scan, machine); }).find("lie on a line"),
            std::string::npos);
}

TEST(ScanTerrain, HeightsThatCannotBeAreRefusedWithTheirName) {
  const Scan scan = slope_with("high.xyz", 2, 2e6);
  EXPECT_EQ(test::error_of([&] { terrain_from_scan(scan, extent, 0.05); }, ErrorKind::bad_file),
            "high.xyz: a height of the ground is 2000000 m from 0, must be at most 1000000 m");
}

}  // namespace
}  // namespace excavplan
