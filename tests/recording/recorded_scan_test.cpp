// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/recorded_scan.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "support/errors.hpp"
#include "support/png_bytes.hpp"
#include "support/recording_files.hpp"
#include "support/recording_in_memory.hpp"

namespace excavplan::test {
namespace {

const double nan_value = std::numeric_limits<double>::quiet_NaN();
const std::string image_type = "sensor_msgs/msg/Image";
const std::string camera_type = "sensor_msgs/msg/CameraInfo";
const std::string joint_type = "sensor_msgs/msg/JointState";

RecordingQuery query_of(const std::string& topic, std::optional<double> time = {},
                        double span = 0.0, const std::string& frame = "") {
  return {"", topic, time, span, frame};
}

/// A recording that begins at 0 s with a message of no interest.
RecordingInMemory recording_from_zero() {
  RecordingInMemory recording;
  recording.add("/rosout", "rcl_interfaces/msg/Log", 0, "");
  return recording;
}

void add_cloud(RecordingInMemory& recording, std::int64_t time, const Points& points,
               std::size_t width = 0, const std::string& frame = "lidar") {
  recording.add("/points", cloud_type, time, cloud_bytes(epoch + time, frame, points, width));
}

std::string error_of_read(RecordingInMemory& recording, const RecordingQuery& query,
                          ErrorKind kind = ErrorKind::bad_file) {
  return error_about([&] { read_recorded_scan(recording, query); }, "run", kind);
}

void expect_near(const Eigen::Vector3d& found, const Eigen::Vector3d& expected,
                 double tolerance = 1e-6) {
  EXPECT_LT((found - expected).norm(), tolerance)
      << found.transpose() << " / " << expected.transpose();
}

/// A lidar on a mast 2 m above a machine that drives along x at 1 m/s; TF at 10 Hz.
RecordingInMemory driving_machine() {
  RecordingInMemory recording = recording_from_zero();
  add_transform(recording, 0, {0, "base", "lidar", {0.0, 0.0, 2.0}}, "/tf_static");
  for (int i = 0; i <= 100; ++i) {
    add_transform(recording, i * 100 * ms, {0, "map", "base", {0.1 * i, 0.0, 0.0}});
  }
  for (const int time : {2050, 2350, 2650}) {  // of a thing at (10, 1, 0) in the map
    add_cloud(recording, time * ms, {{10.0 - 0.001 * time, 1.0, -2.0}, {nan_value, 0.0, 0.0}});
  }
  return recording;
}

// ---- Which message ----------------------------------------------------------------------------

/// One point a message, whose x is its number, every second from 1 s on.
RecordingInMemory numbered_clouds() {
  RecordingInMemory recording = recording_from_zero();
  for (int i = 1; i <= 100; ++i) {
    add_cloud(recording, i * 1000 * ms, {{static_cast<double>(i), 0.0, 0.0}});
  }
  return recording;
}

TEST(RecordedScan, WithoutATimeItIsTheFirstMessageOfTheTopic) {
  RecordingInMemory recording = numbered_clouds();
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points"));
  EXPECT_EQ(scan.cloud.points, (Points{{1.0, 0.0, 0.0}}));
  EXPECT_EQ(scan.cloud.width, 1U);
  EXPECT_EQ(scan.first, 0.0);
  EXPECT_EQ(scan.last, 0.0);
  EXPECT_EQ(scan.topic, "/points");
  EXPECT_EQ(scan.messages, 1U);
  EXPECT_EQ(scan.merge, ScanMerge::single);
  EXPECT_EQ(scan.frame, "lidar");
  EXPECT_FALSE(scan.cloud.sensor_origin) << "nothing says that the frame is that of a sensor";
  EXPECT_TRUE(scan.variance.empty());
}

TEST(RecordedScan, WithATimeItIsTheFirstMessageAtOrAfterIt) {
  RecordingInMemory recording = numbered_clouds();
  const auto x_at = [&](double time) {
    return read_recorded_scan(recording, query_of("/points", time)).cloud.points.at(0).x();
  };
  EXPECT_EQ(x_at(0.0), 1.0);
  EXPECT_EQ(x_at(6.0), 7.0) << "from the first of the topic, at 1 s";
  EXPECT_EQ(x_at(6.001), 8.0);
  EXPECT_EQ(x_at(98.5), 100.0);
}

TEST(RecordedScan, IsSeenAtItsStampUnlessItsClockWasNotSet) {
  RecordingInMemory recording = recording_from_zero();
  const auto add = [&](std::int64_t time, std::int64_t stamp) {
    recording.add("/points", cloud_type, time, cloud_bytes(stamp, "lidar", {{1.0, 0.0, 0.0}}));
  };
  constexpr std::int64_t now = 1700000000000 * ms;
  add(now, epoch + now - 80 * ms);
  add(now + 1000 * ms, 5 * ms);
  const double start = 1e3 + 1.7e9;
  EXPECT_NEAR(read_recorded_scan(recording, query_of("/points")).seen_at, start - 0.08, 1e-6);
  EXPECT_NEAR(read_recorded_scan(recording, query_of("/points", 1.0)).seen_at, start + 1.0, 1e-6);
}

TEST(RecordedScan, ASpanTakesAllMessagesBothEndsIncluded) {
  RecordingInMemory recording = numbered_clouds();
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 2.0, 2.0));
  EXPECT_EQ(scan.cloud.points, (Points{{3.0, 0.0, 0.0}, {4.0, 0.0, 0.0}, {5.0, 0.0, 0.0}}));
  EXPECT_EQ(scan.messages, 3U);
  EXPECT_EQ(scan.merge, ScanMerge::joined);
  EXPECT_EQ(scan.first, 2.0);
  EXPECT_EQ(scan.last, 4.0);
  const RecordedScan from_first = read_recorded_scan(recording, query_of("/points", {}, 1.0));
  EXPECT_EQ(from_first.messages, 2U);
}

TEST(RecordedScan, ReadsOnlyTheMessagesAskedFor) {
  RecordingInMemory recording = numbered_clouds();
  read_recorded_scan(recording, query_of("/points", 50.0));
  EXPECT_LE(recording.visited, 2U);
}

TEST(RecordedScan, ReadsOnlyTheTransformsOfThatTime) {
  RecordingInMemory recording = driving_machine();
  read_recorded_scan(recording, query_of("/points"));
  EXPECT_LE(recording.visited, 3U) << "the static one and the points, twice";
  recording.visited = 0;
  read_recorded_scan(recording, query_of("/points", {}, 0.0, "map"));
  EXPECT_LE(recording.visited, 3U + 21U) << "and those of a second before and after";
}

TEST(RecordedScan, TransformsThatAreRareAreLookedForFartherAway) {
  RecordingInMemory recording = recording_from_zero();
  add_transform(recording, 0, {0, "map", "lidar", {0.0, 0.0, 2.0}});
  add_transform(recording, 12000 * ms, {0, "map", "lidar", {0.0, 0.0, 2.0}});
  add_cloud(recording, 6000 * ms, {{1.0, 0.0, 0.0}});
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points", {}, 0.0, "map"));
  expect_near(scan.cloud.points.at(0), {1.0, 0.0, 2.0});
}

