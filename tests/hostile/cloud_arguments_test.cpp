// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Hostile clouds, scans, poses and logs: what of the room survey needs no PCL.

#include <fstream>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/efficiency/efficiency.hpp>
#include <excavplan/scans/machine_front.hpp>
#include <excavplan/scans/scan_pose.hpp>
#include <excavplan/scans/scan_terrain.hpp>

#include "base/non_finite.hpp"
#include "support/hostile.hpp"

namespace excavplan {
namespace {

using test::answers;
using test::finite;
using test::refuses;

constexpr Rectangle square = {-1.0, -1.0, 1.0, 1.0};

/// 60 x 60 points of a floor that a sensor 2 m above sees.
Cloud floor_cloud() {
  Cloud cloud;
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      cloud.points.emplace_back(-1.0 + i / 30.0, -1.0 + j / 30.0, 0.001 * ((7 * i + 3 * j) % 5));
    }
  }
  cloud.width = cloud.points.size();
  cloud.sensor_origin = Eigen::Vector3d(0.0, 0.0, 2.0);
  return cloud;
}

Scan scan_of(const Cloud& cloud) {
  Scan scan;
  scan.clouds = {std::make_shared<const Cloud>(cloud)};
  return scan;
}

bool no_infinity(const HeightMap& map) { return !map.z.isInf().any(); }

std::vector<test::Function<Cloud>> cloud_functions() {
  return {
      {"summarise",
       [](const Cloud& c) {
         const CloudSummary summary = summarise(c);
         return summary.points == c.points.size() && !summary.frame_guess.empty();
       }},
      {"plan_extent", [](const Cloud& c) { return !std::isnan(plan_extent(c).x_max); }},
      {"rasterise", [](const Cloud& c) { return no_infinity(rasterise(c, square)); }},
      {"outline", [](const Cloud& c) { return outline(scan_of(c)).points == c.points.size(); }},
      {"survey_surface",
       [](const Cloud& c) { return no_infinity(survey_surface(scan_of(c), square).height); }},
      {"level_on_ground", [](const Cloud& c) { return finite(level_on_ground(c).site_from_scan); }},
      {"level_on_ground of a scan",
       [](const Cloud& c) { return finite(level_on_ground(scan_of(c)).site_from_scan); }},
      {"terrain_from_scan", [](const Cloud& c) {
         return no_infinity(terrain_from_scan(scan_of(c), square, 0.1).terrain.bank);
       }}};
}

TEST(HostileCloud, PointsAndPlaces) {
  const std::vector<test::Member<Cloud>> members = {
      {"x", [](Cloud& c) -> double& { return c.points[7].x(); }},
      {"y", [](Cloud& c) -> double& { return c.points[8].y(); }},
      {"z", [](Cloud& c) -> double& { return c.points[9].z(); }},
      {"sensor", [](Cloud& c) -> double& { return c.sensor_origin->z(); }}};
  std::vector<test::Function<Cloud>> quick = cloud_functions();
  quick.erase(quick.begin() + 5, quick.begin() + 7);  // levelling takes long
  test::make_hostile(floor_cloud(), members, quick);
  for (const double bad : test::hostile_numbers) {
    Cloud cloud = floor_cloud();
    cloud.sensor_origin->z() = bad;
    cloud.points[7].x() = bad;
    EXPECT_TRUE(answers([&] { return finite(level_on_ground(cloud).site_from_scan); })) << bad;
  }
}

