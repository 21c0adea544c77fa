// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/efficiency_figures.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/statistics.hpp"
#include "base/text.hpp"
#include "drawing/bars.hpp"
#include "results/efficiency_results.hpp"

namespace excavplan {
namespace {

std::string name_of(const DigEfficiency& run) {
  return std::filesystem::path(run.file).stem().string();
}

/// "m³/mL"
std::string unit_text(std::string symbol) {
  const std::size_t cube = symbol.find("m3");
  if (cube != std::string::npos) symbol.replace(cube, 2, "m³");
  return symbol;
}

DrawnBar bar_of(const DigEfficiency& run) {
  const Measured value = run.value();
  DrawnBar bar{value.value};
  if (std::isfinite(value.sd)) {
    bar.interval = {value.value - two_sided_95_percent * value.sd,
                    value.value + two_sided_95_percent * value.sd};
  }
  return bar;
}

/// Rates of the log as a figure shows them.
struct ShownRate {
  const char* label;
  double per_si;
};

ShownRate rate_of(Spent spent) {
  if (spent == Spent::fuel) return {"fuel flow [mL/s]", 1.0};
  return {"power [kW]", 1e-3};
}

Panel log_panel(const DigEfficiency& run, bool last) {
  const ShownRate shown = rate_of(run.spent);
  Panel panel(name_of(run), "time [s]", shown.label);
  const std::vector<double> rate = run.log.rate();
  const double start = run.log.time.front();
  Points curve;
  double top = 0.0;
  for (std::size_t i = 0; i < rate.size(); ++i) {
    curve.emplace_back(run.log.time[i] - start, shown.per_si * rate[i]);
    top = std::max(top, curve.back().y());
  }
  const double end = curve.back().x();
  if (run.phases != PhaseSource::none) {
    for (const LogInterval& dig : run.log.digs) {
      panel.span(dig.from - start, dig.to - start, colours::orange, "penetrate, drag and scoop");
      Points area;
      const LogRows rows = rows_around(run.log.time, dig);
      for (std::size_t i = rows.first; i < rows.last; ++i) {
        if (run.log.time[i] >= dig.from && run.log.time[i] <= dig.to) area.push_back(curve[i]);
      }
      if (area.size() < 2) continue;
      area.insert(area.begin(), {area.front().x(), 0.0});
      area.emplace_back(area.back().x(), 0.0);
      panel.polygon(area, {"none", 0.0, "#fbe7c0"});
    }
  }
  panel.line(curve, {colours::blue, 1.2}, "log");
  if (run.idle) {
    const double idle = shown.per_si * run.idle->rate;
    panel.line({{0.0, idle}, {end, idle}}, {colours::grey, 0.9, "none", 1.0, {3.0, 2.0}},
               run.idle->is_found ? "idling, found in the log" : "idling, as stated");
  }
  panel.view({0.0, 0.0, end, 1.15 * std::max(top, 1e-9)});
  panel.shape(0.32);
  if (!last) panel.hide_x();
  return panel;
}

/// The runs of a set side by side in the bar of their mean.
Points dots_of(const std::vector<DigEfficiency>& runs, double middle) {
  constexpr double spread = 0.5;
  Points dots;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(runs.size());
    dots.emplace_back(middle + spread * (share - 0.5), runs[i].value().value);
  }
  return dots;
}

}  // namespace

Figure runs_figure(const DrawnRuns& drawn) {
  const std::vector<DigEfficiency>& runs = drawn.runs;
  Figure figure;
  figure.title = "Efficiency of each run";
  std::vector<BarGroup> groups;
  groups.reserve(runs.size());
  for (const DigEfficiency& run : runs) {
    groups.push_back({name_of(run), {bar_of(run)}, readable(run.value().value, run.value().sd)});
  }
  Panel panel = bar_panel("efficiency [" + unit_text(runs.front().symbol()) + "]",
                          {{"", {"#444444", 0.6, "#9ecae1"}}}, groups);
  figure.rows = {{panel}};
  const auto has_sd = [](const DigEfficiency& run) { return std::isfinite(run.value().sd); };
  if (std::any_of(runs.begin(), runs.end(), has_sd)) figure.note = "± is one standard deviation. ";
  if (runs.size() == 2) {
    const Measured gain = efficiency_gain(runs[0], runs[1], drawn.own_meters);
    const auto [low, high] = gain_interval(gain);
    figure.note += "Gain of the second run: " + readable(gain.value, gain.sd) + " %";
    figure.note += std::isfinite(low)
                       ? ", 95 % interval " + readable(low) + " .. " + readable(high) + " %."
                       : ".";
  }
  return figure;
}

Figure rates_figure(const DrawnRuns& drawn) {
  const std::vector<DigEfficiency>& runs = drawn.runs;
  Figure figure;
  figure.title = "Rate of fuel or energy over time";
  double end = 0.0;
  double top = 0.0;
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    panels.push_back(log_panel(runs[i], i + 1 == runs.size()));
    end = std::max(end, panels.back().shown().x_max);
    top = std::max(top, panels.back().shown().y_max);
  }
  for (Panel& panel : panels) {
    panel.view({0.0, 0.0, end, top});
    figure.rows.push_back({panel});
  }
  return figure;
}

Figure sets_figure(const ComparedSets& sets) {
  const std::string symbol = sets.runs.front().symbol();
  const SetComparison& found = sets.comparison;
  Panel panel = bar_panel(
      "efficiency [" + unit_text(symbol) + "]", {{"geometric mean", {"#444444", 0.6, "#9ecae1"}}},
      {{"against", {{found.first.geometric_mean}}}, {"runs", {{found.second.geometric_mean}}}});
  double top = panel.shown().y_max;
  double middle = 0.0;
  for (const std::vector<DigEfficiency>* set : {&sets.against, &sets.runs}) {
    const Points dots = dots_of(*set, middle);
    for (const Eigen::Vector2d& dot : dots) top = std::max(top, 1.08 * dot.y());
    panel.dots(dots, 2.0, {"#ffffff", 0.5, colours::vermilion}, "a run");
    middle += 1.0;
  }
  const Rectangle shown = panel.shown();
  panel.view({shown.x_min, 0.0, shown.x_max, top});
  Figure figure;
  figure.title = "Efficiency of the runs of both sets";
  figure.rows = {{panel}};
  figure.note = std::to_string(found.second.runs) + " runs against " +
                std::to_string(found.first.runs) + ", " + gain_text(found) + ".";
  return figure;
}

}  // namespace excavplan