TEST(RecordedScan, PointsThatAreRecordedAgainAreNoJumpOfAClock) {
  RecordingInMemory recording = recording_from_zero();
  for (const int time : {0, 3000, 6000}) {
    recording.add("/points", cloud_type, time * ms, cloud_bytes(epoch, "map", {{1.0, 0.0, 0.0}}));
  }
  EXPECT_EQ(read_recorded_scan(recording, query_of("/points", 0.0, 6.0)).messages, 3U);
}

TEST(RecordedScan, TheOnlyTopicNeedNotBeNamed) {
  RecordingInMemory recording = numbered_clouds();
  EXPECT_EQ(read_recorded_scan(recording, query_of("")).messages, 1U);
  recording.add("/image", image_type, 0, depth_bytes(0, "camera", 1, {1}));
  EXPECT_EQ(
      error_of_read(recording, query_of("")),
      "found 2 topics to choose from, expected one or the name of one; topics that hold clouds "
      "or images: '/points', '/image'");
}

TEST(RecordedScan, SaysWhatIsThereInsteadOfATopic) {
  RecordingInMemory recording = numbered_clouds();
  EXPECT_EQ(error_of_read(recording, query_of("/point")),
            "found no topic '/point', did you mean '/points'? topics that hold clouds or images: "
            "'/points'");
  EXPECT_EQ(
      error_of_read(recording, query_of("/rosout")),
      "'/rosout': found messages of type 'rcl_interfaces/msg/Log'; topics that hold clouds or "
      "images: '/points'");
  const std::string jpeg =
      RosBytes(cdr_little).header(0, "camera").text("bgr8; jpeg compressed").data("\xFF\xD8\xFF");
  recording.add("/depth/compressed", "sensor_msgs/msg/CompressedImage", 0, jpeg);
  EXPECT_NE(
      error_of_read(recording, query_of("/depth/compressed"))
          .find("found an image compressed as 'bgr8; jpeg compressed', expected depths as PNG"),
      std::string::npos);
}

TEST(RecordedScan, SaysWhatIsThereAroundATimeWithoutMessages) {
  RecordingInMemory recording = numbered_clouds();
  EXPECT_EQ(error_of_read(recording, query_of("/points", 7.25, 0.5)),
            "found no message of /points at 7.250 s to 7.750 s: the last one before is at 7.000 s, "
            "the next one after at 8.000 s");
  EXPECT_EQ(
      error_of_read(recording, query_of("/points", 300.0)),
      "found no message of /points at 300.000 s or later: the last one before is at 99.000 s");
  EXPECT_EQ(error_of_read(recording, query_of("/points", 98.5, 0.2)),
            "found no message of /points at 98.500 s to 98.700 s: the last one before is at 98.000 "
            "s, the next one after at 99.000 s");
}

TEST(RecordedScan, TimesOutOfRangeAreRefused) {
  RecordingInMemory recording = numbered_clouds();
  for (const double time : {-1.0, 1e10, nan_value}) {
    EXPECT_NE(error_of([&] { read_recorded_scan(recording, query_of("/points", time)); }),
              "no error");
    EXPECT_NE(error_of([&] { read_recorded_scan(recording, query_of("/points", 1.0, time)); }),
              "no error");
    EXPECT_NE(error_of([&] { joint_positions(recording, time); }, ErrorKind::bad_file), "no error")
        << "no topic of joints";
  }
}

// ---- Averages ---------------------------------------------------------------------------------

/// Three frames of 2 x 2 points on fixed rays, at these ranges along x, y, z and (0.6, 0.8, 0).
Points organised(double x, double y, double z, double slant) {
  return {{x, 0.0, 0.0}, {0.0, y, 0.0}, {0.0, 0.0, z}, {0.6 * slant, 0.8 * slant, 0.0}};
}

TEST(RecordedScan, OrganisedFramesOfAStandingSensorAreAveragedPixelByPixel) {
  RecordingInMemory recording = recording_from_zero();
  add_cloud(recording, 0, organised(1.000, 2.0, nan_value, 5.0), 2);
  add_cloud(recording, 100 * ms, organised(1.002, 2.0, nan_value, 5.1), 2);
  add_cloud(recording, 200 * ms, organised(1.004, 9.0, 3.0, nan_value), 2);
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 0.0, 1.0));
  EXPECT_EQ(scan.merge, ScanMerge::averaged);
  EXPECT_EQ(scan.cloud.width, 2U);
  EXPECT_EQ(scan.cloud.height, 2U);
  expect_near(scan.cloud.points[0], {1.002, 0.0, 0.0});
  expect_near(scan.cloud.points[1], {0.0, 2.0, 0.0});
  EXPECT_TRUE(std::isnan(scan.cloud.points[2].x())) << "one of three frames saw something";
  expect_near(scan.cloud.points[3], {3.03, 4.04, 0.0});
  ASSERT_EQ(scan.variance.size(), 4U);
  EXPECT_NEAR(scan.variance[0], 4e-6 / 3.0, 1e-9);  // sd 2 mm of three
  EXPECT_NEAR(scan.variance[1], 0.0, 1e-12) << "without the one that disagrees";
  EXPECT_TRUE(std::isnan(scan.variance[2]));
  EXPECT_NEAR(scan.variance[3], 0.005 / 2.0, 1e-6);
  EXPECT_NEAR(scan.frame_sd, 0.002, 1e-6);
}

TEST(RecordedScan, OneMillimetreCountsAsAgreement) {
  RecordingInMemory recording = recording_from_zero();
  for (const double range : {1.0, 1.0, 1.0, 1.0009}) {
    add_cloud(recording, 0, organised(range, range, range, range), 2);
  }
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 0.0, 1.0));
  expect_near(scan.cloud.points[0], {1.000225, 0.0, 0.0});
}

TEST(RecordedScan, FramesWhoseRaysDifferAreJoined) {
  RecordingInMemory recording = recording_from_zero();
  for (const double turn : {0.0, 0.01}) {  // a lidar that begins its turn elsewhere
    const Points points = {{std::cos(turn), std::sin(turn), 0.0},
                           {-std::sin(turn), std::cos(turn), 0.0},
                           {std::cos(turn), std::sin(turn), 1.0},
                           {-std::sin(turn), std::cos(turn), nan_value}};
    add_cloud(recording, 0, points, 2);
  }
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 0.0, 1.0));
  EXPECT_EQ(scan.merge, ScanMerge::joined);
  EXPECT_EQ(scan.cloud.points.size(), 6U) << "without those that are not finite";
  EXPECT_EQ(scan.cloud.width, 6U);
  EXPECT_EQ(scan.cloud.height, 1U);
}

TEST(RecordedScan, FramesOfSeveralSizesAreJoined) {
  RecordingInMemory recording = recording_from_zero();
  add_cloud(recording, 0, organised(1.0, 1.0, 1.0, 1.0), 2);
  add_cloud(recording, 0, organised(1.0, 1.0, 1.0, 1.0), 1);
  EXPECT_EQ(read_recorded_scan(recording, query_of("/points", 0.0, 1.0)).cloud.points.size(), 8U);
}

