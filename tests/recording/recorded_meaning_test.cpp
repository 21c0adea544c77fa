// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "recording/recorded_scan.hpp"
#include "support/recording_files.hpp"
#include "support/recording_in_memory.hpp"
#include "support/wrong_inputs.hpp"

/// @file
/// Recordings whose clocks, frames or transforms do not mean what they should.

namespace excavplan::test {
namespace {

constexpr bool may_be_right = true;

/// A machine that drives along x at 1 m/s for 60 s, and its lidar at 30 s, whose stamp is late by
/// so much; transforms reach the recorder after `delay`.
RecordingInMemory driving(std::int64_t late, std::int64_t delay = 0, double speed = 1.0) {
  RecordingInMemory recording;
  recording.add("/rosout", "rcl_interfaces/msg/Log", 0, "");
  add_transform(recording, 0, {0, "base", "lidar", {0.0, 0.0, 2.0}}, "/tf_static");
  for (int i = 0; i <= 600; ++i) {
    add_transform(recording, i * 100 * ms, {0, "map", "base", {0.1 * speed * i, 0.0, 0.0}}, "/tf",
                  delay);
  }
  recording.add("/points", cloud_type, 30000 * ms,
                cloud_bytes(epoch + 30000 * ms + late, "lidar", {{1.0, 0.0, -2.0}}));
  return recording;
}

Verdict scan_of(RecordingInMemory& recording, const std::string& frame,
                const Eigen::Vector3d& truth, double span = 0.0) {
  const RecordedScan scan = read_recorded_scan(recording, {"", "/points", {}, span, frame});
  bool is_right = true;
  for (const Eigen::Vector3d& point : scan.cloud.points) {
    is_right = is_right && (point - truth).norm() < 0.15;
  }
  bool is_trusted = true;
  for (const Warning& warning : scan.warnings) is_trusted = is_trusted && !warning.ends_trust;
  return {is_trusted, is_right, {}, scan.warnings};
}

WrongInput wrong_clock(const std::string& name, std::int64_t late, std::int64_t delay,
                       const std::vector<std::string>& reasons, bool right = false,
                       double speed = 1.0) {
  const auto made = [=] {
    RecordingInMemory recording = driving(late, delay, speed);
    return scan_of(recording, "map", {30.0 * speed + 1.0, 0.0, 0.0});
  };
  return {name, made, reasons, right};
}

TEST(RecordedMeaning, Clocks) {
  expect_no_wrong_answer({
      wrong_clock("clocks agree", 0, 0, {}, may_be_right),
      wrong_clock("a stamp 0.1 s off", 100 * ms, 0, {}, may_be_right),
      wrong_clock("transforms recorded 0.2 s late", 0, 200 * ms, {}, may_be_right),
      wrong_clock("a stamp 0.5 s late", 500 * ms, 0, {"clocks_differ"}),
      wrong_clock("a stamp 0.5 s early", -500 * ms, 0, {"clocks_differ"}),
      wrong_clock("a stamp 2 s late", 2000 * ms, 0, {"clocks_differ"}),
      wrong_clock("a stamp 5 s early", -5000 * ms, 0, {"clocks_differ"}),
      wrong_clock("a stamp 9 s late", 9000 * ms, 0, {"clocks_differ"}),
      wrong_clock("a stamp 25 s early", -25000 * ms, 0, {"clocks"}),
      wrong_clock("a stamp 5 s late of a machine that stands", 5000 * ms, 0, {}, may_be_right, 0.0),
  });
}

/// Both recorded 3 s after they were stamped, as from a recording that is played again.
TEST(RecordedMeaning, ADelayOfAllIsNoOffset) {
  RecordingInMemory recording = driving(-3000 * ms, 3000 * ms);
  const Verdict verdict = scan_of(recording, "map", {28.0, 0.0, 0.0});
  EXPECT_TRUE(verdict.trusted) << verdict.text();
  EXPECT_TRUE(verdict.right);
}

TEST(RecordedMeaning, Transforms) {
  const auto with = [](const std::function<void(RecordingInMemory&)>& publish,
                       const std::string& frame, const Eigen::Vector3d& truth, double span = 0.0) {
    return [=] {
      RecordingInMemory recording;
      recording.add("/rosout", "rcl_interfaces/msg/Log", 0, "");
      publish(recording);
      for (const std::int64_t time : {60000, 60500, 61000}) {
        recording.add("/points", cloud_type, time * ms,
                      cloud_bytes(epoch + time * ms, "lidar", {{1.0, 0.0, -2.0}}));
      }
      return scan_of(recording, frame, truth, span);
    };
  };
  const auto every_tenth = [](RecordingInMemory& recording, TransformNumbers transform,
                              double speed) {
    for (int i = 590; i <= 620; ++i) {
      transform.translation.x() = speed * 0.1 * (i - 600);
      add_transform(recording, i * 100 * ms, transform);
    }
  };
  const TransformNumbers mast = {0, "base", "lidar", {0.0, 0.0, 2.0}};
  const TransformNumbers other_mast = {0, "base", "lidar", {0.5, 0.0, 2.0}};
  const TransformNumbers place = {0, "map", "base", {0.0, 0.0, 0.0}};
  expect_no_wrong_answer({
      {"one transform, long before the scan",
       with([=](auto& r) { add_transform(r, 100 * ms, mast); }, "base", {1.0, 0.0, 0.0}),
       {"found it from -59.900 s to -59.900 s"}},
      {"a static transform and others that disagree",
       with(
           [=](auto& r) {
             add_transform(r, 0, mast, "/tf_static");
             every_tenth(r, {0, "base", "lidar", {0.0, 0.3, 2.0}}, 0.0);
           },
           "base", {1.0, 0.0, 0.0}),
       {"differ at one time"}},
      {"a static transform and others that agree",
       with(
           [=](auto& r) {
             add_transform(r, 0, mast, "/tf_static");
             every_tenth(r, mast, 0.0);
           },
           "base", {1.0, 0.0, 0.0}),
       {},
       may_be_right},
      {"two transforms of one time that disagree",
       with(
           [=](auto& r) {
             every_tenth(r, mast, 0.0);
             add_transform(r, 60000 * ms, other_mast);
           },
           "base", {1.0, 0.0, 0.0}),
       {"differ at one time"}},
      {"two parents",
       with(
           [=](auto& r) {
             add_transform(r, 0, mast, "/tf_static");
             every_tenth(r, place, 0.0);
             every_tenth(r, {0, "odom", "base", {0.0, 0.0, 0.0}}, 0.0);
           },
           "map", {1.0, 0.0, 0.0}),
       {"one parent"}},
      {"a named frame that moves in the map during the span",
       with(
           [=](auto& r) {
             add_transform(r, 0, mast, "/tf_static");
             every_tenth(r, place, 1.0);
           },
           "base", {1.0, 0.0, 0.0}, 1.0),
       {"frame_moved"}},
      {"a named frame that stands during the span",
       with(
           [=](auto& r) {
             add_transform(r, 0, mast, "/tf_static");
             every_tenth(r, place, 0.0);
           },
           "base", {1.0, 0.0, 0.0}, 1.0),
       {},
       may_be_right},
      {"a frame that is in another tree",
       with(
           [=](auto& r) {
             add_transform(r, 0, mast, "/tf_static");
             add_transform(r, 0, {0, "world", "site", {0.0, 0.0, 0.0}}, "/tf_static");
           },
           "site", {1.0, 0.0, 0.0}),
       {"no transforms that lead"}},
  });
}

TEST(RecordedMeaning, AFileWhoseEndIsMissingSaysSo) {
  const std::string whole = recording("scene_none.mcap");
  if (const std::string library = missing_for(whole); !library.empty()) GTEST_SKIP() << library;
  const TempFolder folder;
  const std::string content = content_of(whole);
  const std::string cut = folder.write("cut.mcap", content.substr(0, content.size() / 2));
  EXPECT_FALSE(describe_recording(whole).is_cut_off);
  const RecordingContents contents = describe_recording(cut);
  EXPECT_TRUE(contents.is_cut_off);
  for (const RecordingTopic& topic : contents.topics) {
    if (!topic.is_scan || topic.messages == 0) continue;
    const RecordedScan scan = read_recorded_scan({cut, topic.name, {}, 0.0, ""});
    ASSERT_EQ(scan.warnings.size(), 1U);
    EXPECT_EQ(scan.warnings[0].code, WarningCode::recording_cut_off);
    return;
  }
  FAIL() << "no scan is left in the half";
}

}  // namespace
}  // namespace excavplan::test
