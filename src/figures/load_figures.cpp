// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/load_figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/text.hpp"
#include "results/dig_timing.hpp"

namespace excavplan {
namespace {

const char* const time_label = "time since the dig began [s]";
const Style limit_style = {colours::vermilion, 0.9, "none", 1.0, {3.0, 2.0}};

/// A dig with the times of its steps.
struct Timed {
  const DugDig& dug;
  std::vector<TimedStep> steps;

  explicit Timed(const DugDig& of) : dug(of), steps(timed_steps(of.machine, of.path, of.dig)) {}

  const ForceSample& sample(std::size_t i) const { return dug.dig.history[i]; }

  /// A value at the middle of each step.
  Points over_time(const std::function<double(std::size_t step)>& value) const {
    Points points;
    for (std::size_t i = 0; i < steps.size(); ++i) points.emplace_back(steps[i].time, value(i));
    return points;
  }

  double end() const {
    return steps.empty() ? 1.0 : steps.back().time + 0.5 * steps.back().duration;
  }

  /// Strips in the greys of the phases.
  void add_phases(Panel& panel) const {
    double from = 0.0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (i + 1 < steps.size() && steps[i + 1].phase == steps[i].phase) continue;
      const double to = steps[i].time + 0.5 * steps[i].duration;
      panel.span(from, to, phase_grey(steps[i].phase), name(steps[i].phase));
      from = to;
    }
  }
};

/// Of all points, with 0, and a little room above for the strips of the phases.
Rectangle time_view(const Timed& timed, const std::vector<Points>& lines) {
  double low = 0.0;
  double high = 0.0;
  for (const Points& line : lines) {
    for (const Eigen::Vector2d& point : line) {
      if (!std::isfinite(point.y())) continue;
      low = std::min(low, point.y());
      high = std::max(high, point.y());
    }
  }
  const double size = std::max(high - low, 1e-9);
  return {0.0, low - (low < 0.0 ? 0.05 * size : 0.0), timed.end(), high + 0.14 * size};
}

struct Curve {
  Points points;
  Style style;
  std::string legend;
};

Panel time_panel(const Timed& timed, const std::string& y_label, const std::vector<Curve>& curves,
                 bool last, double shape) {
  Panel panel("", time_label, y_label);
  std::vector<Points> lines;
  for (const Curve& curve : curves) {
    panel.line(curve.points, curve.style, curve.legend);
    lines.push_back(curve.points);
  }
  timed.add_phases(panel);
  panel.view(time_view(timed, lines));
  panel.shape(shape);
  if (!last) panel.hide_x();
  return panel;
}

/// Three panels, of boom, arm and bucket.
/// @param value  of joint and step
/// @param bounds  lines beside the curve of a joint
template <typename Value, typename Bounds>
Figure joints_figure(const Timed& timed, const std::string& unit, const std::string& legend,
                     const Value& value, const Bounds& bounds) {
  Figure figure;
  for (int i = 0; i < 3; ++i) {
    const Points load = timed.over_time([&](std::size_t step) { return value(i, step); });
    std::vector<Curve> curves = bounds(i, load);
    curves.insert(curves.begin(), {load, {colours::blue, 1.3}, legend});
    figure.rows.push_back(
        {time_panel(timed, std::string(name(static_cast<Joint>(i))) + " [" + unit + "]", curves,
                    i == 2, 0.24)});
  }
  return figure;
}

double largest_of(const Points& load) {
  double largest = 0.0;
  for (const Eigen::Vector2d& at : load) largest = std::max(largest, std::abs(at.y()));
  return largest;
}

/// Of a limit that is drawn; below, it would flatten the curve. Ours.
constexpr double least_drawn_share = 0.6;

/// The limit of a torque, on the sides that come near to it.
std::vector<Curve> limits_of(const Points& load, double limit) {
  std::vector<Curve> limits;
  for (const double sign : {1.0, -1.0}) {
    const auto is_near = [&](const Eigen::Vector2d& at) {
      return sign * at.y() > least_drawn_share * limit;
    };
    if (std::none_of(load.begin(), load.end(), is_near)) continue;
    limits.push_back({{{load.front().x(), sign * limit}, {load.back().x(), sign * limit}},
                      limit_style,
                      "limit"});
  }
  return limits;
}

/// "; of the boom 400 kN m, 15 %"
std::string limit_text(Joint joint, double limit, double share) {
  return std::string("; of the ") + name(joint) + ' ' + readable(limit) + " kN m, " +
         readable(100.0 * share, 2) + " %";
}

}  // namespace