TEST(HostileCloud, EmptyMovedAndDegenerate) {
  Cloud moved = floor_cloud();
  const Cloud taken = std::move(moved);
  Cloud unseen, far, one_line;
  unseen.points.assign(500, Eigen::Vector3d::Constant(nan));
  far.points.assign(500, Eigen::Vector3d::Zero());
  far.points.back() = Eigen::Vector3d::Constant(1e30);
  for (int i = 0; i < 500; ++i) one_line.points.emplace_back(i, 0.0, 0.0);
  for (const Cloud& cloud : {Cloud{}, moved, unseen, far, one_line}) {
    for (const auto& [name, call] : cloud_functions()) {
      EXPECT_TRUE(answers([&, &call = call] { return call(cloud); })) << name;
    }
  }
  EXPECT_TRUE(refuses([&] { plan_extent({}); }, "none of its 0 points"));
  EXPECT_TRUE(refuses([&] { level_on_ground(Cloud{}); }, "0 finite points"));
  EXPECT_TRUE(refuses([&] { write_cloud("x.pcd", moved, {"pcd", false}); }, "width x height"));
  EXPECT_TRUE(refuses([&] { write_cloud("x.pcd", taken, {}); }, "not a supported output format"));
  EXPECT_TRUE(refuses([&] { cloud_format_of_name(""); }));
  Cloud cloud = floor_cloud();
  EXPECT_TRUE(refuses([&] { transform(cloud, Eigen::Matrix4d::Constant(nan)); }, "transform"));
  // Two far groups of points fill few of very many cells.
  Cloud groups;
  for (int i = 0; i < 100000; ++i) {
    groups.points.emplace_back((i % 2) * 1e7 + 1e-3 * i, (i % 2) * 1e7 + 1e-3 * (i % 317), 0.0);
  }
  EXPECT_GT(summarise(groups).density, 0.0);
}

TEST(HostileCloud, RasterOptions) {
  const Cloud cloud = floor_cloud();
  const std::vector<test::Member<RasterOptions>> members = {
      {"cell", [](RasterOptions& o) -> double& { return o.cell_size; }},
      {"outliers", [](RasterOptions& o) -> double& { return o.outlier_distance; }},
      {"node", [](RasterOptions& o) -> double& { return o.node.x(); }}};
  test::make_hostile<RasterOptions>({}, members,
                                    {{"rasterise", [&](const RasterOptions& o) {
                                        return no_infinity(rasterise(cloud, square, o));
                                      }}});
  const std::vector<test::Member<Rectangle>> sides = {
      {"x_min", [](Rectangle& r) -> double& { return r.x_min; }},
      {"y_max", [](Rectangle& r) -> double& { return r.y_max; }}};
  test::make_hostile<Rectangle>(
      square, sides,
      {{"rasterise", [&](const Rectangle& r) { return no_infinity(rasterise(cloud, r)); }},
       {"terrain", [&](const Rectangle& r) {
          return no_infinity(terrain_from_scan(scan_of(cloud), r, 0.1).terrain.bank);
        }}});
  RasterOptions little;
  little.memory = 0;
  EXPECT_TRUE(answers([&] { return no_infinity(rasterise(cloud, square, little)); }));
  for (const double bad : {nan, infinity, -1.0, 0.0}) {
    EXPECT_TRUE(refuses([&] { terrain_from_scan(scan_of(cloud), square, bad); }, "cell_size"));
  }
}

TEST(HostileScan, NumbersAreRefused) {
  const auto refused = [](const std::function<void(Scan&)>& spoil, const char* what) {
    Scan scan = scan_of(floor_cloud());
    spoil(scan);
    EXPECT_TRUE(refuses([&] { outline(scan); }, what));
    EXPECT_TRUE(refuses([&] { survey_surface(scan, square); }, what));
    EXPECT_TRUE(refuses([&] { survey_surfaces({scan}, square); }, what));
    EXPECT_TRUE(refuses([&] { level_on_ground(scan); }, what));
    EXPECT_TRUE(refuses([&] { survey_registered({scan, scan}, square, {}, 0.1); }, what));
  };
  for (const double bad : {nan, infinity, -infinity}) {
    refused([=](Scan& s) { s.site_from_scan(1, 3) = bad; }, "site_from_scan");
    refused([=](Scan& s) { s.sensor_origin = Eigen::Vector3d(0, bad, 0); }, "sensor_origin");
    refused([=](Scan& s) { s.unit = bad; }, "unit");
  }
  for (const double bad : {0.0, -1.0}) refused([=](Scan& s) { s.unit = bad; }, "unit");
  refused([](Scan& s) { s.area = Rectangle{1.0, 0.0, nan, 1.0}; }, "area");
  refused([](Scan& s) { s.area = Rectangle{1.0, 0.0, 0.0, 1.0}; }, "area");
  refused([](Scan& s) { s.clouds.push_back(nullptr); }, "null pointer");
  const Scan good = scan_of(floor_cloud());
  for (const double bad : {nan, infinity, -1.0}) {
    EXPECT_TRUE(refuses([&] { survey_registered({good, good}, square, {}, bad); }, "registration"));
  }
  EXPECT_TRUE(refuses([&] { outlines({good}, 4000000000U); }, "number of threads"));
  EXPECT_TRUE(answers([] { return outline({}).points == 0; }));
  EXPECT_TRUE(answers([] { return survey_surface({}, square).height.z.isNaN().all(); }));
  for (const double bad : test::hostile_numbers) {
    ScanOutline outlined;
    outlined.density = bad;
    outlined.extent = square;
    EXPECT_TRUE(finite(cell_for({outlined})) && cell_for({outlined}) > 0.0) << bad;
  }
  EXPECT_GT(cell_for({}), 0.0);
}

