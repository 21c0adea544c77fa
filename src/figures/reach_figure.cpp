// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/reach_figure.hpp"

#include <cmath>

#include <excavplan/kit/workspace.hpp>

#include "base/parallel.hpp"
#include "base/text.hpp"
#include "figures/dig_figures.hpp"

namespace excavplan {
namespace {

/// The largest force towards the machine that the joints give at the tip [kN], on cells over all
/// that it reaches.
Grid force_grid(const Machine& machine, const Rectangle& all) {
  constexpr double across = 70.0;  // cells
  const double cell = (all.x_max - all.x_min) / across;
  const auto rows = static_cast<Eigen::Index>(std::ceil((all.y_max - all.y_min) / cell));
  const auto cols = static_cast<Eigen::Index>(across);
  Grid grid{{all.x_min, all.y_min}, {cell, cell}, Eigen::ArrayXXd(rows, cols)};
  parallel_for(static_cast<std::size_t>(rows), 0, [&](std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (Eigen::Index col = 0; col < cols; ++col) {
      const Eigen::Vector2d tip(all.x_min + (static_cast<double>(col) + 0.5) * cell,
                                all.y_min + (static_cast<double>(row) + 0.5) * cell);
      grid.z(row, col) = 1e-3 * digging_force(machine, tip).joints;
    }
  });
  return grid;
}

Rectangle box_of(const Points& points) {
  Rectangle all{points[0].x(), points[0].y(), points[0].x(), points[0].y()};
  for (const Eigen::Vector2d& point : points) {
    all.x_min = std::min(all.x_min, point.x());
    all.x_max = std::max(all.x_max, point.x());
    all.y_min = std::min(all.y_min, point.y());
    all.y_max = std::max(all.y_max, point.y());
  }
  return all;
}

/// With the boom in the middle of its range and the bucket ahead on the ground.
JointAngles shown_posture(const Machine& machine) {
  const auto& limits = machine.limits;
  const auto share = [&](std::size_t joint, double part) {
    return limits[joint].lower + part * (limits[joint].upper - limits[joint].lower);
  };
  return {share(0, 0.35), share(1, 0.4), share(2, 0.35)};
}

/// On the ground, half as far as it reaches.
std::string held_text(const Machine& machine) {
  const double x = 0.5 * reach_of(machine).ground;
  const double held = digging_force(machine, {x, 0.0}).held;
  if (!std::isfinite(held)) return ".";
  return "; at x = " + readable(x) + " m on the ground " + readable(1e-3 * held) +
         " kN lift or drag the machine.";
}

}  // namespace

Figure reach_figure(const Machine& machine) {
  const Points outline = reach_outline(machine);
  const Rectangle all = box_of(outline);
  const Grid grid = force_grid(machine, all);
  double most = 0.0;
  for (const double force : grid.z.reshaped()) {
    if (std::isfinite(force)) most = std::max(most, force);
  }
  const ColourScale scale = {{}, 0.0, std::max(most, 1e-3)};
  Panel panel("", "x from the swing axis [m]", "z [m]");
  panel.map(grid, scale, "no digging posture");
  panel.line({{all.x_min - 20.0, 0.0}, {all.x_max + 20.0, 0.0}}, {"#6b5335", 1.0}, "ground");
  panel.line(outline, {colours::black, 1.0}, "tip with the bucket in line with the arm");
  const MachineOutline drawn = machine_outline(machine, shown_posture(machine));
  draw_machine(panel, drawn);
  panel.line(drawn.bucket, {"#222222", 1.3});
  const double tail = box_of(drawn.house).x_min;
  const double room = 0.03 * (all.x_max - all.x_min);
  panel.view(
      {std::min(all.x_min, tail) - room, all.y_min - room, all.x_max + room, all.y_max + room});
  panel.equal_aspect();
  Figure figure;
  figure.title = "Reach and digging force of " + machine.name;
  figure.rows = {{panel}};
  figure.colour_bar = ColourBar{scale, "digging force of the tip, level [kN]"};
  figure.note =
      "The largest force towards the machine that the joints give with the floor of the bucket at "
      "-10 to 60 deg" +
      held_text(machine);
  return figure;
}

}  // namespace excavplan
