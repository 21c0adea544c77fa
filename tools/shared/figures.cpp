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

struct ZoneStyle {
  const char* name;
  Style outline;
};

ZoneStyle style_of(ZoneKind kind) {
  switch (kind) {
    case ZoneKind::dig:
      return {"hole", {"#000000", 2.0}};
    case ZoneKind::spill:
      return {"spill", {"#009e73", 2.0}};
    case ZoneKind::dump:
      return {"heap", {"#e69f00", 2.0}};
    case ZoneKind::other:
      break;
  }
  return {"other change, excluded", {"#777777", 1.0}};
}

/// Borders between the cells of one zone and all others, as strokes.
Points outline(const AreaChange& area, int zone) {
  const Eigen::Index rows = area.zone.rows();
  const Eigen::Index cols = area.zone.cols();
  const auto inside = [&](Eigen::Index row, Eigen::Index col) {
    return row >= 0 && row < rows && col >= 0 && col < cols && area.zone(row, col) == zone;
  };
  const auto corner = [&](Eigen::Index row, Eigen::Index col) -> Eigen::Vector2d {
    return area.difference.origin +
           area.difference.cell_size *
               Eigen::Vector2d(static_cast<double>(col), static_cast<double>(row));
  };
  Points strokes;
  for (Eigen::Index row = 0; row <= rows; ++row) {
    for (Eigen::Index col = 0; col <= cols; ++col) {
      const bool here = inside(row, col);
      if (here != inside(row - 1, col)) {
        strokes.insert(strokes.end(), {corner(row, col), corner(row, col + 1)});
      }
      if (here != inside(row, col - 1)) {
        strokes.insert(strokes.end(), {corner(row, col), corner(row + 1, col)});
      }
    }
  }
  return strokes;
}

/// The largest change inside the zones; without zones the 99th percentile of all cells.
double colour_limit(const VolumeChange& change) {
  double largest = 0.0;
  std::vector<double> all;
  for (const AreaChange& area : change.areas) {
    for (Eigen::Index i = 0; i < area.difference.z.size(); ++i) {
      const double value = std::abs(area.difference.z(i));
      if (!std::isfinite(value)) continue;
      all.push_back(value);
      if (area.zone(i) >= 0) largest = std::max(largest, value);
    }
  }
  if (largest == 0.0 && !all.empty()) {
    const auto place =
        all.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), place, all.end());
    largest = *place;
  }
  return round_up(largest);
}

void draw_zones(Panel& panel, const VolumeChange& change, const AreaChange& area) {
  for (std::size_t i = 0; i < change.zones.size(); ++i) {
    const ChangeZone& zone = change.zones[i];
    const int index = static_cast<int>(i);
    if (!(area.zone == index).any()) continue;
    const ZoneStyle style = style_of(zone.kind);
    panel.strokes(outline(area, index), style.outline, style.name);
    const bool largest_of_kind =
        std::none_of(change.zones.begin(), change.zones.end(), [&](const ChangeZone& other) {
          return other.kind == zone.kind &&
                 std::abs(other.volume.value) > std::abs(zone.volume.value);
        });
    if (zone.kind == ZoneKind::other || (zone.kind == ZoneKind::spill && !largest_of_kind))
      continue;
    const Eigen::Vector2d middle((zone.extent.x_min + zone.extent.x_max) / 2.0,
                                 (zone.extent.y_min + zone.extent.y_max) / 2.0);
    panel.label(middle,
                std::string(style.name) + ' ' + readable(std::abs(zone.volume.value)) + " m³");
  }
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

std::string height_change_figure(const VolumeChange& change,
                                 const std::vector<std::string>& notes) {
  Figure figure;
  figure.title = "Height change of the ground";
  figure.notes = notes;
  const double limit = colour_limit(change);
  figure.colour_bar = ColourBar{limit, "height after − before [m]"};
  for (std::size_t i = 0; i < change.areas.size(); ++i) {
    const AreaChange& area = change.areas[i];
    const std::string title =
        change.areas.size() == 1 ? "whole scene" : (i == 0 ? "dig area" : "dump area");
    Panel panel(title + ", seen from above", "x [m]", "y [m]");
    panel.heat_map(area.difference, limit);
    draw_zones(panel, change, area);
    figure.panels.push_back(panel);
  }
  return to_svg(figure);
}

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
