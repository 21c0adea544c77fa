// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <utility>

#include <excavplan/survey/scan_surface.hpp>

#include "shared/found_pose.hpp"
#include "shared/recordings.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

struct Inputs {
  std::string file;
  std::optional<std::string> frame;
  std::string tf_frame;
  PoseInputs pose;
  std::optional<std::string> out;
  bool ascii = false;
};

const About about = {
    "inspect-cloud",
    "Summarises a scan (PCD, PLY, LAS or XYZ text, detected from the content), and converts it to "
    "another format or frame. Lists what a recording holds (rosbag2, MCAP, ROS 1 bag).",
    {{"inspect-cloud scan.pcd", "points, extent, point density and a guess of the frame"},
     {"inspect-cloud run.db3", "topics, frames and times of a recording"},
     {"inspect-cloud run.db3:/points@12.5s+2s --tf-frame map --out scan.pcd",
      "the points of two seconds of a recording, in the frame map"},
     {"inspect-cloud scan.xyz --out scan.ply", "the summary, and the points as binary PLY"},
     {"inspect-cloud scan.pcd --frame scan_frame.txt --out site.pcd", "into the site frame"},
     {"inspect-cloud scan.pcd --level --pose-out pose.txt --out level.pcd",
      "z up by the ground plane"},
     {"inspect-cloud scan.pcd --points markers.csv --out site.pcd",
      "markers.csv has the columns scan_x_m,scan_y_m,scan_z_m,x_m,y_m,z_m"}}};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("FILE", inputs.file, std::string("scan to summarise, or ") + recording_form);
  arguments.text("frame", "FRAME", inputs.frame, "another name of --pose");
  arguments.text("tf-frame", "NAME", inputs.tf_frame,
                 "frame of the transforms of a recording into which its scan is put");
  declare_pose(arguments, inputs.pose, "scan_x_m,scan_y_m,scan_z_m");
  arguments.output("out", inputs.out, "write the cloud here: " + cloud_endings());
  arguments.flag("ascii", inputs.ascii, "write PCD and PLY as text, with full precision");
}

nlohmann::ordered_json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::string range(const std::string& axis, double low, double high) {
  return axis + " " + readable(low, 4) + " .. " + readable(high, 4) + " m (" +
         readable(high - low) + " m)";
}

std::vector<std::string> lines_for_people(const Inputs& inputs, const CloudSummary& summary,
                                          const std::optional<FoundPose>& pose) {
  std::string points = std::to_string(summary.points) + " points";
  if (summary.height > 1) {
    points += " (" + std::to_string(summary.width) + " x " + std::to_string(summary.height) + ")";
  }
  std::vector<std::string> lines = {inputs.file + ": " + points + ", " +
                                    std::to_string(summary.finite_points) + " finite"};
  if (summary.left_out > 0) {
    lines.push_back("  " + std::to_string(summary.left_out) +
                    " more are withheld or noise: left out");
  }
  if (summary.finite_points > 0) {
    const char* const axes[] = {"x", "y", "z"};
    for (Eigen::Index i = 0; i < 3; ++i) {
      lines.push_back("  " + range(axes[i], summary.min[i], summary.max[i]));
    }
    if (std::isfinite(summary.density)) {
      lines.push_back("  " + readable(summary.density) + " points per m^2 of ground");
    }
    lines.push_back("  frame (a guess): " + summary.frame_guess);
  }
  if (pose && !pose->line.empty()) lines.push_back("  " + pose->line);
  if (inputs.out) lines.push_back("written to " + *inputs.out);
  return lines;
}

Outcome inspect(const Inputs& inputs) {
  if (!inputs.out && !inputs.pose.pose_out) {
    if (auto listing = recording_listing(inputs.file)) {
      if (!inputs.tf_frame.empty()) usage_error("--tf-frame needs a topic: FILE:TOPIC@TIME+SPAN");
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
  if (inputs.frame && placed.pose) usage_error("--frame and --pose are the same: give one of them");
  if (inputs.frame) placed.pose = inputs.frame;
  check_pose(placed);
  CloudFormat format;
  if (inputs.out) format = cloud_format_of_name(*inputs.out);
  format.text = inputs.ascii;
  auto recorded = recorded_input(inputs.file, inputs.tf_frame);
  if (!recorded && !inputs.tf_frame.empty()) usage_error("--tf-frame needs a recording");
  Scan scan;
  if (!recorded) scan.files = {inputs.file};
  if (recorded) scan.clouds = {std::make_shared<const Cloud>(std::move(recorded->scan.cloud))};
  const auto pose = find_pose(
      placed, [&] { return level_on_ground(scan); },
      [](const std::string& path) { return read_known_points(path); });
  if (pose) scan.site_from_scan = pose->site_from_scan;
  const CloudSummary summary = summarise(scan);
  write_pose(placed, pose);
  if (inputs.out) write_cloud(*inputs.out, scan, format);

  Outcome outcome;
  outcome.json = {{"file", inputs.file},
                  {"points", summary.points},
                  {"width", summary.width},
                  {"height", summary.height},
                  {"finite_points", summary.finite_points},
                  {"left_out_points", summary.left_out},
                  {"centroid_m", to_json(summary.centroid)},
                  {"min_m", to_json(summary.min)},
                  {"max_m", to_json(summary.max)},
                  {"density_per_m2", summary.density},
                  {"frame_guess", summary.frame_guess},
                  {"pose", pose ? pose->json : nlohmann::ordered_json()}};
  if (recorded) outcome.json["recording"] = std::move(recorded->json);
  if (inputs.out) outcome.json["out"] = *inputs.out;
  outcome.lines = lines_for_people(inputs, summary, pose);
  if (recorded) {
    outcome.lines.insert(outcome.lines.begin(), recorded->line);
    outcome.warnings = recorded->scan.warnings;
  }
  if (summary.finite_points == 0) {
    outcome.warnings.push_back({"no_finite_points", inputs.file + " has no finite points"});
  }
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, inspect);
}
