// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/recordings.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"
#include "frame/option_names.hpp"
#include "inputs/unit_inputs.hpp"
#include "recording/recording_file.hpp"
#include "results/scan_results.hpp"

namespace excavplan::tools {
namespace {

/// "2 messages at 0.25 .. 1.15 s, joined, in frame map"
std::string line_of(const RecordedScan& scan) {
  std::string line =
      std::to_string(scan.messages) + (scan.messages == 1 ? " message" : " messages");
  line += " at " + decimals(scan.first, 3);
  if (scan.last > scan.first) line += " .. " + decimals(scan.last, 3);
  line += " s";
  if (scan.merge != ScanMerge::single) line += std::string(", ") + name(scan.merge);
  if (scan.frame_sd > 0.0) line += ", one frame to " + readable(1e3 * scan.frame_sd, 2) + " mm";
  return line + (scan.frame.empty() ? "" : ", in frame " + safe_text(scan.frame, longest_frame));
}

std::optional<RecordingQuery> query_of(const std::string& text) {
  std::optional<RecordingQuery> query = parse_recording_spec(text);
  if (!query && is_recording(text)) query = RecordingQuery{text, {}, {}, 0.0, {}, {}};
  return query;
}

}  // namespace

void declare_recorded(Arguments& arguments, RecordedOptions& options) {
  arguments.text("tf-frame", "NAME", options.tf_frame,
                 "frame of the transforms of a recording into which its scans are put");
  declare_depth_unit(
      arguments, options.depth_unit,
      "of a count in the depth images of a recording: 0.25mm, 0.125mm (default: 1mm)");
}

bool is_recorded(const std::string& text) { return query_of(text).has_value(); }

void require_recording(const RecordedOptions& options, bool is_there) {
  if (is_there) return;
  if (!options.tf_frame.empty()) {
    usage_error("--tf-frame needs scans of a recording, FILE:TOPIC@TIME+SPAN");
  }
  if (options.depth_unit) {
    usage_error("--depth-unit needs depth images of a recording; depth-to-cloud has one for PNG");
  }
}

std::optional<RecordedInput> recorded_input(const std::string& text,
                                            const RecordedOptions& options) {
  std::optional<RecordingQuery> query = query_of(text);
  if (!query) return std::nullopt;
  query->frame = options.tf_frame;
  query->depth_unit = options.depth_unit;
  RecordedInput input;
  input.path = query->path;
  const OptionNames names = {{"name the frame", "--tf-frame: name the frame"},
                             {"depth_unit", "--depth-unit"}};
  input.scan = naming_options(names, [&] { return read_recorded_scan(*query); });
  const RecordedScan& scan = input.scan;
  input.json = recorded_scan_json(text, scan);
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

const Scan& RecordedScans::scan(const std::string& text) {
  const auto known = scans_.find(text);
  if (known != scans_.end()) return known->second;
  auto input = recorded_input(text, options);
  Scan scan = scan_of_input(text, input);
  if (input) {
    scan.z_is_up = !options.tf_frame.empty();
    recordings_.push_back(std::move(input->json));
    lines_.push_back("recorded     " + input->line);
    doubts_.insert(doubts_.end(), scan.doubts.begin(), scan.doubts.end());
  }
  return scans_.emplace(text, std::move(scan)).first->second;
}

void RecordedScans::add_to(Outcome& outcome) const {
  if (recordings_.empty()) return;
  outcome.json["recordings"] = recordings_;
  outcome.lines.insert(outcome.lines.end(), lines_.begin(), lines_.end());
  add_new(doubts_, outcome.warnings);
}

MachinePosture recorded_posture(const RecordedInput& input) {
  auto joints = joint_positions(input.path, input.scan.first, input.scan.topic);
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

}  // namespace excavplan::tools
