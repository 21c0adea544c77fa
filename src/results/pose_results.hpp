// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/scans/scan_pose.hpp>

#include "base/json_fwd.hpp"

namespace excavplan {

/// A pose with its method and what is known of its error.
Json pose_json(const LevelPose& pose);
Json pose_json(const PointPose& pose);

}  // namespace excavplan
