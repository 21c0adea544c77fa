// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/base_pose.hpp>

namespace excavplan {

Eigen::Isometry3d BasePose::site_from_machine() const {
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
}

}  // namespace excavplan
