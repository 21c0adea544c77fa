// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/figures.hpp"

#include <algorithm>
#include <cmath>

#include "shared/plot.hpp"
#include "shared/quantity.hpp"

namespace excavplan::tools {
namespace {

// Okabe and Ito's colours, distinct for colour-blind readers too.
const char* colour(DigPhase phase) {
  switch (phase) {
    case DigPhase::approach:
      return "#777777";
    case DigPhase::penetrate:
      return "#d55e00";
    case DigPhase::drag:
      return "#0072b2";
    case DigPhase::scoop:
      return "#009e73";
    case DigPhase::lift:
      return "#cc79a7";
  }
  return "#000000";
}

Points bucket_outline(const Machine& machine, const DigPose& pose) {
  const LinkPositions links = link_positions(machine, pose.joints);
  Points outline;
  for (const Eigen::Vector2d& corner : machine.bucket.profile) {
    outline.push_back(bucket_point(links, corner));
  }
  return outline;
}

/// The first pose, the last of each phase and one in the middle of the drag.
std::vector<std::size_t> shown_poses(const DigPath& path) {
  std::vector<std::size_t> shown = {0};
  std::size_t start = 0;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    if (i + 1 < path.poses.size() && path.poses[i + 1].phase == path.poses[i].phase) continue;
    if (path.poses[i].phase == DigPhase::drag) shown.push_back((start + i) / 2);
    shown.push_back(i);
    start = i + 1;
  }
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
  return shown;
}

/// All that the dig touches: tip and bucket at every pose, and the ground above the deepest point.
Rectangle dig_extent(const Machine& machine, const DigPath& path) {
  Rectangle extent{path.start_x, path.ground_z, path.start_x, path.ground_z};
  for (const DigPose& pose : path.poses) {
    for (const Eigen::Vector2d& corner : bucket_outline(machine, pose)) {
      extent.x_min = std::min(extent.x_min, corner.x());
      extent.x_max = std::max(extent.x_max, corner.x());
      extent.y_min = std::min(extent.y_min, corner.y());
      extent.y_max = std::max(extent.y_max, corner.y());
    }
  }
  return {extent.x_min - 0.5, extent.y_min - 0.35, extent.x_max + 0.5, extent.y_max + 0.35};
}

/// Soil under a profile, filled down to the lower border of the view; unknown ground is left out.
void draw_ground(Panel& panel, const GroundProfile& profile, const Rectangle& view,
                 const Style& style, const std::string& legend) {
  constexpr int samples = 800;
  Points surface;
  const auto close = [&] {
    if (surface.size() > 1) {
      Points soil = surface;
      soil.emplace_back(surface.back().x(), view.y_min);
      soil.emplace_back(surface.front().x(), view.y_min);
      panel.polygon(soil, {"none", 0.0, style.fill}, "");
      panel.line(surface, {style.stroke, style.width}, legend);
    }
    surface.clear();
  };
  for (int i = 0; i <= samples; ++i) {
    const double x = view.x_min + (view.x_max - view.x_min) * i / samples;
    const double z = profile(x);
    if (std::isfinite(z)) {
      surface.emplace_back(x, z);
    } else {
      close();
    }
  }
  close();
}

void draw_tip_path(Panel& panel, const DigPath& path) {
  Points stretch;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const DigPose& pose = path.poses[i];
    stretch.emplace_back(pose.bucket.x, pose.bucket.z);
    const bool last = i + 1 == path.poses.size();
    if (!last && path.poses[i + 1].phase == pose.phase) continue;
    panel.line(stretch, {colour(pose.phase), 3.0}, std::string("tip, ") + name(pose.phase));
    stretch = {stretch.back()};
  }
}

}  // namespace

std::string dig_figure(const Machine& machine, const DigPath& path, const DigSection& ground,
                       const std::string& title, const std::vector<std::string>& notes) {
  Panel panel("section in the boom plane", "x, from the swing axis [m]", "z [m]");
  const Rectangle view = dig_extent(machine, path);
  panel.view(view);
  draw_ground(panel, ground.before, view, {"#9a7b4f", 1.5, "#f1e6d2"}, "ground before");
  if (ground.after) {
    draw_ground(panel, ground.after, view, {"#4d3319", 2.0, "#d9c19a"}, "ground after");
  }
  const LinkPositions links = link_positions(machine, path.poses.front().joints);
  panel.line({machine.boom_pin, links.arm_pin, links.bucket_pin, links.tip},
             {"#8a8a8a", 6.0, "none", 0.45}, "boom, arm, bucket at the start");
  for (const std::size_t i : shown_poses(path)) {
    panel.polygon(bucket_outline(machine, path.poses[i]),
                  {colour(path.poses[i].phase), 1.2, "none", 0.8});
  }
  draw_tip_path(panel, path);
  const Eigen::Vector2d start(path.start_x, path.ground_z);
  panel.marker(start, "#000000", "start, x = " + readable(path.start_x) + " m");

  Figure figure;
  figure.title = title;
  figure.panels = {panel};
  figure.notes = notes;
  return to_svg(figure);
}

}  // namespace excavplan::tools
