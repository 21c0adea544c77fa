// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

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

TEST_F(Recordings, AScanOfOneIsNoTerrainUntilItIsWritten) {
  for (const char* const rest : {":/merged/points@0s+1s", ":/merged/points", "@0s+1s"}) {
    for (const char* const tool : {"plan-path", "simulate-dig"}) {
      refused(
          3, rest + std::string(": --terrain takes a cloud, no scan of a recording; inspect-cloud"),
          tool, {"--density", "40", "--terrain", dig + rest});
    }
  }
}

TEST_F(Recordings, AScanIsWrittenInTheFrameAskedFor) {
  const std::string points = recording("scene.db3") + ":/lidar/points@1s+2s";
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
  refused(2, "outside its range", tool, {scan, later_scan, "--machine-pose", "0,100,0,0"});
  refused(3, "found no topic of sensor_msgs/JointState", tool,
          {dig + ":/merged/points", dig + ":/merged/points@60s", "--machine-recorded", "--tf-frame",
           "site"});
}

TEST_F(Recordings, WhatIsNotThereIsSaidWithWhatIs) {
  const std::string tool = "inspect-cloud";
  refused(3, "/lidar/points", tool, {recording("scene.db3") + ":/lidar/point@1s"});
  refused(3, "at 4.750 s", tool, {recording("scene.db3") + ":/lidar/points@4.8s"});
  refused(3, "frames", tool, {recording("scene.db3") + ":/lidar/points", "--tf-frame", "site"});
  refused(2, "--tf-frame needs a recording", tool,
          {shipped("quickstart/before.pcd"), "--tf-frame", "map"});
  refused(3, "/camera/depth/image_raw", "estimate-density",
          {recording("scene.db3"), dig + ":/merged/points@59s"});
}

}  // namespace
}  // namespace excavplan::test
