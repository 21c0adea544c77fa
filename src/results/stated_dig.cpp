// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/results/stated_dig.hpp>

#include <vector>

#include "base/files.hpp"
#include "base/json.hpp"

namespace excavplan {
namespace {

constexpr double most_angle = 3.2;      // [rad]
constexpr double most_length = 1000.0;  // [m]
constexpr double most_work = 1e12;      // [J]

}  // namespace

StatedDig stated_dig(const std::string& file) {
  JsonObject result = JsonObject::of_others(file, read_file(file));
  const std::string tool = result.text_or("tool", "plan-path");
  if (tool != "plan-path" && tool != "simulate-dig") {
    result.fail("tool", "is of " + tool + ", expected a result of plan-path or simulate-dig");
  }
  if (!result.states("path")) result.fail("path", "is not there: the result has no dig");
  JsonObject path = result.object("path");
  StatedDig dig;
  dig.path.penetration_angle = path.number("penetration_angle_rad", -most_angle, most_angle);
  dig.path.penetration_length = path.number("penetration_length_m", 0.0, most_length);
  dig.path.drag_length = path.number("drag_length_m", 0.0, most_length);
  if (path.states("start_x_m")) {
    dig.start_x = path.number("start_x_m", -most_length, most_length);
  }
  if (result.states("dump_at_m")) {
    const std::vector<double> at = result.numbers("dump_at_m", 2);
    dig.dump_at = Eigen::Vector2d(at[0], at[1]);
  }
  dig.is_plan = tool == "plan-path";
  dig.density_percent = result.number("density_percent", 0.0, 100.0);
  dig.joint_work = 1000.0 * result.number("energy_kj", 0.0, most_work);
  if (result.states("stalled")) dig.stalled = result.flag("stalled");
  return dig;
}

}  // namespace excavplan
