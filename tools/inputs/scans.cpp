// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/scans.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "frame/tool.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/recordings.hpp"
#include "inputs/unit_inputs.hpp"

namespace excavplan::tools {
namespace {

/// One side of a pair, as its options say.
struct Side {
  const char* name;  ///< "before" or "after"
  const std::string& text;
  const std::vector<std::string>& also;
  const std::string& unit;
  const std::optional<std::string>& frame;
  const std::optional<Eigen::Matrix4d>& pose;
  const std::optional<Eigen::Vector3d>& origin;
  const std::optional<MachinePosture>& posture;
};

/// Angles in degrees, or of another zero, are mostly out of the machine's range.
void require_within(const Machine& machine, const MachinePosture& posture) {
  constexpr double play = 0.1;  // ours [rad]
  constexpr std::array<const char*, 3> names = {"boom", "arm", "bucket"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double angle = posture.joints(static_cast<Eigen::Index>(i));
    const JointLimits& limits = machine.limits[i];
    if (angle > limits.lower - play && angle < limits.upper + play) continue;
    usage_error("the " + std::string(names[i]) + " of the machine in the scan stands at " +
                number_text(angle) + " rad, outside its range of " + number_text(limits.lower) +
                " .. " + number_text(limits.upper));
  }
}

/// Clouds from other places, each of which tells its own.
void add_further(const Side& side, const ScanFrames& frames, Scan& scan) {
  const std::string option = "--" + std::string(side.name) + "-also";
  if (!side.also.empty() && (side.origin || frames.sensor_origin)) {
    usage_error(option + " excludes --sensor-origin and --" + side.name +
                "-origin: each cloud was seen from a place of its own, which its VIEWPOINT tells");
  }
  for (const std::string& file : side.also) {
    if (file == side.text || std::count(side.also.begin(), side.also.end(), file) > 1) {
      usage_error(option + ": " + file + " is given twice: its points would count twice");
    }
    scan.files.push_back(file);
  }
}

/// Reads the scan if it is of a recording; a file is left where it is.
Scan scan_of(const Side& side, const ScanFrames& frames, ScanReport& report) {
  std::optional<MachinePosture> posture = side.posture ? side.posture : frames.view.both;
  auto input = recorded_input(side.text, frames.recorded);
  Scan scan = scan_of_input(side.text, input);
  report.seen_at.reset();
  if (input) {
    report.seen_at = input->scan.seen_at;
    if (frames.view.recorded) posture = recorded_posture(*input);
    report.in_counts = report.in_counts || (input->scan.is_counted && !frames.recorded.depth_unit);
    report.recordings.push_back(std::move(input->json));
    report.lines.push_back("recorded   " + input->line);
  }
  add_further(side, frames, scan);
  scan.area = frames.area;
  scan.unit = unit_length(side.unit.empty() ? frames.unit : side.unit);
  scan.sensor_origin = side.origin ? side.origin : frames.sensor_origin;
  if (posture) {
    const Machine machine = machine_named(frames.view.machine);
    require_within(machine, *posture);
    scan.machine = std::make_shared<const MachineFront>(machine, *posture);
  }
  return scan;
}

/// Brings a scan into the site frame if an option says how.
void place(const Side& side, const ScanFrames& frames, Scan& scan) {
  const std::string option = "--" + std::string(side.name);
  scan.z_is_up = side.frame || side.pose || frames.both || !frames.recorded.tf_frame.empty();
  if (side.pose) scan.site_from_scan = *side.pose;
  if (side.frame) scan.site_from_scan = frame_named(option + "-frame", *side.frame);
  if (frames.both) scan.site_from_scan = frame_named("--frame", *frames.both);
}

void check(const ScanFrames& frames) {
  if (frames.level && frames.view.any()) {
    usage_error("--level excludes --machine-pose: it does not find the swing axis");
  }
  if (frames.view.recorded && frames.recorded.tf_frame.empty()) {
    usage_error("--machine-recorded needs --tf-frame, with the swing axis as origin");
  }
}

Side side_after(const std::string& text, const ScanFrames& frames) {
  return {"after",
          text,
          frames.after_also,
          frames.after_unit,
          frames.after,
          frames.after_pose,
          frames.after_origin,
          frames.view.after};
}

Scan placed(const Side& side, const ScanFrames& frames, ScanReport& report) {
  Scan scan = scan_of(side, frames, report);
  place(side, frames, scan);
  return scan;
}

}  // namespace

void declare_frames(Arguments& arguments, ScanFrames& frames) {
  arguments.text("frame", "FRAME", frames.both,
                 std::string("transforms all clouds into the site frame: ") + frame_forms);
  arguments.text("before-frame", "FRAME", frames.before, "the same for the clouds before");
  arguments.text("after-frame", "FRAME", frames.after, "the same for the clouds after");
  arguments.option("before-pose", frames.before_pose,
                   "pose of the sensor before in the site frame: translation and quaternion [m,-]");
  arguments.option("after-pose", frames.after_pose, "the same after [m,-]");
  arguments.flag("level", frames.level,
                 "level both clouds by the ground plane in the one before: origin on the ground "
                 "below the sensor, z up, x forward");
  arguments.exclude("level", {"frame"});
  for (const char* both : {"frame", "level"}) {
    arguments.exclude(both, {"before-frame", "after-frame", "before-pose", "after-pose"});
  }
  arguments.exclude("before-frame", {"before-pose"});
  arguments.exclude("after-frame", {"after-pose"});
  declare_recorded(arguments, frames.recorded);
  arguments.option("sensor-origin", frames.sensor_origin,
                   "where the sensor stood, in the frame of the scans (default: VIEWPOINT of PCD, "
                   "or what a recording tells)");
  arguments.option("before-origin", frames.before_origin, "the same of the clouds before alone");
  arguments.option("after-origin", frames.after_origin, "the same of the clouds after alone");
}

void declare_units(Arguments& arguments, ScanFrames& frames) {
  declare_unit(arguments, "unit", frames.unit, "unit of the coordinates in all clouds");
  declare_unit(arguments, "before-unit", frames.before_unit,
               "of those before (default: as --unit)");
  declare_unit(arguments, "after-unit", frames.after_unit, "of those after (default: as --unit)");
}

void declare_further_clouds(Arguments& arguments, ScanFrames& frames) {
  arguments.texts("before-also", "FILE", frames.before_also,
                  "cloud of the same ground from another place, in the frame of BEFORE; may be "
                  "given several times");
  arguments.texts("after-also", "FILE", frames.after_also, "the same of AFTER");
}

void declare_machine_in_view(Arguments& arguments, MachineInView& view) {
  arguments.machine(view.machine);
  arguments.option("machine-pose", view.both,
                   "how --machine stood in both scans: leaves out the points of boom, arm and "
                   "bucket; needs scans in the site frame");
  arguments.option("before-machine-pose", view.before, "the same of the scan before");
  arguments.option("after-machine-pose", view.after, "the same of the scan after");
  arguments.flag("machine-recorded", view.recorded,
                 "the same by the joint states in the recordings; needs --tf-frame");
  arguments.exclude("machine-pose", {"before-machine-pose", "after-machine-pose"});
  arguments.exclude("machine-recorded",
                    {"machine-pose", "before-machine-pose", "after-machine-pose"});
}

ScanPair placed_pair(const std::string& before, const std::string& after, const ScanFrames& frames,
                     ScanReport& report) {
  check(frames);
  Scan first = placed({"before", before, frames.before_also, frames.before_unit, frames.before,
                       frames.before_pose, frames.before_origin, frames.view.before},
                      frames, report);
  ScanPair pair = {std::move(first), placed(side_after(after, frames), frames, report)};
  require_recording(frames.recorded, !report.recordings.empty());
  if (frames.level) {
    Scan whole = pair.before;
    whole.area.reset();  // is in the levelled frame
    report.level = found_pose(level_on_ground(whole));
    report.lines.push_back("levelled   " + report.level->line);
    pair.before.site_from_scan = pair.after.site_from_scan = report.level->site_from_scan;
  }
  return pair;
}

Scan placed_scan(const std::string& after, const ScanFrames& frames, ScanReport& report) {
  check(frames);
  if (frames.level) usage_error("--level needs BEFORE: it levels by the ground in that scan");
  if (!frames.before_also.empty()) usage_error("--before-also needs BEFORE");
  Scan scan = placed(side_after(after, frames), frames, report);
  require_recording(frames.recorded, !report.recordings.empty());
  return scan;
}

double time_of(const std::optional<double>& told, const ScanReport& report) {
  if (told) return *told;
  if (report.seen_at) return *report.seen_at;
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since_1970).count();
}

void ScanReport::add_to(Outcome& outcome) const {
  outcome.json["pose"] = level ? level->json : nlohmann::ordered_json();
  outcome.json["recordings"] = recordings;
  outcome.lines.insert(outcome.lines.end(), lines.begin(), lines.end());
}

}  // namespace excavplan::tools
