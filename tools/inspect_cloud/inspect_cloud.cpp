// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <vector>

#include <excavplan/scans/scan_surface.hpp>

#include "frame/tool.hpp"
#include "inputs/found_pose.hpp"
#include "inputs/recordings.hpp"
#include "inputs/unit_inputs.hpp"
#include "inspect_cloud/cloud_lines.hpp"
#include "inspect_cloud/polygon_input.hpp"
#include "inspect_cloud/recording_listing.hpp"
#include "results/scan_results.hpp"

namespace excavplan::tools {
namespace {

struct Inputs {
  std::string file;
  std::optional<std::string> frame;
  std::string unit = "m";
  RecordedOptions recorded;
  PoseInputs pose;
  std::optional<std::string> out;
  bool ascii = false;
  std::vector<Eigen::Vector2d> polygon;  ///< of --volume; empty: none
};

const About about = {
    "inspect-cloud",
    "Summarises a scan (PCD, PLY, LAS, GeoTIFF, ASCII grid, OBJ or XYZ text, detected from the "
    "content), and converts it to "
    "another format or frame. Lists what a recording holds (rosbag2, MCAP, ROS 1 bag).",
    {{"inspect-cloud scan.pcd", "points, extent, point density and a guess of the frame"},
     {"inspect-cloud run.db3", "topics, frames and times of a recording"},
     {"inspect-cloud run.db3:/points@12.5s+2s --tf-frame map --out scan.pcd",
      "the points of two seconds of a recording, in the frame map"},
     {"inspect-cloud scan.xyz --out scan.ply", "the summary, and the points as binary PLY"},
     {"inspect-cloud scan.pcd --frame scan_frame.txt --out site.pcd", "into the site frame"},
     {"inspect-cloud scan.pcd --volume 4,-1,7,-1,7,2,4,2", "of the pile or hole in this polygon"},
     {"inspect-cloud scan.pcd --level --pose-out pose.txt --out level.pcd",
      "z up by the ground plane"},
     {"inspect-cloud scan.pcd --points markers.csv --out site.pcd",
      "markers.csv has the columns scan_x_m,scan_y_m,scan_z_m,x_m,y_m,z_m"}}};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("FILE", inputs.file, std::string("scan to summarise, or ") + recording_form);
  declare_unit(arguments, "unit", inputs.unit, "unit of the coordinates in the cloud");
  arguments.text("frame", "FRAME", inputs.frame, "another name of --pose");
  declare_recorded(arguments, inputs.recorded);
  declare_pose(arguments, inputs.pose, "scan_x_m,scan_y_m,scan_z_m");
  arguments.exclude("frame", {"pose", "level", "points"});
  declare_volume(arguments, inputs.polygon);
  arguments.output("out", inputs.out, "write the cloud here: " + cloud_endings());
  arguments.flag("ascii", inputs.ascii, "write PCD and PLY as text, with full precision");
}

/// Options that hold for recordings alone.
void refuse_recorded(const RecordedOptions& options) {
  if (!options.tf_frame.empty()) usage_error("--tf-frame needs a recording");
  if (options.depth_unit) usage_error("--depth-unit needs a recording");
}

Outcome inspect(const Inputs& inputs) {
  if (!inputs.out && !inputs.pose.pose_out && inputs.polygon.empty()) {
    if (auto listing = recording_listing(inputs.file)) {
      if (!inputs.recorded.tf_frame.empty())
        usage_error("--tf-frame needs a topic: FILE:TOPIC@TIME+SPAN");
      Outcome outcome;
      outcome.json = std::move(listing->json);
      outcome.lines = std::move(listing->lines);
      return outcome;
    }
  }
  if (inputs.ascii && !inputs.out) {
    usage_error("--ascii needs --out");
  }
  PoseInputs placed = inputs.pose;
  if (inputs.frame) placed.pose = inputs.frame;
  check_pose(placed);
  CloudFormat format;
  if (inputs.out) format = cloud_format_of_name(*inputs.out);
  format.text = inputs.ascii;
  auto recorded = recorded_input(inputs.file, inputs.recorded);
  if (!recorded) refuse_recorded(inputs.recorded);
  Scan scan = scan_of_input(inputs.file, recorded);
  scan.unit = unit_length(inputs.unit);
  const auto pose = find_pose(
      placed, [&] { return level_on_ground(scan); },
      [](const std::string& path) { return read_known_points(path); });
  if (pose) scan.site_from_scan = pose->site_from_scan;
  const CloudSummary summary = summarise(scan);
  write_pose(placed, pose);
  if (inputs.out) write_cloud(*inputs.out, scan, format);

  Outcome outcome;
  outcome.json = {{"file", inputs.file}};
  outcome.json.update(cloud_json(summary));
  outcome.json["pose"] = pose ? pose->json : nlohmann::ordered_json();
  if (recorded) outcome.json["recording"] = std::move(recorded->json);
  if (inputs.out) outcome.json["out"] = *inputs.out;
  outcome.lines = cloud_lines(inputs.file, summary);
  if (pose && !pose->line.empty()) outcome.lines.push_back("  " + pose->line);
  if (inputs.out) outcome.lines.push_back("written to " + *inputs.out);
  if (recorded) {
    outcome.lines.insert(outcome.lines.begin(), recorded->line);
    outcome.warnings = recorded->scan.warnings;
  }
  const auto of_cloud = cloud_warnings(inputs.file, summary, scan.unit);
  outcome.warnings.insert(outcome.warnings.end(), of_cloud.begin(), of_cloud.end());
  add_volume(scan, inputs.polygon, outcome);
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, inspect);
}
