// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/images/depth_image.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>

#include "base/text.hpp"
#include "frame/tool.hpp"
#include "inputs/found_pose.hpp"
#include "inputs/unit_inputs.hpp"

namespace excavplan::tools {
namespace {

struct Inputs {
  std::string image;
  std::string intrinsics;
  std::string average;
  std::optional<double> depth_unit;
  PoseInputs pose;
  std::string out;
};

const About about = {
    "depth-to-cloud",
    "Turns a depth image (16-bit single-channel PNG), or several frames of one view averaged, into "
    "a cloud in the site frame. The intrinsics are those of Open3D or RealSense (JSON), of "
    "camera_calibration or CameraInfo (ROS, YAML), or a JSON file {\"format\": "
    "\"excavplan-depth-intrinsics\", \"version\": 1, \"fx\": 615.5, \"fy\": 615.5, \"cx\": 320, "
    "\"cy\": 240} in pixels, optionally with depth_unit_m (0.001), min_depth_m (0.1) and "
    "max_depth_m (20). The camera pose is given (--pose), found from known points "
    "(--points), or, for tilt and height alone, from the ground plane (--level). Scans before and "
    "after a dig must share one pose: write it with --pose-out and pass it to the second scan with "
    "--pose.",
    {{"depth-to-cloud depth.png --intrinsics d435i.json --pose camera_pose.txt --out scan.pcd",
      "the pose transforms the camera frame (x right, y down, z forward) into the site frame"},
     {"depth-to-cloud first.png --average frames --intrinsics d435i.json --level --pose-out "
      "pose.txt --out before.pcd",
      "averages first.png and all .png files of the folder frames; z = 0 is the ground"},
     {"depth-to-cloud depth.png --intrinsics d435i.json --points markers.csv --out scan.pcd",
      "markers.csv has the columns u_px,v_px,x_m,y_m,z_m: pixel and position in the site frame"},
     {"depth-to-cloud depth.png --intrinsics d435i.json --out camera.ply",
      "a cloud in the camera frame"}}};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("IMAGE", inputs.image, "depth image, 16-bit PNG");
  arguments.file("intrinsics", inputs.intrinsics, "camera intrinsics, JSON or YAML");
  arguments.require("intrinsics");
  arguments.text("average", "FILES", inputs.average,
                 "more frames of the same view, averaged with IMAGE pixel by pixel: files "
                 "separated by commas, or a folder, for all its .png files");
  declare_depth_unit(arguments, inputs.depth_unit,
                     "of a count: 0.25mm, 0.125mm (default: as the intrinsics say, else 1mm)");
  declare_pose(arguments, inputs.pose, "u_px,v_px (or scan_x_m,scan_y_m,scan_z_m)");
  arguments.output("out", inputs.out, "cloud to write: " + cloud_endings());
  arguments.require("out");
}

/// IMAGE and the frames of --average, each once.
std::vector<std::string> frames_of(const Inputs& inputs) {
  std::vector<std::string> frames = {inputs.image};
  std::istringstream words(inputs.average);
  for (std::string word; std::getline(words, word, ',');) {
    std::vector<std::string> files = {word};
    std::error_code none;
    if (std::filesystem::is_directory(word, none)) {
      files.clear();
      for (const auto& entry : std::filesystem::directory_iterator(word)) {
        if (small_letters(entry.path().extension().string()) == ".png")
          files.push_back(entry.path().string());
      }
      std::sort(files.begin(), files.end());
    }
    for (const std::string& file : files) {
      if (!std::filesystem::equivalent(file, inputs.image, none)) frames.push_back(file);
    }
  }
  return frames;
}

Outcome convert(const Inputs& inputs) {
  check_pose(inputs.pose);
  const CloudFormat format = cloud_format_of_name(inputs.out);
  DepthIntrinsics intrinsics = load_intrinsics(inputs.intrinsics);
  if (inputs.depth_unit) intrinsics.depth_unit = *inputs.depth_unit;
  const std::vector<std::string> frames = frames_of(inputs);
  AveragedDepth average = average_depth_images(frames, intrinsics);
  Cloud& cloud = average.cloud;
  const auto pose = find_pose(
      inputs.pose, [&] { return level_on_ground(cloud); },
      [&](const std::string& path) { return read_known_points(path, cloud, intrinsics); });
  write_pose(inputs.pose, pose);
  if (pose) transform(cloud, pose->site_from_scan);
  const CloudSummary summary = summarise(cloud);
  write_cloud(inputs.out, cloud, format);

  Outcome outcome;
  outcome.json = {{"points", summary.points},
                  {"width", cloud.width},
                  {"height", cloud.height},
                  {"finite_points", summary.finite_points},
                  {"frames", frames.size()},
                  {"frame", pose ? "site" : "camera"},
                  {"pose", pose ? pose->json : nlohmann::ordered_json()},
                  {"out", inputs.out}};
  outcome.lines = {std::to_string(summary.finite_points) + " of " + std::to_string(summary.points) +
                   " pixels hold a depth" +
                   (frames.size() > 1 ? " in " + std::to_string(frames.size()) + " frames" : "")};
  if (pose && !pose->line.empty()) outcome.lines.push_back(pose->line);
  outcome.lines.push_back("written to " + inputs.out);
  if (!pose) {
    outcome.warnings.emplace_back(WarningCode::camera_frame,
                                  "without --pose, --level or --points the cloud stays in the "
                                  "camera frame");
  }
  if (summary.finite_points == 0) {
    outcome.warnings.emplace_back(WarningCode::no_finite_points,
                                  inputs.image + " has no depth in range");
  }
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, convert);
}
