// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/survey/cloud.hpp>

namespace excavplan {

/// Pinhole intrinsics [pixel] and scale of a depth image.
struct DepthIntrinsics {
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  double depth_unit = 0.001;  ///< metres per count; RealSense: 0.001
  double min_depth = 0.1;     ///< nearer pixels are dropped [m]
  double max_depth = 20.0;    ///< farther pixels are dropped [m]
};

/// Reads intrinsics from JSON: fx, fy, cx, cy and optionally depth_unit_m, min_depth_m,
/// max_depth_m.
/// @throws Error (bad_file) naming file, key, value and rule
DepthIntrinsics load_intrinsics(const std::string& path);

/// Turns a 16-bit single-channel image (PNG; read by OpenCV) into an organised cloud in the camera
/// frame (x right, y down, z forward), NaN where the count is 0 or out of range.
/// @throws Error (bad_file) if the file is not such an image; (bad_input) if an intrinsic is out of
/// range
Cloud depth_image_to_cloud(const std::string& image_path, const DepthIntrinsics& intrinsics);

}  // namespace excavplan
