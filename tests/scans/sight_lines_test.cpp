// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/sight_lines.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/change/bulking.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/scans/scan_surface.hpp>
#include <excavplan/sensing/depth_camera.hpp>

#include "base/non_finite.hpp"
#include "ground/sensor_place.hpp"
#include "support/survey_scenes.hpp"

namespace excavplan {
namespace {

using scenes::Dig;
using scenes::Part;

HeightMap blank(HeightMap map, const Rectangle& there) {
  for_each_cell(map.z, [&](Cell at) {
    if (there.contains(map.x(at.col), map.y(at.row))) map.z(at.row, at.col) = nan;
  });
  return map;
}

TEST(SightLines, TheLowestRayOverLevelGroundHitsTheNextCell) {
  const HeightMap map = flat_ground({0.0, 0.0, 4.0, 4.0}, 0.05);
  const SightLines sight(map, {-2.0, 2.0, 3.0});
  const Cell at = *cell_at(map, 1.0, 2.0);
  EXPECT_NEAR(sight.cells_to_rim(at), 1.0, 0.1);
  EXPECT_NEAR(sight.ceiling(at), 0.05 * 3.0 / 3.0, 0.005);
  EXPECT_FALSE(sight.faces_unseen(at));
}

TEST(SightLines, BehindARimTheCeilingFallsToWhatIsSeenNext) {
  // A pit of 0.5 m from x = 1 on; under a sensor 3 m up its floor is seen from x = 1.5 on.
  HeightMap map = flat_ground({0.0, 0.0, 4.0, 4.0}, 0.05);
  for_each_cell(map.z, [&](Cell at) {
    if (map.x(at.col) > 1.0) map.z(at.row, at.col) = -0.5;
  });
  map = blank(std::move(map), {1.0, 0.0, 1.5, 4.0});
  const SightLines sight(map, {-2.0, 2.0, 3.0});
  for (const double x : {1.1, 1.3}) {
    const Cell at = *cell_at(map, x, 2.0);
    EXPECT_NEAR(sight.ceiling(at), 3.0 - (map.x(at.col) + 2.0), 0.04) << x;
  }
  EXPECT_TRUE(sight.hides(*cell_at(map, 0.98, 2.0)));
  EXPECT_FALSE(sight.hides(*cell_at(map, 0.9, 2.0)));
}

TEST(SightLines, AGapInTheScanIsNoShadow) {
  const HeightMap map = blank(flat_ground({0.0, 0.0, 4.0, 4.0}, 0.05), {1.0, 1.5, 1.5, 2.5});
  const SightLines sight(map, {-2.0, 2.0, 3.0});
  EXPECT_TRUE(sight.faces_unseen(*cell_at(map, 0.98, 2.0)));
  EXPECT_FALSE(sight.hides(*cell_at(map, 0.98, 2.0)));
}

TEST(SightLines, ReturnsMixedAtARimAreDropped) {
  Surface surface;
  surface.height = flat_ground({0.0, 0.0, 4.0, 4.0}, 0.05);
  surface.sensors = {{-2.0, 2.0, 3.0}};
  HeightMap& map = surface.height;
  surface.points.setConstant(map.z.rows(), map.z.cols(), 20);
  surface.variance.setConstant(map.z.rows(), map.z.cols(), 1e-5);
  for_each_cell(map.z, [&](Cell at) {
    if (map.x(at.col) > 1.0) map.z(at.row, at.col) = -0.5;
    const Eigen::Vector3d point(map.x(at.col), map.y(at.row), map.z(at.row, at.col));
    const Eigen::Vector3d ray = surface.sensors[0] - point;
    surface.points(at.row, at.col) = static_cast<int>(600.0 * ray.z() / std::pow(ray.norm(), 3));
  });
  map = blank(std::move(map), {1.0, 0.0, 1.5, 4.0});
  const Cell mixed = *cell_at(map, 1.22, 2.0);
  map.z(mixed.row, mixed.col) = 3.0 - (map.x(mixed.col) + 2.0);
  surface.points(mixed.row, mixed.col) = 2;
  const Eigen::ArrayXXi dropped = drop_mixed_returns(surface);
  EXPECT_TRUE(std::isnan(map.z(mixed.row, mixed.col)));
  EXPECT_EQ(dropped.sum(), 1);
}

bool has_warning(const VolumeChange& change, const std::string& code) {
  return std::any_of(change.warnings.begin(), change.warnings.end(),
                     [&](const Warning& warning) { return code_text(warning.code) == code; });
}

// ---- One standpoint ---------------------------------------------------------------------------

/// The whole scene from one place, by a lidar: walls of 80 degrees.
class OneStandpoint : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dig.wall_angle = 80.0 * scenes::degree;
    before = scan(false);
    after = scan(true);
  }

