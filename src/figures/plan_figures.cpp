// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/plan_figures.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "planning/dig_layout.hpp"
#include "planning/simulated_dig.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

std::string worth_label(const DigObjective& objective) {
  const DigGoalInfo& goal = info_of(objective.goal);
  return goal.description + " [" + goal.unit + "]";
}

/// A number of a path as a figure shows it.
struct ShownNumber {
  const DigParameterInfo* info;
  std::string label;
  double per_si = 1.0;

  explicit ShownNumber(const DigParameterInfo& of) : info(&of) {
    const bool is_angle = std::string(of.unit) == "rad";
    if (is_angle) per_si = 180.0 / pi;
    label = std::string(of.text) + (is_angle ? " [deg]" : " [m]");
  }
  double of(const DigParameters& dig) const { return per_si * (dig.*info->field); }
  /// "drag length 0.40 m"
  std::string named(const DigParameters& dig) const {
    return std::string(info->text) + ' ' + short_number(of(dig), per_si == 1.0 ? 2 : 0) +
           (per_si == 1.0 ? " m" : " deg");
  }
};

/// One section: two numbers, the others as planned.
class PlanSection {
 public:
  PlanSection(const DrawnPlan& drawn, std::size_t x, std::size_t y)
      : drawn_(drawn),
        x_(dig_parameter_table()[x]),
        y_(dig_parameter_table()[y]),
        held_(dig_parameter_table()[3 - x - y]),
        bounds_(machine_bounds(drawn.machine, drawn.search.bounds)) {}

  static constexpr Eigen::Index across = 20;  ///< cells a side
  static constexpr std::size_t count = across * across;

  /// From the search range to the part of it that has a path: little of the figure is empty.
  void narrow(const DigLayout& layout) {
    const Eigen::Vector2d low(bounds_.lower.*x_.info->field, bounds_.lower.*y_.info->field);
    const Eigen::Vector2d high(bounds_.upper.*x_.info->field, bounds_.upper.*y_.info->field);
    const DigPlan& plan = drawn_.plan;
    const DigParameters& best = plan.dig->parameters;
    Eigen::AlignedBox2d used(Eigen::Vector2d(best.*x_.info->field, best.*y_.info->field));
    const Eigen::Vector2d half = (high - low) / (2.0 * static_cast<double>(across));
    for (std::size_t i = 0; i < count; ++i) {
      const DigParameters each = dig(i);
      if (!std::holds_alternative<DigPath>(layout.path_from(each, plan.dig->start_x))) continue;
      const Eigen::Vector2d middle(each.*x_.info->field, each.*y_.info->field);
      used.extend(middle - half).extend(middle + half);
    }
    for (const int axis : {0, 1}) {
      const auto field = (axis == 0 ? x_ : y_).info->field;
      bounds_.lower.*field = std::max(low[axis], used.min()[axis]);
      bounds_.upper.*field = std::min(high[axis], used.max()[axis]);
    }
  }

  DigParameters dig(std::size_t cell) const {
    DigParameters dig = drawn_.plan.dig->parameters;
    dig.*x_.info->field = at(x_, cell % across);
    dig.*y_.info->field = at(y_, cell / across);
    return dig;
  }

  Panel panel(const std::vector<double>& worth, const ColourScale& scale) const {
    Panel panel("at " + held_.named(drawn_.plan.dig->parameters), x_.label, y_.label);
    const Eigen::Vector2d low(x_.of(bounds_.lower), y_.of(bounds_.lower));
    const Eigen::Vector2d high(x_.of(bounds_.upper), y_.of(bounds_.upper));
    Grid grid{low, (high - low) / static_cast<double>(across), Eigen::ArrayXXd(across, across)};
    for (std::size_t i = 0; i < count; ++i) {
      grid.z(static_cast<Eigen::Index>(i / across), static_cast<Eigen::Index>(i % across)) =
          worth[i];
    }
    panel.map(grid, scale, "cannot be dug");
    const DigParameters& best = drawn_.plan.dig->parameters;
    panel.dots({{x_.of(best), y_.of(best)}}, 2.6, {"#000000", 0.9, "#ffffff"}, "planned dig");
    panel.shape(0.85);
    return panel;
  }

 private:
  double at(const ShownNumber& number, std::size_t place) const {
    const double lower = bounds_.lower.*number.info->field;
    const double upper = bounds_.upper.*number.info->field;
    return lower +
           (upper - lower) * (static_cast<double>(place) + 0.5) / static_cast<double>(across);
  }

  const DrawnPlan& drawn_;
  ShownNumber x_, y_, held_;
  DigBounds bounds_;
};

