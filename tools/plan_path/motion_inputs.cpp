// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/motion_inputs.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include <excavplan/base/warning.hpp>

#include <excavplan/machine/joint_motion.hpp>
#include <excavplan/planning/plan_motion.hpp>
#include <excavplan/planning/standing_ground.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/files.hpp"
#include "base/text.hpp"
#include "inputs/found_pose.hpp"

namespace excavplan::tools {
namespace {

struct Format {
  const char* word;
  std::vector<std::string> endings;
  std::string (*text)(const Trajectory& trajectory);
};

const std::vector<Format>& formats() {
  static const std::vector<Format> rows = {{"csv", {".csv", ""}, to_csv},
                                           {"json", {".json"}, to_json},
                                           {"yaml", {".yaml", ".yml"}, to_joint_trajectory},
                                           {"com3", {".com3"}, to_joint_commands}};
  return rows;
}

std::vector<std::string> words() {
  std::vector<std::string> list = {"ending"};
  for (const Format& format : formats()) list.emplace_back(format.word);
  return list;
}

std::vector<std::string> endings() {
  std::vector<std::string> list;
  for (const Format& format : formats()) {
    list.insert(list.end(), format.endings.begin(), format.endings.end());
  }
  return list;
}

const Format& format_of(const MotionInputs& inputs) {
  const std::string ending =
      *inputs.file == "-" ? ""
                          : small_letters(std::filesystem::path(*inputs.file).extension().string());
  for (const Format& format : formats()) {
    if (inputs.format == format.word) return format;
    if (inputs.format != "ending") continue;
    for (const std::string& each : format.endings) {
      if (each == ending) return format;
    }
  }
  return formats().front();
}

const std::string joints_option = "--joints";

FrontJoints parse_list(const std::vector<std::string>& parts) {
  FrontJoints joints = FrontJoints::Zero();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    joints[static_cast<Eigen::Index>(i)] = parse_quantity(joints_option, parts[i], Quantity::angle);
  }
  return joints;
}

std::string names_of(const RobotJoints& joints) {
  std::string text;
  for (const RobotJoint& joint : joints) {
    if (!joint.name.empty()) text += (text.empty() ? "" : ", ") + joint.name;
  }
  return text;
}

/// @param parts  NAME=ANGLE, in any order, in the names and angles of the robot
FrontJoints parse_named(const std::vector<std::string>& parts, const RobotJoints& robot) {
  std::array<std::optional<double>, 4> given;
  for (const std::string& part : parts) {
    const std::size_t equal = part.find('=');
    const std::string name = part.substr(0, equal);
    const auto joint = std::find_if(robot.begin(), robot.end(), [&](const RobotJoint& each) {
      return !name.empty() && each.name == name;
    });
    if (equal == std::string::npos || joint == robot.end()) {
      usage_error(joints_option + ": '" + part +
                  "' is not NAME=ANGLE of a joint of the machine: " + names_of(robot));
    }
    auto& angle = given[static_cast<std::size_t>(joint - robot.begin())];
    if (angle) usage_error(joints_option + ": " + name + " is given twice");
    angle = joint->to_ours(parse_quantity(joints_option, part.substr(equal + 1), Quantity::angle));
  }
  FrontJoints joints = FrontJoints::Zero();
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!given[i] && !robot[i].name.empty()) {
      usage_error(joints_option + ": there is no angle of " + robot[i].name);
    }
    joints[static_cast<Eigen::Index>(i)] = given[i].value_or(0.0);
  }
  return joints;
}

std::optional<FrontJoints> joints_of(const MotionInputs& inputs, const Machine& machine) {
  if (!inputs.joints) return std::nullopt;
  const std::vector<std::string> parts = split(*inputs.joints, ',');
  if (inputs.joints->find('=') != std::string::npos) {
    return parse_named(parts, machine.robot_joints);
  }
  if (parts.size() < 3 || parts.size() > 4) {
    usage_error(joints_option + ": '" + *inputs.joints +
                "' is not BOOM,ARM,BUCKET or BOOM,ARM,BUCKET,SWING such as -40deg,90deg,40deg, "
                "nor NAME=ANGLE of each joint");
  }
  return parse_list(parts);
}

