// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <excavplan/scans/scan_pose.hpp>

#include "frame/arguments.hpp"

namespace excavplan::tools {

/// A pose with what is known of its error.
struct FoundPose {
  Eigen::Matrix4d site_from_scan;
  nlohmann::ordered_json json;
  std::string line;  ///< empty of one that was given
};

FoundPose found_pose(const LevelPose& level);

/// The frame that an option gives: "camera" (x right, y down, z forward), "lidar" (x forward, y
/// left, z up) or "y-up" (x right, y up, z backward) at the origin of the site, seven numbers
/// X,Y,Z,QX,QY,QZ,QW, or a file that read_frame() reads. `what` names the option in messages.
/// @throws Error (bad_input) or (bad_file)
Eigen::Matrix4d frame_named(const std::string& what, const std::string& text);
inline constexpr const char* frame_forms =
    "camera (x right, y down, z forward), lidar (x forward, y left, z up) or y-up (x right, y up, "
    "z "
    "backward, as phone apps write) at the origin of the site, X,Y,Z,QX,QY,QZ,QW, or a file (4 x 4 "
    "matrix; TF transform or pose as JSON or YAML)";

/// How one scan is brought into the site frame.
struct PoseInputs {
  std::optional<std::string> pose;
  bool level = false;
  std::optional<std::string> points;
  std::optional<std::string> pose_out;
};
/// --pose, --level, --points and --pose-out; `columns` of the known points in the scan.
void declare_pose(Arguments& arguments, PoseInputs& inputs, const std::string& columns);
/// @throws Error (bad_input) if they exclude each other
void check_pose(const PoseInputs& inputs);
using Leveller = std::function<LevelPose()>;
using PointsReader = std::function<KnownPoints(const std::string& path)>;
/// The pose of a scan, if one is asked for.
std::optional<FoundPose> find_pose(const PoseInputs& inputs, const Leveller& level,
                                   const PointsReader& read_points);
/// Writes it to --pose-out, if that is given.
void write_pose(const PoseInputs& inputs, const std::optional<FoundPose>& pose);

}  // namespace excavplan::tools
