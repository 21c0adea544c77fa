// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace excavplan {

/// Where a machine stands in the frame of its site: its swing axis at ground level.
struct BasePose {
  double x = 0.0;        ///< [m]
  double y = 0.0;        ///< [m]
  double z = 0.0;        ///< [m]
  double heading = 0.0;  ///< of the machine's x axis from that of the site, to the left [rad]

  Eigen::Isometry3d site_from_machine() const;  ///< level: a heading and a shift
  /// Whether it is that of the frame itself.
  bool is_origin() const { return x == 0.0 && y == 0.0 && z == 0.0 && heading == 0.0; }
};

}  // namespace excavplan
