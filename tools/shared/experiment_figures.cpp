// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/experiment_figures.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/soil/density_law.hpp>

#include "base/text.hpp"
#include "shared/bars.hpp"
#include "shared/law_curve.hpp"

namespace excavplan::tools {
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

/// "soft, 10 %"; a condition may be named by its density.
std::string title_of(const NamedExperiment& experiment) {
  if (experiment.condition.find('%') != std::string::npos) return experiment.condition;
  return experiment.condition + ", " + short_number(experiment.result.density_percent, 1) + " %";
}

std::string gain_text(double percent) {
  return (percent < 0.0 ? "−" : "+") + short_number(std::abs(percent), 0) + " %";
}

DensityLine line_of(const nlohmann::ordered_json& json) {
  return {json.at("a_percent"), json.at("b_percent"), json.at("r2")};
}

std::string line_text(const std::string& name, const DensityLine& line) {
  return name + ": d = " + decimals(line.a, 1) + " k − " + decimals(-line.b, 1);
}

}  // namespace

Figure paths_figure(const std::vector<NamedExperiment>& experiments) {
  Figure figure;
  figure.title = "Digs along the fixed and along the planned path";
  figure.rows.emplace_back();
  Rectangle all{1e9, 0.0, -1e9, 0.0};
  const std::size_t count = std::min(most_panels, experiments.size());
  for (std::size_t i = 0; i < count; ++i) {
    for (const DigPath* path :
         {&experiments[i].result.fixed_path, &experiments[i].result.planned_path}) {
      for (const Eigen::Vector2d& point : tip_path(*path)) {
        all.x_min = std::min(all.x_min, point.x());
        all.x_max = std::max(all.x_max, point.x());
        all.y_min = std::min(all.y_min, point.y());
        all.y_max = std::max(all.y_max, point.y());
      }
    }
  }
  const double room = 0.08 * (all.x_max - all.x_min);
  const Rectangle view{all.x_min - room, all.y_min - room, all.x_max + room, all.y_max + room};
  for (std::size_t i = 0; i < count; ++i) {
    const ExperimentResult& result = experiments[i].result;
    Panel panel(title_of(experiments[i]), "x from the swing axis [m]", "z [m]");
    panel.equal_aspect();
    panel.view(view);
    panel.polygon({{-99.0, 0.0}, {99.0, 0.0}, {99.0, -99.0}, {-99.0, -99.0}},
                  {"#a08050", 0.7, "#f3ead9"}, "ground");
    panel.line(tip_path(result.fixed_path), {colours::vermilion, 1.4}, "tip, fixed path");
    panel.line(tip_path(result.planned_path), {colours::blue, 1.4, "none", 1.0, {4.0, 1.6}},
               "tip, planned path");
    figure.rows.back().push_back(panel);
  }
  return figure;
}

Figure efficiency_figure(const std::vector<NamedExperiment>& experiments) {
  Figure figure;
  figure.title = "Efficiency of digs along the fixed and along the planned path";
  if (experiments.empty()) return figure;
  const DigGoalInfo& goal = info_of(experiments.front().result.objective.goal);
  std::vector<BarGroup> groups;
  for (const auto& [condition, result] : experiments) {
    const auto worth = [&, &result = result](const PlannedDig& dig) {
      return Bar{result.objective.worth(dig) * goal.per_si};
    };
    groups.push_back({condition,
                      {worth(result.fixed), worth(result.planned)},
                      gain_text(result.gain_percent())});
  }
  figure.rows = {
      {bar_panel(goal.description.substr(0, goal.description.find(',')) + " [" + goal.unit + "]",
                 {{"fixed path", {"#444444", 0.6, "#c9c9c9"}},
                  {"planned path", {"#444444", 0.6, colours::blue}}},
                 groups)}};
  return figure;
}

Figure regression_figure(const DrawnExperiments& drawn) {
  Panel panel("", bulking_label, density_label);
  const auto& regression = drawn.regression;
  const DensityLine own = line_of(regression.at("line"));
  const DensityLine freed = line_of(regression.at("line_without_fallback"));
  const DensityLine paper = line_of(regression.at("paper_line"));
  panel.line(law_curve(paper), {"#b5b5b5", 2.8}, line_text("paper", paper));
  panel.line(law_curve(density_law_of(drawn.soil).form),
             {colours::green, 1.1, "none", 1.0, {5.0, 1.5, 1.2, 1.5}},
             "closed form of the void ratios");
  panel.line(law_curve(freed), {colours::vermilion, 1.1, "none", 1.0, {4.0, 1.6}},
             line_text("without fallback", freed));
  panel.line(law_curve(own), {colours::blue, 1.3}, line_text("regression", own));
  Points samples;
  for (const auto& sample : regression.at("samples")) {
    samples.emplace_back(sample.at("bulking_factor"), sample.at("density_percent"));
  }
  panel.dots(samples, 1.7, {colours::blue, 0.8, "#ffffff"}, "digs along the fixed path");
  Figure figure;
  figure.title = "Relative density over bulking factor";
  figure.rows = {{panel}};
  figure.note = "The void ratios of loam were derived from the paper's line.";
  return figure;
}

FigureTable<DrawnExperiments> experiment_figures(const Arguments::Use& experiment) {
  return {{{"paths", "paths of the tip, fixed and planned", experiment},
           [](const DrawnExperiments& drawn) { return paths_figure(drawn.experiments); }},
          {{"efficiency", "what both digs of each condition are worth", experiment},
           [](const DrawnExperiments& drawn) { return efficiency_figure(drawn.experiments); }},
          {{"regression", "density over bulking factor, with the paper's line", experiment},
           regression_figure}};
}

}  // namespace excavplan::tools
