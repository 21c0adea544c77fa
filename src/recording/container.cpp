// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/container.hpp"

#include <algorithm>

namespace excavplan {

std::string ros2_type(std::string_view type) {
  std::string out(type);
  const std::size_t slash = out.find('/');
  if (slash != out.npos && out.find('/', slash + 1) == out.npos) out.insert(slash, "/msg");
  return out;
}

std::int64_t time_span(const RecordedTopic& topic) {
  std::int64_t span = 0;
  return __builtin_sub_overflow(topic.last, topic.first, &span) ? latest : span;
}

void date_without_strays(const std::string& file, const std::vector<std::int64_t>& times,
                         const TimeRange& usual, RecordedTopic& topic, SkippedParts& skipped) {
  std::uint64_t strays = 0;
  std::int64_t first_stray = latest;
  topic.first = latest;
  topic.last = earliest;
  for (const std::int64_t time : times) {
    if (time >= usual.from && time <= usual.to) {
      topic.first = std::min(topic.first, time);
      topic.last = std::max(topic.last, time);
    } else {
      ++strays;
      first_stray = std::min(first_stray, time);
    }
  }
  topic.messages -= std::min(topic.messages, strays);
  if (strays == 0) return;
  skipped.add(file + ": topic " + topic.name + ": found " + std::to_string(strays) +
                  (strays == 1 ? " message" : " messages") +
                  " over a year from the others, the first at " + std::to_string(first_stray) +
                  " ns, expected them within a year",
              {{topic.first, topic.last}, {topic.name}});
}

}  // namespace excavplan
