// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "trial/scored_design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <excavplan/design/cut_and_fill.hpp>

#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double whole = 1.0 - 1e-6;  // share of a cell

}  // namespace

ScoredDesign scored_design(const SiteBrief& site, const HeightMap& before) {
  const DesignCover cover = cover_of(site.design, before);
  ScoredDesign scored;
  scored.height = before;
  scored.height.z = (cover.share >= whole && cover.height < before.z)
                        .select(cover.height, nan);
  scored.gentle = scored.height;
  const auto step_to = [&](Cell from, Eigen::Index rows, Eigen::Index cols) {
    const Cell to = {from.row + rows, from.col + cols};
    const ArrayXXd& z = scored.height.z;
    if (to.row < 0 || to.col < 0 || to.row >= z.rows() || to.col >= z.cols()) return 0.0;
    const double step = std::abs(z(to.row, to.col) - z(from.row, from.col));
    return std::isnan(step) ? 0.0 : step;
  };
  const double highest_step = before.cell_size * std::tan(CutOptions{}.steepest);
  for_each_cell(scored.height.z, [&](Cell at) {
    const double step = std::hypot(std::max(step_to(at, 0, 1), step_to(at, 0, -1)),
                                   std::max(step_to(at, 1, 0), step_to(at, -1, 0)));
    if (step > highest_step) scored.gentle.z(at.row, at.col) = nan;
  });
  return scored;
}

}  // namespace excavplan
