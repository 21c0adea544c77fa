// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/survey/depth_image.hpp>

#include "tool.hpp"

namespace excavplan::tools {
namespace {

struct Inputs {
  std::string image;
  std::string intrinsics;
  std::optional<std::string> pose;
  std::string out;
};

const About about = {
    "depth-to-cloud",
    "Turns a depth image (16-bit single-channel PNG) into a cloud in the site frame. The "
    "intrinsics are a JSON file {\"format\": \"excavplan-depth-intrinsics\", \"version\": 1, "
    "\"fx\": 615.5, \"fy\": 615.5, \"cx\": 320, \"cy\": 240} in pixels, optionally with "
    "depth_unit_m (0.001), min_depth_m (0.1) and max_depth_m (20).",
    {{"depth-to-cloud depth.png --intrinsics d435i.json --pose camera_pose.txt --out scan.pcd",
      "the pose takes the camera (x right, y down, z forward) into the site frame"},
     {"depth-to-cloud depth.png --intrinsics d435i.json --out camera.ply",
      "a cloud that stays in the camera frame"}}};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("IMAGE", inputs.image, "depth image, 16-bit PNG");
  arguments.file("intrinsics", inputs.intrinsics, "camera intrinsics, JSON");
  arguments.require("intrinsics");
  arguments.file("pose", inputs.pose,
                 "4 x 4 text matrix that takes the camera into the site frame");
  arguments.file("out", inputs.out, "cloud to write: .pcd, .ply, .xyz, .txt or .asc");
  arguments.require("out");
}

Outcome convert(const Inputs& inputs) {
  const CloudFormat format = cloud_format_of_name(inputs.out);
  const DepthIntrinsics intrinsics = load_intrinsics(inputs.intrinsics);
  const auto pose = inputs.pose ? std::optional(read_frame(*inputs.pose)) : std::nullopt;
  Cloud cloud = depth_image_to_cloud(inputs.image, intrinsics);
  if (pose) transform(cloud, *pose);
  const CloudSummary summary = summarise(cloud);
  write_cloud(inputs.out, cloud, format);

  Outcome outcome;
  outcome.json = {{"points", summary.points},
                  {"width", cloud.width},
                  {"height", cloud.height},
                  {"finite_points", summary.finite_points},
                  {"frame", pose ? "site" : "camera"},
                  {"out", inputs.out}};
  outcome.lines = {std::to_string(summary.finite_points) + " of " + std::to_string(summary.points) +
                       " pixels hold a depth",
                   "written to " + inputs.out};
  if (!pose) {
    outcome.warnings.push_back(
        {"camera_frame", "without --pose the cloud stays in the camera frame"});
  }
  if (summary.finite_points == 0) {
    outcome.warnings.push_back({"no_finite_points", inputs.image + " holds no depth in range"});
  }
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, convert);
}