// ---- Transforms -------------------------------------------------------------------------------

TEST(RecordedScan, AMessageIsTransformedAtItsOwnStamp) {
  RecordingInMemory recording = driving_machine();
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 0.1, 0.0, "/map"));
  EXPECT_EQ(scan.frame, "map");
  EXPECT_EQ(scan.recorded_frame, "lidar");
  expect_near(scan.cloud.points.at(0), {10.0, 1.0, 0.0});
  EXPECT_TRUE(std::isnan(scan.cloud.points.at(1).x())) << "one message keeps its order";
  ASSERT_TRUE(scan.cloud.sensor_origin);
  expect_near(*scan.cloud.sensor_origin, {2.35, 0.0, 2.0});
}

TEST(RecordedScan, WithoutAFrameOneMessageStaysAsItWasRecorded) {
  RecordingInMemory recording = driving_machine();
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points"));
  expect_near(scan.cloud.points.at(0), {7.95, 1.0, -2.0});
  ASSERT_TRUE(scan.cloud.sensor_origin) << "a leaf of the tree of transforms";
  EXPECT_EQ(*scan.cloud.sensor_origin, Eigen::Vector3d::Zero());
}

TEST(RecordedScan, AMovingSensorAccumulatesInAFrame) {
  RecordingInMemory recording = driving_machine();
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 0.0, 1.0, "map"));
  ASSERT_EQ(scan.cloud.points.size(), 3U);
  for (const Eigen::Vector3d& point : scan.cloud.points) expect_near(point, {10.0, 1.0, 0.0});
  EXPECT_FALSE(scan.cloud.sensor_origin) << "it stood nowhere";
  EXPECT_EQ(error_of_read(recording, query_of("/points", 0.0, 1.0), ErrorKind::bad_input),
            "between 0.000 s and 0.600 s frame 'lidar' of /points moved: name the frame into which "
            "the points are put, or a span in which it stood; frames: 'base', 'lidar', 'map'");
}

TEST(RecordedScan, OfSeveralRobotsItsOwnTransformsCount) {
  RecordingInMemory recording = recording_from_zero();
  add_transform(recording, 0, {0, "map", "lidar", {1.0, 2.0, 3.0}}, "/r1/tf_static");
  add_transform(recording, 0, {0, "map", "lidar", {7.0, 8.0, 9.0}}, "/r2/tf_static");
  for (const char* const robot : {"/r1", "/r2"}) {
    recording.add(robot + std::string("/points"), cloud_type, 1000 * ms,
                  cloud_bytes(epoch + 1000 * ms, "lidar", {{1.0, 0.0, 0.0}}, 0));
  }
  const auto point = [&](const std::string& topic) {
    return read_recorded_scan(recording, query_of(topic, {}, 0.0, "map")).cloud.points.at(0);
  };
  expect_near(point("/r1/points"), {2.0, 2.0, 3.0});
  expect_near(point("/r2/points"), {8.0, 8.0, 9.0});
}

TEST(RecordedScan, AStaticTransformThatWasSentAgainCountsFromThenOn) {
  RecordingInMemory recording = recording_from_zero();
  add_transform(recording, 2000 * ms, {0, "map", "lidar", {1.0, 0.0, 0.0}}, "/tf_static");
  add_transform(recording, 30000 * ms, {0, "map", "lidar", {5.0, 0.0, 0.0}}, "/tf_static");
  for (const int time : {1000, 10000, 40000}) {
    add_cloud(recording, time * ms, {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
  }
  const auto x_at = [&](double time) {
    return read_recorded_scan(recording, query_of("/points", time, 0.0, "map"))
        .cloud.points.at(1)
        .x();
  };
  EXPECT_EQ(x_at(0.0), 2.0) << "the first, although it was recorded later";
  EXPECT_EQ(x_at(9.0), 2.0);
  EXPECT_EQ(x_at(39.0), 6.0);
}

TEST(RecordedScan, ASensorThatStoodInTheFrameAskedForIsAveraged) {
  RecordingInMemory recording = recording_from_zero();
  add_transform(recording, 0, {0, "base", "lidar", {0.0, 0.0, 2.0}}, "/tf_static");
  for (int i = 0; i <= 10; ++i) {
    add_transform(recording, i * 100 * ms, {0, "map", "base", {0.1 * i, 0.0, 0.0}});
    add_cloud(recording, i * 100 * ms, organised(1.0, 2.0, 3.0, 5.0), 2);
  }
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 0.0, 1.0, "base"));
  EXPECT_EQ(scan.merge, ScanMerge::averaged);
  expect_near(scan.cloud.points[2], {0.0, 0.0, 5.0});
  expect_near(*scan.cloud.sensor_origin, {0.0, 0.0, 2.0});
  EXPECT_EQ(read_recorded_scan(recording, query_of("/points", 0.0, 1.0, "map")).merge,
            ScanMerge::joined);
}

// ---- What is damaged, and other clocks

TEST(RecordedScan, ATopicOfAnotherClockMovesNoTime) {
  for (const std::int64_t time : {std::int64_t{0}, epoch / 2, epoch + 3600000 * ms, ever}) {
    RecordingInMemory recording;
    recording.add_at(time, "/status", "std_msgs/msg/Bool", "");
    for (int i = 0; i < 5; ++i) add_cloud(recording, (70 + i) * 1000 * ms, {{1.0 * i, 0.0, 0.0}});
    const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 2.0, 1.0));
    EXPECT_EQ(scan.cloud.points, (Points{{2.0, 0.0, 0.0}, {3.0, 0.0, 0.0}}));
    EXPECT_EQ(scan.first, 2.0);
  }
}

std::string cut_off(const std::string& bytes) { return bytes.substr(0, bytes.size() - 9); }

TEST(RecordedScan, AMessageThatIsDamagedIsLeftOutAndSaid) {
  RecordingInMemory recording = recording_from_zero();
  for (int i = 0; i < 6; ++i) {
    const std::string bytes = cloud_bytes(epoch + i * 100 * ms, "lidar", {{1.0 * i, 0.0, 0.0}});
    recording.add("/points", cloud_type, i * 100 * ms, i % 3 == 0 ? cut_off(bytes) : bytes);
  }
  const RecordedScan one = read_recorded_scan(recording, query_of("/points"));
  EXPECT_EQ(one.cloud.points, (Points{{1.0, 0.0, 0.0}}));
  const RecordedScan all = read_recorded_scan(recording, query_of("/points", 0.0, 1.0));
  EXPECT_EQ(all.cloud.points.size(), 4U);
  ASSERT_EQ(all.warnings.size(), 1U);
  EXPECT_EQ(all.warnings[0].code, WarningCode::recording_cut_off);
  EXPECT_TRUE(all.warnings[0].ends_trust) << "what they saw may be missing";
  EXPECT_NE(all.warnings[0].message.find("run: 2 parts are damaged and left out, the first: run: "
                                         "message 1 of /points: found "),
            std::string::npos)
      << all.warnings[0].message;
}

