// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <excavplan/robot/dig_cycle_settings.hpp>
#include <excavplan/robot/job_session.hpp>

/// @file
/// The parameters of the nodes of ROS 1 and ROS 2 (docs/ros.md#parameters).

namespace excavplan {

/// Settings of a node.
struct NodeSettings {
  DigCycleSettings session;    ///< of the dig cycle
  bool send_doubtful = false;  ///< the trajectory is sent even if it is not a safe_motion()
};

/// Parameters as they are given, each with its default. Members are named as the parameters.
struct NodeParameters {
  /// Of a number: it is not given.
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  std::string machine = CycleSources{}.machine;  ///< as CycleSources::machine
  std::string soil = CycleSources{}.soil;        ///< as CycleSources::soil
  std::string law;                               ///< as CycleSources::law
  std::string library;                           ///< as CycleSources::library
  std::string goal = CycleSources{}.goal;        ///< as CycleSources::goal
  double swing = none;                           ///< as CycleSources::swing [rad]
  double dump_height = none;                     ///< as CycleSources::dump_height [m]
  double min_fill = none;                        ///< as CycleSources::min_fill
  double density_percent = 50.0;                 ///< of DigCycleSettings::density
  double density_sd_percent = 25.0;              ///< likewise
  int scans = 5;                                 ///< as DigCycleSettings::scans
  std::string site_frame;                        ///< as DigCycleSettings::site_frame
  std::string frame_file;                        ///< of DigCycleSettings::site_from_scan
  std::string site;                              ///< as DigCycleSettings::site
  std::vector<std::string> joint_names;          ///< four, or none: the machine's
  bool machine_in_view = false;                  ///< as DigCycleSettings::machine_in_view
  bool digs_as_planned = true;                   ///< as DigCycleSettings::digs_as_planned
  bool level_ground = false;                     ///< as DigCycleSettings::level_ground
  std::string surroundings;                      ///< cloud in the frame of the scans
  double joint_age_seconds = 1.0;                ///< as DigCycleSettings::oldest_joints
  double scan_age_seconds = DigCycleSettings{}.oldest_scan;  ///< as DigCycleSettings::oldest_scan
  bool search = false;                                       ///< as CycleSources::search
  double search_seconds = none;                            ///< as DigCycleSettings::search_seconds
  double speed_fraction = MotionOptions{}.speed_fraction;  ///< as MotionOptions::speed_fraction
  double rate_hz = MotionOptions{}.rate;                   ///< as MotionOptions::rate
  double max_jerk = MotionOptions{}.max_jerk;              ///< as MotionOptions::max_jerk
  bool whole_cycle = false;                                ///< as DigCycleSettings::whole_cycle
  bool send_doubtful = false;                              ///< as NodeSettings::send_doubtful
};

/// Calls `use(name, member)` for each parameter.
template <typename Use>
void for_each_parameter(NodeParameters& all, const Use& use) {
  use("machine", all.machine), use("soil", all.soil);
  use("law", all.law), use("library", all.library);
  use("goal", all.goal), use("min_fill", all.min_fill);
  use("swing", all.swing), use("dump_height", all.dump_height);
  use("density_percent", all.density_percent);
  use("density_sd_percent", all.density_sd_percent);
  use("scans", all.scans);
  use("site_frame", all.site_frame), use("frame_file", all.frame_file);
  use("site", all.site);
  use("joint_names", all.joint_names);
  use("joint_age_seconds", all.joint_age_seconds);
  use("scan_age_seconds", all.scan_age_seconds);
  use("machine_in_view", all.machine_in_view);
  use("digs_as_planned", all.digs_as_planned);
  use("level_ground", all.level_ground), use("surroundings", all.surroundings);
  use("search", all.search), use("search_seconds", all.search_seconds);
  use("speed_fraction", all.speed_fraction);
  use("rate_hz", all.rate_hz), use("max_jerk", all.max_jerk);
  use("whole_cycle", all.whole_cycle), use("send_doubtful", all.send_doubtful);
}

/// Those of the node of a job.
struct JobNodeParameters {
  std::string job;                       ///< as JobSessionSettings::folder
  int scans = NodeParameters{}.scans;    ///< as JobSessionSettings::scans
  std::string site_frame;                ///< as JobSessionSettings::site_frame
  std::string frame_file;                ///< of JobSessionSettings::site_from_scan
  std::vector<std::string> joint_names;  ///< as JobSessionSettings::joint_names
  bool machine_in_view = false;          ///< as JobSessionSettings::machine_in_view
  double joint_age_seconds = NodeParameters{}.joint_age_seconds;  ///< as of NodeParameters
  double speed_fraction = NodeParameters{}.speed_fraction;        ///< likewise
  double rate_hz = NodeParameters{}.rate_hz;                      ///< likewise
  double max_jerk = NodeParameters{}.max_jerk;                    ///< likewise
};

/// Calls `use(name, member)` for each parameter.
template <typename Use>
void for_each_parameter(JobNodeParameters& all, const Use& use) {
  use("job", all.job), use("scans", all.scans);
  use("site_frame", all.site_frame), use("frame_file", all.frame_file);
  use("joint_names", all.joint_names), use("joint_age_seconds", all.joint_age_seconds);
  use("machine_in_view", all.machine_in_view);
  use("speed_fraction", all.speed_fraction);
  use("rate_hz", all.rate_hz), use("max_jerk", all.max_jerk);
}

/// The settings that parameters give, all of them checked.
/// @throws Error as cycle_settings() and read_frame(), or (bad_input) naming a parameter
NodeSettings node_settings(const NodeParameters& given);
/// The same. @throws Error as read_frame(), or (bad_input) naming a parameter
JobSessionSettings job_node_settings(const JobNodeParameters& given);

/// Those that a node reads: NodeParameters or JobNodeParameters.
/// @param parameters  has `value(name, fallback)` for texts, numbers, flags, counts (int) and lists
/// of texts
template <typename Given, typename Parameters>
Given parameters_of(Parameters& parameters) {
  Given given;
  for_each_parameter(
      given, [&](const char* name, auto& member) { member = parameters.value(name, member); });
  return given;
}
/// The settings that these give. @throws Error as node_settings()
template <typename Parameters>
NodeSettings settings_of(Parameters& parameters) {
  return node_settings(parameters_of<NodeParameters>(parameters));
}
/// Likewise. @throws Error as job_node_settings()
template <typename Parameters>
JobSessionSettings job_settings_of(Parameters& parameters) {
  return job_node_settings(parameters_of<JobNodeParameters>(parameters));
}

}  // namespace excavplan