  static VolumeChange measured(bool known, const ChangeOptions& options = {}) {
    ScanPair scans = {before, after};
    if (known) scans.before.sensor_origin = scans.after.sensor_origin = place;
    RasterOptions raster;
    raster.cell_size = 0.06;
    return measure_change(survey_registered(scans, extent, raster, 0.06).surfaces, options);
  }

  static Scan scan(bool dug) {
    HeightMap map = flat_ground(extent, 0.02);
    for_each_cell(map.z, [&](Cell at) {
      const double there = scenes::change_at(dig, Part::whole, map.x(at.col), map.y(at.row));
      if (dug) map.z(at.row, at.col) = there;
    });
    Lidar lidar;
    lidar.position = place;
    lidar.azimuth = {0.45, pi - 0.45};
    lidar.elevation = {-1.1, -0.6};
    lidar.angle_step = {0.003, 0.003};
    auto cloud = std::make_shared<Cloud>();
    cloud->points = scan_surface(map, lidar, dug ? 2 : 1);
    Scan scan;
    scan.clouds = {cloud};
    return scan;
  }

  static constexpr Rectangle extent = {-2.4, -2.0, 7.2, 2.0};
  static inline const Eigen::Vector3d place = {2.6, -4.2, 4.5};
  static inline Dig dig;
  static inline Scan before;
  static inline Scan after;
};

TEST_F(OneStandpoint, ShadowsAreFilledWithinTheirErrorWhereTheSensorIsKnown) {
  const VolumeChange change = measured(true);
  const auto k = bulking_factor(change);
  ASSERT_TRUE(k);
  EXPECT_NEAR(k->value, dig.bulking, 0.03 * dig.bulking);
  EXPECT_NEAR(k->value, dig.bulking, 2.0 * k->sd);
  EXPECT_LT(k->sd, 0.06 * dig.bulking);
  EXPECT_GT(change.errors.holes(0, 0), 0.5 * change.errors.total()(0, 0));
  EXPECT_NEAR(change.dumped.value, dig.heap_volume(), 0.03 * dig.heap_volume());
}

TEST_F(OneStandpoint, TellsItsPlaceByThePointsOnSlopes) {
  RasterOptions raster;
  raster.cell_size = 0.06;
  const auto found = infer_sensor(survey_surface(after, extent, raster));
  ASSERT_TRUE(found);
  EXPECT_LT((found->place() - place).norm(), 0.15 * place.norm());
  const Eigen::Vector3d pit(dig.pit_x, dig.pit_y, 0.0);
  const auto tangent = [&](const Eigen::Vector3d& from) {
    return (pit - from).head<2>().norm() / from.z();
  };
  EXPECT_NEAR(tangent(found->place()), tangent(place), 2.0 * found->tangent_sd(pit));
}

TEST_F(OneStandpoint, IsToldByNoEvenGroundAndNoThinnedPoints) {
  RasterOptions raster;
  raster.cell_size = 0.06;
  EXPECT_FALSE(infer_sensor(survey_surface(before, extent, raster)));
  Surface thinned = survey_surface(after, extent, raster);
  thinned.points = thinned.points.min(1);
  EXPECT_FALSE(infer_sensor(thinned));
}

TEST_F(OneStandpoint, ShadowsAreFilledWithinTheirErrorWhereOnlyTheScanTellsItsPlace) {
  const VolumeChange change = measured(false);
  const auto k = bulking_factor(change);
  ASSERT_TRUE(k);
  EXPECT_NEAR(k->value, dig.bulking, 0.03 * dig.bulking);
  EXPECT_NEAR(k->value, dig.bulking, 2.0 * k->sd);
  EXPECT_GT(k->sd, bulking_factor(measured(true))->sd);
  EXPECT_TRUE(has_warning(change, "sensor_place_inferred"));
  EXPECT_FALSE(has_warning(measured(true), "sensor_place_inferred"));
}

TEST_F(OneStandpoint, ShadowsOfAHoleDoNotEndTrustWhereTheSensorIsKnown) {
  ChangeOptions options;
  options.max_unknown_share = 0.05;
  const VolumeChange change = measured(true, options);
  const auto hole = std::find_if(change.zones.begin(), change.zones.end(),
                                 [](const ChangeZone& z) { return z.kind == ZoneKind::dig; });
  ASSERT_NE(hole, change.zones.end());
  EXPECT_GT(hole->unknown_share, options.max_unknown_share);
  for (const Warning& warning : change.warnings) {
    const bool is_of_hole = warning.message.find("ground that fell") != std::string::npos;
    EXPECT_FALSE(is_of_hole && warning.code == WarningCode::zone_partly_unseen) << warning.message;
  }
}

