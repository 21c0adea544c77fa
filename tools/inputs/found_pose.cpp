// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/found_pose.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "results/scan_results.hpp"

namespace excavplan::tools {
namespace {

std::string millimetres(double metres) {
  return number_text(std::round(metres * 1e4) / 10.0) + " mm";
}

FoundPose pose_from_points(const KnownPoints& points) {
  const PointPose pose = pose_of_points(points.in_scan, points.in_site);
  const double worst = *std::max_element(pose.residuals.begin(), pose.residuals.end());
  double lowest = points.in_site.front().z();
  for (const Eigen::Vector3d& point : points.in_site) lowest = std::min(lowest, point.z());
  const double below = lowest - pose.site_from_scan(2, 3);
  return {pose.site_from_scan, pose_json(pose),
          std::to_string(points.in_site.size()) + " known points fit within " +
              millimetres(pose.rms) + " (rms), the worst one within " + millimetres(worst) +
              (below > 0.0 ? "; the sensor is " + readable(below) +
                                 " m below them all: points on level ground that are mirrored or "
                                 "exchanged turn it over"
                           : "")};
}

}  // namespace

FoundPose found_pose(const LevelPose& level) {
  return {level.site_from_scan, pose_json(level),
          "ground found in " + std::to_string(std::lround(100.0 * level.ground_share)) +
              " % of the points, " + number_text(std::round(level.height * 1e3) / 1e3) +
              " m below the sensor, flat within " + millimetres(level.residual_sd)};
}

Eigen::Matrix4d frame_named(const std::string& what, const std::string& text) {
  if (text == "lidar") return Eigen::Matrix4d::Identity();
  if (text == "camera") {
    Eigen::Matrix4d axes = Eigen::Matrix4d::Zero();
    axes(0, 2) = axes(3, 3) = 1.0;
    axes(1, 0) = axes(2, 1) = -1.0;
    return axes;
  }
  if (text == "y-up") {
    Eigen::Matrix4d axes = Eigen::Matrix4d::Zero();
    axes(2, 1) = axes(3, 3) = 1.0;
    axes(0, 2) = axes(1, 0) = -1.0;
    return axes;
  }
  const bool is_pose = std::count(text.begin(), text.end(), ',') == 6 &&
                       text.find_first_not_of("0123456789+-.,eEcm ") == text.npos;
  return is_pose ? parse_pose(what, text) : read_frame(text);
}

void declare_pose(Arguments& arguments, PoseInputs& inputs, const std::string& columns) {
  arguments.text("pose", "FRAME", inputs.pose,
                 std::string("transform of the scan into the site frame: ") + frame_forms);
  arguments.flag("level", inputs.level,
                 "level the cloud by the ground plane: origin on the ground below the sensor, z "
                 "up, x forward");
  arguments.file(
      "points", inputs.points,
      "CSV of 3 or more known points: " + columns + " and x_m,y_m,z_m in the site frame");
  arguments.exclude("pose", {"level", "points"});
  arguments.exclude("level", {"points"});
  arguments.output("pose-out", inputs.pose_out,
                   "write the pose found, for --pose of the next scan");
}

void check_pose(const PoseInputs& inputs) {
  if (inputs.pose_out && !inputs.level && !inputs.points) {
    usage_error("--pose-out needs --level or --points");
  }
}

std::optional<FoundPose> find_pose(const PoseInputs& inputs, const Leveller& level,
                                   const PointsReader& read_points) {
  std::optional<FoundPose> found;
  if (inputs.pose) found = {frame_named("--pose", *inputs.pose), {{"method", "given"}}, {}};
  if (inputs.level) found = found_pose(level());
  if (inputs.points) found = pose_from_points(read_points(*inputs.points));
  return found;
}

void write_pose(const PoseInputs& inputs, const std::optional<FoundPose>& pose) {
  if (inputs.pose_out) write_frame(*inputs.pose_out, pose->site_from_scan);
}

}  // namespace excavplan::tools
