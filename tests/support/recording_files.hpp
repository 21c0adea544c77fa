// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recording/recording_file.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {

/// A recording of tests/recording/data.
inline std::string recording(const std::string& name) { return EXCAVPLAN_RECORDINGS "/" + name; }

/// What this build is without, "" if it has all that a file of the data needs.
inline std::string missing_for([[maybe_unused]] const std::string& name) {
  [[maybe_unused]] const auto needs = [&](const char* part) {
    return name.find(part) != std::string::npos;
  };
#ifndef EXCAVPLAN_WITH_SQLITE3
  if (needs("db3") || needs("split")) return "libsqlite3-dev";
#endif
#ifndef EXCAVPLAN_WITH_LZ4
  if (needs("lz4")) return "liblz4-dev";
#endif
#ifndef EXCAVPLAN_WITH_ZSTD
  if (needs("zstd") || needs("ros1") || needs("no_summary")) return "libzstd-dev";
#endif
#ifndef EXCAVPLAN_WITH_BZ2
  if (needs("bz2")) return "libbz2-dev";
#endif
  return "";
}

/// A folder that is gone when the test ends.
class TempFolder {
 public:
  TempFolder() : path_(testing::TempDir() + "excavplan_recordings_" + std::to_string(::getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::string& path() const { return path_; }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ + "/" + name, std::ios::binary) << content;
    return path_ + "/" + name;
  }

 private:
  std::string path_;
};

/// A message, copied.
struct KeptMessage {
  std::string topic;
  std::int64_t time;
  Serialization serialization;
  std::string bytes;
  std::string place;
};

constexpr std::int64_t ever = std::numeric_limits<std::int64_t>::max();

inline std::vector<KeptMessage> messages_of(RecordingFile& file,
                                            const std::vector<std::string>& topics,
                                            std::int64_t from = 0, std::int64_t to = ever) {
  std::vector<KeptMessage> kept;
  file.visit(topics, from, to, [&](const RecordedMessage& message) {
    kept.push_back({message.topic.name, message.time, message.serialization,
                    std::string(message.bytes), message.place});
    return true;
  });
  return kept;
}

inline std::vector<KeptMessage> all_messages(RecordingFile& file) {
  std::vector<std::string> topics;
  for (const RecordedTopic& topic : file.topics()) topics.push_back(topic.name);
  return messages_of(file, topics);
}

}  // namespace excavplan::test
