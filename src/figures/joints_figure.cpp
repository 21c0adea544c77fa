// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/joints_figure.hpp"

#include <cmath>

#include <excavplan/machine/kinematics.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"
#include "figures/dig_figures.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

Points arc(const Vector2d& pin, double radius, double from, double to) {
  constexpr int steps = 40;
  Points points;
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    points.push_back(pin + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

/// Two strokes at the end of a line.
Points head(const Points& line, double size) {
  const Vector2d& end = line.back();
  const Vector2d back = size * (line[line.size() - 4] - end).normalized();
  const Vector2d side(-back.y(), back.x());
  return {end, end + back + 0.5 * side, end, end + back - 0.5 * side};
}

/// A joint and the link that it turns.
struct DrawnJoint {
  const RobotJoint& robot;
  const JointLimits& limits;
  const Vector2d& pin;
  double before;  ///< direction of the link before [rad]
  double link;    ///< direction of the link [rad]
  double length;  ///< of the link [m]
};

void draw_joint(Panel& panel, const DrawnJoint& joint) {
  const auto& [robot, limits, pin, before, link, length] = joint;
  constexpr double turn = 0.5;  // [rad]
  const double size = 0.07 * length;
  panel.line(arc(pin, 0.45 * length, before - limits.lower, before - limits.upper),
             {colours::blue, 1.2}, "range of the link");
  panel.strokes({pin, pin + 0.45 * length * Vector2d(std::cos(link), std::sin(link))},
                {colours::black, 0.8}, "");
  const Points way = arc(pin, 0.6 * length, link, link - turn * robot.sign);
  panel.line(way, {colours::vermilion, 1.4}, "grows with the angle of the robot");
  panel.strokes(head(way, size), {colours::vermilion, 1.4});
  panel.label(
      pin + 0.75 * length *
                Vector2d(std::cos(link - turn * robot.sign), std::sin(link - turn * robot.sign)),
      robot.name);
}

std::string note_of(const Machine& machine) {
  const char* const words[] = {"boom", "arm", "bucket", "swing"};
  std::string text = "All joints of the robot at zero. Angles of excavplan, in rad: ";
  const char* comma = "";
  for (std::size_t i = 0; i < machine.robot_joints.size(); ++i) {
    const auto& [name, sign, zero] = machine.robot_joints[i];
    if (name.empty()) continue;
    text += comma + std::string(words[i]) + " = " + (sign < 0.0 ? "-" : "") + name;
    comma = ", ";
    if (zero != 0.0) text += (zero < 0.0 ? " - " : " + ") + readable(std::abs(zero));
  }
  const Eigen::Vector3d at = machine.site_from_root.translation();
  const Eigen::Vector3d ahead = machine.site_from_root.linear().transpose().col(0);
  return text + ". Root frame: origin at (" + readable(at.x()) + ", " + readable(at.y()) + ", " +
         readable(at.z()) + ") m; the boom points along (" + readable(ahead.x()) + ", " +
         readable(ahead.y()) + ") of its x and y.";
}

}  // namespace

Figure joints_figure(const Machine& machine) {
  JointAngles zero;
  for (std::size_t i = 0; i < 3; ++i) {
    zero[static_cast<int>(i)] = machine.robot_joints[i].to_ours(0.0);
  }
  const LinkPositions at = link_positions(machine, zero);
  Panel panel("", "x from the swing axis [m]", "z [m]");
  const MachineOutline drawn = machine_outline(machine, zero);
  draw_machine(panel, drawn);
  panel.line(drawn.bucket, {"#222222", 1.3});
  const std::array<Vector2d, 3> pins = {machine.boom_pin, at.arm_pin, at.bucket_pin};
  const std::array<double, 4> directions = {0.0, at.phi1, at.phi2, at.phi3};
  const std::array<double, 3> lengths = {machine.boom_length, machine.arm_length,
                                         machine.bucket_length};
  for (std::size_t i = 0; i < 3; ++i) {
    draw_joint(panel, {machine.robot_joints[i], machine.limits[i], pins[i], directions[i],
                       directions[i + 1], lengths[i]});
  }
  panel.dots({at.tip}, 2.0, {colours::black, 0.5, colours::orange}, "tooth tip");
  const double room = 0.1 * machine.full_length();
  const Rectangle all = panel.shown();
  panel.line({{all.x_min - room, 0.0}, {all.x_max + room, 0.0}}, {"#6b5335", 1.0}, "ground");
  panel.view({all.x_min - room, all.y_min - room, all.x_max + room, all.y_max + room});
  panel.equal_aspect();
  Figure figure;
  figure.title = "Joints of " + machine.name;
  figure.rows = {{panel}};
  figure.note = note_of(machine);
  return figure;
}

}  // namespace excavplan
