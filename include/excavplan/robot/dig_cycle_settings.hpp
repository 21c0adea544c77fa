// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <excavplan/density/density_estimate.hpp>
#include <excavplan/planning/plan_motion.hpp>

/// @file
/// What a DigCycleSession is given: settings, and messages of a robot.

namespace excavplan {

/// A message of a robot as it was sent.
struct RobotMessage {
  std::string topic;   ///< "/points"; transforms on one that ends in "tf_static" hold at all times
  std::string type;    ///< as ROS 2 spells it: "sensor_msgs/msg/PointCloud2"
  bool is_cdr = true;  ///< of ROS 2; false: of ROS 1
  std::string_view bytes;  ///< serialized
  /// By the clock of the marks; nothing: it is that of the stamps [ns].
  std::optional<std::int64_t> received = {};
};

/// Settings of a session.
struct DigCycleSettings {
  Machine machine;                    ///< that digs; its robot_joints name the joint states
  SoilKind soil;                      ///< kind of the ground
  DensityLaw law;                     ///< of digs of this machine in this soil
  GroundDensity density{50.0, 25.0};  ///< until one was estimated
  std::size_t scans = 5;              ///< messages in a scan, averaged if they can be; 1 .. 100
  std::string site_frame = {};        ///< into which /tf puts the points; empty: not by /tf
  /// Puts the points, or the site frame of /tf, into that of the machine: origin on the swing axis
  /// at ground level, x forward, z up.
  Eigen::Matrix4d site_from_scan = Eigen::Matrix4d::Identity();
  /// Folder of a Site that remembers ground and density, for this session alone while it lives;
  /// empty: none. Its frame is `site_frame`, where the inverse of `site_from_scan` says how the
  /// machine stands, which must be level; without a `site_frame` that of the machine.
  std::string site = {};
  /// Points of boom, arm and bucket are left out, by the joint states; needs scans in the frame of
  /// the machine.
  bool machine_in_view = false;
  /// A joint state that is older than this where it is needed is unknown: against the time of the
  /// plan, or the stamp of the points [s]; above 0.
  double oldest_joints = 1.0;
  /// A scan older than this [s] when a plan is made, or its motion is to be sent, ends trust:
  /// people and machines move. Above 0; ours.
  double oldest_scan = 60.0;
  /// The dig that is scanned is the last plan of the session, if there is one, whose path corrects
  /// for the soil that fell back.
  bool digs_as_planned = true;
  DensityOptions estimate = {};  ///< `dug_path` is set by the session
  PlanOptions plan = {};         ///< how the next dig is planned; its cycle is that of the motion
  double search_seconds = std::numeric_limits<double>::infinity();  ///< a search ends then [s]; > 0
  bool whole_cycle = false;   ///< as CycleWayOptions::whole_cycle; needs a name of the swing joint
  MotionOptions motion = {};  ///< of the trajectory that is sent
  /// The ground before any scan is known to be level; if not, a plan on it is not trustworthy.
  bool level_ground = false;
  /// Earlier swing_terrain_from_scan(), for motions where the last scan does not see the ground;
  /// not with level_ground.
  std::optional<Terrain> surroundings = {};
  std::vector<Warning> warnings = {};  ///< of what the settings were made from; every plan has them
};

/// @throws Error (bad_input) naming a member that is out of range, that does not suit the machine,
/// or a library that is not of machine, soil and objective
void check(const DigCycleSettings& settings);

/// What settings are made from, in the words of the tools.
struct CycleSources {
  std::string machine = "zx120";  ///< shipped name, file, URDF, or folder of a kit
  std::string soil = "loam";      ///< shipped name or file
  std::string law = {};           ///< likewise; empty: of the machine's kit, else the shipped one
  std::string library = {};       ///< file; empty: of the machine's kit, else the shipped one
  std::string goal = dig_goals().front().word;  ///< as objective_named() takes it
  // Numbers of the goal; nothing: those of the kit's library, else the usual ones.
  std::optional<double> swing = {};        ///< as CycleOptions::swing [rad]
  std::optional<double> dump_height = {};  ///< as CycleOptions::dump_height [m]
  std::optional<double> min_fill = {};     ///< as DigObjective::min_fill
  bool search = false;                     ///< search in place of a look-up
};

/// The usual dump height is lowered to what the machine reaches: warning dump_height_lowered.
/// @throws Error as machine_path(), load_machine_file(), load_soil(), load_density_law(),
/// load_path_library() and check(DigObjective); (bad_input) if neither a kit has the law or the
/// library nor is one shipped
DigCycleSettings cycle_settings(const CycleSources& sources = {});

}  // namespace excavplan
