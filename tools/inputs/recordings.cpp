// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/recordings.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"
#include "recording/recording_file.hpp"
#include "frame/arguments.hpp"
#include "frame/tool.hpp"

namespace excavplan::tools {
namespace {

constexpr std::size_t longest_name = 100;  // of a frame in a line [byte]

const char* name_of(ScanMerge merge) {
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

/// "2 messages at 0.25 .. 1.15 s, joined, in frame map"
std::string line_of(const RecordedScan& scan) {
  std::string line =
      std::to_string(scan.messages) + (scan.messages == 1 ? " message" : " messages");
  line += " at " + decimals(scan.first, 3);
  if (scan.last > scan.first) line += " .. " + decimals(scan.last, 3);
  line += " s";
  if (scan.merge != ScanMerge::single) line += std::string(", ") + name_of(scan.merge);
  if (scan.frame_sd > 0.0) line += ", one frame to " + readable(1e3 * scan.frame_sd, 2) + " mm";
  return line + (scan.frame.empty() ? "" : ", in frame " + safe_text(scan.frame, longest_name));
}

nlohmann::ordered_json time_of(double seconds) {
  return std::isfinite(seconds) ? nlohmann::ordered_json(seconds) : nlohmann::ordered_json();
}

}  // namespace

std::optional<RecordedInput> recorded_input(const std::string& text, const std::string& tf_frame) {
  std::optional<RecordingQuery> query = parse_recording_spec(text);
  if (!query && is_recording(text)) query = RecordingQuery{text, {}, {}, 0.0, {}};
  if (!query) return std::nullopt;
  query->frame = tf_frame;
  RecordedInput input;
  input.path = query->path;
  const OptionNames names = {{"name the frame", "--tf-frame: name the frame"}};
  input.scan = naming_options(names, [&] { return read_recorded_scan(*query); });
  const RecordedScan& scan = input.scan;
  input.json = {{"scan", text},
                {"messages", scan.messages},
                {"first_s", scan.first},
                {"last_s", scan.last},
                {"merge", name_of(scan.merge)},
                {"frame", scan.frame},
                {"recorded_frame", scan.recorded_frame},
                {"frame_sd_m", scan.merge == ScanMerge::averaged ? time_of(scan.frame_sd)
                                                                 : nlohmann::ordered_json()}};
  input.line = text + ": " + line_of(scan);
  return input;
}

Scan scan_of_input(const std::string& text, std::optional<RecordedInput>& recorded) {
  Scan scan;
  if (recorded) {
    scan.name = text;
    scan.clouds = {std::make_shared<const Cloud>(std::move(recorded->scan.cloud))};
    scan.doubts = recorded->scan.warnings;
  } else {
    scan.files = {text};
  }
  return scan;
}

MachinePosture recorded_posture(const RecordedInput& input) {
  auto joints = joint_positions(input.path, input.scan.first);
  std::string names;
  for (const auto& [name, position] : joints) names += (names.empty() ? "" : ", ") + name;
  // "arm" last: names such as front_arm_boom hold it too.
  const auto angle = [&](const std::vector<std::string>& words) {
    const auto holds = [&](const auto& joint) {
      const std::string name = small_letters(joint.first);
      return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
        return name.find(word) != std::string::npos;
      });
    };
    const auto found = std::find_if(joints.begin(), joints.end(), holds);
    if (std::count_if(joints.begin(), joints.end(), holds) != 1) {
      throw Error(ErrorKind::bad_file, input.path + ": joint states: found " + names +
                                           ", expected one joint whose name holds " +
                                           words.front());
    }
    const double position = found->second;
    joints.erase(found);
    return position;
  };
  MachinePosture posture;
  posture.swing = angle({"swing"});
  posture.joints(0) = angle({"boom"});
  posture.joints(2) = angle({"bucket"});
  posture.joints(1) = angle({"stick", "arm"});
  return posture;
}

std::optional<RecordingListing> recording_listing(const std::string& text) {
  if (!is_recording(text)) return std::nullopt;
  const RecordingContents contents = describe_recording(text);
  RecordingListing listing;
  auto topics = nlohmann::ordered_json::array();
  listing.lines = {text + ": " + readable(contents.duration, 4) + " s"};
  for (const RecordingTopic& topic : contents.topics) {
    topics.push_back({{"name", topic.name},
                      {"type", topic.type},
                      {"messages", topic.messages},
                      {"first_s", time_of(topic.first)},
                      {"last_s", time_of(topic.last)},
                      {"frame", topic.frame},
                      {"is_scan", topic.is_scan}});
    std::string line = std::string(topic.is_scan ? "* " : "  ") + topic.name + "  " + topic.type +
                       ", " + std::to_string(topic.messages);
    if (topic.messages > 0) {
      line += " at " + decimals(topic.first, 3) + " .. " + decimals(topic.last, 3) + " s";
    }
    listing.lines.push_back(line +
                            (topic.frame.empty() ? "" : ", frame " + in_quotes(topic.frame)));
  }
  if (contents.is_cut_off) listing.lines.push_back("its end is missing");
  const auto is_scan = [](const RecordingTopic& topic) { return topic.is_scan; };
  const bool has_scans = std::any_of(contents.topics.begin(), contents.topics.end(), is_scan);
  listing.lines.push_back(has_scans ? "* scans: name one as " + text + ":TOPIC@TIME+SPAN"
                                    : "no topic holds scans");
  if (!contents.frames.empty()) {
    std::string frames;
    for (const std::string& frame : contents.frames) {
      frames += (frames.empty() ? "" : ", ") + safe_text(frame, longest_name);
    }
    listing.lines.push_back("frames for --tf-frame: " + frames);
  }
  listing.json = {{"file", text},
                  {"start_s", contents.start},
                  {"duration_s", contents.duration},
                  {"topics", std::move(topics)},
                  {"frames", contents.frames},
                  {"cut_off", contents.is_cut_off}};
  return listing;
}

}  // namespace excavplan::tools
