// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/scans.hpp"

#include <map>
#include <memory>
#include <vector>

#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

/// Length of a unit [m].
const std::map<std::string, double>& units() {
  static const std::map<std::string, double> lengths = {
      {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"ft", 0.3048}, {"in", 0.0254}};
  return lengths;
}

Scan scan_of(const std::string& file, const std::string& unit, const ScanFrames& frames) {
  Scan scan;
  scan.files = {file};
  scan.area = frames.area;
  scan.unit = units().at(unit.empty() ? frames.unit : unit);
  scan.sensor_origin = frames.sensor_origin;
  return scan;
}

/// Brings a scan into the site frame if an option says how; `which` is "before" or "after".
void place(const std::string& which, const std::optional<std::string>& own,
           const std::optional<Eigen::Matrix4d>& pose, const ScanFrames& frames, Scan& scan) {
  const std::string frame = "--" + which + "-frame";
  if (own && pose) usage_error("give either " + frame + " or --" + which + "-pose");
  if ((own || pose) && (frames.both || frames.level)) {
    usage_error(std::string(frames.both ? "--frame" : "--level") + " excludes " +
                (own ? frame : "--" + which + "-pose"));
  }
  scan.z_is_up = own || pose || frames.both;
  if (pose) scan.site_from_scan = *pose;
  if (own) scan.site_from_scan = frame_named(frame, *own);
  if (frames.both) scan.site_from_scan = frame_named("--frame", *frames.both);
}

/// Leaves the points of the machine's front out.
void cut_out(const MachineInView& view, ScanPair& scans) {
  if (view.both && (view.before || view.after)) {
    usage_error("--machine-pose excludes --before-machine-pose and --after-machine-pose");
  }
  const Machine machine = machine_named(view.machine);
  const auto cut = [&](const std::optional<MachinePosture>& own, Scan& scan) {
    const std::optional<MachinePosture>& posture = own ? own : view.both;
    if (posture) scan.machine = std::make_shared<const MachineFront>(machine, *posture);
  };
  cut(view.before, scans.before);
  cut(view.after, scans.after);
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
  arguments.option("sensor-origin", frames.sensor_origin,
                   "where the sensor stood, in the frame of the scans (default: VIEWPOINT of PCD)");
}

void declare_units(Arguments& arguments, ScanFrames& frames) {
  std::vector<std::string> words;
  for (const auto& [word, length] : units()) words.push_back(word);
  arguments.choice("unit", frames.unit, words, "unit of the coordinates in all clouds");
  arguments.choice("before-unit", frames.before_unit, words,
                   "of those before (default: as --unit)");
  arguments.choice("after-unit", frames.after_unit, words, "of those after (default: as --unit)");
}

void declare_machine_in_view(Arguments& arguments, MachineInView& view) {
  arguments.machine(view.machine);
  arguments.option("machine-pose", view.both,
                   "how --machine stood in both scans: leaves out the points of boom, arm and "
                   "bucket; needs scans in the site frame");
  arguments.option("before-machine-pose", view.before, "the same of the scan before");
  arguments.option("after-machine-pose", view.after, "the same of the scan after");
}

PlacedPair placed_pair(const std::string& before, const std::string& after,
                       const ScanFrames& frames) {
  if (frames.both && frames.level) usage_error("--level excludes --frame");
  if (frames.level && frames.view.any()) {
    usage_error("--level excludes --machine-pose: it does not find the swing axis");
  }
  PlacedPair pair = {
      {scan_of(before, frames.before_unit, frames), scan_of(after, frames.after_unit, frames)}, {}};
  place("before", frames.before, frames.before_pose, frames, pair.scans.before);
  place("after", frames.after, frames.after_pose, frames, pair.scans.after);
  if (frames.level) {
    Scan whole = pair.scans.before;
    whole.area.reset();  // is in the levelled frame
    pair.level = found_pose(level_on_ground(whole));
    pair.scans.before.site_from_scan = pair.scans.after.site_from_scan = pair.level->site_from_scan;
  }
  if (frames.view.any()) cut_out(frames.view, pair.scans);
  return pair;
}

}  // namespace excavplan::tools
