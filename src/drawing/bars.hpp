// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drawing/plot.hpp"

namespace excavplan {

/// One bar of a group.
struct Bar {
  double value = 0.0;
  std::optional<std::pair<double, double>> interval = {};  ///< 95 %
};

struct BarGroup {
  std::string name;
  std::vector<Bar> bars;    ///< in the order of the series
  std::string remark = {};  ///< above the group: "+28 %"
};

struct BarSeries {
  std::string legend;
  Style style;
};

/// Groups of bars side by side from 0 on.
Panel bar_panel(const std::string& y_label, const std::vector<BarSeries>& series,
                const std::vector<BarGroup>& groups, const std::string& x_label = "");

}  // namespace excavplan
