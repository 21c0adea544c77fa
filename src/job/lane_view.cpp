// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/lane_view.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "base/non_finite.hpp"
#include "base/plan_geometry.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr Index top_part = 4;  // the highest quarter of the soil under the bucket meets it; ours
constexpr double edge_slack =
    0.04;  // by which the bucket's edge may be beside the design or within a face; ours [m]
constexpr double face_rise = 0.01;  // of the design at that edge, if it is a face; ours [m]

double mean_of(const std::vector<double>& values, Index first) {
  return std::accumulate(values.begin(), values.begin() + first, 0.0) / static_cast<double>(first);
}

/// Linear between the columns of a view; constant beyond.
GroundProfile between_columns(const HeightMap& view, ArrayXd values) {
  const double first = view.x(0);
  const double cell = view.cell_size;
  return [first, cell, values = std::move(values)](double x) {
    const double at = (x - first) / cell;
    const auto last = static_cast<double>(values.size() - 1);
    if (!(at > 0.0)) return values(0);
    if (at >= last) return values(values.size() - 1);
    const auto left = static_cast<Index>(at);
    const double share = at - static_cast<double>(left);
    if (share == 0.0) return values(left);
    return (1.0 - share) * values(left) + share * values(left + 1);
  };
}

}  // namespace

LaneView::LaneView(const Terrain& ground, const JobMap& job, const DigLine& line,
                   const Rectangle& extent, double bucket_width)
    : ground_(ground, line, extent, ground.bank.cell_size),
      surface_(ground_.terrain().surface()),
      target_(Eigen::ArrayXXd::Constant(surface_.z.rows(), surface_.z.cols(), nan)),
      exact_(target_),
      dump_(Mask::Constant(surface_.z.rows(), surface_.z.cols(), false)),
      counts_(dump_),
      untouched_(dump_),
      forbidden_(Eigen::ArrayXXd::Constant(surface_.z.rows(), surface_.z.cols(), -infinity)) {
  const PlanFrame frame(line.origin, line.heading);
  for_each_cell(target_, [&](Cell at) {
    const Eigen::Vector2d place = frame.place(surface_.x(at.col), surface_.y(at.row));
    const auto cell = cell_at(job.target, place.x(), place.y());
    if (!cell) return;
    target_(at.row, at.col) = job.target.z(cell->row, cell->col) - line.z;
    const double between = height_at(job.target, place.x(), place.y()) - line.z;
    exact_(at.row, at.col) = std::isnan(between) ? target_(at.row, at.col) : between;
    dump_(at.row, at.col) = job.dump(cell->row, cell->col);
    counts_(at.row, at.col) = job.counts(cell->row, cell->col);
    untouched_(at.row, at.col) = job.untouched(cell->row, cell->col);
    forbidden_(at.row, at.col) = job.forbidden(cell->row, cell->col) - line.z;
  });
  look_under_bucket(bucket_width);
}

void LaneView::look_under_bucket(double bucket_width) {
  const double cell = surface_.cell_size;
  const auto row_of = [&](double y) { return (y - surface_.origin.y()) / cell; };
  first_row_ = static_cast<Index>(std::round(row_of(-0.5 * bucket_width)));
  end_row_ = static_cast<Index>(std::round(row_of(0.5 * bucket_width)));
  inner_ = static_cast<Index>(std::ceil(edge_slack / cell - 1e-9));
  floor_ = exact_floor_ = ground_at_ = top_ = ArrayXd::Zero(columns());
  std::vector<double> heights;
  fall_ = ArrayXd::Constant(columns(), nan);
  for (Index col = 0; col < columns(); ++col) {
    heights.clear();
    const auto under = target_.col(col).segment(first_row_, end_row_ - first_row_);
    if (under.size() > 0 && !under.isNaN().any()) fall_(col) = under.maxCoeff() - under.minCoeff();
    for (Index row = first_row_; row < end_row_; ++row) {
      const double z = surface_.z(row, col);
      if (!is_edge(row) && !std::isnan(z)) heights.push_back(z);
    }
    std::sort(heights.begin(), heights.end(), std::greater<>());
    const auto known = static_cast<Index>(heights.size());
    const bool is_known = 2 * known > end_row_ - first_row_ - 2 * inner_;
    ground_at_(col) = is_known ? mean_of(heights, known) : nan;
    top_(col) = is_known ? mean_of(heights, std::max<Index>(1, known / top_part)) : nan;
    floor_(col) = is_known ? floor_of(target_, col) : nan;
    exact_floor_(col) = is_known ? floor_of(exact_, col) : nan;
  }
}

bool LaneView::is_edge(Index row) const {
  return row < first_row_ + inner_ || row >= end_row_ - inner_;
}

