// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/measures_figure.hpp"

#include <cmath>

#include <excavplan/kit/workspace.hpp>
#include <excavplan/machine/kinematics.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"
#include "figures/dig_figures.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

JointAngles middle_posture(const Machine& machine) {
  const auto share = [&](std::size_t i, double part) {
    const JointLimits& limits = machine.limits[i];
    return limits.lower + part * (limits.upper - limits.lower);
  };
  return {share(0, 0.35), share(1, 0.35), share(2, 0.35)};
}

std::string range_text(const Machine& machine, Joint joint) {
  const JointLimits& limits = machine.limits[static_cast<std::size_t>(joint)];
  const auto degrees = [](double angle) { return decimals(angle * 180.0 / pi, 0); };
  return std::string(name(joint)) + " " + degrees(limits.lower) + " .. " + degrees(limits.upper);
}

std::string place_text(const Vector2d& at) {
  return "(" + readable(at.x()) + ", " + readable(at.y()) + ")";
}

/// Where the link comes to at the ends of the range of its joint.
void draw_range(Panel& panel, const Vector2d& pin, double before, const JointLimits& limits,
                double radius) {
  constexpr int steps = 40;
  Points arc;
  for (int i = 0; i <= steps; ++i) {
    const double angle = before - limits.lower - (limits.upper - limits.lower) * i / steps;
    arc.push_back(pin + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  panel.line(arc, {colours::blue, 1.2}, "range of the link");
  panel.strokes({pin, arc.front(), pin, arc.back()}, {colours::blue, 0.6});
}

Panel front_panel(const Machine& machine) {
  Panel panel("Pins and lengths [m]", "x from the swing axis [m]", "z [m]");
  const JointAngles joints = middle_posture(machine);
  const LinkPositions at = link_positions(machine, joints);
  const MachineOutline drawn = machine_outline(machine, joints);
  draw_machine(panel, drawn);
  panel.line(drawn.bucket, {"#222222", 1.3});
  draw_range(panel, machine.boom_pin, 0.0, machine.limits[0], 0.3 * machine.boom_length);
  draw_range(panel, at.arm_pin, at.phi1, machine.limits[1], 0.45 * machine.arm_length);
  draw_range(panel, at.bucket_pin, at.phi2, machine.limits[2], 0.6 * machine.bucket_length);
  const Points pins = {machine.boom_pin, at.arm_pin, at.bucket_pin, at.tip};
  panel.line(pins, {colours::vermilion, 1.2}, "from pin to pin");
  panel.dots(pins, 2.0, {colours::black, 0.5, colours::orange}, "pins and tooth tip");
  const std::array<double, 3> lengths = {machine.boom_length, machine.arm_length,
                                         machine.bucket_length};
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    panel.label(0.5 * (pins[i] + pins[i + 1]), decimals(lengths[i], 2));
  }
  const Rectangle all = panel.shown();
  const double room = 0.05 * machine.full_length();
  panel.line({{all.x_min - room, 0.0}, {all.x_max + room, 0.0}}, {"#6b5335", 1.0}, "ground");
  panel.view({all.x_min - room, all.y_min - room, all.x_max + room, all.y_max + room});
  panel.equal_aspect();
  return panel;
}

Panel bucket_panel(const Machine& machine) {
  Panel panel("Bucket", "from its pin to the tip [m]", "across [m]");
  const Points& profile = machine.bucket.profile;
  panel.polygon(profile, {"#222222", 1.3, "#e8e4dc"});
  panel.line({{0.0, 0.0}, {machine.bucket_length, 0.0}}, {colours::vermilion, 1.2},
             "from pin to pin");
  panel.dots({{0.0, 0.0}, profile.front()}, 2.0, {colours::black, 0.5, colours::orange},
             "pins and tooth tip");
  for (std::size_t i = 1; i < profile.size(); ++i) panel.label(profile[i], place_text(profile[i]));
  panel.equal_aspect();
  return panel;
}

}  // namespace

Figure measures_figure(const Machine& machine) {
  Figure figure;
  figure.title = "Measures of " + machine.name;
  figure.rows = {{front_panel(machine), bucket_panel(machine)}};
  figure.note =
      "Boom pin at " + place_text(machine.boom_pin) +
      " m. Ranges in deg, from the link before, down and in: " + range_text(machine, Joint::boom) +
      ", " + range_text(machine, Joint::arm) + ", " + range_text(machine, Joint::bucket) +
      ". Bucket " + readable(machine.bucket.width_outside) + " m wide, " +
      readable(heaped_capacity(machine)) + " m3 heaped, its floor at " +
      decimals(machine.beta() * 180.0 / pi, 0) + " deg to the line from tip to pin.";
  return figure;
}

}  // namespace excavplan
