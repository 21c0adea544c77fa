// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "kit/fitted_cylinders.hpp"

#include <cmath>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "machine/machine_mass.hpp"

namespace excavplan {
namespace {

using nlohmann::json;

PolarPin scaled(const PolarPin& pin, double size, double turn) {
  return {size * pin.distance, std::remainder(pin.angle + turn, 2.0 * pi)};
}

/// @param turn  of the pins on the link after the joint
CylinderGeometry scaled(CylinderGeometry geometry, double size, double turn) {
  geometry.foot = scaled(geometry.foot, size, 0.0);
  if (auto* rod = std::get_if<PolarPin>(&geometry.rod)) *rod = scaled(*rod, size, turn);
  if (auto* bars = std::get_if<FourBar>(&geometry.rod)) {
    bars->rocker = {scaled(bars->rocker.pin, size, 0.0), size * bars->rocker.length};
    bars->link = {scaled(bars->link.pin, size, turn), size * bars->link.length};
  }
  return geometry;
}

json pin_json(const PolarPin& pin) {
  return {{"distance_m", pin.distance}, {"angle_rad", pin.angle}};
}

json bar_json(const Bar& bar) {
  json file = pin_json(bar.pin);
  file["length_m"] = bar.length;
  return file;
}

json cylinder_json(const CylinderGeometry& geometry) {
  json file = {{"count", geometry.count}, {"foot", pin_json(geometry.foot)}};
  if (const auto* rod = std::get_if<PolarPin>(&geometry.rod)) file["rod"] = pin_json(*rod);
  if (const auto* bars = std::get_if<FourBar>(&geometry.rod)) {
    file["rocker"] = bar_json(bars->rocker);
    file["link"] = bar_json(bars->link);
  }
  return file;
}

double middle(const JointLimits& limits) { return 0.5 * (limits.lower + limits.upper); }

json cylinders_json(const Machine& like, const Machine& machine) {
  const double front =
      (machine.boom_length + machine.arm_length) / (like.boom_length + like.arm_length);
  const std::array<double, 3> sizes = {front, front, machine.bucket_length / like.bucket_length};
  json all;
  for (const Joint joint : {Joint::boom, Joint::arm, Joint::bucket}) {
    const auto i = static_cast<std::size_t>(joint);
    const JointLimits& limits = machine.limits[i];
    const CylinderGeometry geometry =
        scaled((*like.cylinders)[i].geometry(), sizes[i], middle(limits) - middle(like.limits[i]));
    const Cylinder moves(geometry, limits.lower, limits.upper);  // or it throws
    all[name(joint)] = cylinder_json(moves.geometry());
  }
  return all;
}

const Machine* nearest_with_cylinders(const std::vector<const Proportioned*>& known, double mass) {
  const Machine* nearest = nullptr;
  double least = 0.0;
  for (const Proportioned* each : known) {
    const double apart = std::abs(std::log(*each->sheet.operating_mass / mass));
    if (!each->file.machine.cylinders || (nearest != nullptr && apart >= least)) continue;
    nearest = &each->file.machine;
    least = apart;
  }
  return nearest;
}

}  // namespace

void add_cylinders(const std::vector<const Proportioned*>& known, const Machine& machine,
                   nlohmann::json& file) {
  const double mass = total_mass(machine);
  const Machine* like = nearest_with_cylinders(known, mass);
  json& source = file["sources"]["cylinders"];
  source = "none: no machine that this one is fitted from states them";
  if (like == nullptr) return;
  try {
    file["cylinders"] = cylinders_json(*like, machine);
    source = "fitted: those of " + like->name + " in the size of front and bucket; spread unknown";
  } catch (const Error& error) {
    source = "none: those of " + like->name + " do not turn this far: " + error.what();
  }
}

}  // namespace excavplan
