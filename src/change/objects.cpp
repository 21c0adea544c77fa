// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/objects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/statistics.hpp"
#include "change/low_objects.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

constexpr double steepest_soil = 1.7320508075688772;  // ours: 60 degrees
constexpr double least_over_slope = 0.5;              // ours [m]
constexpr double least_object = 0.02;  // ours: smaller ones are single bad cells [m^2]
constexpr double edge_excess = 0.05;   // ours: as far as an object reaches [m]
constexpr double of_a_heap = 0.2;      // ours: ground around over top, as risen [-]

/// Height above the steepest surface that could lie there, less what one cell blurs.
Eigen::ArrayXXd excess_of(const Eigen::ArrayXXd& z, double cell_size) {
  return z - slope_limited(z, steepest_soil * cell_size) - steepest_soil * cell_size;
}

/// Cells within `margin` of the given ones, or next to them.
std::vector<Cell> widened(const std::vector<Cell>& cells, const Eigen::ArrayXXd& grid,
                          double margin) {
  const auto reach = static_cast<Eigen::Index>(std::ceil(margin));
  Eigen::ArrayXXi taken = Eigen::ArrayXXi::Zero(grid.rows(), grid.cols());
  std::vector<Cell> wide;
  for (const Cell from : cells) {
    for_each_around(grid, from, reach, [&](Cell at) {
      const auto rows = static_cast<double>(at.row - from.row);
      const auto cols = static_cast<double>(at.col - from.col);
      int& is_taken = taken(at.row, at.col);
      if (is_taken != 0 || std::hypot(rows, cols) > std::max(margin, 1.5)) return;
      is_taken = 1;
      wide.push_back(at);
    });
  }
  return wide;
}

/// True if the ground around rose with it, as around a block in a heap of them: by the median of
/// the cells next to it.
bool is_part_of_heap(const std::vector<Cell>& cells, const Eigen::ArrayXXd& rise) {
  Eigen::ArrayXXi own = Eigen::ArrayXXi::Zero(rise.rows(), rise.cols());
  double top = 0.0;
  for (const Cell at : cells) {
    own(at.row, at.col) = 1;
    if (rise(at.row, at.col) > top) top = rise(at.row, at.col);
  }
  std::vector<double> around;
  for (const Cell at : cells) {
    for_each_neighbour(rise, at, [&](Cell n) {
      if (own(n.row, n.col) == 0 && !std::isnan(rise(n.row, n.col))) {
        around.push_back(rise(n.row, n.col));
      }
    });
  }
  return !around.empty() && median(around) > of_a_heap * top;
}

/// The cells with those that they enclose: the steep sides of an object go all round its top.
std::vector<Cell> with_enclosed(const std::vector<Cell>& cells) {
  Cell low = cells.front();
  Cell high = cells.front();
  for (const Cell at : cells) {
    low = {std::min(low.row, at.row), std::min(low.col, at.col)};
    high = {std::max(high.row, at.row), std::max(high.col, at.col)};
  }
  constexpr int open = -1;
  Eigen::ArrayXXi label =
      Eigen::ArrayXXi::Constant(high.row - low.row + 3, high.col - low.col + 3, open);
  for (const Cell at : cells) label(at.row - low.row + 1, at.col - low.col + 1) = 0;
  mark_connected(label, {0, 0}, 1, [](Cell) { return true; });
  std::vector<Cell> whole = cells;
  for_each_cell(label, [&](Cell at) {
    if (label(at.row, at.col) == open)
      whole.push_back({at.row + low.row - 1, at.col + low.col - 1});
  });
  return whole;
}

/// Objects in `with` that are not in `without`.
std::vector<Object> standing(const Eigen::ArrayXXd& with, const Eigen::ArrayXXd& without,
                             double cell_size, double margin) {
  constexpr int free = -1;
  std::vector<Object> objects;
  const Eigen::ArrayXXd rise =
      (with - without).isNaN().select(with - without, (with - without).max(0.0));
  const Eigen::ArrayXXd excess = excess_of(rise, cell_size);
  if (!(excess > least_over_slope).any()) return objects;
  const Eigen::ArrayXXd own_excess = excess_of(with, cell_size);
  Eigen::ArrayXXi label = Eigen::ArrayXXi::Constant(rise.rows(), rise.cols(), free);
  for_each_cell(rise, [&](Cell seed) {
    if (label(seed.row, seed.col) != free) return;
    if (!(std::min(excess(seed.row, seed.col), own_excess(seed.row, seed.col)) >
          least_over_slope)) {
      return;
    }
    const auto joins = [&](Cell cell_at) { return excess(cell_at.row, cell_at.col) > edge_excess; };
    Object object;
    object.cells = with_enclosed(mark_connected(label, seed, 0, joins));
    for (const Cell at : object.cells) label(at.row, at.col) = 0;
    object.is_blunder =
        static_cast<double>(object.cells.size()) * cell_size * cell_size < least_object;
    if (!object.is_blunder) {
      object.cells = widened(object.cells, rise, margin);
      if (is_part_of_heap(object.cells, rise)) return;
    }
    for (const Cell at : object.cells) {
      const double change = with(at.row, at.col) - without(at.row, at.col);
      if (!std::isnan(change)) object.volume += cell_size * cell_size * change;
    }
    objects.push_back(std::move(object));
  });
  return objects;
}

