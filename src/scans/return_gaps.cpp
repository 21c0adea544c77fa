// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/return_gaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/non_finite.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double steepest = 1.0;                    // slope that goes on across a gap; ours
constexpr double widest = 0.25;                     // ours [m]
constexpr double alike = 2.0 * between_returns_sd;  // heights of one surface differ by less; ours

/// The cells with returns on both sides of a cell without.
struct Ends {
  Cell low, high;
  double to_low, to_high;  ///< [cell]
};

class ReturnGaps {
 public:
  ReturnGaps(const Eigen::ArrayXXd& seen, const Eigen::ArrayXXd& known, double cell_size)
      : seen_(seen),
        known_(known),
        most_(static_cast<Index>(std::floor(widest / cell_size + rounding))),
        steepest_(steepest * cell_size) {}

  /// By the gaps along x and y, as far as they are narrow; NaN if none is, or one tells nothing.
  double height(Cell at) const {
    double sum = 0.0;
    double weights = 0.0;
    for (const Cell step : {Cell{0, 1}, Cell{1, 0}}) {
      const std::optional<Ends> ends = ends_along(at, step);
      if (!ends) continue;
      const double weight = 1.0 / (ends->to_low + ends->to_high);
      sum += weight * height_between(*ends, at, step);
      weights += weight;
    }
    return weights > 0.0 ? sum / weights : nan;
  }

 private:
  static constexpr double rounding = 1e-9;  // of a cell

  double seen(Cell at) const {
    const bool inside =
        at.row >= 0 && at.col >= 0 && at.row < seen_.rows() && at.col < seen_.cols();
    return inside ? seen_(at.row, at.col) : nan;
  }

  /// Cells to the next with a return; more than the widest gap if there is none.
  Index way_to_return(Cell at, Cell step) const {
    Index way = 1;
    for (; way <= most_; ++way) {
      at = {at.row + step.row, at.col + step.col};
      if (!std::isnan(seen(at))) break;
    }
    return way;
  }

  std::optional<Ends> ends_along(Cell at, Cell step) const {
    const Index low = way_to_return(at, {-step.row, -step.col});
    const Index high = way_to_return(at, step);
    if (low + high - 1 > most_) return std::nullopt;
    return Ends{{at.row - low * step.row, at.col - low * step.col},
                {at.row + high * step.row, at.col + high * step.col},
                static_cast<double>(low),
                static_cast<double>(high)};
  }

  double height_between(const Ends& ends, Cell at, Cell step) const {
    const double base = known_.size() > 0 ? known_(at.row, at.col) : nan;
    const bool is_known = !std::isnan(base);
    const double low = seen(ends.low) - (is_known ? known_(ends.low.row, ends.low.col) : 0.0);
    const double high = seen(ends.high) - (is_known ? known_(ends.high.row, ends.high.col) : 0.0);
    const double across = ends.to_low + ends.to_high;
    const double apart = is_known ? high - low : out_of_line(ends, step);
    if (!(std::abs(apart) <= alike)) return nan;
    return (is_known ? base : 0.0) + (low * ends.to_high + high * ends.to_low) / across;
  }

  /// By how much the rise across a gap is other than the slopes beside it let expect, as far as
  /// they are none of a wall.
  double out_of_line(const Ends& ends, Cell step) const {
    constexpr Index base = 2;  // cells, of a slope; ours
    const auto slope = [&](Cell from, Index way) {
      const Cell beyond = {from.row + way * step.row, from.col + way * step.col};
      const double rise = (seen(beyond) - seen(from)) / static_cast<double>(way);
      return std::abs(rise) < steepest_ ? rise : 0.0;
    };
    const double before = slope(ends.low, -base);
    const double behind = slope(ends.high, base);
    const double across = ends.to_low + ends.to_high;
    const double rise = seen(ends.high) - seen(ends.low);
    return rise -
           std::clamp(rise, across * std::min(before, behind), across * std::max(before, behind));
  }

  const Eigen::ArrayXXd& seen_;
  const Eigen::ArrayXXd& known_;
  Index most_;       ///< cells of a gap
  double steepest_;  ///< [m/cell]
};

/// In gaps along x and y.
Eigen::ArrayXXd heights_in_gaps(const Eigen::ArrayXXd& seen, const Eigen::ArrayXXd& known,
                                double cell_size) {
  Eigen::ArrayXXd heights = Eigen::ArrayXXd::Constant(seen.rows(), seen.cols(), nan);
  const ReturnGaps gaps(seen, known, cell_size);
  for_each_cell(seen, [&](Cell at) {
    if (std::isnan(seen(at.row, at.col))) heights(at.row, at.col) = gaps.height(at);
  });
  return heights;
}

}  // namespace

Eigen::ArrayXXd heights_between_returns(const Eigen::ArrayXXd& seen, const Eigen::ArrayXXd& known,
                                        double cell_size) {
  const Eigen::ArrayXXd beside = heights_in_gaps(seen, known, cell_size);
  // In the middle of four returns lie cells with none along x or y, but with such gaps beside them.
  const Eigen::ArrayXXd with_beside = beside.isNaN().select(seen, beside);
  const Eigen::ArrayXXd amid = heights_in_gaps(with_beside, known, cell_size);
  return beside.isNaN().select(amid, beside);
}

}  // namespace excavplan