TEST(RecordedScan, WhatMayBeAnotherTimeIsNotTrusted) {
  RecordingInMemory recording = recording_from_zero();
  recording.add("/points", cloud_type, 0, cut_off(cloud_bytes(epoch, "lidar", {{1.0, 0.0, 0.0}})));
  add_cloud(recording, 60000 * ms, {{2.0, 0.0, 0.0}});
  const RecordedScan late = read_recorded_scan(recording, query_of("/points"));
  EXPECT_EQ(late.cloud.points, (Points{{2.0, 0.0, 0.0}}));
  ASSERT_EQ(late.warnings.size(), 1U);
  EXPECT_TRUE(late.warnings[0].ends_trust);
  const RecordedScan meant = read_recorded_scan(recording, query_of("/points", 60.0));
  ASSERT_EQ(meant.warnings.size(), 1U);
  EXPECT_FALSE(meant.warnings[0].ends_trust);
}

TEST(RecordedScan, WhereNothingIsLeftTheDamageIsTheError) {
  RecordingInMemory recording = recording_from_zero();
  recording.add("/points", cloud_type, 0, cut_off(cloud_bytes(epoch, "lidar", {{1.0, 0.0, 0.0}})));
  EXPECT_NE(
      error_of_read(recording, query_of("/points"))
          .find("the recording holds none; 1 part is damaged and left out: run: message 1 of"),
      std::string::npos);
}

// ---- Units of depth ---------------------------------------------------------------------------

RecordingInMemory recording_of_depths(const std::vector<std::uint16_t>& counts) {
  RecordingInMemory recording = recording_from_zero();
  const std::size_t width = counts.size() / 2;
  recording.add("/camera/depth/camera_info", camera_type, 0,
                camera_bytes({width, 2, 2.0, 2.0, {}}));
  recording.add("/camera/depth/image_rect_raw", image_type, 0,
                depth_bytes(epoch, "camera", width, counts));
  return recording;
}

TEST(RecordedScan, DepthsAreInTheUnitThatIsSaid) {
  RecordingInMemory recording = recording_of_depths({16000, 16400, 16800, 17200, 16000, 0});
  RecordingQuery query = query_of("/camera/depth/image_rect_raw");
  const RecordedScan wrong = read_recorded_scan(recording, query);
  EXPECT_TRUE(wrong.is_counted);
  ASSERT_EQ(wrong.warnings.size(), 1U);
  EXPECT_EQ(wrong.warnings[0].code, WarningCode::units);
  EXPECT_TRUE(wrong.warnings[0].ends_trust);
  EXPECT_NE(wrong.warnings[0].message.find("`depth_unit`, such as 0.25mm, which gives 4.1 m, or "
                                           "0.125mm"),
            std::string::npos)
      << wrong.warnings[0].message;
  for (const double unit : {0.25e-3, 0.125e-3}) {
    query.depth_unit = unit;
    const RecordedScan right = read_recorded_scan(recording, query);
    EXPECT_TRUE(right.warnings.empty());
    EXPECT_NEAR(right.cloud.points[0].z(), 16000 * unit, 1e-6);
    EXPECT_TRUE(std::isnan(right.cloud.points[5].z()));
  }
  RecordingInMemory near = recording_of_depths({1600, 1640, 1680, 1720, 1600, 0});
  EXPECT_TRUE(read_recorded_scan(near, query_of("/camera/depth/image_rect_raw")).warnings.empty());
}

TEST(RecordedScan, WhereNoDepthIsInRangeTheUnitIsTheError) {
  RecordingInMemory recording = recording_of_depths({33600, 34000, 34200, 34400, 33600, 0});
  RecordingQuery query = query_of("/camera/depth/image_rect_raw");
  EXPECT_NE(error_of_read(recording, query).find("0.125mm, which gives 4.2 m"), std::string::npos);
  query.depth_unit = 0.125e-3;
  EXPECT_NEAR(read_recorded_scan(recording, query).cloud.points[0].z(), 4.2, 1e-6);
}

TEST(RecordedScan, ADepthUnitIsOfDepthImages) {
  RecordingInMemory recording = numbered_clouds();
  RecordingQuery query = query_of("/points");
  query.depth_unit = 0.25e-3;
  EXPECT_NE(error_of_read(recording, query, ErrorKind::bad_input).find("holds points in metres"),
            std::string::npos);
  RecordingInMemory depths = recording_of_depths({1, 1});
  query = query_of("/camera/depth/image_rect_raw");
  for (const double unit : {0.0, -1.0, nan_value}) {
    query.depth_unit = unit;
    EXPECT_THROW(read_recorded_scan(depths, query), Error);
  }
}

/// sensor_msgs/CompressedImage as compressed_depth_image_transport fills it.
std::string compressed_bytes(const std::string& format, float a, float b, const std::string& png) {
  RosBytes data({Serialization::ros1, false});
  data.append(std::uint32_t{0}, false);
  data.append(a, false);
  data.append(b, false);
  return RosBytes(cdr_little).header(epoch, "camera").text(format).data(data.bytes() + png);
}

TEST(RecordedScan, CompressedDepthIsReadAsTheRawImage) {
  const std::vector<std::uint16_t> counts = {1600, 1640, 0, 1720};
  const std::string type = "sensor_msgs/msg/CompressedImage";
  const std::string png = png_of(2, counts);
  const std::string name = "/camera/depth/image_rect_raw/compressedDepth";
  RecordingInMemory raw = recording_of_depths(counts);
  const RecordedScan expected = read_recorded_scan(raw, query_of("/camera/depth/image_rect_raw"));
  const auto compressed = [&](const std::string& topic, const std::string& bytes) {
    RecordingInMemory recording = recording_from_zero();
    recording.add("/camera/depth/camera_info", camera_type, 0, camera_bytes({2, 2, 2.0, 2.0, {}}));
    recording.add(topic, type, 0, bytes);
    return recording;
  };
  const std::string plain =
      RosBytes(cdr_little).header(epoch, "camera").text("16UC1; png compressed").data(png);
  // inverse depths, 100 / (count - 20), of the second and the last pixel
  const std::string inverse =
      compressed_bytes("32FC1; compressedDepth png", 100.0F, 20.0F, png_of(2, {0, 70, 0, 45}));
  for (const char* format : {"16UC1; compressedDepth png", "16UC1; compressedDepth"}) {
    RecordingInMemory recording = compressed(name, compressed_bytes(format, 0.0F, 0.0F, png));
    const RecordedScan scan = read_recorded_scan(recording, query_of(""));
    EXPECT_TRUE(scan.is_counted);
    ASSERT_EQ(scan.cloud.points.size(), 4U);
    for (const std::size_t i : {0U, 1U, 3U}) {
      expect_near(scan.cloud.points[i], expected.cloud.points[i]);
    }
    EXPECT_TRUE(std::isnan(scan.cloud.points[2].x()));
    EXPECT_TRUE(scan.cloud.sensor_origin);
  }
  RecordingInMemory as_png = compressed("/camera/depth/image_rect_raw/compressed", plain);
  expect_near(read_recorded_scan(as_png, query_of("/camera/depth/image_rect_raw/compressed"))
                  .cloud.points[1],
              expected.cloud.points[1]);
  RecordingInMemory as_inverse = compressed(name, inverse);
  const RecordedScan scan = read_recorded_scan(as_inverse, query_of(name));
  EXPECT_FALSE(scan.is_counted);
  RecordingQuery in_counts = query_of(name);
  in_counts.depth_unit = 0.25e-3;
  EXPECT_NE(error_of_read(as_inverse, in_counts, ErrorKind::bad_input).find("depths in metres"),
            std::string::npos);
  EXPECT_NEAR(scan.cloud.points[1].z(), 2.0, 1e-6);
  EXPECT_NEAR(scan.cloud.points[3].z(), 4.0, 1e-6);
  EXPECT_TRUE(std::isnan(scan.cloud.points[0].z()));
}

