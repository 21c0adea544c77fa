// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inspect_cloud/cloud_lines.hpp"

#include <cmath>

#include "base/text.hpp"
#include "clouds/cloud_units.hpp"

namespace excavplan::tools {
namespace {

std::string range(const std::string& axis, double low, double high) {
  return axis + " " + readable(low, 4) + " .. " + readable(high, 4) + " m (" +
         readable(high - low) + " m)";
}

}  // namespace

std::vector<std::string> cloud_lines(const std::string& file, const CloudSummary& summary) {
  std::string points = std::to_string(summary.points) + " points";
  if (summary.height > 1) {
    points += " (" + std::to_string(summary.width) + " x " + std::to_string(summary.height) + ")";
  }
  std::vector<std::string> lines = {file + ": " + points + ", " +
                                    std::to_string(summary.finite_points) + " finite"};
  if (summary.left_out > 0) {
    lines.push_back("  " + std::to_string(summary.left_out) +
                    " more are withheld or noise: left out");
  }
  if (summary.finite_points == 0) return lines;
  const char* const axes[] = {"x", "y", "z"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    lines.push_back("  " + range(axes[i], summary.min[i], summary.max[i]));
  }
  if (std::isfinite(summary.density)) {
    lines.push_back("  " + readable(summary.density) + " points per m^2 of ground");
  }
  lines.push_back("  frame (a guess): " + summary.frame_guess);
  return lines;
}

std::vector<Warning> cloud_warnings(const std::string& file, const CloudSummary& summary,
                                    double unit) {
  if (summary.finite_points == 0) {
    return {{WarningCode::no_finite_points, file + " has no finite points"}};
  }
  const auto doubt = doubt_of_extent(*summary.extent, summary.density, unit);
  if (!doubt) return {};
  return {{doubt->code, file + ": " + doubt->message}};
}

}  // namespace excavplan::tools
