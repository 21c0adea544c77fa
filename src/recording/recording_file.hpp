// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "recording/container.hpp"

/// @file Messages of a recording in whatever container they lie: rosbag2 (SQLite or MCAP) and ROS 1
/// bags. Private to the library.

namespace excavplan {

/// A message as it was recorded.
struct RecordedMessage {
  const RecordedTopic& topic;
  std::int64_t time = 0;  ///< when it was recorded [ns since 1970]
  Serialization serialization = Serialization::cdr;
  std::string_view bytes;  ///< uncompressed; good until the visitor returns
  std::string place;       ///< for messages: "message 17 of /tf at 12.5 s"
};

/// Of this message alone.
inline Loss loss_of(const RecordedMessage& message) {
  return {{message.time, message.time}, {message.topic.name}};
}

/// Goes on to the next message if it returns true.
using MessageVisitor = std::function<bool(const RecordedMessage& message)>;

/// A recording that is open. Reads what is asked for alone, by the index of the container.
class RecordingFile {
 public:
  virtual ~RecordingFile() = default;

  virtual const std::string& path() const = 0;
  virtual const std::vector<RecordedTopic>& topics() const = 0;  ///< sorted by name
  virtual std::int64_t start() const = 0;  ///< of the first message of all topics of one time
  virtual bool is_cut_off() const { return false; }  ///< the end of a file of it is missing
  /// What was found to be damaged so far, to which readers of messages add; nothing else is lost.
  SkippedParts& skipped() { return skipped_; }
  /// The messages of some topics recorded at `from` to `to`, both included, in the order of their
  /// times. @throws Unsupported naming file, place, what was found and what was expected
  virtual void visit(const std::vector<std::string>& topics, std::int64_t from, std::int64_t to,
                     const MessageVisitor& visitor) = 0;
  virtual void check() {}  ///< finds all chunks that are damaged

 private:
  SkippedParts skipped_;
};

/// True if the path is that of a recording, by its content: a rosbag2 folder (with metadata.yaml),
/// a .db3 file, an MCAP file or a ROS 1 bag. Never throws.
bool is_recording(const std::string& path);

/// Opens one. A rosbag2 folder may hold several files, which count as one recording.
/// @throws Error (bad_file) if it is none, holds no message that can be read, or needs a library
/// that this build is without
std::unique_ptr<RecordingFile> open_recording(const std::string& path);

}  // namespace excavplan
