// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "drawing/bars.hpp"

#include <algorithm>
#include <cmath>

namespace excavplan {
namespace {

constexpr double group_width = 0.72;       // of the distance of two groups
constexpr std::size_t many_groups = 6;     // remarks may stand upright above more
constexpr std::size_t most_outlined = 30;  // groups; outlines would hide the colours of more

void draw_bar(Panel& panel, double left, double width, const Bar& bar, const BarSeries& series) {
  panel.polygon({{left, 0.0}, {left + width, 0.0}, {left + width, bar.value}, {left, bar.value}},
                series.style, series.legend);
  if (!bar.interval || !std::isfinite(bar.interval->first)) return;
  const double middle = left + 0.5 * width;
  panel.interval({middle, bar.interval->first}, {middle, bar.interval->second},
                 {colours::black, 0.8}, "95 % interval");
}

double top_of(const BarGroup& group) {
  double top = 0.0;
  for (const Bar& bar : group.bars) {
    top = std::max(top, bar.value);
    if (bar.interval && std::isfinite(bar.interval->second)) {
      top = std::max(top, bar.interval->second);
    }
  }
  return top;
}

}  // namespace

Panel bar_panel(const std::string& y_label, const std::vector<BarSeries>& series,
                const std::vector<BarGroup>& groups, const std::string& x_label) {
  Panel panel("", x_label, y_label);
  std::vector<Panel::Tick> names;
  double top = 0.0;
  for (const BarGroup& group : groups) top = std::max(top, top_of(group));
  std::vector<BarSeries> drawn = series;
  if (groups.size() > most_outlined) {
    for (BarSeries& each : drawn) each.style.stroke = "none";
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const double width = group_width / static_cast<double>(std::max<std::size_t>(1, series.size()));
    const auto middle = static_cast<double>(i);
    names.emplace_back(middle, groups[i].name);
    for (std::size_t j = 0; j < groups[i].bars.size(); ++j) {
      draw_bar(panel, middle - 0.5 * group_width + width * static_cast<double>(j), width,
               groups[i].bars[j], drawn[j]);
    }
    if (!groups[i].remark.empty()) {
      panel.remark({middle, top_of(groups[i])}, 1.0, groups[i].remark);
    }
  }
  panel.x_ticks(std::move(names));
  const double with_remarks = groups.size() > many_groups ? 1.35 : 1.18;
  panel.view({-0.55, 0.0, static_cast<double>(groups.size()) - 0.45,
              top > 0.0 ? with_remarks * top : 1.0});
  return panel;
}

}  // namespace excavplan
