// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/noisy_scan.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <excavplan/ground/plain_ground.hpp>

#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

/// Of level ground, seen from 3 m above the origin.
Scan flat_scan(double z, double reach) {
  auto cloud = std::make_shared<Cloud>();
  cloud->sensor_origin = Eigen::Vector3d(0.0, 0.0, 3.0);
  for (double x = 0.5; x < reach; x += 0.02) {
    for (double y = -1.0; y < 1.0; y += 0.02) cloud->points.emplace_back(x, y, z);
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  scan.z_is_up = true;
  return scan;
}

TEST(NoisyScan, ItsHeightsErrAsStatedForTheirRange) {
  const SensorErrors stereo = {0.001, 0.0012, 2.0};
  const ScanHeights heights =
      heights_of(flat_scan(0.0, 6.0), stereo, flat_ground({0.0, -1.0, 8.0, 1.0}, 0.05));
  const auto sd_at = [&](double x) {
    const auto at = *cell_at(flat_ground({0.0, -1.0, 8.0, 1.0}, 0.05), x, 0.0);
    return heights.sd(at.row, at.col);
  };
  // The range of 4 m has a height error of 3 / 4 of that along it.
  const double shared = 0.0012 * 16.0 * 0.75;
  EXPECT_GT(sd_at(std::sqrt(7.0)), shared);
  EXPECT_LT(sd_at(std::sqrt(7.0)), 1.15 * shared);
  EXPECT_GT(sd_at(5.0), 1.5 * sd_at(2.0));
  EXPECT_TRUE(heights.z(5, 150) != heights.z(5, 150)) << "nobody saw what is 7.5 m away";
}

TEST(NoisyScan, ManyTellMoreThanOneAndAChangeBeginsAnew) {
  Terrain ground = undisturbed(flat_ground({0.0, 0.0, 0.1, 0.05}, 0.05));
  Eigen::ArrayXXd sd = Eigen::ArrayXXd::Constant(1, 2, std::nan(""));
  ScanHeights scan = {ground.bank.z, Eigen::ArrayXXd::Constant(1, 2, 0.02)};
  scan.z << 0.02, 0.3;
  fuse(scan, ground, sd);
  EXPECT_NEAR(ground.bank.z(0, 0), 0.01, 1e-12) << "the first scan of a place counts alike";
  EXPECT_NEAR(sd(0, 0), 0.02 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(ground.bank.z(0, 1), 0.3, 1e-12);
  EXPECT_NEAR(sd(0, 1), 0.02, 1e-12);
  scan.z << 0.04, 0.3;
  fuse(scan, ground, sd);
  EXPECT_NEAR(ground.bank.z(0, 0), 0.02, 1e-12);
}

}  // namespace
}  // namespace excavplan
