// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <excavplan/survey/depth_image.hpp>

namespace excavplan::tools {

/// A pose with what is known of its error.
struct FoundPose {
  Eigen::Matrix4d site_from_camera;
  nlohmann::ordered_json json;
  std::string line;
};

/// Of level_on_ground().
FoundPose levelled_pose(const Cloud& cloud);

/// Of pose_of_points() for the known points of a file, see read_known_points().
FoundPose pose_from_points(const std::string& path, const Cloud& cloud,
                           const DepthIntrinsics& intrinsics);

}  // namespace excavplan::tools
