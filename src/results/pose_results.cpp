// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/pose_results.hpp"

#include "base/json.hpp"

namespace excavplan {

Json pose_json(const LevelPose& pose) {
  return {{"method", "level"},
          {"height_m", pose.height},
          {"tilt_rad", pose.tilt},
          {"residual_sd_m", pose.residual_sd},
          {"ground_share", pose.ground_share}};
}

Json pose_json(const PointPose& pose) {
  return {{"method", "points"}, {"residuals_m", pose.residuals}, {"residual_rms_m", pose.rms}};
}

}  // namespace excavplan