const OptionNames option_names = {{"joints at the start", joints_option},
                                  {"cycle: swing", "--swing"},
                                  {"MotionOptions::rate", "--rate"},
                                  {"MotionOptions::max_jerk", "--max-jerk"}};

/// Without points, and a warning, where the ground is in the way: the plan is worth having still.
Trajectory motion_of(const MotionInputs& inputs, const PlannedMotion& planned) {
  auto motion = plan_motion(
      planned.machine, planned.ground.ground, planned.plan,
      {joints_of(inputs, planned.machine), inputs.whole_cycle, planned.objective}, inputs.options);
  if (auto* made = std::get_if<Trajectory>(&motion)) {
    if (made->plan) made->plan->pose = planned.ground.pose;
    return std::move(*made);
  }
  const auto* stop = std::get_if<BlockedWay>(&motion);
  Trajectory none = {planned.machine.name, {}, planned.machine.robot_joints};
  none.warnings = {{WarningCode::no_motion,
                    "the plan has no motion: the ground is in the way: " + stop->message}};
  return none;
}

void add(const std::vector<Warning>& warnings, Outcome& outcome) {
  outcome.warnings.insert(outcome.warnings.end(), warnings.begin(), warnings.end());
  if (any_ends_trust(warnings)) outcome.trustworthy = false;
  outcome.json["trustworthy"] = outcome.trustworthy;
}

TerrainInput surroundings_of(const MotionInputs& inputs, const TerrainInput& terrain) {
  TerrainInput around = terrain;
  around.cloud = inputs.surroundings;
  around.option = "--surroundings";
  return around;
}

void check(const MotionInputs& inputs, const Machine& machine, const CycleOptions& cycle) {
  if (!inputs.file) return;
  naming_options(option_names, [&] {
    excavplan::check(inputs.options);
    excavplan::check(machine,
                     CycleWayOptions{joints_of(inputs, machine), inputs.whole_cycle, cycle});
  });
}

}  // namespace

void declare_motion(Arguments& arguments, MotionInputs& inputs) {
  arguments.file(
      "surroundings", inputs.surroundings,
      "earlier cloud, or scan of a recording, of the ground around and under the machine, for what "
      "--terrain does not see; in its frame and unit");
  arguments.output("trajectory", inputs.file,
                   "write the joint motion: .csv, .json, .yaml or .yml (ROS 2 JointTrajectory), "
                   ".com3 (OPERA's JointCmd); - is standard output, as CSV");
  arguments.require_ending(endings(), [&inputs] { return inputs.format == "ending"; });
  arguments.allow_standard_output();
  arguments.only_if(
      {[&inputs] { return inputs.file.has_value(); }, "no --trajectory is written"}, [&] {
        arguments.choice("trajectory-format", inputs.format, words(),
                         "format of the trajectory; ending: that of its file's name");
        Arguments::Entry joints;
        joints.name = "joints";
        joints.placeholder = "BOOM,ARM,BUCKET[,SWING]|NAME=ANGLE,...";
        joints.help =
            "present joints, from which the trajectory begins; swing to the left of the plane of "
            "the dig, 0 if left out; angles as in the CSV, or with names as in /joint_states: "
            "those of the robot [rad]";
        joints.assign = [&inputs](const std::string& text) { inputs.joints = text; };
        arguments.add(joints);
        arguments.flag("whole-cycle", inputs.whole_cycle,
                       "go on over swing, dump and back to above the dig");
        arguments.option("rate", inputs.options.rate, Quantity::frequency,
                         "points of the trajectory per second, 10 .. 500");
        Arguments::Entry jerk;
        jerk.name = "max-jerk";
        jerk.placeholder = "NUMBER";
        jerk.help = "largest jerk of every joint, at least 0.1; without it none is set [rad/s^3]";
        jerk.assign = [&inputs](const std::string& text) {
          inputs.options.max_jerk = parse_quantity("--max-jerk", text, Quantity::ratio);
        };
        arguments.add(jerk);
      });
}