/// Worths of digs from the planned start, in the unit shown; NaN where one cannot be dug.
std::vector<double> worths(const DrawnPlan& drawn, std::vector<PlanSection>& sections) {
  const PlanSite& site = drawn.site;
  const Machine& machine = drawn.machine;
  const DigObjective& objective = drawn.search.objective;
  const auto simulator = make_simulator(site.simulator, machine, site.soil, site.density_percent);
  const DigLayout layout(machine, site.ground);
  for (PlanSection& section : sections) section.narrow(layout);
  std::vector<double> found(sections.size() * PlanSection::count, nan);
  parallel_for(found.size(), drawn.search.threads, [&](std::size_t i) {
    const DigParameters dig = sections[i / PlanSection::count].dig(i % PlanSection::count);
    const auto path = layout.path_from(dig, drawn.plan.dig->start_x);
    if (!std::holds_alternative<DigPath>(path)) return;
    const auto dug =
        dig_of_path(machine, *simulator, site.ground, std::get<DigPath>(path), objective);
    if (const auto* done = std::get_if<PlannedDig>(&dug)) {
      found[i] = objective.worth(*done) * info_of(objective.goal).per_si;
    }
  });
  return found;
}

/// The best worth so far on a scale of its own, as it grows by little.
Panel best_panel(const Points& best, const std::string& x_label, const std::string& unit) {
  Panel panel("", x_label, "best [" + unit + "]");
  if (best.empty()) return panel;
  const double low = best.front().y();
  const double high = best.back().y();
  const double room = std::max(0.1 * (high - low), 1e-3 * std::abs(high));
  panel.line(best, {colours::vermilion, 1.3}, "best so far");
  panel.view({0.0, low - room, best.back().x() + 1.0, high + room});
  panel.shape(0.2);
  return panel;
}

/// What the dots do not show.
std::string search_note(const DrawnPlan& drawn, bool is_uncertain) {
  std::string note;
  if (is_uncertain) {
    note =
        "The worth is the mean over the possible densities, at each of which a path is dug. With "
        "the searches at single densities, not shown, " +
        std::to_string(drawn.plan.evaluations) + " digs were simulated. ";
  }
  if (drawn.search.objective.min_fill > 0.0) {
    note += "Digs that fill the bucket less than asked count for less. ";
  }
  if (drawn.plan.search->refused > 0) {
    note += std::to_string(drawn.plan.search->refused) +
            " more cannot be driven and were not simulated.";
  }
  return note;
}

}  // namespace

Figure search_figure(const DrawnPlan& drawn) {
  const DigGoalInfo& goal = info_of(drawn.search.objective.goal);
  const std::vector<double>& ranks = drawn.plan.search->ranks;
  const bool is_uncertain = drawn.plan.evaluations > static_cast<int>(ranks.size());
  const std::string x_label = is_uncertain ? "paths evaluated" : "digs evaluated";
  Panel panel("", x_label, worth_label(drawn.search.objective));
  Points digs, failed, best;
  double highest = nan;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    const auto number = static_cast<double>(i + 1);
    const double worth = ranks[i] * goal.per_si;
    if (!std::isfinite(worth)) {
      failed.emplace_back(number, 0.0);
      continue;
    }
    digs.emplace_back(number, worth);
    if (!(worth <= highest)) {
      if (std::isfinite(highest)) best.emplace_back(number, highest);
      highest = worth;
      best.emplace_back(number, highest);
    }
  }
  if (!best.empty()) best.emplace_back(static_cast<double>(ranks.size()), highest);
  panel.dots(digs, 0.9, {"none", 0.0, colours::sky}, is_uncertain ? "a path" : "a dig");
  if (!failed.empty()) {
    panel.dots(failed, 0.9, {colours::grey, 0.5, "#ffffff"}, "the machine stalls");
  }
  panel.line(best, {colours::vermilion, 1.3}, "best so far");
  panel.view({0.0, 0.0, static_cast<double>(ranks.size()) + 1.0,
              1.06 * (std::isfinite(highest) ? highest : 1.0)});
  panel.shape(0.4);
  panel.hide_x();
  Figure figure;
  figure.title = "Search: " + drawn.dug->title;
  figure.rows = {{panel}, {best_panel(best, x_label, goal.unit)}};
  figure.note = search_note(drawn, is_uncertain);
  return figure;
}

Figure landscape_figure(const DrawnPlan& drawn) {
  std::vector<PlanSection> sections = {PlanSection(drawn, 0, 1), PlanSection(drawn, 1, 2)};
  const std::vector<double> worth = worths(drawn, sections);
  ColourScale scale;
  scale.high = 0.0;
  for (const double each : worth) {
    if (std::isfinite(each)) scale.high = std::max(scale.high, each);
  }
  if (!(scale.high > 0.0)) scale.high = 1.0;
  Figure figure;
  figure.title = "Worth about the planned dig: " + drawn.dug->title;
  figure.colour_bar = ColourBar{scale, worth_label(drawn.search.objective)};
  figure.rows.emplace_back();
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const auto first = worth.begin() + static_cast<std::ptrdiff_t>(i * PlanSection::count);
    figure.rows.back().push_back(
        sections[i].panel({first, first + static_cast<std::ptrdiff_t>(PlanSection::count)}, scale));
  }
  figure.note =
      "All digs begin where the planned one does, at x = " + readable(drawn.plan.dig->start_x) +
      " m. Beyond the axes none can be driven.";
  return figure;
}

}  // namespace excavplan
