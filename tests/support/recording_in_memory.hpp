// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "recording/recording_file.hpp"
#include "support/ros_bytes.hpp"

namespace excavplan::test {

/// A recording named "run" whose messages lie in memory; times are in ns from 1000 s on.
class RecordingInMemory : public RecordingFile {
 public:
  static constexpr std::int64_t epoch = 1000000000000;

  void add(const std::string& topic, const std::string& type, std::int64_t time, std::string bytes,
           Serialization serialization = Serialization::cdr) {
    add_at(epoch + time, topic, type, std::move(bytes), serialization);
  }
  /// At a time since 1970 [ns].
  void add_at(std::int64_t time, const std::string& topic, const std::string& type,
              std::string bytes, Serialization serialization = Serialization::cdr) {
    messages_.push_back({topic, time, std::move(bytes), serialization});
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const Stored& a, const Stored& b) { return a.time < b.time; });
    if (find(topic) == nullptr) topics_.push_back({topic, type, 0, time, time});
    std::sort(topics_.begin(), topics_.end(),
              [](const RecordedTopic& a, const RecordedTopic& b) { return a.name < b.name; });
    RecordedTopic& entry = *find(topic);
    ++entry.messages;
    entry.first = std::min(entry.first, time);
    entry.last = std::max(entry.last, time);
  }

  const std::string& path() const override { return path_; }
  const std::vector<RecordedTopic>& topics() const override { return topics_; }
  std::int64_t start() const override { return messages_.empty() ? 0 : messages_.front().time; }
  void visit(const std::vector<std::string>& topics, std::int64_t from, std::int64_t to,
             const MessageVisitor& visitor) override {
    for (std::size_t i = 0; i < messages_.size(); ++i) {
      const Stored& stored = messages_[i];
      const bool is_asked = std::find(topics.begin(), topics.end(), stored.topic) != topics.end();
      if (!is_asked || stored.time < from || stored.time > to) continue;
      // a copy of its own, so that a sanitizer sees a read beyond its end
      const std::vector<char> bytes(stored.bytes.begin(), stored.bytes.end());
      ++visited;
      if (!visitor({*find(stored.topic),
                    stored.time,
                    stored.serialization,
                    {bytes.data(), bytes.size()},
                    "message " + std::to_string(i) + " of " + stored.topic})) {
        return;
      }
    }
  }

  std::size_t visited = 0;  ///< messages that were handed on so far

 private:
  struct Stored {
    std::string topic;
    std::int64_t time = 0;
    std::string bytes;
    Serialization serialization = Serialization::cdr;
  };
  RecordedTopic* find(const std::string& name) {
    for (RecordedTopic& topic : topics_) {
      if (topic.name == name) return &topic;
    }
    return nullptr;
  }

  std::string path_ = "run";
  std::vector<RecordedTopic> topics_;
  std::vector<Stored> messages_;
};

inline constexpr std::int64_t ms = 1000000;  // [ns]
inline constexpr std::int64_t epoch = RecordingInMemory::epoch;
inline const std::string cloud_type = "sensor_msgs/msg/PointCloud2";
inline const std::string tf_type = "tf2_msgs/msg/TFMessage";

/// Stamped at `time`, recorded `late` after it [ns].
inline void add_transform(RecordingInMemory& recording, std::int64_t time,
                          TransformNumbers transform, const std::string& topic = "/tf",
                          std::int64_t late = 0) {
  transform.stamp = epoch + time;
  recording.add(topic, tf_type, time + late, transform_bytes({transform}));
}

}  // namespace excavplan::test
