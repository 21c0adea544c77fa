// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/study_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace excavplan {
namespace {

struct Gain {
  StudyGains StudyResult::*goal;
  const char* legend;
  Style style;
  double offset;  ///< of its row
};

const std::array<Gain, 3> gains = {
    {{&StudyResult::energy, "gain, mass per energy of the dig", {colours::blue, 0.9}, 0.26},
     {&StudyResult::equal,
      "gain at no less payload",
      {colours::vermilion, 0.9, "none", 1.0, {2.0, 1.0}},
      0.0},
     {&StudyResult::cycle,
      "gain per cycle",
      {colours::green, 0.9, "none", 1.0, {0.9, 0.9}},
      -0.26}}};

/// The first row is at the top.
double row_of(std::size_t condition) { return -static_cast<double>(condition); }

std::vector<Panel::Tick> names_of(const std::vector<StudyResult>& results) {
  std::vector<Panel::Tick> names;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const StudyCondition& condition = results[i].condition;
    names.emplace_back(row_of(i), condition.factor + ", " + condition.level);
  }
  return names;
}

/// Lines between the factors.
void draw_factors(Panel& panel, const std::vector<StudyResult>& results, double low, double high) {
  Points ends;
  for (std::size_t i = 1; i < results.size(); ++i) {
    if (results[i].condition.factor == results[i - 1].condition.factor) continue;
    const double y = row_of(i) + 0.5;
    ends.insert(ends.end(), {{low, y}, {high, y}});
  }
  panel.strokes(ends, {"#d0d0d0", 0.5});
}

void shape(Panel& panel, const std::vector<StudyResult>& results, double low, double high) {
  const auto rows = static_cast<double>(results.size());
  const double room = 0.05 * (high - low);
  panel.view({low - (low < 0.0 ? room : 0.0), -rows + 0.5, high + room, 0.5});
  panel.least_height(11.0 * rows);
  draw_factors(panel, results, low - room, high + room);
}

/// The largest gain that the axis shows: a few conditions reach many times the others' gain.
double largest_shown(const std::vector<StudyResult>& results) {
  std::vector<double> means;
  for (const StudyResult& result : results) {
    for (const Gain& gain : gains) {
      if (std::isfinite((result.*gain.goal).gain.mean))
        means.push_back((result.*gain.goal).gain.mean);
    }
  }
  if (means.empty()) return 1.0;
  std::sort(means.begin(), means.end());
  return std::max(10.0, 2.0 * means[means.size() * 9 / 10]);
}

/// In the order of the legend.
std::string gains_beyond(const StudyResult& result, double high) {
  std::string text;
  for (const Gain& gain : gains) {
    const double mean = (result.*gain.goal).gain.mean;
    if (mean > high) text += (text.empty() ? "" : ", ") + short_number(mean, 0);
  }
  return text;
}

bool tells_gain(const StudyResult& result) {
  return std::any_of(gains.begin(), gains.end(), [&](const Gain& gain) {
    return std::isfinite((result.*gain.goal).gain.mean);
  });
}

/// Why a row has no gain.
std::string why_empty(const StudyResult& result) {
  if (result.compared == 0) return "density alone";
  if (result.held_down == result.compared) return "machine lifts or drags";
  return "no run with both digs";
}

Panel gain_panel(const std::vector<StudyResult>& results) {
  Panel panel("", "gain of the planned dig [%]", "");
  double low = 0.0;
  double high = 1.0;
  for (const StudyResult& result : results) {
    for (const Gain& gain : gains) {
      const auto& interval = (result.*gain.goal).gain.interval;
      if (!std::isfinite((result.*gain.goal).gain.mean)) continue;
      low = std::min(low, interval[0]);
      high = std::max(high, interval[1]);
    }
  }
  high = std::min(high, largest_shown(results));
  panel.y_ticks(names_of(results));
  shape(panel, results, low, high);
  panel.line({{0.0, 1.0}, {0.0, row_of(results.size())}}, {"#444444", 0.6});
  for (const Gain& gain : gains) {
    Points means;
    for (std::size_t i = 0; i < results.size(); ++i) {
      const StudyMean& mean = (results[i].*gain.goal).gain;
      if (!std::isfinite(mean.mean)) continue;
      const double y = row_of(i) + gain.offset;
      if (mean.mean > high) continue;
      means.emplace_back(mean.mean, y);
      panel.interval({mean.interval[0], y}, {mean.interval[1], y}, gain.style, gain.legend);
    }
    panel.dots(means, 1.3, {"none", 0.0, gain.style.stroke});
  }
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::string beyond = gains_beyond(results[i], high);
    if (!beyond.empty()) panel.label({high, row_of(i)}, beyond + " % →");
    if (!tells_gain(results[i])) {
      panel.label({0.5 * high, row_of(i)}, why_empty(results[i]));
    }
  }
  return panel;
}

Panel error_panel(const std::vector<StudyResult>& results) {
  Panel panel("", "rms error of the density [%]", "");
  Points errors;
  double high = 1.0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!std::isfinite(results[i].rms)) continue;
    errors.emplace_back(results[i].rms, row_of(i));
    high = std::max(high, results[i].rms);
  }
  std::vector<Panel::Tick> names = names_of(results);
  panel.y_ticks(names);
  shape(panel, results, 0.0, high);
  panel.dots(errors, 1.7, {colours::black, 0.7, "#ffffff"}, "rms error of the density");
  return panel;
}

}  // namespace

Figure study_figure(const std::vector<StudyResult>& results) {
  Figure figure;
  figure.title = "Gain and density error by condition";
  figure.rows = {{gain_panel(results), error_panel(results)}};
  figure.note =
      "Intervals: 95 %, over the runs. →: gains beyond the axis, in the order of the legend. "
      "Machine "
      "lifts or drags: the fixed dig would move it, and no gain can be told.";
  return figure;
}

}  // namespace excavplan
