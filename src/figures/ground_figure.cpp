// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/ground_figure.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

constexpr Eigen::Index most_cells = 200;

/// With what is left over at the upper edges.
HeightMap coarsened(const HeightMap& map) {
  const Eigen::Index rows = map.z.rows(), cols = map.z.cols();
  const Eigen::Index block = (std::max(rows, cols) + most_cells - 1) / most_cells;
  if (block <= 1) return map;
  HeightMap whole = map;
  const auto filled = [&](Eigen::Index cells) { return (cells + block - 1) / block * block; };
  whole.z = Eigen::ArrayXXd::Constant(filled(rows), filled(cols), std::nan(""));
  whole.z.topLeftCorner(rows, cols) = map.z;
  return coarser(whole, block);
}

/// Most heights are inside, and they differ.
ColourScale scale_of(const Eigen::ArrayXXd& heights) {
  const auto known = known_values(heights.isFinite().select(heights, std::nan("")));
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
