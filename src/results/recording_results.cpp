// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/recording_results.hpp"

#include <cmath>

#include "base/json.hpp"

namespace excavplan {
namespace {

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

}  // namespace

const char* name(ScanMerge merge) {
  switch (merge) {
    case ScanMerge::single:
      return "single";
    case ScanMerge::averaged:
      return "averaged";
    case ScanMerge::joined:
      return "joined";
  }
  return "";
}

Json recorded_scan_json(const std::string& text, const RecordedScan& scan) {
  return {
      {"scan", text},
      {"messages", scan.messages},
      {"first_s", scan.first},
      {"last_s", scan.last},
      {"merge", name(scan.merge)},
      {"frame", scan.frame},
      {"recorded_frame", scan.recorded_frame},
      {"frame_sd_m", scan.merge == ScanMerge::averaged ? finite_or_null(scan.frame_sd) : Json()}};
}

Json recording_json(const std::string& file, const RecordingContents& contents) {
  auto topics = Json::array();
  for (const RecordingTopic& topic : contents.topics) {
    topics.push_back({{"name", topic.name},
                      {"type", topic.type},
                      {"messages", topic.messages},
                      {"first_s", finite_or_null(topic.first)},
                      {"last_s", finite_or_null(topic.last)},
                      {"frame", topic.frame},
                      {"is_scan", topic.is_scan}});
  }
  return {{"file", file},
          {"start_s", contents.start},
          {"duration_s", contents.duration},
          {"topics", std::move(topics)},
          {"frames", contents.frames},
          {"cut_off", contents.is_cut_off}};
}

}  // namespace excavplan
