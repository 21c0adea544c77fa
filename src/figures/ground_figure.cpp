// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/ground_figure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/statistics.hpp"

namespace excavplan {
namespace {

constexpr Eigen::Index most_cells = 200;

/// The mean of the known cells of a block.
double mean_of(const Eigen::Ref<const Eigen::ArrayXXd>& block) {
  double sum = 0.0, count = 0.0;
  for (Eigen::Index col = 0; col < block.cols(); ++col) {
    for (Eigen::Index row = 0; row < block.rows(); ++row) {
      if (!std::isfinite(block(row, col))) continue;
      sum += block(row, col);
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

HeightMap coarsened(const HeightMap& map) {
  const Eigen::Index longest = std::max(map.z.rows(), map.z.cols());
  const Eigen::Index block = (longest + most_cells - 1) / most_cells;
  if (block <= 1) return map;
  HeightMap coarse = {map.origin, map.cell_size * static_cast<double>(block), {}};
  coarse.z.resize((map.z.rows() + block - 1) / block, (map.z.cols() + block - 1) / block);
  for (Eigen::Index col = 0; col < coarse.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < coarse.z.rows(); ++row) {
      const Eigen::Index top = row * block, left = col * block;
      coarse.z(row, col) = mean_of(map.z.block(top, left, std::min(block, map.z.rows() - top),
                                               std::min(block, map.z.cols() - left)));
    }
  }
  return coarse;
}

/// Most heights are inside, and they differ.
ColourScale scale_of(const Eigen::ArrayXXd& heights) {
  std::vector<double> known;
  for (Eigen::Index i = 0; i < heights.size(); ++i) {
    if (std::isfinite(heights(i))) known.push_back(heights(i));
  }
  if (known.empty()) return {};
  constexpr double least_range = 0.02;  // ours [m]
  const double low = quantile(known, 0.005), high = quantile(known, 0.995);
  const double room = std::max(0.0, 0.5 * (least_range - (high - low)));
  return {{}, low - room, high + room};
}

}  // namespace

Figure ground_figure(const HeightMap& ground) {
  const HeightMap shown = coarsened(ground);
  const ColourScale scale = scale_of(shown.z);
  Panel panel("", "x [m]", "y [m]");
  panel.map({shown.origin, Eigen::Vector2d::Constant(shown.cell_size), shown.z}, scale);
  panel.view(ground.extent());
  panel.equal_aspect();
  Figure figure;
  figure.title = "Heights of the ground";
  figure.rows = {{panel}};
  figure.colour_bar = {scale, "height [m]"};
  return figure;
}

}  // namespace excavplan
