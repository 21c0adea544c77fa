// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/las_file.hpp"
#include "support/tool_answers.hpp"

/// @file
/// inspect-cloud: what is in a scan, and scans written in other formats.

namespace excavplan::test {
namespace {

TEST_F(Tools, InspectCloudGivesTheKeysOfTheContract) {
  const std::string file = folder.write("three.xyz", "0 0 0\n2 0 1\nnan nan nan\n1 3 2\n");
  const json result = answer("inspect-cloud", {file});
  EXPECT_EQ(result.at("points"), 4);
  EXPECT_EQ(result.at("width"), 4);
  EXPECT_EQ(result.at("height"), 1);
  EXPECT_EQ(result.at("finite_points"), 3);
  EXPECT_EQ(result.at("centroid_m"), json({1.0, 1.0, 1.0}));
  EXPECT_EQ(result.at("min_m"), json({0.0, 0.0, 0.0}));
  EXPECT_EQ(result.at("max_m"), json({2.0, 3.0, 2.0}));
}

TEST_F(Tools, CloudsKeepTheirPointsInEveryFormat) {
  std::string last = shipped("quickstart/before.pcd");
  const json original = answer("inspect-cloud", {last});
  for (const char* name : {"a.ply", "b.xyz", "c.pcd", "d.asc"}) {
    const std::string next = folder.file(name);
    answer("inspect-cloud", {last, "--out", next});
    last = next;
  }
  const json copy = answer("inspect-cloud", {last});
  for (const char* key : {"finite_points", "centroid_m", "min_m", "max_m"}) {
    EXPECT_EQ(copy.at(key), original.at(key)) << key;
  }
}

TEST_F(Tools, InspectCloudTakesTheUnitAndDoubtsAWrongOne) {
  const std::string metres = shipped("quickstart/before.pcd");
  const std::string scan = in_millimetres(folder, metres);
  const json wrong = answer("inspect-cloud", {scan});
  EXPECT_EQ(warning_codes(wrong), Words{"units"});
  EXPECT_TRUE(contains(wrong["warnings"].dump(), "coordinates in mm")) << wrong["warnings"];
  EXPECT_EQ(warning_codes(answer("inspect-cloud", {metres, "--unit", "mm"})), Words{"units"});
  const json right = answer("inspect-cloud", {scan, "--unit", "mm"});
  EXPECT_EQ(warning_codes(right), Words{});
  const json original = answer("inspect-cloud", {metres});
  EXPECT_NEAR(number(right, "/max_m/1"), number(original, "/max_m/1"), 1e-4);
}

TEST_F(Tools, InspectCloudNamesDegrees) {
  std::string rows;
  for (int i = 0; i < 400; ++i) {  // 10 x 6 m
    rows += "8.50" + std::to_string(1000 + 70 * (i % 20)).substr(0, 4) + "0 49.00" +
            std::to_string(1000 + 27 * (i / 20)).substr(0, 4) + "0 0.1\n";
  }
  const json result = answer("inspect-cloud", {folder.write("degrees.xyz", rows)});
  EXPECT_EQ(warning_codes(result), Words{"units"});
  EXPECT_TRUE(contains(result["warnings"].dump(), "degrees of longitude and latitude"))
      << result["warnings"];
}

TEST_F(Tools, InspectCloudReadsLas) {
  LasFile las;
  las.offset = {500000.0, 5800000.0, 0.0};
  const json result = answer("inspect-cloud", {folder.write("a.las", las.bytes())});
  EXPECT_EQ(result.at("points"), 2);
  EXPECT_EQ(result.at("min_m"), json({499996.0, 5800002.0, 3.0}));
  EXPECT_EQ(result.at("pose"), nullptr);
}

TEST_F(Tools, InspectCloudGivesTheVolumeOfALoneHeap) {
  std::string rows;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      const double x = 3.0 + 0.04 * i, y = -2.0 + 0.04 * j;
      const double cone = std::max(0.0, 0.5 * (1.0 - std::hypot(x - 5.0, y) / 0.8));
      rows += std::to_string(x) + " " + std::to_string(y) + " " +
              std::to_string(cone + 0.002 * ((i * 7 + j * 13) % 5 - 2)) + "\n";
    }
  }
  const std::string heap = folder.write("heap.xyz", rows);
  const Words words = {heap, "--volume", "3.8,-1.2,6.2,-1.2,6.2,1.2,3.8,1.2"};
  const json result = answer("inspect-cloud", words);
  const double truth = 3.14159265 * 0.8 * 0.8 * 0.5 / 3.0;
  EXPECT_NEAR(number(result, "/volume/above_m3"), truth, 0.005);
  EXPECT_LT(number(result, "/volume/below_m3"), 0.005);
  EXPECT_GT(number(result, "/volume/above_sd_m3"), 0.0);
  EXPECT_GT(number(result, "/volume/below_sd_m3"), 0.0);
  EXPECT_NEAR(number(result, "/volume/area_m2"), 5.76, 1e-9);
  const std::regex said(
      R"(m\^2: [0-9.]+ ± [0-9.]+ m\^3 above its rim, [0-9.]+ ± [0-9.]+ m\^3 below)");
  const std::string text = run_program("inspect-cloud", words).out;
  EXPECT_TRUE(std::regex_search(text, said)) << text;
}