// ---- Two standpoints --------------------------------------------------------------------------

TEST(AllSightLines, BoundUnseenGroundByWhatEachPlaceSawItself) {
  const HeightMap map = blank(flat_ground({0.0, 0.0, 4.0, 4.0}, 0.05), {1.0, 0.0, 1.5, 4.0});
  Surface surface;
  surface.sensors = {{-2.0, 2.0, 3.0}, {8.0, 2.0, 3.0}};
  surface.seen_from.setConstant(map.z.rows(), map.z.cols(), 3);
  const SightLines left(map, surface.sensors[0]);
  const SightLines right(map, surface.sensors[1]);
  const Cell at = *cell_at(map, 1.4, 2.0);
  EXPECT_EQ(AllSightLines(map, surface).ceiling(at), std::min(left.ceiling(at), right.ceiling(at)));
  EXPECT_LT(left.ceiling(at), right.ceiling(at));
  for_each_cell(map.z, [&](Cell cell) {
    if (map.x(cell.col) > 1.5) surface.seen_from(cell.row, cell.col) = 2;
  });
  EXPECT_EQ(AllSightLines(map, surface).ceiling(at), right.ceiling(at));
}

/// Low lidars on either side, as two clouds of each scan.
class TwoStandpoints : public testing::Test {
 protected:
  static Scan scan(const Dig& dig, bool dug, bool known) {
    HeightMap map = flat_ground(extent, 0.02);
    for_each_cell(map.z, [&](Cell at) {
      const double there = scenes::change_at(dig, Part::whole, map.x(at.col), map.y(at.row));
      if (dug) map.z(at.row, at.col) = there;
    });
    Scan scan;
    for (const double side : {-1.0, 1.0}) {
      Lidar lidar;
      lidar.position = {1.5, side * 2.8, 2.5};
      lidar.azimuth = {0.2 - (side > 0.0 ? pi : 0.0), pi - 0.2 - (side > 0.0 ? pi : 0.0)};
      lidar.elevation = {-1.2, -0.35};
      lidar.angle_step = {0.006, 0.004};
      auto cloud = std::make_shared<Cloud>();
      cloud->points = scan_surface(map, lidar, (dug ? 4 : 2) + (side > 0.0 ? 1 : 0));
      if (known) cloud->sensor_origin = lidar.position;
      scan.clouds.push_back(cloud);
    }
    return scan;
  }

  static VolumeChange measured(const Dig& dig, bool known) {
    RasterOptions raster;
    raster.cell_size = 0.05;
    const ScanPair scans = {scan(dig, false, known), scan(dig, true, known)};
    return measure_change(survey_registered(scans, extent, raster, 0.06).surfaces);
  }

  static constexpr Rectangle extent = {-2.4, -2.0, 7.2, 2.0};
};

TEST_F(TwoStandpoints, ReturnsMixedFromOnePlaceAreLeftOutWhereTheOtherSees) {
  Dig dig;
  dig.wall_angle = 80.0 * scenes::degree;
  const VolumeChange known = measured(dig, true);
  const VolumeChange unknown = measured(dig, false);
  const double truth = dig.pit_volume();
  EXPECT_LT(std::abs(known.excavated.value - truth),
            0.6 * std::abs(unknown.excavated.value - truth));
  EXPECT_NEAR(known.excavated.value, truth, 3.0 * known.excavated.sd);
}

TEST(ScanSensor, IsThatOfAllItsCloudsInTheSiteFrame) {
  auto cloud = std::make_shared<Cloud>();
  cloud->points = {{0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}};
  cloud->sensor_origin = Eigen::Vector3d(1.0, 2.0, 3.0);
  auto other = std::make_shared<Cloud>(*cloud);
  Scan scan;
  scan.clouds = {cloud, other};
  scan.site_from_scan(0, 3) = 10.0;
  const auto sensors = [&] { return survey_surface(scan, {9.0, -1.0, 12.0, 2.0}).sensors; };
  using Places = std::vector<Eigen::Vector3d>;
  EXPECT_EQ(sensors(), Places({{11.0, 2.0, 3.0}}));
  other->sensor_origin = Eigen::Vector3d(5.0, 2.0, 3.0);
  EXPECT_EQ(sensors(), Places({{11.0, 2.0, 3.0}, {15.0, 2.0, 3.0}}));
  other->sensor_origin.reset();
  EXPECT_TRUE(sensors().empty());
  scan.sensor_origin = Eigen::Vector3d(0.0, 0.0, 2.0);
  EXPECT_EQ(sensors(), Places({{10.0, 0.0, 2.0}}));
}

}  // namespace
}  // namespace excavplan
