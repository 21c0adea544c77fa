// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/recording_files.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace excavplan::test {

std::string recording(const std::string& name) { return EXCAVPLAN_RECORDINGS "/" + name; }

std::string missing_for([[maybe_unused]] const std::string& name) {
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

std::vector<KeptMessage> messages_of(RecordingFile& file, const std::vector<std::string>& topics,
                                     std::int64_t from, std::int64_t to) {
  std::vector<KeptMessage> kept;
  file.visit(topics, from, to, [&](const RecordedMessage& message) {
    kept.push_back({message.topic.name, message.time, message.serialization,
                    std::string(message.bytes), message.place});
    return true;
  });
  return kept;
}

std::vector<KeptMessage> all_messages(RecordingFile& file) {
  std::vector<std::string> topics;
  for (const RecordedTopic& topic : file.topics()) topics.push_back(topic.name);
  return messages_of(file, topics);
}

}  // namespace excavplan::test
