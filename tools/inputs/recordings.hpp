// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/recording/recording.hpp>
#include <excavplan/scans/machine_front.hpp>
#include <excavplan/scans/scan_surface.hpp>

#include "frame/arguments.hpp"
#include "frame/tool.hpp"

namespace excavplan::tools {

inline constexpr const char* recording_form =
    "of a recording (rosbag2, MCAP, ROS 1 bag) FILE:TOPIC@TIME+SPAN";

inline constexpr std::size_t longest_frame = 100;  ///< of its name in a line [byte]

/// How scans of recordings are read.
struct RecordedOptions {
  std::string tf_frame;              ///< of the transforms, into which they are put; empty: none
  std::optional<double> depth_unit;  ///< of depths in counts [m]
};
/// --tf-frame and --depth-unit.
void declare_recorded(Arguments& arguments, RecordedOptions& options);

/// A scan out of a recording, with what was read for people and programs.
struct RecordedInput {
  std::string path;  ///< of the recording
  RecordedScan scan;
  nlohmann::ordered_json json;
  std::string line;
};

/// Reads what `text` names if it is FILE:TOPIC@TIME+SPAN, or a recording of one topic of scans; of
/// a plain cloud file nothing. @throws Error as parse_recording_spec() and read_recorded_scan()
std::optional<RecordedInput> recorded_input(const std::string& text,
                                            const RecordedOptions& options);

/// Whether recorded_input() would read it.
bool is_recorded(const std::string& text);
/// @throws Error (bad_input) if options of recordings are given where none is read
void require_recording(const RecordedOptions& options, bool is_there);

/// The scan that `text` names: that of the recording, or of a file, which is left where it is.
Scan scan_of_input(const std::string& text, std::optional<RecordedInput>& recorded);

/// Scans that the options of a run name, those of recordings each read once.
class RecordedScans {
 public:
  RecordedOptions options;

  /// @throws Error as recorded_input()
  const Scan& scan(const std::string& text);
  /// What was read of recordings, as `recordings` and in lines, with the doubts that are not told
  /// yet; nothing if none was.
  void add_to(Outcome& outcome) const;

 private:
  std::map<std::string, Scan> scans_;
  std::vector<std::string> lines_;
  std::vector<Warning> doubts_;
  nlohmann::ordered_json recordings_ = nlohmann::ordered_json::array();
};

/// How the machine stood when a scan was recorded: of /joint_states the joints whose names hold
/// swing, boom, arm or stick, and bucket. @throws Error (bad_file) if one of them is not there
MachinePosture recorded_posture(const RecordedInput& input);

}  // namespace excavplan::tools
