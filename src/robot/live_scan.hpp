// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/scans/machine_front.hpp>
#include <excavplan/scans/scan_surface.hpp>

#include "recording/ros_messages.hpp"

/// @file Messages of points that make one scan. Private to the library.

namespace excavplan {

/// One message of points.
struct LiveFrame {
  MessageHeader header;
  PointMessage points;
  std::optional<std::int64_t> measured;   ///< when, as its stamp tells [ns]
  std::int64_t time = 0;                  ///< the same; if that is not known, when it came [ns]
  std::optional<Eigen::Isometry3d> pose;  ///< of the sensor in the site frame; unset: not yet known
  bool from_sensor = false;               ///< the pose is that of the sensor
  std::optional<MachinePosture> posture;  ///< of the machine then; unset: not yet known
};

/// Frames as one cloud.
struct LiveScan {
  Cloud cloud;            ///< in the site frame
  bool averaged = false;  ///< pixel by pixel; else the finite points of all frames
};

/// @param frames  at least one, each with its pose
LiveScan merged(const std::vector<LiveFrame>& frames);

/// When they were measured, since 1970; else by the clock of the computer [s].
double seconds_of(const std::vector<LiveFrame>& frames);

/// Its points without those of the machine. @param scan  puts its points into the machine's frame
Scan without_machine(Scan scan);

}  // namespace excavplan
