// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/survey/scan_terrain.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "base/random.hpp"

#include "support/errors.hpp"

namespace excavplan {
namespace {

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
  for (const Warning& warning : ground.warnings) list.push_back(warning.code);
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

TEST(ScanTerrain, NarrowGapsAreFilledAndWideOnesStayUnknown) {
  const ScannedTerrain narrow = terrain_from_scan(slope(2000.0, 4.0, 4.2), extent, 0.05);
  EXPECT_EQ(codes(narrow), Codes{});
  EXPECT_NEAR(height_at(narrow.terrain.bank, 4.1, 0.0), 0.41, 0.01);
  const ScannedTerrain wide = terrain_from_scan(slope(2000.0, 4.0, 4.6), extent, 0.05);
  EXPECT_EQ(codes(wide), Codes{"unseen_ground"});
  EXPECT_TRUE(std::isnan(height_at(wide.terrain.bank, 4.3, 0.0)));
}

TEST(ScanTerrain, ScanElsewhereIsRefused) {
  Scan scan = slope(2000.0);
  scan.site_from_scan(0, 3) = 50.0;
  EXPECT_THROW(terrain_from_scan(scan, extent, 0.05), FrameError);
  EXPECT_EQ(test::error_of([&] { terrain_from_scan(slope(2000.0), extent, 0.0); }),
            "terrain from a scan: cell_size is 0, must be > 0 m and finite");
}

}  // namespace
}  // namespace excavplan
