// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inspect_cloud/recording_listing.hpp"

#include <algorithm>

#include <excavplan/recording/recording.hpp>

#include "base/text.hpp"
#include "inputs/recordings.hpp"
#include "recording/recording_file.hpp"
#include "results/scan_results.hpp"

namespace excavplan::tools {
namespace {

/// "* /points  sensor_msgs/PointCloud2, 12 at 0.000 .. 1.100 s, from 0.250 s on, frame 'lidar'"
std::string topic_line(const RecordingTopic& topic) {
  std::string line = std::string(topic.is_scan ? "* " : "  ") + topic.name + "  " + topic.type +
                     ", " + std::to_string(topic.messages);
  if (topic.messages > 0) {
    line += " at 0.000 .. " + decimals(topic.last - topic.first, 3) + " s";
    if (topic.first != 0.0) line += ", from " + decimals(topic.first, 3) + " s on";
  }
  return line + (topic.frame.empty() ? "" : ", frame " + in_quotes(topic.frame));
}

}  // namespace

std::optional<RecordingListing> recording_listing(const std::string& text) {
  if (!is_recording(text)) return std::nullopt;
  const RecordingContents contents = describe_recording(text);
  RecordingListing listing;
  listing.lines = {text + ": " + readable(contents.duration, 4) + " s"};
  for (const RecordingTopic& topic : contents.topics) {
    listing.lines.push_back(topic_line(topic));
  }
  if (contents.is_cut_off) listing.lines.emplace_back("its end is missing");
  if (contents.damaged_parts > 0) {
    listing.lines.push_back("damaged and left out: " + std::to_string(contents.damaged_parts));
    constexpr std::size_t most = 20;  // ours
    const std::size_t count = std::min(most, contents.damage.size());
    for (std::size_t i = 0; i < count; ++i) listing.lines.push_back("  " + contents.damage[i]);
    if (contents.damage.size() > most) listing.lines.emplace_back("  ...");
  }
  const auto is_scan = [](const RecordingTopic& topic) { return topic.is_scan; };
  const bool has_scans = std::any_of(contents.topics.begin(), contents.topics.end(), is_scan);
  listing.lines.push_back(has_scans ? "* scans: name one as " + text +
                                          ":TOPIC@TIME+SPAN, TIME from the first of the topic"
                                    : "no topic holds scans");
  if (!contents.frames.empty()) {
    std::string frames;
    for (const std::string& frame : contents.frames) {
      frames += (frames.empty() ? "" : ", ") + safe_text(frame, longest_frame);
    }
    listing.lines.push_back("frames for --tf-frame: " + frames);
  }
  listing.json = recording_json(text, contents);
  return listing;
}

}  // namespace excavplan::tools
