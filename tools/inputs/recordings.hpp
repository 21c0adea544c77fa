// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <excavplan/recording/recording.hpp>
#include <excavplan/scans/machine_front.hpp>
#include <excavplan/scans/scan_surface.hpp>

namespace excavplan::tools {

inline constexpr const char* recording_form =
    "of a recording (rosbag2, MCAP, ROS 1 bag) FILE:TOPIC@TIME+SPAN";

inline constexpr std::size_t longest_frame = 100;  ///< of its name in a line [byte]

/// A scan out of a recording, with what was read for people and programs.
struct RecordedInput {
  std::string path;  ///< of the recording
  RecordedScan scan;
  nlohmann::ordered_json json;
  std::string line;
};

/// Reads what `text` names if it is FILE:TOPIC@TIME+SPAN, or a recording of one topic of scans; of
/// a plain cloud file nothing. @throws Error as parse_recording_spec() and read_recorded_scan()
std::optional<RecordedInput> recorded_input(const std::string& text, const std::string& tf_frame);

/// The scan that `text` names: that of the recording, or of a file, which is left where it is.
Scan scan_of_input(const std::string& text, std::optional<RecordedInput>& recorded);

/// How the machine stood when a scan was recorded: of /joint_states the joints whose names hold
/// swing, boom, arm or stick, and bucket. @throws Error (bad_file) if one of them is not there
MachinePosture recorded_posture(const RecordedInput& input);

}  // namespace excavplan::tools
