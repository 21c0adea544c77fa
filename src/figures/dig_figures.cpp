// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/dig_figures.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"

namespace excavplan {
namespace {

const Style ground_before = {"#a08050", 0.8, "#f3ead9"};
const Style ground_after = {"#4d3319", 1.1, "#d9c19a"};
const Style soil_style = {"#4d3319", 0.7, "#b08a55"};

/// A stretch of x.
struct Along {
  double from;
  double to;
};

void grow(Rectangle& all, const Points& points) {
  for (const Eigen::Vector2d& point : points) {
    all.x_min = std::min(all.x_min, point.x());
    all.x_max = std::max(all.x_max, point.x());
    all.y_min = std::min(all.y_min, point.y());
    all.y_max = std::max(all.y_max, point.y());
  }
}

/// Soil under a profile between two x, down to far below; unknown ground is left out.
void draw_ground(Panel& panel, const Along& along, const GroundProfile& profile, const Style& style,
                 const std::string& legend) {
  constexpr int samples = 1200;
  constexpr double depth = -50.0;  // below any view [m]
  Points surface;
  const auto close = [&] {
    if (surface.size() > 1) {
      Points soil = surface;
      soil.emplace_back(surface.back().x(), depth);
      soil.emplace_back(surface.front().x(), depth);
      panel.polygon(soil, {"none", 0.0, style.fill});
      panel.line(surface, {style.stroke, style.width});
    }
    surface.clear();
  };
  for (int i = 0; i <= samples; ++i) {
    const double x = along.from + (along.to - along.from) * i / samples;
    const double z = profile(x);
    if (std::isfinite(z)) {
      surface.emplace_back(x, z);
    } else {
      close();
    }
  }
  close();
  panel.polygon({}, style, legend);
}

void draw_grounds(Panel& panel, const DugDig& dug, const Along& along) {
  draw_ground(panel, along, dug.before, ground_before, "ground before");
  if (dug.after) {
    draw_ground(panel, along, dug.after, ground_after, "ground after");
  }
}

/// The level that the machine stands on, as far as the ground there is not known.
void draw_standing_place(Panel& panel, const DugDig& dug, double from, double to) {
  constexpr double step = 0.02;  // [m]
  double known = from;
  while (known < to && !std::isfinite(dug.before(known))) known += step;
  known += step;  // under what is known: no seam
  panel.polygon({{from, 0.0}, {known, 0.0}, {known, -50.0}, {from, -50.0}},
                {"none", 0.0, ground_after.fill});
  panel.line({{from, 0.0}, {known, 0.0}}, {ground_after.stroke, ground_after.width});
}

/// The pose at which a dig ended early; else the last of the path.
std::size_t last_pose(const DugDig& dug) {
  const std::size_t last = dug.path.poses.size() - 1;
  return dug.dig.stall ? std::min(last, dug.dig.history.size()) : last;
}

/// By phase as far as it was dug.
void draw_tip_path(Panel& panel, const DugDig& dug) {
  const std::vector<DigPose>& poses = dug.path.poses;
  const std::size_t end = last_pose(dug);
  Points stretch;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    stretch.emplace_back(poses[i].bucket.x, poses[i].bucket.z);
    const bool last = i + 1 == poses.size();
    const bool goes_on = i != end && !last && (i > end || poses[i + 1].phase == poses[i].phase);
    if (goes_on) continue;
    if (i <= end) {
      panel.line(stretch, phase_style(poses[i].phase), std::string("tip, ") + name(poses[i].phase));
    } else {
      panel.line(stretch, {"#9a9a9a", 0.9, "none", 1.0, {2.0, 2.0}}, "path not dug");
    }
    stretch = {stretch.back()};
  }
}

/// "the front of the machine lifts"
std::string end_text(const Stall& stall) {
  switch (stall.cause) {
    case Stall::Cause::torque:
      return std::string("the ") + name(stall.joint) + " stalls";
    case Stall::Cause::front_lifts:
      return "the front of the machine lifts";
    case Stall::Cause::rear_lifts:
      return "the rear of the machine lifts";
    case Stall::Cause::slides:
      return "the machine slides";
  }
  return {};
}

/// Soil in the bucket at a pose; that of the payload once it is lifted.
double fill_at(const DugDig& dug, std::size_t pose) {
  const std::vector<ForceSample>& history = dug.dig.history;
  if (pose == 0 || history.empty()) return 0.0;
  return pose <= history.size() ? history[pose - 1].bucket_fill : dug.dig.payload_volume;
}

/// Whether two buckets would cover one another.
bool looks_alike(const BucketPose& a, const BucketPose& b) {
  return std::hypot(b.x - a.x, b.z - a.z) < 0.1 && std::abs(b.floor_angle - a.floor_angle) < 0.1;
}

/// The last pose of each phase that was dug, but for those that the next covers.
std::vector<std::size_t> ends_of_phases(const DugDig& dug) {
  std::vector<std::size_t> ends;
  const std::vector<DigPose>& poses = dug.path.poses;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].phase == DigPhase::lift || i > dug.dig.history.size()) break;
    const bool last = i + 1 == poses.size() || i == dug.dig.history.size();
    if (!last && poses[i + 1].phase == poses[i].phase) continue;
    if (!ends.empty() && looks_alike(poses[ends.back()].bucket, poses[i].bucket)) ends.pop_back();
    ends.push_back(i);
  }
  return ends;
}