MotionGround motion_ground(const MotionInputs& inputs, const Machine& machine,
                           const TerrainInput& terrain, const CycleOptions& cycle) {
  check(inputs, machine, cycle);
  if (inputs.surroundings && !terrain.cloud) usage_error("--surroundings needs --terrain");
  MotionGround ground{level_swing_ground(machine)};
  if (terrain.cloud) ground.known_by = "as scanned";
  if (terrain.frame) {
    ground.pose = Eigen::Isometry3d(frame_named("--terrain-frame", *terrain.frame)).inverse();
  }
  if (!terrain.attitude.is_level()) ground.pose.rotate(terrain.attitude.to_site());
  if (!terrain.cloud) return ground;
  ground.ground = make_swing_ground(terrain, machine);
  if (!inputs.surroundings) return ground;
  ScannedTerrain both = with_surroundings(
      ground.ground, make_swing_ground(surroundings_of(inputs, terrain), machine));
  ground.ground = std::move(both.terrain);
  ground.warnings = std::move(both.warnings);
  return ground;
}

Site dig_site(const MotionInputs& inputs, const Machine& machine, const TerrainInput& terrain,
              double cell_size) {
  Site site = make_site(terrain, planning_extent(machine), cell_size, inputs.surroundings);
  if (inputs.surroundings && terrain.cloud) {
    add_earlier_obstacles(surroundings_of(inputs, terrain), planning_extent(machine), site.ground);
  }
  return site;
}

void set_standing(const MotionInputs& inputs, const Machine& machine, const TerrainInput& terrain,
                  PlanOptions& options) {
  options.attitude = terrain.attitude;
  if (!terrain.cloud) return;
  options.standing_on = make_standing_ground(terrain, machine);
  if (!inputs.surroundings) return;
  options.standing_on = known_from_both(
      *options.standing_on, make_standing_ground(surroundings_of(inputs, terrain), machine));
}

Trajectory dig_motion(const MotionInputs& inputs, const Machine& machine, const DigPlan& plan) {
  return time_way(machine, way_of(plan.path, plan.torques), inputs.options);
}

void write_motion(const MotionInputs& inputs, const PlannedMotion& planned, Outcome& outcome) {
  const char* const on = planned.ground.known_by;
  outcome.json["ground"] = on;
  if (planned.plan.dig) outcome.lines.push_back(std::string("ground       ") + on);
  add(planned.ground.warnings, outcome);
  if (planned.ground.ground.obstacles.size() > 0) {
    const auto at_dump = naming_options(option_names, [&] {
      return check_dump_place(planned.machine, planned.ground.ground, planned.plan,
                              planned.objective);
    });
    if (at_dump) add({*at_dump}, outcome);
  }
  if (!inputs.file || (!planned.plan.dig && planned.plan.stopped)) return;
  const Trajectory motion =
      naming_options(option_names, [&] { return motion_of(inputs, planned); });
  add(motion.warnings, outcome);
  const Format& format = format_of(inputs);
  const std::string text = format.text(motion);
  if (*inputs.file == "-") {
    outcome.output = text;
  } else {
    write_file(*inputs.file, text);
  }
  if (motion.points.empty()) return;
  outcome.json["trajectory"] = {{"format", format.word},
                                {"points", motion.points.size()},
                                {"rate_hz", inputs.options.rate},
                                {"duration_s", motion.duration()},
                                {"joint_names", names_of(motion.robot_joints)}};
  if (motion.plan) outcome.json["trajectory"]["plan_id"] = motion.plan->id;
  outcome.lines.push_back("trajectory   " + readable(motion.duration()) + " s, " +
                          std::to_string(motion.points.size()) + " points of " +
                          names_of(motion.robot_joints));
}

}  // namespace excavplan::tools
