// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/reach_figure.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <excavplan/kit/workspace.hpp>
#include <excavplan/machine/kinematics.hpp>

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

/// Whether the tip comes to a place at some angle of the bucket.
bool is_reached(const Machine& machine, double x, double z) {
  constexpr int angles = 36;
  const auto& limits = machine.limits[2];
  for (int i = 0; i <= angles; ++i) {
    const double bucket = limits.lower + (limits.upper - limits.lower) * i / angles;
    const auto joints = inverse_kinematics_fixed_bucket(machine, x, z, bucket);
    if (std::holds_alternative<JointAngles>(joints)) return true;
  }
  return false;
}

/// In grey, row by row: where the tip comes, but in no digging posture.
void draw_reached(Panel& panel, const Machine& machine, const Grid& grid) {
  const Style grey = {"none", 0.0, "#c8c8c8"};
  const double cell = grid.cell.x();
  const auto at = [&](Eigen::Index i) { return cell * static_cast<double>(i); };
  const auto is_grey = [&](Eigen::Index row, Eigen::Index col) {
    return col < grid.z.cols() && !std::isfinite(grid.z(row, col)) &&
           is_reached(machine, grid.origin.x() + at(col) + 0.5 * cell,
                      grid.origin.y() + at(row) + 0.5 * cell);
  };
  for (Eigen::Index row = 0; row < grid.z.rows(); ++row) {
    const double low = grid.origin.y() + at(row);
    const double high = low + 1.04 * cell;  // no seam between rows
    for (Eigen::Index col = 0; col < grid.z.cols(); ++col) {
      const Eigen::Index first = col;
      while (is_grey(row, col)) ++col;
      if (col == first) continue;
      const double left = grid.origin.x() + at(first);
      const double right = grid.origin.x() + at(col);
      panel.polygon({{left, low}, {right, low}, {right, high}, {left, high}}, grey);
    }
  }
  panel.polygon({}, {"#888888", 0.5, "#c8c8c8"}, "reached, but not at these angles");
}

/// The furthest, lowest and highest places with what a data sheet calls them.
void label_reach(Panel& panel, const Reach& reach) {
  if (reach.ground > 0.0) {
    panel.label({reach.ground, 0.0}, "reach on the ground " + readable(reach.ground) + " m");
  }
  if (reach.depth > 0.0)
    panel.label(reach.deepest, "digging depth " + readable(reach.depth) + " m");
  panel.label(reach.highest, "cutting height " + readable(reach.height) + " m");
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

/// Of the machine on the ground, half as far as it reaches.
std::string held_text(const Machine& machine, const Reach& reach) {
  const double x = 0.5 * reach.ground;
  const double held = digging_force(machine, {x, 0.0}).held;
  if (!std::isfinite(held)) return "";
  return " On the ground at x = " + readable(x) + " m the machine lifts or slides above " +
         readable(1e-3 * held) + " kN.";
}

}  // namespace

Figure reach_figure(const Machine& machine) {
  const Points outline = reach_outline(machine);
  const Reach reach = reach_of(machine);
  Points farthest = outline;
  farthest.insert(farthest.end(), {reach.deepest, reach.highest});
  const Rectangle all = box_of(farthest);
  const Grid grid = force_grid(machine, all);
  double most = 0.0;
  for (const double force : grid.z.reshaped()) {
    if (std::isfinite(force)) most = std::max(most, force);
  }
  const ColourScale scale = {{}, 0.0, std::max(most, 1e-3)};
  Panel panel("", "x from the swing axis [m]", "z [m]");
  draw_reached(panel, machine, grid);
  panel.map(grid, scale, "");
  panel.line({{all.x_min - 20.0, 0.0}, {all.x_max + 20.0, 0.0}}, {"#6b5335", 1.0}, "ground");
  panel.line(outline, {colours::black, 1.0}, "tip with the bucket in line with the arm");
  const MachineOutline drawn = machine_outline(machine, shown_posture(machine));
  draw_machine(panel, drawn);
  panel.line(drawn.bucket, {"#222222", 1.3});
  label_reach(panel, reach);
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
      "Colours: the largest level force towards the machine that the joints give at the tip, with "
      "the floor of the bucket at −10 to 60 deg to the ground." +
      held_text(machine, reach);
  return figure;
}

}  // namespace excavplan
