// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Hostile times, spans, paths, topics and frames for the readers of recordings.

#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/recording/recording.hpp>

#include "base/non_finite.hpp"
#include "support/errors.hpp"
#include "support/hostile.hpp"
#include "support/recording_files.hpp"

namespace excavplan {
namespace {

using test::answers;
using test::refuses;

/// A recording that needs none of the optional libraries.
RecordingQuery good() { return {test::recording("scene_none.mcap"), "/lidar/points", {}, 0.0, ""}; }

TEST(HostileRecording, TimesAndSpans) {
  ASSERT_FALSE(read_recorded_scan(good()).cloud.points.empty());
  for (const double bad : {nan, infinity, -infinity, -1.0, 1e300}) {
    RecordingQuery query = good();
    query.time = bad;
    EXPECT_TRUE(refuses([&] { read_recorded_scan(query); }, "time is ")) << bad;
    query = good();
    query.span = bad;
    EXPECT_TRUE(refuses([&] { read_recorded_scan(query); }, "span is ")) << bad;
    EXPECT_TRUE(refuses([&] { joint_positions(good().path, bad); }, "time is ")) << bad;
  }
  for (const double odd : test::hostile_numbers) {
    RecordingQuery query = good();
    query.time = odd;
    query.span = odd;
    EXPECT_TRUE(answers([&] { return !read_recorded_scan(query).cloud.points.empty(); })) << odd;
  }
}

TEST(HostileRecording, Paths) {
  const std::string zero("scene\0.mcap", 11);
  for (const std::string& path : {std::string(), std::string("/nowhere/run.mcap"), zero,
                                  std::string("/dev/null"), std::string(10000000, 'x')}) {
    RecordingQuery query = good();
    query.path = path;
    test::error_of([&] { read_recorded_scan(query); }, ErrorKind::bad_file);
    EXPECT_NE(test::error_of([&] { describe_recording(path); }, ErrorKind::bad_file), "no error");
    EXPECT_NE(test::error_of([&] { joint_positions(path, 0.0); }, ErrorKind::bad_file), "no error");
    EXPECT_TRUE(answers([&] { return !parse_recording_spec(path); }));
  }
}

TEST(HostileRecording, Topics) {
  RecordingQuery query = good();
  query.topic.clear();
  EXPECT_NE(test::error_of([&] { read_recorded_scan(query); }, ErrorKind::bad_file).find("topics"),
            std::string::npos);
  query.topic = std::string(10000000, 'x');
  const auto start = std::chrono::steady_clock::now();
  const std::string text = test::error_of([&] { read_recorded_scan(query); }, ErrorKind::bad_file);
  EXPECT_NE(text.find("found no topic 'xxx"), std::string::npos) << text;
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  query.topic = std::string("/lidar\0/points", 14);
  EXPECT_NE(test::error_of([&] { read_recorded_scan(query); }, ErrorKind::bad_file), "no error");
}

TEST(HostileRecording, Frames) {
  RecordingQuery query = good();
  query.frame = "/";
  EXPECT_TRUE(refuses([&] { read_recorded_scan(query); }, "the frame is '/'"));
  for (const std::string& frame : {std::string("//"), std::string("\xff\n"), std::string(1, '\0'),
                                   std::string(10000000, 'x')}) {
    query.frame = frame;
    EXPECT_NE(test::error_of([&] { read_recorded_scan(query); }, ErrorKind::bad_file), "no error");
  }
}

}  // namespace
}  // namespace excavplan
