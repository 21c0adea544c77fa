// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "support/recording_files.hpp"
#include "support/tool_answers.hpp"

/// @file
/// Scans of recordings on the command line, from a bag to the density.

namespace excavplan::test {
namespace {

class Recordings : public BadInput {
 protected:
  void SetUp() override {
    BadInput::SetUp();
    for (const char* const file : {"scene.db3", "scene_zstd.mcap", "scene_lz4.bag"}) {
      if (!missing_for(file).empty()) GTEST_SKIP() << "built without " << missing_for(file);
    }
  }
  const std::string dig = shipped("quickstart/dig.mcap");
};

TEST_F(Recordings, InspectCloudListsWhatIsThere) {
  for (const char* const file : {"scene.db3", "scene_split", "scene_zstd.mcap", "scene_lz4.bag"}) {
    SCOPED_TRACE(file);
    const json result = answer("inspect-cloud", {recording(file)});
    EXPECT_NEAR(number(result, "/duration_s"), 5.0, 1e-6);
    EXPECT_NEAR(number(result, "/start_s"), 1.7e9, 1e-3);
    EXPECT_EQ(result.at("frames"), json({"base_link", "camera", "lidar", "map"}));
    const auto& topics = result.at("topics");
    const auto lidar = std::find_if(topics.begin(), topics.end(), [](const json& topic) {
      return topic.at("name") == "/lidar/points";
    });
    ASSERT_NE(lidar, topics.end());
    EXPECT_EQ(lidar->at("type"), "sensor_msgs/msg/PointCloud2");
    EXPECT_EQ(lidar->at("messages"), 6);
    EXPECT_EQ(lidar->at("frame"), "lidar");
    EXPECT_EQ(lidar->at("is_scan"), true);
    EXPECT_NEAR(number(*lidar, "/first_s"), 0.25, 1e-6);
  }
}

/// Without what differs between a scan of a recording and the same one in a file.
/// @param scans  as they were named
json plan_alone(json plan, const Words& scans) {
  for (const char* const key : {"recordings", "wall_time_s"}) plan.erase(key);
  for (json& warning : plan["warnings"]) {
    std::string text = warning["message"];
    for (const std::string& scan : scans) {
      const std::size_t at = text.find(scan);
      if (at != std::string::npos) text.replace(at, scan.size(), "a scan");
    }
    warning["message"] = text;
  }
  return plan;
}

TEST_F(Recordings, AScanIsTheGroundOfAPlanAsItsCloudIs) {
  const std::string before = dig + ":/merged/points@0s+1s", after = dig + ":/merged/points@59s+2s";
  const std::string cloud = folder.file("before.ply"), around = folder.file("after.ply");
  answer("inspect-cloud", {before, "--out", cloud});
  answer("inspect-cloud", {after, "--out", around});
  const Words density = {"--density", "40", "--terrain"};
  const json recorded = answer("plan-path", density + Words{before, "--surroundings", after});
  ASSERT_EQ(recorded.at("recordings").size(), 2U) << "each is read once";
  EXPECT_EQ(recorded.at("/recordings/0/messages"_json_pointer), 4);
  EXPECT_NEAR(number(recorded, "/recordings/1/first_s"), 60.0, 1e-6);
  EXPECT_NEAR(number(recorded, "/recordings/1/seen_at_s"), 1.7e9 + 60.3, 1e-6);
  EXPECT_EQ(recorded.at("ground"), "as scanned");
  const auto alone = [&](const std::string& tool, const Words& words) {
    return plan_alone(answer(tool, density + words), {before, after, cloud, around});
  };
  EXPECT_EQ(alone("plan-path", {before, "--surroundings", after}),
            alone("plan-path", {cloud, "--surroundings", around}));
  EXPECT_EQ(alone("simulate-dig", {before}), alone("simulate-dig", {cloud}));
  EXPECT_FALSE(answer("plan-path", density + Words{cloud}).contains("recordings"));
}

TEST_F(Recordings, AScanComesIntoTheFrameOfThePlan) {
  const std::string lidar = recording("scene.db3") + ":/lidar/points@0.75s+2s";
  const std::string cloud = folder.file("map.ply");
  answer("inspect-cloud", {lidar, "--tf-frame", "map", "--out", cloud});
  const Words plan = {"--density", "40", "--terrain"};
  const Words turned = {"--terrain-frame", "0,0,-0.3,0,0,-0.7071068,0.7071068"};
  const json recorded = answer("plan-path", plan + Words{lidar, "--tf-frame", "map"} + turned);
  EXPECT_EQ(recorded.at("/recordings/0/frame"_json_pointer), "map");
  EXPECT_EQ(plan_alone(recorded, {lidar}),
            plan_alone(answer("plan-path", plan + Words{cloud} + turned), {cloud}));
  const std::string tool = "plan-path",
                    images = recording("scene.db3") + ":/camera/depth/image_raw";
  refused(3, "frames", tool, plan + Words{lidar, "--tf-frame", "site"});
  refused(2, "name the frame into which", tool, plan + Words{images + "@0s+5s"});
  refused(2, "holds points in metres", tool, plan + Words{lidar, "--depth-unit", "0.25mm"});
  refused(2, "--tf-frame needs scans of a recording", tool,
          plan + Words{scan, "--tf-frame", "map"});
  refused(2, "--tf-frame needs scans of a recording", tool,
          {"--density", "40", "--tf-frame", "map"});
  refused(2, "--depth-unit needs depth images", "simulate-dig",
          plan + Words{scan, "--depth-unit", "0.25mm"});
  refused(2, "a topic that begins with /", tool, plan + Words{dig + "@0s+1s"});
}

TEST_F(Recordings, WhatIsDamagedIsLeftOutOfTheGroundAndSaid) {
  const std::string whole = content_of(dig);
  const std::string cut = folder.write("cut.mcap", whole.substr(0, whole.size() * 4 / 5));
  const json plan =
      answer("plan-path", {"--density", "40", "--terrain", cut + ":/merged/points@0s+1s"});
  EXPECT_TRUE(warns(plan, "recording_cut_off"));
  const json around = answer("plan-path", {"--density", "40", "--terrain", scan, "--surroundings",
                                           cut + ":/merged/points@0s+1s"});
  EXPECT_TRUE(warns(around, "recording_cut_off"));
  const json job =
      answer("plan-site",
             {"new", folder.file("job"), "--trench", "1.5x1x0.2", "--from", "4,0", "--heading", "0",
              "--windrow", "3,1.2,8,1.2,8,2.6,3,2.6", "--scan", cut + ":/merged/points@0s+1s"});
  EXPECT_TRUE(warns(job, "recording_cut_off"));
}

TEST_F(Recordings, AScanOfAJobIsOfTheTimeAtWhichItWasRecorded) {
  const std::string job = folder.file("job"), points = dig + ":/merged/points@";
  const json begun =
      answer("plan-site", {"new", job, "--trench", "1.5x1x0.2", "--from", "4,0", "--heading", "0",
                           "--windrow", "3,1.2,8,1.2,8,2.6,3,2.6", "--scan", points + "0s+1s"});
  EXPECT_EQ(begun.at("/recordings/0/messages"_json_pointer), 4);
  refused(2, "--tf-frame needs scans of a recording", "plan-site",
          {"scan", job, "--scan", later_scan, "--tf-frame", "map"});
  const std::string old =
      "the scan is of 1700000000.2 s, older than the last one of the site, of "
      "1700000000.3 s";
  refused(2, old, "plan-site", {"scan", job, "--scan", points + "0s+0.2s"});
  const json seen = answer("plan-site", {"scan", job, "--scan", points + "59s+2s"});
  EXPECT_EQ(seen.at("scan_taken"), true);
  EXPECT_NEAR(number(seen, "/recordings/0/seen_at_s"), 1.7e9 + 60.3, 1e-6);
  const json told = json::parse(content_of(job + "/site.json"));
  EXPECT_TRUE(contains(told.dump(), "1700000060.3")) << told;
}

TEST_F(Recordings, AScanIsWrittenInTheFrameAskedFor) {
  const std::string points = recording("scene.db3") + ":/lidar/points@0.75s+2s";
  const std::string out = folder.file("scan.pcd");
  const json result = answer("inspect-cloud", {points, "--tf-frame", "map", "--out", out});
  EXPECT_EQ(result.at("/recording/messages"_json_pointer), 3);
  EXPECT_EQ(result.at("/recording/frame"_json_pointer), "map");
  EXPECT_EQ(result.at("/recording/merge"_json_pointer), "joined");
  EXPECT_EQ(answer("inspect-cloud", {out}).at("points"), 87);
  const std::string images = recording("scene.db3") + ":/camera/depth/image_raw@0s+5s";
  refused(2, "--tf-frame: name the frame into which", "inspect-cloud", {images});
  const json depth = answer("inspect-cloud", {images, "--tf-frame", "base_link"});
  EXPECT_EQ(depth.at("/recording/merge"_json_pointer), "averaged");
  EXPECT_EQ(depth.at("width"), 16);
  EXPECT_GT(number(depth, "/recording/frame_sd_m"), 0.0);
}

TEST_F(Recordings, OneCommandGivesTheDensityOfARecordedDig) {
  const std::string points = dig + ":/merged/points@";
  const json result = answer("estimate-density", {points + "0s+1s", points + "59s+2s"});
  const json truth = json::parse(content_of(shipped("quickstart/truth.json")));
  EXPECT_LE(number(result, "/density_interval_percent/0"), number(truth, "/density_percent"));
  EXPECT_GE(number(result, "/density_interval_percent/1"), number(truth, "/density_percent"));
  EXPECT_EQ(result.at("trustworthy"), true);
  ASSERT_EQ(result.at("recordings").size(), 2U);
  EXPECT_EQ(result.at("/recordings/1/messages"_json_pointer), 4);
  EXPECT_NEAR(number(result, "/recordings/1/first_s"), 60.0, 1e-6);
}

TEST_F(Recordings, TheMachineIsWhereItsJointStatesSay) {
  const std::string tool = "estimate-density";
  const std::string lidar = recording("scene.db3") + ":/lidar/points";
  refused(2, "the arm of the machine in the scan stands at -1.2 rad, outside its range", tool,
          {lidar, lidar, "--tf-frame", "map", "--machine-recorded"});
  refused(2, "--machine-recorded needs --tf-frame", tool, {lidar, lidar, "--machine-recorded"});
  refused(2, "outside its range", tool, {scan, later_scan, "--machine-pose", "0,5,0,0"});
  refused(3, "found no topic of sensor_msgs/JointState", tool,
          {dig + ":/merged/points", dig + ":/merged/points@60s", "--machine-recorded", "--tf-frame",
           "site"});
}

/// The base scene of the reported files: hole 0.2522, heap 0.3077, factor 1.220.
void expect_base_scene(const json& result) {
  EXPECT_EQ(result.at("trustworthy"), true) << result.at("warnings");
  EXPECT_NEAR(number(result, "/bulking_factor"), 1.220, 3.0 * number(result, "/bulking_factor_sd"));
  EXPECT_NEAR(number(result, "/bulking_factor"), 1.220, 0.01);
}

TEST_F(Recordings, ReportedFilesGiveTheirDig) {
  const std::string reported = std::string(EXCAVPLAN_SHARED_DATA) + "/reported/";
  if (!std::filesystem::exists(reported)) GTEST_SKIP() << "no reported files in " << reported;
  for (const char* const file :
       {"stamps/zero.mcap", "stamps/u64.mcap", "spoilt-chunk/noindex.mcap"}) {
    SCOPED_TRACE(file);
    const std::string points = reported + file + ":/points@";
    const json result = answer("estimate-density", {points + "0s+1s", points + "60s+1s"});
    expect_base_scene(result);
    const Words codes = warning_codes(result);
    const bool is_said = std::count(codes.begin(), codes.end(), "recording_cut_off") > 0;
    EXPECT_EQ(is_said, std::string(file) != "stamps/zero.mcap");
  }
  const std::string images = reported + "depth-scale/quarter.mcap:/camera/depth/image_rect_raw@";
  expect_base_scene(answer("estimate-density",
                           {images + "0s", images + "60s", "--level", "--depth-unit", "0.25mm"}));
  const json wrong = answer("estimate-density", {images + "0s", images + "60s", "--level"});
  EXPECT_EQ(wrong.at("trustworthy"), false);
  EXPECT_TRUE(contains(wrong.at("warnings").dump(), "--depth-unit, such as 0.25mm"));
}

/// Level ground with a cone of this radius and height on it, as text.
std::string ground_with_cone(double radius, double height) {
  Random random(5);
  std::string rows;
  for (int i = 0; i < 30000; ++i) {
    const double x = random.uniform(3.0, 7.0), y = random.uniform(-2.0, 2.0);
    const double cone = height * std::max(0.0, 1.0 - std::hypot(x - 5.0, y) / radius);
    rows += std::to_string(x) + ' ' + std::to_string(y) + ' ' +
            std::to_string(cone + 0.003 * random.normal()) + '\n';
  }
  return rows;
}

TEST_F(Recordings, ALoneHeapHasAVolumeWhereItIsNamed) {
  const std::string flat = folder.write("flat.xyz", ground_with_cone(0.8, 0.0));
  const std::string heap = folder.write("heap.xyz", ground_with_cone(0.8, 0.5));
  const json unnamed = answer("estimate-density", {flat, heap});
  EXPECT_EQ(number(unnamed, "/volume/dumped_m3"), 0.0);
  EXPECT_TRUE(contains(unnamed.at("warnings").dump(), "--dump-area take it in"));
  const json named = answer("estimate-density", {flat, heap, "--dump-area", "4,-1,6,1"});
  const double truth = pi * 0.8 * 0.8 * 0.5 / 3.0;
  EXPECT_NEAR(number(named, "/volume/dumped_m3"), truth, 0.002);
  EXPECT_GT(number(named, "/volume/dumped_sd_m3"), 0.0);
}

TEST_F(Recordings, WhatIsNotThereIsSaidWithWhatIs) {
  const std::string tool = "inspect-cloud";
  refused(3, "/lidar/points", tool, {recording("scene.db3") + ":/lidar/point@1s"});
  refused(3, "at 4.500 s", tool, {recording("scene.db3") + ":/lidar/points@4.8s"});
  refused(3, "frames", tool, {recording("scene.db3") + ":/lidar/points", "--tf-frame", "site"});
  refused(2, "--tf-frame needs a recording", tool,
          {shipped("quickstart/before.pcd"), "--tf-frame", "map"});
  refused(2, "--depth-unit needs a recording", tool,
          {shipped("quickstart/before.pcd"), "--depth-unit", "0.25mm"});
  refused(2, "as in 0.25mm", tool, {recording("scene.db3"), "--depth-unit", "0.25"});
  refused(2, "holds points in metres", tool,
          {recording("scene.db3") + ":/lidar/points", "--depth-unit", "0.25mm"});
  refused(3, "/camera/depth/image_raw", "estimate-density",
          {recording("scene.db3"), dig + ":/merged/points@59s"});
}

}  // namespace
}  // namespace excavplan::test
