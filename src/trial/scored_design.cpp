// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "trial/scored_design.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/design/cut_and_fill.hpp>

#include "base/non_finite.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
using Eigen::ArrayXXd;

double ScoredDesign::below(const ArrayXXd& surface) const {
  const ArrayXXd over = share * (surface - height.z);
  return height.cell_size * height.cell_size * (over > 0.0).select(over, 0.0).sum();
}

ScoredDesign scored_design(const SiteBrief& site, const HeightMap& before) {
  const DesignCover cover = cover_of(site.design, before);
  ScoredDesign scored;
  scored.height = before;
  const Mask inside = cover.share > 0.0 && cover.height < before.z;
  scored.height.z = inside.select(cover.height, nan);
  scored.share = inside.select(cover.share.min(1.0), 0.0);
  const ArrayXXd& z = scored.height.z;
  const auto step_to = [&](Cell from, Eigen::Index rows, Eigen::Index cols) {
    const Cell to = {from.row + rows, from.col + cols};
    if (to.row < 0 || to.col < 0 || to.row >= z.rows() || to.col >= z.cols()) return 0.0;
    const double step = std::abs(z(to.row, to.col) - z(from.row, from.col));
    return std::isnan(step) ? 0.0 : step;
  };
  const double highest_step = before.cell_size * std::tan(CutOptions{}.steepest);
  scored.gentle = scored.share;
  for_each_cell(z, [&](Cell at) {
    const double step = std::hypot(std::max(step_to(at, 0, 1), step_to(at, 0, -1)),
                                   std::max(step_to(at, 1, 0), step_to(at, -1, 0)));
    if (step > highest_step) scored.gentle(at.row, at.col) = 0.0;
  });
  return scored;
}

}  // namespace excavplan
