// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/node_settings.hpp>

#include <cmath>
#include <optional>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/robot/dig_cycle_session.hpp>
#include <excavplan/scans/scan_terrain.hpp>

#include "base/check.hpp"
#include "robot/live_robot.hpp"

namespace excavplan {
namespace {

std::string parameter(const std::string& name) { return "parameter " + name; }

/// An error of the check then names the parameter.
template <typename Check>
void naming(const std::string& name, const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    throw Error(error.kind(), parameter(name) + ": " + error.what());
  }
}

std::optional<double> known(double number) {
  return std::isnan(number) ? std::nullopt : std::optional(number);
}

/// Of scans, joint states and the motion.
template <typename Parameters>
void check_shared(const Parameters& given) {
  require_in(parameter("scans"), given.scans, 1.0, DigCycleSession::most_scans);
  require(given.joint_age_seconds > 0.0, parameter("joint_age_seconds"), given.joint_age_seconds,
          "above 0");
  const auto check_motion = [](const std::string& name, double MotionOptions::*field,
                               double value) {
    MotionOptions motion;
    motion.*field = value;
    naming(name, [&] { check(motion); });
  };
  check_motion("speed_fraction", &MotionOptions::speed_fraction, given.speed_fraction);
  check_motion("rate_hz", &MotionOptions::rate, given.rate_hz);
  check_motion("max_jerk", &MotionOptions::max_jerk, given.max_jerk);
}

template <typename Parameters>
MotionOptions motion_of(const Parameters& given) {
  MotionOptions motion;
  motion.rate = given.rate_hz;
  motion.max_jerk = given.max_jerk;
  motion.speed_fraction = given.speed_fraction;
  return motion;
}

/// Those that can be checked one by one.
void check_numbers(const NodeParameters& given) {
  check_shared(given);
  require(given.scan_age_seconds > 0.0, parameter("scan_age_seconds"), given.scan_age_seconds,
          "above 0");
  naming("density_percent", [&] { require_density({given.density_percent, 0.0}); });
  naming("density_sd_percent", [&] { require_density({0.0, given.density_sd_percent}); });
  const auto seconds = known(given.search_seconds);
  if (!seconds) return;
  require(given.search, parameter("search_seconds") + ": has no effect without search");
  require(*seconds > 0.0, parameter("search_seconds"), *seconds, "above 0");
}

CycleSources sources_of(const NodeParameters& given) {
  CycleSources sources = {given.machine, given.soil, given.law, given.library, given.goal};
  sources.swing = known(given.swing);
  sources.dump_height = known(given.dump_height);
  sources.min_fill = known(given.min_fill);
  sources.search = given.search;
  return sources;
}

/// After site_from_scan.
void set_surroundings(const std::string& file, DigCycleSettings& settings) {
  if (file.empty()) return;
  Scan scan;
  scan.files = {file};
  scan.site_from_scan = settings.site_from_scan;
  settings.surroundings = swing_terrain_from_scan(scan, settings.machine).terrain;
}

}  // namespace

NodeSettings node_settings(const NodeParameters& given) {
  check_numbers(given);
  NodeSettings node = {cycle_settings(sources_of(given)), given.send_doubtful};
  DigCycleSettings& settings = node.session;
  settings.density = {given.density_percent, given.density_sd_percent};
  settings.scans = static_cast<std::size_t>(given.scans);
  settings.site_frame = given.site_frame;
  if (!given.frame_file.empty()) settings.site_from_scan = read_frame(given.frame_file);
  settings.site = given.site;
  name_joints(given.joint_names, settings.machine.robot_joints, parameter("joint_names") + ": ");
  settings.machine_in_view = given.machine_in_view;
  settings.digs_as_planned = given.digs_as_planned;
  settings.level_ground = given.level_ground;
  require(!given.level_ground || given.surroundings.empty(),
          parameter("level_ground") + ": not with surroundings, which show whether it is");
  naming("surroundings", [&] { set_surroundings(given.surroundings, settings); });
  settings.oldest_joints = given.joint_age_seconds;
  settings.oldest_scan = given.scan_age_seconds;
  if (const auto seconds = known(given.search_seconds)) settings.search_seconds = *seconds;
  settings.whole_cycle = given.whole_cycle;
  settings.motion = motion_of(given);
  settings.plan.trajectory.speed_fraction = given.speed_fraction;
  naming("whole_cycle", [&] {
    require(!given.whole_cycle || !settings.machine.robot_joints[3].name.empty(),
            "needs a name of the swing joint in joint_names");
    check(settings.machine, CycleWayOptions{{}, given.whole_cycle, settings.plan.search.objective});
  });
  check(settings);
  return node;
}

JobSessionSettings job_node_settings(const JobNodeParameters& given) {
  check_shared(given);
  require(!given.job.empty(), parameter("job") + ": is missing: folder of a job of plan-site");
  JobSessionSettings settings;
  settings.folder = given.job;
  settings.scans = static_cast<std::size_t>(given.scans);
  settings.site_frame = given.site_frame;
  if (!given.frame_file.empty()) settings.site_from_scan = read_frame(given.frame_file);
  settings.joint_names = given.joint_names;
  settings.machine_in_view = given.machine_in_view;
  settings.oldest_joints = given.joint_age_seconds;
  settings.motion = motion_of(given);
  return settings;
}

}  // namespace excavplan
