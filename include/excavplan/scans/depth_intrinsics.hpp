// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace excavplan {

/// A unit of the counts in depth images.
struct DepthUnit {
  const char* word;  ///< "0.25mm"
  double length;     ///< [m]
};
/// Those that cameras have besides 1 mm: RealSense L500 and SR300.
inline constexpr std::array<DepthUnit, 2> other_depth_units = {
    {{"0.25mm", 0.25e-3}, {"0.125mm", 0.125e-3}}};

/// Pinhole intrinsics [pixel] and scale of a depth image.
struct DepthIntrinsics {
  double fx = 0.0;            ///< focal length along a row [pixel]
  double fy = 0.0;            ///< focal length along a column [pixel]
  double cx = 0.0;            ///< column of the optical axis [pixel]
  double cy = 0.0;            ///< row of the optical axis [pixel]
  double depth_unit = 0.001;  ///< metres per count; RealSense: 0.001
  double min_depth = 0.1;     ///< nearer pixels are dropped [m]
  double max_depth = 20.0;    ///< farther pixels are dropped [m]
  int width = 0;              ///< of the images they hold for [pixel]; 0: of any
  int height = 0;             ///< the same
};

/// Reads intrinsics, whichever of the forms of docs/formats.md#intrinsics the content has: ours in
/// JSON, those of Open3D, RealSense and OpenCV-like flat keys in JSON or YAML, a calibration of ROS
/// (camera_matrix) or a CameraInfo message as it is echoed.
/// @throws Error (bad_file) naming file, key, value and rule, also if a distortion is not zero
DepthIntrinsics load_intrinsics(const std::string& path);

}  // namespace excavplan