TEST(HostilePose, PointsQuaternionsAndMachines) {
  const std::vector<Eigen::Vector3d> good = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  ASSERT_TRUE(finite(pose_of_points(good, good).rms));
  for (const double bad : {nan, infinity, 1e300}) {
    std::vector<Eigen::Vector3d> points = good;
    points[2].y() = bad;
    EXPECT_TRUE(refuses([&] { pose_of_points(points, good); }, "known point 3"));
    EXPECT_TRUE(refuses([&] { pose_of_points(good, points); }, "known point 3"));
    EXPECT_TRUE(refuses([&] { pose_of_quaternion({0, 0, bad}, {0, 0, 0, 1}); }) || bad == 1e300);
    EXPECT_TRUE(refuses([&] { pose_of_quaternion({0, 0, 0}, {0, bad, 0, 1}); }));
  }
  EXPECT_TRUE(refuses([] { pose_of_points({}, {}); }, "0 known points"));
  EXPECT_TRUE(refuses([&] { pose_of_points(good, {}); }, "each point needs one"));
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_TRUE(refuses([&] { MachineFront(machine, {bad, {}}); }, "swing"));
    EXPECT_TRUE(refuses([&] { MachineFront(machine, {0.0, {0.0, bad, 0.0}}); }, "joint"));
    EXPECT_TRUE(refuses([&] { MachineFront(machine, {}, bad); }, "margin"));
    EXPECT_FALSE(MachineFront(machine, {}).holds({bad, bad, bad}));
  }
  EXPECT_TRUE(refuses([] { MachineFront({}, {}); }, "machine"));
  MachineFront moved(machine, {});
  const MachineFront taken = std::move(moved);
  EXPECT_FALSE(moved.holds({5.0, 0.0, 1.0}));
  moved = taken;
}

TEST(HostileLog, DigsAndPayloads) {
  const std::string file = testing::TempDir() + "hostile_log.csv";
  std::ofstream(file) << "time_s,power_w\n0,1000\n1,1000\n2,1000\n";
  LoggedDig good;
  good.file = file;
  good.lifted = Payload{Lifted::mass, {500.0, nan}};
  ASSERT_TRUE(finite(measure_efficiency(good).value().value));
  for (const double bad : {nan, infinity, -infinity, -1.0}) {
    LoggedDig dig = good;
    dig.from = bad;
    EXPECT_TRUE(refuses([&] { measure_efficiency(dig); }, "from: "));
    dig = good;
    dig.to = bad;
    EXPECT_TRUE(refuses([&] { measure_efficiency(dig); }, "to: "));
    dig = good;
    dig.lifted = Payload{Lifted::mass, {bad, nan}};
    EXPECT_TRUE(refuses([&] { measure_efficiency(dig); }, "mass: "));
    if (std::isnan(bad)) continue;
    dig.lifted = Payload{Lifted::mass, {500.0, bad}};
    EXPECT_TRUE(refuses([&] { measure_efficiency(dig); }, "mass-sd: "));
  }
  EXPECT_TRUE(refuses([] { efficiency_gain({}, {}); }, "payload per cost"));
}

}  // namespace
}  // namespace excavplan
