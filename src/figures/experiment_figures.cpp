// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/experiment_figures.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/soil/density_law.hpp>

#include "base/text.hpp"
#include "drawing/bars.hpp"
#include "figures/law_curve.hpp"

namespace excavplan {
namespace {

constexpr std::size_t most_panels = 6;  // ours

Points tip_path(const DigPath& path) {
  Points points;
  for (const DigPose& pose : path.poses) {
    if (pose.phase == DigPhase::lift) break;
    points.emplace_back(pose.bucket.x, pose.bucket.z);
  }
  return points;
}

/// A condition may be named by its density: "5.00 %".
bool is_density(const std::string& condition) { return condition.find('%') != std::string::npos; }

/// "soft, 10 %", "5 %"
std::string title_of(const std::string& condition, double density_percent) {
  const std::string density = short_number(density_percent, 1) + " %";
  return is_density(condition) ? density : condition + ", " + density;
}

/// "soft", "5"
std::string name_of(const std::string& condition, double density_percent) {
  return is_density(condition) ? short_number(density_percent, 1) : condition;
}

std::string gain_text(double percent) {
  return (percent < 0.0 ? "−" : "+") + short_number(std::abs(percent), 0) + " %";
}

std::string line_text(const std::string& name, const DensityLine& line) {
  return name + ": d = " + decimals(line.a, 1) + " k − " + decimals(-line.b, 1);
}

/// At most most_panels, evenly from the first to the last.
std::vector<const NamedExperiment*> some_of(const std::vector<NamedExperiment>& experiments) {
  const std::size_t count = std::min(most_panels, experiments.size());
  std::vector<const NamedExperiment*> some;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = count > 1 ? i * (experiments.size() - 1) / (count - 1) : 0;
    some.push_back(&experiments[place]);
  }
  return some;
}

/// Of all paths, with room around them.
Rectangle view_of(const std::vector<const NamedExperiment*>& experiments) {
  Rectangle all{1e9, 0.0, -1e9, 0.0};
  for (const NamedExperiment* experiment : experiments) {
    for (const DigPath* path : {&experiment->result.fixed_path, &experiment->result.planned_path}) {
      for (const Eigen::Vector2d& point : tip_path(*path)) {
        all.x_min = std::min(all.x_min, point.x());
        all.x_max = std::max(all.x_max, point.x());
        all.y_min = std::min(all.y_min, point.y());
        all.y_max = std::max(all.y_max, point.y());
      }
    }
  }
  const double room = 0.08 * (all.x_max - all.x_min);
  return {all.x_min - room, all.y_min - room, all.x_max + room, all.y_max + room};
}

/// Of each condition; one that failed has no bars.
std::vector<BarGroup> bar_groups(const Experiments& experiments, double per_si) {
  std::vector<BarGroup> groups;
  for (const auto& [condition, result] : experiments.done) {
    const auto worth = [&, &result = result](const PlannedDig& dig) {
      return Bar{result.objective.worth(dig) * per_si};
    };
    groups.push_back({name_of(condition, result.density_percent),
                      {worth(result.fixed), worth(result.planned)},
                      gain_text(result.gain_percent())});
  }
  for (auto failed = experiments.failed.rbegin(); failed != experiments.failed.rend(); ++failed) {
    const auto place = groups.begin() + static_cast<std::ptrdiff_t>(failed->place);
    groups.insert(place, {name_of(failed->condition, failed->density_percent), {}, "no dig"});
  }
  return groups;
}

/// What bars and paths do not show.
std::string note_on(const Experiments& experiments) {
  std::string note;
  for (const FailedExperiment& failed : experiments.failed) {
    note +=
        (note.empty() ? "No dig in " : ", ") + title_of(failed.condition, failed.density_percent);
  }
  if (!note.empty()) note += ": the machine cannot dig along one of the paths. ";
  if (experiments.second == SecondGround::left) {
    note +=
        "Fixed path on fresh ground, planned path on the ground that this dig left: the gain is "
        "that of path and ground.";
  }
  return note;
}

}  // namespace

Figure paths_figure(const Experiments& experiments) {
  Figure figure;
  figure.title = "Digs along the fixed and along the planned path";
  const std::vector<const NamedExperiment*> shown = some_of(experiments.done);
  figure.rows.emplace_back();
  const Rectangle view = view_of(shown);
  for (const NamedExperiment* experiment : shown) {
    Panel panel(title_of(experiment->condition, experiment->result.density_percent),
                "x from the swing axis [m]", "z [m]");
    panel.equal_aspect();
    panel.view(view);
    panel.polygon({{-99.0, 0.0}, {99.0, 0.0}, {99.0, -99.0}, {-99.0, -99.0}},
                  {"#a08050", 0.7, "#f3ead9"}, "ground");
    panel.line(tip_path(experiment->result.fixed_path), {colours::vermilion, 1.4},
               "tip, fixed path");
    panel.line(tip_path(experiment->result.planned_path),
               {colours::blue, 1.4, "none", 1.0, {4.0, 1.6}}, "tip, planned path");
    figure.rows.back().push_back(panel);
  }
  const std::size_t count = experiments.done.size();
  if (shown.size() < count) {
    figure.note = std::to_string(shown.size()) + " of " + std::to_string(count) + " conditions. ";
  }
  figure.note += note_on(experiments);
  return figure;
}

Figure efficiency_figure(const Experiments& experiments) {
  Figure figure;
  figure.title = "Efficiency of digs along the fixed and along the planned path";
  if (experiments.done.empty()) return figure;
  const DigGoalInfo& goal = info_of(experiments.done.front().result.objective.goal);
  const std::string x_label = is_density(experiments.done.front().condition) ? density_label : "";
  Panel panel =
      bar_panel(goal.description.substr(0, goal.description.find(',')) + " [" + goal.unit + "]",
                {{"fixed path", {"#444444", 0.6, "#c9c9c9"}},
                 {"planned path", {"#444444", 0.6, colours::blue}}},
                bar_groups(experiments, goal.per_si), x_label);
  panel.skip_x_ticks();
  figure.rows = {{panel}};
  figure.note = note_on(experiments);
  return figure;
}

Figure regression_figure(const DrawnExperiments& drawn) {
  Panel panel("", bulking_label, density_label);
  const DensityRegression& regression = drawn.regression;
  const DensityLine& own = regression.line;
  const DensityLine& freed = regression.line_without_fallback;
  const DensityLine& paper = regression.paper_line;
  panel.line(law_curve(paper), {"#b5b5b5", 2.8}, line_text("paper", paper));
  panel.line(law_curve(density_law_of(drawn.soil).form),
             {colours::green, 1.1, "none", 1.0, {5.0, 1.5, 1.2, 1.5}},
             "closed form of the void ratios");
  panel.line(law_curve(freed), {colours::vermilion, 1.1, "none", 1.0, {4.0, 1.6}},
             line_text("without fallback", freed));
  panel.line(law_curve(own), {colours::blue, 1.3}, line_text("regression", own));
  Points samples;
  for (const DensityCalibration::Sample& sample : regression.samples) {
    samples.emplace_back(sample.bulking_factor_measured, sample.density_percent);
  }
  panel.dots(samples, 1.7, {colours::blue, 0.8, "#ffffff"}, "digs along the fixed path");
  Figure figure;
  figure.title = "Relative density over bulking factor";
  figure.rows = {{panel}};
  figure.note = "The void ratios of loam were derived from the paper's line.";
  return figure;
}

}  // namespace excavplan