TEST(RecordedScan, CompressedDepthThatIsDamagedIsLeftOut) {
  const std::string type = "sensor_msgs/msg/CompressedImage";
  const std::string name = "/camera/depth/image/compressedDepth";
  const std::string good =
      compressed_bytes("16UC1; compressedDepth png", 0.0F, 0.0F, png_of(2, {1, 2, 3, 4}));
  for (const std::size_t keep : {std::size_t{0}, good.size() - 50, good.size() - 20}) {
    RecordingInMemory recording = recording_from_zero();
    recording.add("/camera/depth/camera_info", camera_type, 0, camera_bytes({2, 2, 2.0, 2.0, {}}));
    std::string bad = good;
    for (std::size_t i = keep + 4; i < std::min(bad.size(), keep + 24); ++i) bad[i] ^= 0x55;
    recording.add(name, type, 0, bad);
    EXPECT_NE(error_of_read(recording, query_of(name)).find("1 part is damaged"),
              std::string::npos);
    recording.add(name, type, 100 * ms, good);
    EXPECT_EQ(read_recorded_scan(recording, query_of(name)).cloud.points.size(), 4U);
  }
}

// ---- Frames -----------------------------------------------------------------------------------

TEST(RecordedScan, AMissingTransformNamesTheFrames) {
  RecordingInMemory recording = driving_machine();
  EXPECT_EQ(error_of_read(recording, query_of("/points", 0.0, 0.0, "odom")),
            "found no transform of frame 'odom', the frames there are: 'base', 'lidar', 'map'");
  EXPECT_EQ(error_of_read(recording, query_of("/points", 0.0, 1.0, "odom")),
            "found no transform of frame 'odom', the frames there are: 'base', 'lidar', 'map'");
  add_cloud(recording, 20000 * ms, {{1.0, 0.0, 0.0}});
  EXPECT_EQ(error_of_read(recording, query_of("/points", 17.0, 0.0, "map")),
            "transform of 'base' in 'map' at 17.950 s: found it from -2.050 s to 7.950 s, expected "
            "it at that time");
}

TEST(RecordedScan, ASensorWhoseClockIsNotSetCannotBeTransformed) {
  RecordingInMemory recording = driving_machine();
  recording.add("/own", cloud_type, 2050 * ms, cloud_bytes(50 * ms, "lidar", {{1.0, 0.0, 0.0}}));
  EXPECT_EQ(
      error_of_read(recording, query_of("/own", {}, 0.0, "map")),
      "transform of 'base' in 'map' at -1002.000 s: found it from -2.050 s to 7.950 s, expected "
      "it at that time; the message recorded at 0.000 s is stamped -1002.000 s later: the "
      "clocks of sensor and transforms differ");
  // nothing is wrong with it as long as no transform is asked for, or a static one
  expect_near(read_recorded_scan(recording, query_of("/own", {}, 0.0, "base")).cloud.points.at(0),
              {1.0, 0.0, 2.0});
}

TEST(RecordedScan, ASensorWhoseClockIsNotSetIsSeenToMove) {
  RecordingInMemory recording = driving_machine();
  for (const int time : {2050, 2350}) {
    recording.add("/own", cloud_type, time * ms,
                  cloud_bytes(time * ms, "lidar", {{1.0, 0.0, 0.0}}));
  }
  EXPECT_NE(error_of_read(recording, query_of("/own", {}, 1.0), ErrorKind::bad_input)
                .find("frame 'lidar' of /own moved"),
            std::string::npos);
}

TEST(RecordedScan, FramesThatChangeNeedAFrameToBePutInto) {
  RecordingInMemory recording = driving_machine();
  add_transform(recording, 0, {0, "base", "other", {1.0, 0.0, 0.0}}, "/tf_static");
  add_cloud(recording, 2700 * ms, {{10.0 - 3.7, 1.0, 0.0}}, 0, "other");
  EXPECT_NE(error_of_read(recording, query_of("/points", 0.55, 0.5), ErrorKind::bad_input)
                .find("frame 'lidar' of /points became another: name the frame"),
            std::string::npos);
  const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 0.55, 0.5, "map"));
  ASSERT_EQ(scan.cloud.points.size(), 2U);
  for (const Eigen::Vector3d& point : scan.cloud.points) expect_near(point, {10.0, 1.0, 0.0});
}

// ---- Clocks -----------------------------------------------------------------------------------

TEST(RecordedScan, ClocksThatJumpAreAnError) {
  const auto error_of_steps = [](std::int64_t recorded, std::int64_t stamped) {
    RecordingInMemory recording = recording_from_zero();
    const Points points = {{1.0, 0.0, 0.0}};
    recording.add("/points", cloud_type, 0, cloud_bytes(epoch, "lidar", points));
    recording.add("/points", cloud_type, recorded, cloud_bytes(epoch + stamped, "lidar", points));
    return error_of_read(recording, query_of("/points", 0.0, 10.0));
  };
  EXPECT_EQ(error_of_steps(100 * ms, 100 * ms), "no error");
  EXPECT_EQ(error_of_steps(100 * ms, 1100 * ms), "no error");
  EXPECT_EQ(error_of_steps(100 * ms, -900 * ms), "no error");
  EXPECT_EQ(
      error_of_steps(100 * ms, -901 * ms),
      "a clock jumped: the message at 0.100 s was recorded 0.100 s after the one before, but "
      "stamped -0.901 s after it, expected the same within 1 s; choose a time or span without "
      "the jump");
  EXPECT_NE(error_of_steps(100 * ms, 1101 * ms), "no error");
}

TEST(RecordedScan, TimesAtTheEndsOfTheirRangeOverflowNothing) {
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  for (const auto& [first, last] :
       {std::pair{least, most}, std::pair{least, least + 5}, std::pair{most - 5, most}}) {
    RecordingInMemory recording;
    const std::string bytes = cloud_bytes(0, "lidar", {{1.0, 0.0, 0.0}});
    recording.add_at(first, "/points", cloud_type, bytes);
    recording.add_at(last, "/points", cloud_type, bytes);
    recording.add_at(first, "/tf", tf_type, transform_bytes({{0, "map", "lidar"}}));
    recording.add_at(last, "/joint_states", joint_type, joint_bytes(0, {{"boom", 1.0}}));
    EXPECT_EQ(describe_recording(recording).topics.size(), 3U);
    EXPECT_EQ(read_recorded_scan(recording, query_of("/points", 0.0, 1e9, "map")).messages,
              first + 5 == last ? 2U : 1U);
    error_of_read(recording, query_of("/points", 1e9, 0.0));
    error_about([&] { joint_positions(recording, 1e9); }, "run");
  }
}

