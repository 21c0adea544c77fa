// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/scan_reading.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/change/volume_change.hpp>

#include "base/random.hpp"
#include "scans/scan_checks.hpp"
#include "scans/scan_pairs.hpp"

namespace excavplan {
namespace {

/// Level points over a square with this edge.
Scan level_scan(double edge, std::uint64_t seed) {
  Random random(seed);
  const auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 5000; ++i) {
    cloud->points.emplace_back(random.uniform(0.0, edge), random.uniform(0.0, edge),
                               0.002 * random.normal());
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  return scan;
}

bool names_units(const std::vector<Warning>& doubts) {
  return std::any_of(doubts.begin(), doubts.end(),
                     [](const Warning& doubt) { return doubt.code == WarningCode::units; });
}

TEST(ScanReading, AScanNarrowerThanAnyBucketIsInOtherUnits) {
  const auto in_doubt = [](double edge) {
    return names_units(check_outlines(outlined({level_scan(edge, 1), level_scan(edge, 2)}, 1)));
  };
  EXPECT_TRUE(in_doubt(0.25));
  EXPECT_FALSE(in_doubt(0.4)) << "as of a trial in a box of soil";
}

TEST(ScanReading, NoBucketDigsAThousandCubicMetres) {
  const auto in_doubt = [](double depth) {
    const HeightMap before = flat_ground({0.0, 0.0, 100.0, 60.0}, 0.5);
    HeightMap after = before;
    after.z.block(40, 40, 40, 50).setConstant(-depth);
    after.z.block(40, 120, 40, 50).setConstant(1.2 * depth);
    return names_units(check_volumes(measure_change(before, after), 1.0));
  };
  EXPECT_FALSE(in_doubt(0.4)) << "a dragline's 168 m^3 and more";
  EXPECT_TRUE(in_doubt(4.0));
}

TEST(ScanReading, ASensorThatStoodAtMoreThanFourPlacesMoved) {
  for (std::size_t places = 1; places <= 6; ++places) {
    Scan scan;
    for (std::size_t i = 0; i < places; ++i) {
      const auto cloud = std::make_shared<Cloud>(*level_scan(2.0, i).clouds.front());
      cloud->sensor_origin = Eigen::Vector3d(static_cast<double>(i), 0.0, 2.0);
      scan.clouds.push_back(cloud);
    }
    const std::vector<Standpoint> found = standpoints_of(scan);
    ASSERT_EQ(found.size(), places <= 4 ? places : 0);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].place, Eigen::Vector3d(static_cast<double>(i), 0.0, 2.0));
    }
  }
}

TEST(ScanReading, GroundDiffersByMoreThanTheScatterOfItsPoints) {
  const auto differs = [](double residual, double noise) {
    SurfacePair pair;
    pair.before.height = pair.after.height = flat_ground({0.0, 0.0, 4.0, 4.0}, 0.1);
    pair.before.variance = pair.after.variance =
        Eigen::ArrayXXd::Constant(40, 40, 0.5 * noise * noise);
    pair.alignment.residual_sd = residual;
    return leaves_difference(pair);
  };
  EXPECT_FALSE(differs(0.009, 0.001));
  EXPECT_TRUE(differs(0.011, 0.001));
  EXPECT_FALSE(differs(0.05, 0.02)) << "2.5 times the scatter";
  EXPECT_TRUE(differs(0.07, 0.02)) << "3.5 times the scatter";
}

}  // namespace
}  // namespace excavplan