/// Crates and the like in the scan `with`.
std::vector<Object> lying(const Eigen::ArrayXXd& without, const Eigen::ArrayXXd& with,
                          double cell_size, double margin, bool on_any_ground) {
  constexpr double side = 1.5;  // cells that show its sides beyond the top
  std::vector<Object> objects;
  for (const LevelTop& top : level_tops(without, with, cell_size, on_any_ground)) {
    Object object;
    object.is_low = true;
    object.is_sure = top.is_sure;
    object.cells = widened(top.cells, with, margin + side);
    for (const Cell at : top.cells) {
      const double change = with(at.row, at.col) - without(at.row, at.col);
      if (!std::isnan(change)) object.volume += cell_size * cell_size * change;
    }
    objects.push_back(std::move(object));
  }
  return objects;
}

void blank(Eigen::ArrayXXd& z, const std::vector<Object>& objects) {
  for (const Object& object : objects) {
    for (const Cell at : object.cells) {
      z(at.row, at.col) = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

/// The heights of two opposite neighbours, if they differ by more than a wall's height.
struct Step {
  double low;
  double high;
};
std::optional<Step> wall_across(const Eigen::ArrayXXd& z, Cell at) {
  constexpr double wall = 0.5;  // ours [m]
  for (const Cell d : {Cell{1, 0}, Cell{0, 1}}) {
    const Cell one = {at.row - d.row, at.col - d.col};
    const Cell two = {at.row + d.row, at.col + d.col};
    if (one.row < 0 || one.col < 0 || two.row >= z.rows() || two.col >= z.cols()) continue;
    const double a = z(one.row, one.col);
    const double b = z(two.row, two.col);
    if (std::abs(b - a) > wall) return Step{std::min(a, b), std::max(a, b)};
  }
  return std::nullopt;
}

/// Faces of walls that stand in both scans: how high a cell of them is depends on how many points
/// of the face it holds, which soil against the wall hides.
/// @param dug  1 on walls of earlier digs, which are soil
void blank_faces(Eigen::ArrayXXd& before, Eigen::ArrayXXd& after, const Eigen::ArrayXXi& dug) {
  constexpr double between = 0.05;  // ours, of the step
  std::vector<Cell> faces;
  for_each_cell(before, [&](Cell at) {
    const auto step = wall_across(before, at);
    if (!step || (dug.size() > 0 && dug(at.row, at.col) != 0)) return;
    const double share = (before(at.row, at.col) - step->low) / (step->high - step->low);
    if (share > between && share < 1.0 - between) faces.push_back(at);
  });
  for (const Cell at : faces) {
    before(at.row, at.col) = after(at.row, at.col) = std::numeric_limits<double>::quiet_NaN();
  }
}

/// Walls, masts and buildings that stand in both scans, and what lies right beside them: their
/// cells are as high as the points of a face that fell into them, which no two scans share.
/// @param dug  1 in holes of earlier digs, above which nothing stands
void blank_structures(Eigen::ArrayXXd& before, Eigen::ArrayXXd& after, double cell_size,
                      const Eigen::ArrayXXi& dug) {
  constexpr double beside = 1.5;  // cells
  const Eigen::ArrayXXd lower = before.min(after);
  const double range =
      lower.isNaN().select(-1e30, lower).maxCoeff() - lower.isNaN().select(1e30, lower).minCoeff();
  if (range < least_over_slope) return;
  const auto without = [&](const Eigen::ArrayXXd& z) -> Eigen::ArrayXXd {
    if (dug.size() == 0) return z;
    return (dug != 0).select(std::numeric_limits<double>::quiet_NaN(), z);
  };
  const Eigen::ArrayXXd of_both =
      excess_of(without(before), cell_size)
          .min(excess_of(without(after), cell_size));  // NaN: not in both
  std::vector<Cell> cells;
  for_each_cell(of_both, [&](Cell at) {
    if (of_both(at.row, at.col) > least_over_slope) cells.push_back(at);
  });
  for (const Cell at : widened(cells, before, beside)) {
    before(at.row, at.col) = after(at.row, at.col) = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

bool is_beside_wall(const Eigen::ArrayXXd& z, Cell at) { return wall_across(z, at).has_value(); }

std::vector<Object> take_out_objects(Eigen::ArrayXXd& before, Eigen::ArrayXXd& after,
                                     double cell_size, double margin, const Eigen::ArrayXXi& dug) {
  const bool is_known = dug.size() > 0;  // then things were told from soil already
  std::vector<Object> objects = standing(after, before, cell_size, margin);
  std::vector<Object> gone;
  if (!is_known) gone = standing(before, after, cell_size, margin);
  blank(after, objects);
  blank(before, gone);
  blank_faces(before, after, dug);
  blank_structures(before, after, cell_size, dug);
  // Soil lies level with steep sides only where it was dug, so that a thing before may lie
  // anywhere.
  std::vector<Object> low = lying(before, after, cell_size, margin, false);
  std::vector<Object> low_before;
  if (!is_known) low_before = lying(after, before, cell_size, margin, true);
  blank(after, low);
  blank(before, low_before);
  objects.insert(objects.end(), low.begin(), low.end());
  gone.insert(gone.end(), low_before.begin(), low_before.end());
  for (Object& object : gone) {
    object.is_before = true;
    object.volume = -object.volume;
    objects.push_back(std::move(object));
  }
  return objects;
}

}  // namespace excavplan
