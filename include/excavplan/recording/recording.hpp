// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/clouds/cloud.hpp>

/// @file
/// Scans out of what a robot recorded: rosbag2 (SQLite or MCAP) and ROS 1 bags, without ROS.
///
/// A time is counted from the first message of its topic [s], by the clock that recorded. Messages
/// over a year from the others of their topic (ours) bear a wrong time and are left out, as is what
/// is damaged: a warning says so.
/// Every function throws Error (bad_file) "file: message of /topic at 12.5 s: found X, expected Y"
/// if nothing of what is asked for is whole, or a library is needed that this build is without.

namespace excavplan {

/// What a recording holds under one name.
struct RecordingTopic {
  std::string name;            ///< "/livox/lidar"
  std::string type;            ///< as ROS 2 spells it: "sensor_msgs/msg/PointCloud2"
  std::uint64_t messages = 0;  ///< of it
  double first = 0.0;  ///< its first message from the start of the recording [s]; NaN without one
  double last = 0.0;   ///< its last message, likewise
  std::string frame;   ///< of its first message; empty if it has none, or the type is not read here
  bool is_scan = false;  ///< read_recorded_scan() reads it
};

/// What is in a recording.
struct RecordingContents {
  /// When its first message was recorded [s since 1970], of the topics within a year of the one
  /// with most messages; a topic of another clock does not count.
  double start = 0.0;
  double duration = 0.0;               ///< up to the last message of these topics [s]
  std::vector<RecordingTopic> topics;  ///< sorted by name
  /// Between which there are transforms: of /tf_static, and of the first second of /tf; sorted.
  std::vector<std::string> frames;
  bool is_cut_off = false;          ///< its end is missing, as that of a recorder that was killed
  std::uint64_t damaged_parts = 0;  ///< that are left out
  std::string first_damage;         ///< "file: place: found X, expected Y"; empty without one
  std::vector<std::string> damage;  ///< of each part likewise, at most 1000
};

/// Reads the index of a recording, all its chunks, which may be damaged, and the first message of
/// each topic.
RecordingContents describe_recording(const std::string& path);

/// Which points of a recording.
struct RecordingQuery {
  std::string path;            ///< a rosbag2 folder, .db3, .mcap or .bag file
  std::string topic;           ///< empty: the only one that holds scans
  std::optional<double> time;  ///< >= 0 [s]; unset: that of the first message of the topic
  double span = 0.0;           ///< 0: the first message at or after the time; else all of them from
                               ///< the time on for so long, >= 0 [s]
  std::string frame;           ///< into which the points are put; empty: as they were recorded
  /// Of depth images in counts, > 0 [m]; unset: 1 mm, as ROS says (REP 118).
  std::optional<double> depth_unit = {};
};

/// Reads `FILE:TOPIC\@TIME+SPAN`, e.g. "run.db3:/livox/lidar@12.5s+2s", in s, ms or min (s without
/// a unit); "\@TIME" and "+SPAN" may be left out. The topic begins with "/".
///
/// @return nothing if the text is no such thing but the name of a file, as it is whenever a file of
/// that name exists
/// @throws Error (bad_input) that shows the form, if only a part of it is wrong
std::optional<RecordingQuery> parse_recording_spec(const std::string& text);

/// What became of several messages.
enum class ScanMerge {
  single,    ///< there was one
  averaged,  ///< pixel by pixel, of a sensor that stood still
  joined     ///< the points of all of them together
};

/// Points of a recording and how they came about.
struct RecordedScan {
  /// In `frame` [m]. The sensor's place is set where it is known: of depth images and Livox
  /// messages, and where the frame of the messages is a leaf of the tree of transforms; not of a
  /// sensor that moved in between.
  Cloud cloud;
  std::string topic;           ///< of the messages
  std::string frame;           ///< of the points
  std::string recorded_frame;  ///< of the first message
  std::size_t messages = 0;    ///< that were used
  bool is_counted = false;     ///< depths in counts, in the unit of the query or 1 mm
  double first = 0.0;          ///< time of the first of them [s]
  double last = 0.0;           ///< time of the last of them [s]
  /// When the last of them was seen, since 1970-01-01 UTC [s]: by its stamp, or where that is over
  /// a year off (ours), as of a clock that was not set, by the clock that recorded.
  double seen_at = 0.0;
  ScanMerge merge = ScanMerge::single;  ///< what became of several messages
  /// Of each averaged point along its ray, from the scatter of the frames [m^2], NaN where fewer
  /// than two agree; empty unless averaged. What all frames have in common is not in it.
  std::vector<double> variance;
  double frame_sd = 0.0;  ///< median over the points of the sd of one frame [m]; 0 unless averaged
  /// clocks_differ, frame_moved, recording_cut_off, units (depths beyond 10 m, of another unit):
  /// for Scan::doubts.
  std::vector<Warning> warnings;
};

/// Reads points of PointCloud2, of Livox's CustomMsg, or of depth images (16UC1, mono16, 32FC1, and
/// PNG as compressedDepth writes it) with the CameraInfo of the topic camera_info beside.
///
/// With a frame every message is transformed at its own stamp, by /tf and /tf_static. Where the
/// stamps are over 0.4 s (ours) off the clock of the transforms and the sensor moved meanwhile, or
/// the frame moved in the root of its tree during a span, a warning says so. Several
/// messages of a sensor that stood still are averaged pixel by pixel if they are organised, of one
/// size, and their rays coincide, as average_depth_images() does along the rays; else their finite
/// points are joined. Without transforms a sensor is taken to have stood still. Points at exactly
/// (0, 0, 0) count as not seen, and so do depths outside 0.1 to 20 m. docs/formats.md#recordings
/// has all rules.
///
/// @throws Error (bad_file) also if there is no such topic or no message at that time, no transform
/// into the frame at the time of a message, no camera info, or if a clock jumped between the
/// messages; (bad_input) if a time is out of range, the span holds more than
/// most_recorded_points (ceilings.hpp) points or pixels, the frame is "/", a depth unit is given
/// for what has none, or the sensor moved and no frame is named
RecordedScan read_recorded_scan(const RecordingQuery& query);

/// Where the joints were: of every name on a topic of sensor_msgs/JointState the position [rad; m
/// of a sliding joint] nearest to a time [s] within 0.5 s (ours).
/// @param topic  from whose first message the time counts; empty: from the start of the recording
/// @throws Error (bad_file) also if none was recorded then; (bad_input) if the time is out of range
std::map<std::string, double> joint_positions(const std::string& path, double time,
                                              const std::string& topic = "");

}  // namespace excavplan
