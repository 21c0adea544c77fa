// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/low_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/statistics.hpp"
#include "ground/plane_fit.hpp"

namespace excavplan {
namespace {

constexpr double steep = 1.2;         // 50 degrees
constexpr double least_drop = 0.10;   // [m]
constexpr double least_area = 0.03;   // [m^2]
constexpr double largest_area = 1.0;  // [m^2]
constexpr double level_slope = 0.3;   // of a top, between neighbouring cells [-]
constexpr double level_tilt = 0.1;    // of a top as a whole [-]

/// What the edge of a thing is like.
struct EdgeLimits {
  double least_falling;  ///< share
  double most_rising;    ///< share
  double one_sided;      ///< length of the mean direction of what falls
};
constexpr EdgeLimits sure_edge = {0.45, 0.15, 0.65};
constexpr EdgeLimits suspected = {0.3, 0.2, 0.5};
constexpr double least_change = 0.03;  // of the ground around [m]
constexpr double own_change = 0.015;   // of the top, at least [m]
constexpr std::size_t most_tops = 2;

/// The edge of a patch of cells: what lies two cells beyond it.
struct Edge {
  int count = 0;
  int falling = 0;
  int rising = 0;
  Eigen::Vector2i direction = Eigen::Vector2i::Zero();  ///< sum of those that fall
  std::vector<double> changes;                          ///< of the ground beyond [m]

  bool is_within(const EdgeLimits& limits) const {
    if (count == 0 || falling < limits.least_falling * count) return false;
    if (rising > limits.most_rising * count) return false;
    return direction.cast<double>().norm() < limits.one_sided * falling;
  }
};

class TopFinder {
 public:
  TopFinder(const Eigen::ArrayXXd& before, const Eigen::ArrayXXd& after, double cell_size,
            bool on_any_ground)
      : before_(before),
        after_(after),
        cell_size_(cell_size),
        on_any_ground_(on_any_ground),
        drop_(std::max(least_drop, steep * 2.0 * cell_size)),
        label_(Eigen::ArrayXXi::Constant(after.rows(), after.cols(), free)) {}

  std::vector<LevelTop> find() {
    std::vector<LevelTop> tops;
    int mark = 0;
    for_each_cell(after_, [&](Cell seed) {
      if (label_(seed.row, seed.col) != free || std::isnan(after_(seed.row, seed.col))) return;
      if (!falls_beside(after_, seed)) return;
      LevelTop top;
      top.cells = patch_around(seed, mark);
      const double area = static_cast<double>(top.cells.size()) * cell_size_ * cell_size_;
      if (area < least_area || area > largest_area) return;
      Edge edge = edge_of(top.cells, mark++);
      top.is_sure = edge.is_within(sure_edge);
      if (!top.is_sure && !edge.is_within(suspected)) return;
      if (!on_any_ground_ && median(edge.changes) < least_change) return;
      if (is_unchanged(top.cells)) {
        if (on_any_ground_ || stood_out_before(top.cells)) return;
        top.is_sure = false;
      }
      tops.push_back(std::move(top));
    });
    drop_blocks(tops);
    drop_if(tops, [&](const LevelTop& top) { return !is_level(top.cells); });
    return tops;
  }

 private:
  static constexpr int free = -1;
  static constexpr std::array<std::array<int, 2>, 4> directions = {
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

  template <typename Test>
  static void drop_if(std::vector<LevelTop>& tops, const Test& test) {
    tops.erase(std::remove_if(tops.begin(), tops.end(), test), tops.end());
  }

  static void drop_blocks(std::vector<LevelTop>& tops) {
    const auto is_unsure = [](const LevelTop& top) { return !top.is_sure; };
    if (tops.size() > most_tops) drop_if(tops, is_unsure);
    if (tops.size() > most_tops) tops.clear();
  }

  static double height(const Eigen::ArrayXXd& z, Cell at) {
    const bool inside = at.row >= 0 && at.col >= 0 && at.row < z.rows() && at.col < z.cols();
    return inside ? z(at.row, at.col) : std::nan("");
  }

  bool falls_beside(const Eigen::ArrayXXd& z, Cell at) const {
    const double here = height(z, at);
    return std::any_of(directions.begin(), directions.end(), [&](const auto& d) {
      return here - height(z, {at.row + 2 * d[0], at.col + 2 * d[1]}) > drop_;
    });
  }

  /// The connected cells that go on from one to the next nearly level.
  std::vector<Cell> patch_around(Cell seed, int mark) {
    std::vector<Cell> cells = {seed};
    label_(seed.row, seed.col) = mark;
    for (std::size_t next = 0; next < cells.size(); ++next) {
      const double here = after_(cells[next].row, cells[next].col);
      for_each_neighbour(after_, cells[next], [&](Cell n) {
        if (label_(n.row, n.col) != free) return;
        if (!(std::abs(after_(n.row, n.col) - here) < level_slope * cell_size_)) return;
        label_(n.row, n.col) = mark;
        cells.push_back(n);
      });
    }
    return cells;
  }

  /// Unlike the top of a block, which lies as it fell.
  bool is_level(const std::vector<Cell>& cells) const {
    PlaneFit fit;
    for (const Cell at : cells) {
      fit.add(static_cast<double>(at.col - cells.front().col),
              static_cast<double>(at.row - cells.front().row), after_(at.row, at.col));
    }
    return fit.plane().gradient().norm() < level_tilt * cell_size_;
  }

  /// As high as before: a wall, ground that was left standing, or a thing of just this height.
  bool is_unchanged(const std::vector<Cell>& cells) const {
    std::vector<double> changes;
    for (const Cell at : cells) {
      const double change = std::abs(after_(at.row, at.col) - before_(at.row, at.col));
      if (!std::isnan(change)) changes.push_back(change);
    }
    return !changes.empty() && median(changes) < own_change;
  }

  /// As a wall does.
  bool stood_out_before(const std::vector<Cell>& cells) const {
    return std::any_of(cells.begin(), cells.end(),
                       [&](Cell at) { return falls_beside(before_, at); });
  }

  Edge edge_of(const std::vector<Cell>& cells, int mark) const {
    Edge edge;
    for (const Cell at : cells) {
      for (const auto& d : directions) {
        const Cell beside = {at.row + d[0], at.col + d[1]};
        const Cell beyond = {beside.row + d[0], beside.col + d[1]};
        if (std::isnan(height(after_, beyond)) || label_(beside.row, beside.col) == mark) continue;
        const double fall = height(after_, at) - height(after_, beyond);
        ++edge.count;
        edge.rising += fall < -drop_ ? 1 : 0;
        const double change = height(after_, beyond) - before_(beyond.row, beyond.col);
        edge.changes.push_back(std::isnan(change) ? 0.0 : std::abs(change));
        if (!(fall > drop_)) continue;
        ++edge.falling;
        edge.direction += Eigen::Vector2i(d[0], d[1]);
      }
    }
    return edge;
  }

  const Eigen::ArrayXXd& before_;
  const Eigen::ArrayXXd& after_;
  double cell_size_;
  bool on_any_ground_;
  double drop_;
  Eigen::ArrayXXi label_;
};

}  // namespace

std::vector<LevelTop> level_tops(const Eigen::ArrayXXd& before, const Eigen::ArrayXXd& after,
                                 double cell_size, bool on_any_ground) {
  return TopFinder(before, after, cell_size, on_any_ground).find();
}

}  // namespace excavplan
