// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/found_pose.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/survey/scan_pose.hpp>

#include "base/json.hpp"
#include "base/text.hpp"

namespace excavplan::tools {
namespace {

std::string millimetres(double metres) {
  return number_text(std::round(metres * 1e4) / 10.0) + " mm";
}

}  // namespace

FoundPose levelled_pose(const Cloud& cloud) {
  const LevelPose pose = level_on_ground(cloud);
  return {pose.site_from_scan,
          {{"method", "level"},
           {"height_m", pose.height},
           {"tilt_rad", pose.tilt},
           {"residual_sd_m", pose.residual_sd},
           {"ground_share", pose.ground_share}},
          "ground found in " + std::to_string(std::lround(100.0 * pose.ground_share)) +
              " % of the pixels, " + number_text(std::round(pose.height * 1e3) / 1e3) +
              " m below the camera, flat within " + millimetres(pose.residual_sd)};
}

FoundPose pose_from_points(const std::string& path, const Cloud& cloud,
                           const DepthIntrinsics& intrinsics) {
  const KnownPoints points = read_known_points(path, cloud, intrinsics);
  const PointPose pose = pose_of_points(points.in_camera, points.in_site);
  const double worst = *std::max_element(pose.residuals.begin(), pose.residuals.end());
  return {pose.site_from_scan,
          {{"method", "points"}, {"residuals_m", pose.residuals}, {"residual_rms_m", pose.rms}},
          std::to_string(points.in_site.size()) + " known points fit within " +
              millimetres(pose.rms) + " (rms), the worst one within " + millimetres(worst)};
}

}  // namespace excavplan::tools