// ---- Depth images -----------------------------------------------------------------------------

struct DepthTopic {
  std::string folder = "/camera/depth/";
  std::string image = "image_raw";
  CameraNumbers camera = {3, 2, 100.0, 50.0, {}};
};

RecordingInMemory depth_recording(const DepthTopic& topic) {
  RecordingInMemory recording = recording_from_zero();
  recording.add(topic.folder + "camera_info", camera_type, 0, camera_bytes(topic.camera));
  for (int i = 0; i < 3; ++i) {
    const auto count = static_cast<std::uint16_t>(2000 + i);
    recording.add(
        topic.folder + topic.image, image_type, i * 100 * ms,
        depth_bytes(epoch + i * 100 * ms, "camera", 3, {0, 50, 30000, 2000, count, 2000}));
  }
  return recording;
}

TEST(RecordedScan, DepthsBecomePointsInTheCameraFrame) {
  RecordingInMemory recording = depth_recording({});
  const RecordedScan scan = read_recorded_scan(recording, query_of("/camera/depth/image_raw", 0.1));
  ASSERT_EQ(scan.cloud.points.size(), 6U);
  EXPECT_EQ(scan.cloud.width, 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(std::isnan(scan.cloud.points[i].z())) << "none, too near and too far: " << i;
  }
  expect_near(scan.cloud.points[3], {-0.02, 0.0, 2.0});  // K: focal length 100, centre (1, 1)
  expect_near(scan.cloud.points[4], {0.0, 0.0, 2.001});
  EXPECT_EQ(*scan.cloud.sensor_origin, Eigen::Vector3d::Zero());
}

TEST(RecordedScan, DepthsOfAStandingCameraAreAveraged) {
  RecordingInMemory recording = depth_recording({});
  const RecordedScan scan =
      read_recorded_scan(recording, query_of("/camera/depth/image_raw", 0.0, 1.0));
  EXPECT_EQ(scan.merge, ScanMerge::averaged);
  expect_near(scan.cloud.points[4], {0.0, 0.0, 2.001});
  EXPECT_NEAR(scan.variance[4], 1e-6 / 3.0, 1e-9);
}

