// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/survey/cloud.hpp>
#include <excavplan/survey/scan_pose.hpp>

namespace excavplan {

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

/// Turns a 16-bit single-channel image (PNG, at most 2^24 pixels; read by OpenCV) into an organised
/// cloud in the camera frame (x right, y down, z forward), NaN where the count is 0 or out of
/// range.
/// @throws Error (bad_file) if the file is not such an image or of another size than the intrinsics
/// hold for; (bad_input) if an intrinsic is out of range
Cloud depth_image_to_cloud(const std::string& image_path, const DepthIntrinsics& intrinsics);

/// Several frames of one view in one cloud.
struct AveragedDepth {
  Cloud cloud;              ///< in the camera frame, NaN where most frames saw nothing
  std::vector<int> frames;  ///< averaged into each pixel, 0 where unknown
};

/// Averages depth images of a camera that did not move, pixel by pixel: the mean of the depths
/// within 3 robust sd (1.4826 MAD, at least one count) of their median; unknown where fewer than
/// half of the frames agree. Noise falls with the square root of the frames; what all frames have
/// in common (a stereo camera's fixed pattern) stays.
///
/// @throws Error (bad_file) as depth_image_to_cloud(), or if the images differ in size; (bad_input)
/// without an image, with more than 10000, or if they hold more than 2 billion pixels together
AveragedDepth average_depth_images(const std::vector<std::string>& image_paths,
                                   const DepthIntrinsics& intrinsics);

/// The point of an organised cloud at a place of the image [pixel]: on the ray of that place, at
/// the median depth of the 5 x 5 pixels around it.
///
/// @throws Error (bad_input) if the place is outside the image or fewer than 3 of the pixels hold a
/// depth
Eigen::Vector3d point_at_pixel(const Cloud& cloud, const DepthIntrinsics& intrinsics, double u,
                               double v);

/// Reads known points of a depth image from a CSV file with the columns x_m, y_m, z_m of the site
/// and either u_px, v_px, looked up by point_at_pixel(), or those of the other read_known_points().
/// @throws Error (bad_file) naming file, line or column and rule; (bad_input) as point_at_pixel()
KnownPoints read_known_points(const std::string& path, const Cloud& cloud,
                              const DepthIntrinsics& intrinsics);

}  // namespace excavplan