TEST_F(BadInput, VolumesOverWhatIsNoPolygonAreRefused) {
  const std::string before = shipped("quickstart/before.pcd");
  refused(2, "is not X1,Y1,X2,Y2,X3,Y3", "inspect-cloud", {before, "--volume", "1,2,3,4"});
  refused(2, "is not X1,Y1,X2,Y2,X3,Y3", "inspect-cloud", {before, "--volume", "1,2,3,4,5,6,7"});
  refused(2, "--volume: area of the polygon is 0", "inspect-cloud",
          {before, "--volume", "1,1,2,2,3,3"});
  refused(3, "same frame", "inspect-cloud", {before, "--volume", "101,1,102,1,102,2"});
}

/// A flat place seen by a lidar 2 m above it that leans forward by a tenth.
std::string leaning_scan(const TemporaryFolder& folder) {
  std::string rows;
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      const double x = 2.0 + 0.1 * i;
      const double z = -2.0;
      const double c = std::cos(0.1);
      const double s = std::sin(0.1);
      rows += std::to_string(c * x - s * z) + " " + std::to_string(-3.0 + 0.1 * j) + " " +
              std::to_string(s * x + c * z) + "\n";
    }
  }
  return folder.write("leaning.xyz", rows);
}

TEST_F(Tools, InspectCloudLevelsACloudAndKeepsThePose) {
  const std::string scan = leaning_scan(folder);
  const std::string pose = folder.file("pose.txt");
  const json result =
      answer("inspect-cloud", {scan, "--level", "--pose-out", pose, "--out", folder.file("a.ply")});
  EXPECT_EQ(result.at("/pose/method"_json_pointer), "level");
  EXPECT_NEAR(number(result, "/pose/height_m"), 2.0, 1e-4);
  EXPECT_NEAR(number(result, "/min_m/2"), 0.0, 1e-4);
  EXPECT_NEAR(number(result, "/max_m/2"), 0.0, 1e-4);
  EXPECT_NEAR(number(result, "/min_m/0"), 2.0, 1e-3);
  for (const char* option : {"--pose", "--frame"}) {
    const json again = answer("inspect-cloud", {scan, option, pose});
    EXPECT_EQ(again.at("/pose/method"_json_pointer), "given");
    EXPECT_NEAR(number(again, "/max_m/2"), number(result, "/max_m/2"), 1e-9);
  }
}

TEST_F(Tools, InspectCloudFindsThePoseFromKnownPoints) {
  const std::string scan = folder.write("a.xyz", "0 0 0\n1 0 0\n0 2 0\n");
  const std::string rows = "0,0,0,5,6,7\n1,0,0,5,7,7\n0,2,0,3,6,7\n";
  for (const std::string sensor : {"scan", "camera"}) {
    const std::string markers = folder.write(
        "markers.csv", sensor + "_x_m," + sensor + "_y_m," + sensor + "_z_m,x_m,y_m,z_m\n" + rows);
    const json result = answer("inspect-cloud", {scan, "--points", markers});
    EXPECT_EQ(result.at("/pose/method"_json_pointer), "points");
    EXPECT_NEAR(number(result, "/pose/residual_rms_m"), 0.0, 1e-9);
    EXPECT_NEAR(number(result, "/min_m/0"), 3.0, 1e-9);
    EXPECT_NEAR(number(result, "/max_m/1"), 7.0, 1e-9);
  }
}

