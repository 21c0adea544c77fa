// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/job_estimate_figure.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/text.hpp"

namespace excavplan {
namespace {

struct Row {
  const char* name;
  const char* unit;  ///< empty: whole, rounded up
  double scale;
  const EstimatedFigure* figure;
};

std::vector<Row> rows_of(const JobEstimate& estimate, const std::optional<JobCost>& cost) {
  std::vector<Row> rows = {{"digs", "", 1.0, &estimate.digs},
                           {"time", "min", 1.0 / 60.0, &estimate.time},
                           {"fuel", "L", 1.0, &estimate.fuel},
                           {"truckloads", "", 1.0, &estimate.truckloads}};
  if (cost) rows.push_back({"cost", " ", 1.0, &cost->total});
  return rows;
}

std::string text_of(const Row& row, double value) {
  return *row.unit == 0 ? std::to_string(std::llround(std::ceil(value)))
                        : readable(row.scale * value, 3);
}

}  // namespace

Figure job_estimate_figure(const JobEstimate& estimate, const std::optional<JobCost>& cost) {
  Panel panel("", "share of the estimate, 95 %", "");
  std::vector<Panel::Tick> names;
  const std::vector<Row> rows = rows_of(estimate, cost);
  double most = 1.0, y = static_cast<double>(rows.size());
  for (const Row& row : rows) {
    const auto interval = row.figure->interval();
    const double low = interval[0] / row.figure->value, high = interval[1] / row.figure->value;
    panel.interval({low, y}, {high, y}, {colours::blue, 1.4}, "95 %");
    panel.dots({{1.0, y}}, 2.2, {colours::black, 0.0, colours::black}, "estimate");
    panel.remark({0.5 * (low + high), y + 0.15}, high,
                 text_of(row, interval[0]) + " .. " + text_of(row, interval[1]));
    names.emplace_back(y, std::string(row.name) + " " + text_of(row, row.figure->value) +
                              (*row.unit == 0 ? "" : " " + std::string(row.unit)));
    most = std::max(most, high);
    y -= 1.0;
  }
  panel.y_ticks(std::move(names));
  panel.view({0.0, 0.4, 1.05 * most, static_cast<double>(rows.size()) + 0.9});
  panel.shape(0.11 * static_cast<double>(rows.size()));
  Figure figure;
  figure.title = "What the job takes";
  figure.rows = {{panel}};
  return figure;
}

}  // namespace excavplan
