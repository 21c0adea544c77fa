// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>
#include <excavplan/robot/robot_node.hpp>

namespace excavplan_ros {

/// The settings that the private parameters of the node give (docs/ros.md#parameters).
/// @throws excavplan::Error naming a parameter that is not of its type, not known or out of range
excavplan::NodeSettings settings_of(const ros::NodeHandle& parameters);
/// Likewise of the node of a job.
excavplan::JobSessionSettings job_settings_of(const ros::NodeHandle& parameters);

}  // namespace excavplan_ros