TEST(RecordedScan, RectifiedImagesTakeTheProjectionRawOnesMayHaveNoDistortion) {
  DepthTopic topic;
  topic.camera.distortion = {0.0, 0.1};
  RecordingInMemory raw = depth_recording(topic);
  EXPECT_EQ(error_of_read(raw, query_of("/camera/depth/image_raw")),
            "'/camera/depth/image_raw': found a raw image of a lens with distortion, expected a "
            "rectified one: rectify it with image_proc before it is recorded");
  raw.add("/camera/depth/image_rect", image_type, 0,
          depth_bytes(0, "camera", 3, {0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(error_of_read(raw, query_of("/camera/depth/image_raw")),
            "'/camera/depth/image_raw': found a raw image of a lens with distortion, expected a "
            "rectified one: read '/camera/depth/image_rect'");
  topic.image = "image_rect";
  RecordingInMemory rectified = depth_recording(topic);
  const RecordedScan scan = read_recorded_scan(rectified, query_of("/camera/depth/image_rect"));
  expect_near(scan.cloud.points[3], {-0.08, -0.04, 2.0});  // P: focal length 50, centre (2, 2)
}

TEST(RecordedScan, CamerasThatDoNotFitAreRefused) {
  DepthTopic topic;
  topic.camera.width = 4;
  RecordingInMemory other_size = depth_recording(topic);
  EXPECT_EQ(error_of_read(other_size, query_of("/camera/depth/image_raw")),
            "message 2 of /camera/depth/image_raw: found 3 x 2 pixels, expected 4 x 2 as in the "
            "camera info");
  topic = {};
  topic.camera.focal = 0.0;
  RecordingInMemory uncalibrated = depth_recording(topic);
  EXPECT_EQ(
      error_of_read(uncalibrated, query_of("/camera/depth/image_raw")),
      "'/camera/depth/camera_info': found focal lengths 0, 0 and centre 1, 1, expected those of "
      "a camera");
  RecordingInMemory none = recording_from_zero();
  none.add("/a/image", image_type, 0, depth_bytes(0, "camera", 1, {1}));
  none.add("/b/camera_info", camera_type, 0, camera_bytes({1, 1, 1.0, 1.0, {}}));
  EXPECT_EQ(error_of_read(none, query_of("/a/image")),
            "found no topic '/a/camera_info', expected the intrinsics of '/a/image' there; camera "
            "infos: '/b/camera_info'");
}

// ---- What is there ----------------------------------------------------------------------------

TEST(RecordedScan, DescribesARecording) {
  RecordingInMemory recording = driving_machine();
  const RecordingContents contents = describe_recording(recording);
  EXPECT_EQ(contents.start, 1000.0);
  EXPECT_EQ(contents.duration, 10.0);
  EXPECT_EQ(contents.frames, (std::vector<std::string>{"base", "lidar", "map"}));
  ASSERT_EQ(contents.topics.size(), 4U);
  const RecordingTopic& points = contents.topics[0];
  EXPECT_EQ(points.name, "/points");
  EXPECT_EQ(points.type, cloud_type);
  EXPECT_EQ(points.messages, 3U);
  EXPECT_EQ(points.first, 2.05);
  EXPECT_EQ(points.last, 2.65);
  EXPECT_EQ(points.frame, "lidar");
  EXPECT_TRUE(points.is_scan);
  EXPECT_FALSE(contents.topics[2].is_scan);
}

TEST(RecordedScan, JointPositionsAreTheNearestOfEachName) {
  RecordingInMemory recording = recording_from_zero();
  recording.add("/joint_states", joint_type, 1000 * ms,
                joint_bytes(0, {{"boom", 1.0}, {"arm", 2.0}}));
  recording.add("/joint_states", joint_type, 1200 * ms, joint_bytes(0, {{"boom", 1.5}}));
  recording.add("/bucket", joint_type, 1500 * ms, joint_bytes(0, {{"bucket", 3.0}}));
  EXPECT_EQ(joint_positions(recording, 1.15),
            (std::map<std::string, double>{{"arm", 2.0}, {"boom", 1.5}, {"bucket", 3.0}}));
  EXPECT_EQ(joint_positions(recording, 0.6),
            (std::map<std::string, double>{{"arm", 2.0}, {"boom", 1.0}}));
  EXPECT_EQ(error_about([&] { joint_positions(recording, 5.0); }, "run"),
            "found no joint positions within 0.5 s of 5.000 s on '/bucket', '/joint_states'");
}

// ---- Damage -----------------------------------------------------------------------------------

/// Of a topic and times of which a message may be lost, whether the scan may lack soil.
TEST(RecordedScan, WhatIsLostOfItsTopicAndTimesAloneEndsTrust) {
  const auto doubts = [](const Loss& loss, double time, double span, std::size_t height) {
    RecordingInMemory recording;
    for (int i = 0; i < 30; ++i) {
      Points seen = organised(1.0, 2.0, 3.0, 4.0);
      if (height == 1 && i % 2 == 0) seen.pop_back();  // frames that are joined
      recording.add("/points", cloud_type, i * 100 * ms,
                    cloud_bytes(epoch + i * 100 * ms, "lidar", seen, height));
    }
    recording.skipped().add("run: a part", loss);
    const RecordedScan scan = read_recorded_scan(recording, query_of("/points", time, span));
    EXPECT_EQ(scan.warnings.size(), 1U);
    EXPECT_EQ(scan.warnings.at(0).code, WarningCode::recording_cut_off);
    return scan.warnings.at(0).ends_trust;
  };
  const TimeRange second = {epoch + 1000 * ms, epoch + 1200 * ms};
  EXPECT_TRUE(doubts({second, {"/points"}}, 0.5, 1.0, 1)) << "in the span";
  EXPECT_TRUE(doubts({second}, 0.5, 1.0, 1)) << "perhaps of it";
  EXPECT_FALSE(doubts({second, {"/tf", "/imu"}}, 0.5, 1.0, 1)) << "of other topics";
  EXPECT_FALSE(doubts({second, {"/points"}}, 2.0, 0.5, 1)) << "before the span";
  EXPECT_FALSE(doubts({second, {"/points"}}, 0.1, 0.5, 1)) << "after it";
  EXPECT_FALSE(doubts({second, {"/points"}}, 0.5, 1.0, 2))
      << "each of the averaged frames shows all";
  EXPECT_FALSE(doubts({second, {"/points"}}, 1.0, 0.0, 1)) << "the next one is as good";
  EXPECT_FALSE(doubts({no_time}, 0.5, 1.0, 1));
  EXPECT_TRUE(doubts({{}, {"/points"}}, 0.5, 1.0, 1)) << "at a time that is not known";
}

/// As of a lidar that stands, unlike that of one that turns.
TEST(RecordedScan, WhereEachMessageShowsAllNoneIsMissed) {
  for (const double moved : {0.0, 1.0}) {
    RecordingInMemory recording = recording_from_zero();
    for (int i = 0; i < 5; ++i) {
      Points seen;
      for (int k = 0; k < 200 + i; ++k)
        seen.emplace_back(0.1 * (k % 100) + moved * i, 0.2, 0.01 * i);
      add_cloud(recording, i * 100 * ms, seen);
    }
    recording.skipped().add("run: a part", {{epoch + 150 * ms, epoch + 150 * ms}, {"/points"}});
    const RecordedScan scan = read_recorded_scan(recording, query_of("/points", 0.0, 1.0));
    ASSERT_EQ(scan.merge, ScanMerge::joined);
    ASSERT_EQ(scan.warnings.size(), 1U);
    EXPECT_EQ(scan.warnings[0].ends_trust, moved > 0.0);
  }
}

/// Every message of a scan with depths, transforms and several frames, changed at random.
TEST(RecordedScan, MutatedRecordingsEndInAScanOrAnError) {
  std::mt19937 random(11);
  const auto changed = [&](std::string bytes) {
    for (auto changes = random() % 3; changes > 0; --changes) {
      const auto to = random();
      bytes[random() % bytes.size()] = static_cast<char>(to % 256);
      if (to % 11 == 0) bytes.resize(random() % bytes.size() + 1);
    }
    return bytes;
  };
  int refused = 0;
  for (int round = 0; round < 1500; ++round) {
    RecordingInMemory recording;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t stamp = epoch + i * 100 * ms;
      recording.add("/d/camera_info", camera_type, 0, changed(camera_bytes({3, 2, 9.0, 9.0, {}})));
      recording.add("/d/image", image_type, i * 100 * ms,
                    changed(depth_bytes(stamp, "lidar", 3, {900, 901, 902, 903, 904, 905})));
      recording.add("/points", cloud_type, i * 100 * ms,
                    changed(cloud_bytes(stamp, "lidar", organised(1.0, 2.0, 3.0, 4.0), 2)));
      recording.add("/tf", tf_type, i * 100 * ms,
                    changed(transform_bytes({{stamp, "map", "lidar"}})));
      recording.add("/joint_states", joint_type, 0, changed(joint_bytes(0, {{"boom", 1.0}})));
    }
    for (const char* const topic : {"/d/image", "/points"}) {
      for (const char* const frame : {"", "map"}) {
        try {
          read_recorded_scan(recording, query_of(topic, 0.0, 1.0, frame));
        } catch (const Error&) {
          ++refused;
        }
      }
    }
    try {
      describe_recording(recording);
      joint_positions(recording, 0.0);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

// ---- Recordings that other programs wrote -----------------------------------------------------

class EveryContainer : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!missing_for(GetParam()).empty()) GTEST_SKIP() << "without " << missing_for(GetParam());
  }
  static std::string path() { return recording(GetParam()); }
  static RecordedScan read(const RecordingQuery& query) {
    RecordingQuery in_file = query;
    in_file.path = path();
    return read_recorded_scan(in_file);
  }
};
INSTANTIATE_TEST_SUITE_P(RecordedScan, EveryContainer,
                         testing::Values("scene_none.bag", "scene_bz2.bag", "scene_lz4.bag",
                                         "scene_none.mcap", "scene_lz4.mcap", "scene_zstd.mcap",
                                         "scene_unchunked.mcap", "scene_no_summary.mcap",
                                         "scene_ros1.mcap", "scene.db3", "scene_split",
                                         "scene_zstd.db3"));

TEST_P(EveryContainer, PointsInTheirFrameAndInTheMap) {
  const RecordedScan scan = read(query_of("/lidar/points", 1.7));
  EXPECT_NEAR(scan.first, 1.8, 1e-9) << "from the first of the topic, at 0.25 s";
  EXPECT_EQ(scan.cloud.width, 6U);
  EXPECT_EQ(scan.cloud.height, 5U);
  expect_near(scan.cloud.points[7], {3.25, -0.25, -1.478});
  EXPECT_TRUE(std::isnan(scan.cloud.points[29].z()));
  EXPECT_EQ(*scan.cloud.sensor_origin, Eigen::Vector3d::Zero());

  const RecordedScan in_map = read(query_of("/lidar/points", 1.7, 0.0, "map"));
  const double yaw = 0.05 * 2.05;
  const Eigen::Vector3d in_base(0.4 + 0.25, 3.25, 1.8 - 1.478);  // turned left by 90 deg
  const Eigen::Vector3d expected(
      0.2 * 2.05 + std::cos(yaw) * in_base.x() - std::sin(yaw) * in_base.y(),
      std::sin(yaw) * in_base.x() + std::cos(yaw) * in_base.y(), in_base.z());
  expect_near(in_map.cloud.points[7], expected, 1e-5);
  expect_near(*in_map.cloud.sensor_origin,
              {0.2 * 2.05 + 0.4 * std::cos(yaw), 0.4 * std::sin(yaw), 1.8}, 1e-5);
}

TEST_P(EveryContainer, SpansAreAveragedOnTheMachineAndJoinedInTheMap) {
  const RecordedScan on_machine = read(query_of("/lidar/points", 0.0, 5.0, "base_link"));
  EXPECT_EQ(on_machine.merge, ScanMerge::averaged);
  EXPECT_EQ(on_machine.messages, 6U);
  EXPECT_EQ(on_machine.variance.size(), 30U);
  EXPECT_GT(on_machine.frame_sd, 0.0);
  const RecordedScan in_map = read(query_of("/lidar/points", 0.0, 5.0, "map"));
  EXPECT_EQ(in_map.merge, ScanMerge::joined);
  EXPECT_EQ(in_map.cloud.points.size(), 6U * 29U);
  EXPECT_NE(
      error_about([&] { read(query_of("/lidar/points", 0.0, 5.0)); }, path(), ErrorKind::bad_input)
          .find("frame 'lidar' of /lidar/points moved"),
      std::string::npos);
}

TEST_P(EveryContainer, DepthImagesOnTheMachine) {
  const RecordedScan scan = read(query_of("/camera/depth/image_raw", {}, 5.0, "base_link"));
  EXPECT_EQ(scan.messages, 5U);
  EXPECT_EQ(scan.merge, ScanMerge::averaged);
  EXPECT_EQ(scan.cloud.width, 16U);
  EXPECT_TRUE(std::isnan(scan.cloud.points[0].z()));
  const double z = 1.5 + 0.01 * 3 + 0.001 * 4 + 0.002;  // of row 3, column 4, the mean of 5 frames
  // the camera looks straight down: its x is the machine's -y, its y the machine's -x
  expect_near(scan.cloud.points[3 * 16 + 4],
              {-(3 - 5.5) / 20.0 * z, 0.2 - (4 - 7.5) / 20.0 * z, 2.0 - z}, 1e-5);
  expect_near(*scan.cloud.sensor_origin, {0.0, 0.2, 2.0});
}

TEST_P(EveryContainer, ContentsAndJoints) {
  const RecordingContents contents = describe_recording(path());
  EXPECT_EQ(contents.start, 1.7e9);
  EXPECT_EQ(contents.duration, 5.0);
  EXPECT_EQ(contents.frames, (std::vector<std::string>{"base_link", "camera", "lidar", "map"}));
  std::size_t scans = 0;
  for (const RecordingTopic& topic : contents.topics) {
    if (topic.is_scan) ++scans;
    if (topic.name == "/lidar/points") {
      EXPECT_EQ(topic.frame, "lidar");
    }
  }
  EXPECT_EQ(scans, 2U);
  EXPECT_EQ(joint_positions(path(), 2.0),
            (std::map<std::string, double>{
                {"boom", 0.54}, {"bucket", 0.3}, {"stick", -1.2}, {"swing", 0.0}}));
}

TEST(RecordedScan, TheSiteOfARealBag) {
  const std::string folder = std::string(EXCAVPLAN_SHARED_DATA) + "/site-terrain/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  if (!missing_for("db3").empty()) GTEST_SKIP() << "without " << missing_for("db3");
  const RecordedScan scan = read_recorded_scan(
      {folder + "rosbag2_static_terrain_0.db3", "/demo2/terrain/static", {}, 0.0, ""});
  EXPECT_EQ(scan.frame, "world");
  EXPECT_FALSE(scan.cloud.sensor_origin);
  EXPECT_EQ(scan.cloud.points, read_cloud(folder + "terrain.pcd").points);
}

// ---- The form of the tools --------------------------------------------------------------------

TEST(RecordingSpec, ReadsTheForm) {
  const auto spec = parse_recording_spec("some/run.db3:/livox/lidar@12.5s+2s");
  ASSERT_TRUE(spec);
  EXPECT_EQ(spec->path, "some/run.db3");
  EXPECT_EQ(spec->topic, "/livox/lidar");
  EXPECT_EQ(spec->time, 12.5);
  EXPECT_EQ(spec->span, 2.0);
  EXPECT_EQ(spec->frame, "");
  EXPECT_FALSE(parse_recording_spec("run.db3:/a")->time);
  EXPECT_EQ(parse_recording_spec("run.db3:/a")->span, 0.0);
  EXPECT_EQ(parse_recording_spec("run.db3:/a@3")->time, 3.0);
  EXPECT_EQ(parse_recording_spec("run.db3:/a@250ms")->time, 0.25);
  EXPECT_EQ(parse_recording_spec("run.db3:/a@1.5min+0.5min")->time, 90.0);
  EXPECT_EQ(parse_recording_spec("run.db3:/a@1.5min+0.5min")->span, 30.0);
  EXPECT_EQ(parse_recording_spec("run.db3:/a+500ms")->span, 0.5);
  EXPECT_EQ(parse_recording_spec("at:home@work/run.db3:/a")->path, "at:home@work/run.db3");
}

TEST(RecordingSpec, FileNamesAreNone) {
  for (const char* const name : {"cloud.pcd", "C:/data/run.pcd", "http://host/run.db3", "", ":/a",
                                 "a:b", "run@12s.pcd", "/absolute/cloud.pcd"}) {
    EXPECT_FALSE(parse_recording_spec(name)) << name;
  }
  EXPECT_FALSE(parse_recording_spec(recording("scene.db3")));
}

TEST(RecordingSpec, AFileThatExistsIsNeverASpec) {
  const auto folder = std::filesystem::temp_directory_path() / "excavplan_spec:";
  std::filesystem::create_directories(folder);
  const std::string name = (folder / "cloud.xyz").string();
  std::ofstream(name) << "1 2 3\n";
  EXPECT_FALSE(parse_recording_spec(name));
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(parse_recording_spec(name));
}

TEST(RecordingSpec, ErrorsShowTheForm) {
  const auto error = [](const std::string& text) {
    return error_of([&] { parse_recording_spec(text); });
  };
  const std::string form = ": FILE:TOPIC@TIME+SPAN, such as run.db3:/livox/lidar@12.5s+2s";
  EXPECT_EQ(error("run.db3:/a@x"),
            "'run.db3:/a@x': found time 'x', expected a number with s, ms or min" + form);
  EXPECT_EQ(error("run.db3:/a@1s+-2s"),
            "'run.db3:/a@1s+-2s': found span '-2s', expected 0 to 1e9 s" + form);
  EXPECT_EQ(error("run.db3:/"),
            "'run.db3:/': found the topic '/', expected a name behind the /" + form);
  for (const char* const text : {"run.db3:/a@", "run.db3:/a+", "run.db3:/a@1h", "run.db3:/a@nans",
                                 "run.db3:/a@infs", "run.db3:/a@1s+2s+3s", "run.db3:/a+1s@2s"}) {
    EXPECT_NE(error(text).find(form), std::string::npos) << text;
  }
  const std::string file = recording("scene.db3");
  for (const char* const rest : {"@2s", "@2s+1s"}) {
    EXPECT_EQ(error(file + rest), "'" + file + rest + "': found '" + rest +
                                      "' behind a recording, expected a topic that begins with /, "
                                      "which inspect-cloud " +
                                      file + " lists" + form);
  }
  EXPECT_NE(error(file + ":lidar"), "no error");
}

}  // namespace
}  // namespace excavplan::test