void draw_bucket(Panel& panel, const DugDig& dug, std::size_t pose, const Style& wall) {
  const JointAngles& joints = dug.path.poses[pose].joints;
  const Points shell = bucket_outline(dug.machine, joints);
  const Points soil = soil_in_bucket(dug.machine, joints, fill_at(dug, pose));
  if (!soil.empty()) panel.polygon(soil, soil_style, "soil in the bucket");
  panel.line(shell, wall);
}

/// Of its corners: inside a convex outline.
Eigen::Vector2d middle_of(const Points& outline) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : outline) sum += corner;
  return sum / static_cast<double>(outline.size());
}

/// The pose at which the machine is drawn: as the dig ends, before the bucket is lifted.
std::size_t shown_pose(const DugDig& dug) {
  const std::vector<std::size_t> ends = ends_of_phases(dug);
  return ends.empty() ? 0 : ends.back();
}

Panel machine_panel(const DugDig& dug) {
  Panel panel("machine", "x from the swing axis [m]", "z [m]");
  const std::size_t pose = shown_pose(dug);
  const MachineOutline machine = machine_outline(dug.machine, dug.path.poses[pose].joints);
  Rectangle all{dug.path.start_x, dug.path.ground_z, dug.path.start_x, dug.path.ground_z};
  Points tip;
  for (const DigPose& each : dug.path.poses) tip.emplace_back(each.bucket.x, each.bucket.z);
  for (const Points* part : {&machine.tracks, &machine.house, &machine.cab, &machine.boom,
                             &machine.arm, &machine.bucket, static_cast<const Points*>(&tip)}) {
    grow(all, *part);
  }
  const double room = 0.04 * (all.x_max - all.x_min);
  panel.view({all.x_min - room, all.y_min - 2.0 * room, all.x_max + room, all.y_max + room});
  panel.equal_aspect();
  draw_standing_place(panel, dug, all.x_min - 20.0, dug.path.start_x);
  draw_grounds(panel, dug, {all.x_min - 20.0, all.x_max + 20.0});
  draw_machine(panel, machine);
  draw_bucket(panel, dug, pose, {"#222222", 1.3});
  panel.dots(machine.pins, 1.1, {"#4a4a4a", 0.5, "#f2f2f2"});
  draw_tip_path(panel, dug);
  return panel;
}

Panel dig_panel(const DugDig& dug) {
  Panel panel("dig", "x from the swing axis [m]", "z [m]");
  Rectangle all{dug.path.start_x, dug.path.ground_z, dug.path.start_x, dug.path.ground_z};
  const std::vector<std::size_t> ends = ends_of_phases(dug);
  for (const std::size_t pose : ends) {
    grow(all, bucket_outline(dug.machine, dug.path.poses[pose].joints));
  }
  Points dug_tip;
  for (std::size_t i = 0; i <= last_pose(dug); ++i) {
    const DigPose& pose = dug.path.poses[i];
    if (pose.phase != DigPhase::lift) dug_tip.emplace_back(pose.bucket.x, pose.bucket.z);
  }
  grow(all, dug_tip);
  const double narrow = std::max(0.0, 1.4 * (all.y_max - all.y_min) - (all.x_max - all.x_min));
  all.x_min -= 0.5 * narrow;  // a dig that ends early is no wider than the bucket
  all.x_max += 0.5 * narrow;
  const double room = 0.06 * std::max(1.0, all.x_max - all.x_min);
  panel.view({all.x_min - room, all.y_min - room, all.x_max + room, all.y_max + 2.5 * room});
  panel.equal_aspect();
  draw_grounds(panel, dug, {all.x_min - 20.0, all.x_max + 20.0});
  for (const std::size_t pose : ends) {
    Style wall = phase_style(dug.path.poses[pose].phase);
    wall.dash.clear();
    draw_bucket(panel, dug, pose, wall);
  }
  draw_tip_path(panel, dug);
  panel.dots({{dug.path.start_x, dug.path.ground_z}}, 2.0, {"#ffffff", 0.6, colours::black},
             "start, x = " + readable(dug.path.start_x) + " m");
  for (const std::size_t pose : ends) {
    const double fill = fill_at(dug, pose);
    const Points soil = soil_in_bucket(dug.machine, dug.path.poses[pose].joints, fill);
    const bool is_visible = fill > 1e-3 && !soil.empty();
    if (is_visible) panel.label(middle_of(soil), readable(fill, 2) + " m³");
  }
  if (dug.dig.stall && !ends.empty()) {
    const BucketPose& end = dug.path.poses[ends.back()].bucket;
    panel.dots({{end.x, end.z}}, 2.4, {"#ffffff", 0.6, colours::vermilion},
               end_text(*dug.dig.stall));
  }
  return panel;
}

}  // namespace

void draw_machine(Panel& panel, const MachineOutline& machine) {
  const Style front = {"#4a4a4a", 0.7, "#e6bd55"};
  panel.polygon(machine.cab, {"#4a4a4a", 0.7, "#dbe7ee"});
  panel.polygon(machine.turntable, {"#4a4a4a", 0.7, "#f2f2f2"});
  panel.polygon(machine.house, front);
  panel.polygon(machine.tracks, {"#4a4a4a", 0.7, "#9a9a9a"});
  for (const Points& cylinder : machine.cylinders) panel.line(cylinder, {"#5a5a5a", 2.0});
  panel.polygon(machine.arm, front);
  panel.polygon(machine.boom, front);
  if (!machine.bracket.empty()) panel.polygon(machine.bracket, front);
}

Figure section_figure(const DugDig& dug) {
  Figure figure;
  figure.title = dug.title;
  figure.rows = {{machine_panel(dug), dig_panel(dug)}};
  return figure;
}

}  // namespace excavplan