TEST_F(Tools, InspectCloudTakesFramesByWordAndNumbers) {
  const std::string scan = folder.write("a.xyz", "0.5 0.25 3\n");
  const auto place = [&](const std::string& frame) {
    return answer("inspect-cloud", {scan, "--frame", frame}).at("centroid_m");
  };
  EXPECT_EQ(place("lidar"), json({0.5, 0.25, 3.0}));
  EXPECT_EQ(place("camera"), json({3.0, -0.5, -0.25}));
  EXPECT_EQ(place("1,0,-2,0,0,1,0"), json({0.5, -0.25, 1.0}));
  EXPECT_EQ(place("-1m,50cm,0,0,0,0,1"), json({-0.5, 0.75, 3.0}));
}

TEST_F(BadInput, PosesOfACloudExcludeEachOther) {
  const Words both = {scan, "--frame", "lidar", "--pose", "camera"};
  refused(2, "--frame excludes --pose", "inspect-cloud", both);
  refused(2, "--frame excludes --level", "inspect-cloud", {scan, "--frame", "lidar", "--level"});
  refused(2, "--pose-out needs --level or --points", "inspect-cloud", {scan, "--pose-out", plot});
  refused(3, "no column", "inspect-cloud", {scan, "--points", folder.write("m.csv", "u_px\n1\n")});
}

TEST_F(Tools, InspectCloudReadsStandardInput) {
  const std::string scan = shipped("quickstart/before.pcd");
  const ProgramResult piped = run_program("inspect-cloud", {"-", "--json"}, scan);
  ASSERT_EQ(piped.code, 0) << piped.err;
  json read = json::parse(piped.out);
  EXPECT_EQ(read.at("file"), "standard input");
  const json direct = answer("inspect-cloud", {scan});
  EXPECT_EQ(read.at("centroid_m"), direct.at("centroid_m"));
  const ProgramResult none = run_program("inspect-cloud", {"-"});
  EXPECT_EQ(none.code, 3);
  EXPECT_EQ(none.err, "inspect-cloud: standard input: is empty\n");
}

TEST_F(RealScans, TheGroundIsFoundInAScanOfAWholeSite) {
  // The third row of the frame that came with the scan, which others found.
  const json result = answer("inspect-cloud", {shared("dig-pair-livox/before.pcd"), "--level",
                                               "--pose-out", folder.file("pose.txt")});
  std::istringstream numbers(content_of(folder.file("pose.txt")));
  std::vector<double> pose(16);
  for (double& value : pose) numbers >> value;
  EXPECT_NEAR(pose[8], -0.10254807745574128, 0.002);
  EXPECT_NEAR(pose[9], -0.008625173881281251, 0.002);
  EXPECT_NEAR(pose[10], 0.9946906545181015, 0.001);
  EXPECT_LT(number(result, "/pose/residual_sd_m"), 0.02);
}

TEST_F(RealScans, AreRead) {
  for (const auto& [file, points] :
       std::vector<std::pair<std::string, int>>{{"site-terrain/terrain.pcd", 56758},
                                                {"dig-pair-livox/before.pcd", 100645},
                                                {"dig-pair-livox/after.pcd", 87900}}) {
    const json cloud = answer("inspect-cloud", {shared(file)});
    EXPECT_EQ(cloud.at("points"), points) << file;
    EXPECT_EQ(cloud.at("finite_points"), points) << file;
  }
  const json site = answer("inspect-cloud", {terrain});
  EXPECT_NEAR(number(site, "/min_m/2"), -3.7, 0.05);
  EXPECT_NEAR(number(site, "/max_m/2"), 8.1, 0.05);
}

}  // namespace
}  // namespace excavplan::test
