// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/across_tracks.hpp"

#include <cmath>

namespace excavplan {

namespace {

/// Of a machine whose front looks to a side, as that side lies.
Attitude turned_to_side(const Attitude& attitude, bool to_left) {
  const Eigen::Vector3d up = attitude.up();
  const double side = to_left ? 1.0 : -1.0;
  return {std::atan2(-side * up.x(), up.z()), std::asin(-side * up.y())};
}

}  // namespace

bool is_across(double swung) { return std::abs(std::sin(swung)) > std::abs(std::cos(swung)); }

Machine looking(Machine machine, double swung) {
  if (!is_across(swung)) return machine;
  const double half = 0.5 * machine.undercarriage_width();
  machine.tail_radius = machine.tail_swing_radius();  // before its front is another one
  if (machine.body) {
    machine.body->front_edge *= side_edge;
    machine.body->rear_edge = -machine.body->front_edge;
  }
  machine.track_width = 2.0 * machine.track_front;
  machine.track_front = half;
  if (machine.swing) {
    machine.swing->lower -= swung;
    machine.swing->upper -= swung;
  }
  if (!machine.attitude.is_level())
    machine.attitude = turned_to_side(machine.attitude, std::sin(swung) > 0.0);
  return machine;
}

}  // namespace excavplan
