// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "recording/skipped_parts.hpp"

/// @file One file of a recording. Private to the library.

namespace excavplan {

/// How the fields of a message are laid out.
enum class Serialization { cdr, ros1 };

/// What a recording holds under one name.
struct RecordedTopic {
  std::string name;            ///< "/livox/lidar"
  std::string type;            ///< as ROS 2 spells it: "sensor_msgs/msg/PointCloud2"
  std::uint64_t messages = 0;  ///< 0: the recording has the topic, but no message of it
  std::int64_t first = 0;      ///< when its first message was recorded [ns since 1970]
  std::int64_t last = 0;       ///< when its last message was recorded [ns since 1970]
};

/// A message as it lies in its file.
struct StoredMessage {
  std::size_t topic = 0;  ///< of Container::topics
  Serialization serialization = Serialization::cdr;
  std::string_view bytes;  ///< good until the next call of the cursor
};

/// Goes through messages in the order of their times.
class MessageCursor {
 public:
  virtual ~MessageCursor() = default;
  virtual bool next() = 0;  ///< to the next message, at first to the first; false at the end
  virtual std::int64_t time() const = 0;  ///< of the message [ns since 1970]
  /// @throws Error (bad_file) if it is damaged; the next ones may not be
  virtual StoredMessage read() = 0;
};

/// One file. What is damaged in it is noted and left out, or an Error (bad_file) that its functions
/// and cursors throw where nothing else is left.
class Container {
 public:
  explicit Container(SkippedParts& skipped) : skipped_(skipped) {}
  virtual ~Container() = default;
  /// A topic's name once only, in any order.
  const std::vector<RecordedTopic>& topics() const { return topics_; }
  /// True if its end is missing, as that of a recorder that was killed.
  virtual bool is_cut_off() const { return false; }
  virtual void check() {}  ///< notes all chunks that are damaged
  /// The messages of these topics recorded at `from` to `to`, both included. Good as long as the
  /// container.
  virtual std::unique_ptr<MessageCursor> messages(const std::vector<std::size_t>& topics,
                                                  std::int64_t from, std::int64_t to) = 0;

 protected:
  SkippedParts& skipped_;
  std::vector<RecordedTopic> topics_;
};

/// Each outlived by `skipped`, where it notes what it leaves out.
std::unique_ptr<Container> open_sqlite_recording(const std::string& path, SkippedParts& skipped);
std::unique_ptr<Container> open_mcap_recording(const std::string& path, SkippedParts& skipped);
std::unique_ptr<Container> open_bag_recording(const std::string& path, SkippedParts& skipped);

/// From its first message to its last [ns].
std::int64_t time_span(const RecordedTopic& topic);
/// Sets when a topic begins and ends, and the number of its messages, by those in `usual`; notes
/// the others. @param times  of its messages
void date_without_strays(const std::string& file, const std::vector<std::int64_t>& times,
                         const TimeRange& usual, RecordedTopic& topic, SkippedParts& skipped);

/// How the file of each kind begins.
constexpr std::string_view sqlite_magic("SQLite format 3\0", 16);
constexpr std::string_view mcap_magic = "\x89MCAP";
constexpr std::string_view bag_magic = "#ROSBAG V";

/// "sensor_msgs/PointCloud2" of ROS 1 as ROS 2 spells it, "sensor_msgs/msg/PointCloud2".
std::string ros2_type(std::string_view type);

}  // namespace excavplan