double LaneView::floor_of(const Eigen::ArrayXXd& target, Index col) const {
  double floor = -infinity, edge = -infinity;
  for (Index row = first_row_; row < end_row_; ++row) {
    const double here = target(row, col);
    if (!is_edge(row)) floor = std::max(floor, std::isnan(here) ? surface_.z(row, col) : here);
    if (is_edge(row) && !std::isnan(here)) edge = std::max(edge, here);
    if (forbidden_(row, col) > floor)
      floor = std::isinf(forbidden_(row, col)) ? nan : forbidden_(row, col);
  }
  return edge < floor + face_rise ? std::max(floor, edge) : floor;
}

void LaneView::keep_above(double level) {
  for (ArrayXd* floor : {&floor_, &exact_floor_})
    *floor = floor->isNaN().select(*floor, floor->max(level));
}

GroundProfile LaneView::floor(double allowance) const {
  // Nothing is dug where the floor is not known.
  return between_columns(surface_,
                         exact_floor_.isNaN().select(ground_at_, exact_floor_ + allowance));
}

GroundProfile LaneView::top() const { return between_columns(surface_, top_); }
GroundProfile LaneView::mean() const { return between_columns(surface_, ground_at_); }

bool LaneView::is_known(double from, double to) const {
  const auto col_of = [&](double place) {
    return static_cast<Index>(std::floor((place - surface_.origin.x()) / surface_.cell_size));
  };
  const Index first = col_of(from) - 1, end = col_of(to) + 2;
  const Index low = first_row_ - 1, high = end_row_ + 1;
  if (first < 0 || end > columns() || low < 0 || high > surface_.z.rows()) return false;
  return !surface_.z.block(low, first, high - low, end - first).isNaN().any();
}

ArrayXd LaneView::excess(double allowance) const {
  ArrayXd excess = ArrayXd::Zero(columns());
  for (Index col = 0; col < columns(); ++col) {
    const double floor = floor_(col) + allowance;
    if (std::isnan(floor)) continue;
    double sum = 0.0;
    for (Index row = first_row_; row < end_row_; ++row) {
      const double above = surface_.z(row, col) - floor;
      if (above > 0.0) sum += above;
    }
    excess(col) = sum / static_cast<double>(end_row_ - first_row_);
  }
  return excess;
}

ShapeChange LaneView::change(const TerrainPatch& patch, const ShapeRules& rules) const {
  const double slack = rules.slack;
  const double area = surface_.cell_size * surface_.cell_size;
  ShapeChange change;
  // What must not be touched: the noise of a heap that comes to rest adds up to nothing.
  double risen = 0.0;
  for_each_cell(patch.bank, [&](Cell at) {
    const Cell cell = {at.row + patch.row, at.col + patch.col};
    const double before = surface_.z(cell.row, cell.col);
    const double after = patch.bank(at.row, at.col) + patch.loose(at.row, at.col);
    if (std::isnan(before) || before == after) return;
    const double target = target_(cell.row, cell.col);
    if (std::isnan(target)) {
      const double bank = ground_.terrain().bank.z(cell.row, cell.col);
      change.too_deep += area * std::max(0.0, bank - patch.bank(at.row, at.col));
      const double loose = ground_.terrain().loose(cell.row, cell.col);
      if (!dump_(cell.row, cell.col))
        change.spilled += area * (patch.loose(at.row, at.col) - loose);
      if (untouched_(cell.row, cell.col)) risen += area * (after - before);
      return;
    }
    const double gained = area * (std::max(0.0, before - target) - std::max(0.0, after - target));
    change.gained += gained;
    if (surface_.x(cell.col) > rules.end) change.at_end += gained;
    const bool is_later = floor_(cell.col) - target > rules.deepest;
    const bool is_under = cell.row >= first_row_ && cell.row < end_row_;
    const double level = target + slack;
    const double lowered = area * (std::max(0.0, before - level) - std::max(0.0, after - level));
    if (!is_under && !is_later) change.pushed -= lowered;
    if (is_under && !is_later && counts_(cell.row, cell.col)) {
      change.cleared += lowered;
      const auto is_off = [&](double z) { return std::abs(z - target) > rules.tolerance; };
      change.finished += area * (is_off(before) - is_off(after));
      change.shaped += area * (std::max(0.0, std::abs(before - target) - slack) -
                               std::max(0.0, std::abs(after - target) - slack));
    }
    change.too_deep +=
        area * (std::max(0.0, target - slack - after) - std::max(0.0, target - slack - before));
  });
  change.touched = std::abs(risen);
  change.spilled = std::max(0.0, change.spilled);
  return change;
}

}  // namespace excavplan
