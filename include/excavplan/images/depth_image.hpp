// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/scans/depth_intrinsics.hpp>
#include <excavplan/scans/scan_pose.hpp>

namespace excavplan {

/// Turns a 16-bit single-channel image (PNG, at most 2^24 pixels; read by libpng) into an organised
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