Figure forces_figure(const DugDig& dug) {
  const Timed timed(dug);
  const auto force = [&](int axis, double sign) {
    return timed.over_time(
        [&](std::size_t i) { return sign * timed.sample(i).soil[axis] / 1000.0; });
  };
  Figure figure;
  figure.title = "Force of the soil and payload: " + dug.title;
  figure.rows.push_back({time_panel(
      timed, "force [kN]",
      {{force(0, 1.0), {colours::blue, 1.3}, "horizontal, away from the machine"},
       {force(1, 1.0), {colours::vermilion, 1.3, "none", 1.0, {4.0, 1.5}}, "vertical, upwards"},
       {timed.over_time([&](std::size_t i) { return timed.sample(i).soil.norm() / 1000.0; }),
        {colours::grey, 0.9, "none", 1.0, {1.2, 1.2}},
        "resultant"}},
      false, 0.36)});
  const double density =
      dug.dig.payload_volume > 0.0 ? dug.dig.payload_mass / dug.dig.payload_volume : 0.0;
  const bool has_mass = density > 0.0;
  figure.rows.push_back({time_panel(timed, has_mass ? "soil in bucket [kg]" : "soil in bucket [m³]",
                                    {{timed.over_time([&](std::size_t i) {
                                        return timed.sample(i).bucket_fill *
                                               (has_mass ? density : 1.0);
                                      }),
                                      {colours::black, 1.3},
                                      ""}},
                                    true, 0.28)});
  return figure;
}

Figure torques_figure(const DugDig& dug) {
  const Timed timed(dug);
  std::string beyond;
  Figure figure = joints_figure(
      timed, "kN m", "torque",
      [&](int joint, std::size_t i) { return timed.sample(i).torque[joint] / 1000.0; },
      [&](int joint, const Points& load) {
        const double limit = dug.machine.limits[static_cast<std::size_t>(joint)].torque / 1000.0;
        const double share = largest_of(load) / limit;
        if (share <= least_drawn_share)
          beyond += limit_text(static_cast<Joint>(joint), limit, share);
        return limits_of(load, limit);
      });
  figure.title = "Torques of the joints: " + dug.title;
  if (!beyond.empty()) {
    figure.note = "Beyond the axes, with the largest share of it that the dig takes: limit" +
                  beyond.substr(1) + ".";
  }
  return figure;
}

Figure power_figure(const DugDig& dug) {
  const Timed timed(dug);
  Points energy = {{0.0, 0.0}};
  for (const TimedStep& step : timed.steps) {
    energy.emplace_back(step.time + 0.5 * step.duration,
                        energy.back().y() + step.power * step.duration / 1000.0);
  }
  Figure figure;
  figure.title = "Power and energy: " + dug.title;
  figure.rows.push_back(
      {time_panel(timed, "power [kW]",
                  {{timed.over_time([&](std::size_t i) { return timed.steps[i].power / 1000.0; }),
                    {colours::blue, 1.3},
                    ""}},
                  false, 0.32)});
  figure.rows.push_back(
      {time_panel(timed, "energy [kJ]", {{energy, {colours::black, 1.3}, ""}}, true, 0.28)});
  return figure;
}

Figure cylinders_figure(const DugDig& dug) {
  const Timed timed(dug);
  if (!dug.machine.cylinders) return {};
  const Cylinders& cylinders = *dug.machine.cylinders;
  const auto& hydraulics = dug.machine.hydraulics;
  // Of the side that oil pushes on: the whole piston, or the ring around its rod.
  const auto area = [&](int joint, double force) {
    return hydraulics ? hydraulics->pistons[static_cast<std::size_t>(joint)].area_filled(force)
                      : 1.0;
  };
  const double unit = hydraulics ? 1e6 : 1e3;
  const auto load = [&](int joint, std::size_t i) {
    const double newtons = cylinders[static_cast<std::size_t>(joint)].force(
        timed.sample(i).joints[joint], timed.sample(i).torque[joint]);
    return newtons / area(joint, newtons) / unit;
  };
  Figure figure = joints_figure(timed, hydraulics ? "MPa" : "kN", hydraulics ? "pressure" : "force",
                                load, [](int, const Points&) { return std::vector<Curve>(); });
  figure.title = (hydraulics ? "Pressures" : "Forces") + std::string(" of the cylinders: ");
  figure.title += dug.title;
  figure.note = hydraulics ? "Positive: the cylinder pushes, on the side of the piston; negative: "
                             "it pulls, on the side of the rod."
                           : "Positive: the cylinder pushes.";
  return figure;
}

}  // namespace excavplan
