// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/scans/scan_surface.hpp>

#include "frame/arguments.hpp"
#include "frame/tool.hpp"
#include "inputs/found_pose.hpp"
#include "inputs/recordings.hpp"

namespace excavplan::tools {

/// The machine, and how it stood in scans that it is in the view of.
struct MachineInView {
  std::string machine = "zx120";  ///< its name or file
  std::optional<MachinePosture> both;
  std::optional<MachinePosture> before;
  std::optional<MachinePosture> after;
  bool recorded = false;  ///< by the joint states of recordings

  bool any() const { return both || before || after || recorded; }
};

/// What brings scans into the site frame and what part of them counts.
struct ScanFrames {
  std::optional<std::string> both;    ///< frame of all scans, as frame_named() takes it
  std::optional<std::string> before;  ///< of those before
  std::optional<std::string> after;
  std::optional<Eigen::Matrix4d> before_pose = {};
  std::optional<Eigen::Matrix4d> after_pose = {};
  bool level = false;             ///< by the ground in the scan before
  std::optional<Rectangle> area;  ///< points outside are left out
  std::string unit = "m";         ///< of the coordinates in all clouds
  std::string before_unit;        ///< of those before, if another
  std::string after_unit;
  RecordedOptions recorded = {};
  std::optional<Eigen::Vector3d> sensor_origin = {};  ///< of all scans, in their frame and unit
  std::optional<Eigen::Vector3d> before_origin = {};  ///< of those before
  std::optional<Eigen::Vector3d> after_origin = {};
  std::vector<std::string> before_also = {};  ///< clouds of the same ground from other places
  std::vector<std::string> after_also = {};
  MachineInView view = {};  ///< boom, arm and bucket are left out of the scans
};

/// --frame, --before-frame, --after-frame, --before-pose, --after-pose, --tf-frame, --depth-unit,
/// --level, --sensor-origin, --before-origin, --after-origin.
void declare_frames(Arguments& arguments, ScanFrames& frames);
/// --before-also and --after-also.
void declare_further_clouds(Arguments& arguments, ScanFrames& frames);
/// --machine, --machine-pose, --before-machine-pose and --after-machine-pose.
void declare_machine_in_view(Arguments& arguments, MachineInView& view);
/// --unit, --before-unit and --after-unit.
void declare_units(Arguments& arguments, ScanFrames& frames);

/// What was done to bring scans in.
struct ScanReport {
  std::optional<FoundPose> level;  ///< of the last pair, if it was levelled
  nlohmann::ordered_json recordings = nlohmann::ordered_json::array();
  bool in_counts = false;  ///< depths of a recording, taken for millimetres as no unit is given
  std::vector<std::string> lines;  ///< of both, for people
  std::optional<double> seen_at;   ///< RecordedScan::seen_at of the last scan

  /// Into a tool's result, as `pose` and `recordings`.
  void add_to(Outcome& outcome) const;
};

/// @throws Error (bad_file) if a file or recording cannot be read; (bad_input) if options exclude
/// each other, or as level_on_ground() and machine_named()
ScanPair placed_pair(const std::string& before, const std::string& after, const ScanFrames& frames,
                     ScanReport& report);

/// The same of a scan after a dig alone, whose ground before is known.
/// @throws Error also if it is to be levelled by a scan before
Scan placed_scan(const std::string& after, const ScanFrames& frames, ScanReport& report);

/// When a scan was made, since 1970-01-01 UTC [s]: as told, else as recorded, else now.
double time_of(const std::optional<double>& told, const ScanReport& report);

/// Runs `work`, and adds to an error about the frame of a scan the options that correct it.
template <typename Work>
auto with_frame_hint(const std::string& hint, const Work& work) {
  try {
    return work();
  } catch (const FrameError& error) {
    throw Error(error.kind(), error.what() + ("; " + hint));
  }
}

inline constexpr const char* pair_frame_hint =
    "--before-frame and --after-frame transform them into one frame";

}  // namespace excavplan::tools
