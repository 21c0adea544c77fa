// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "earth/slump.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

/// A cell: its row and column on the map and its index in the layers.
struct Place {
  Index row = 0;
  Index col = 0;
  std::size_t cell = 0;
};

/// How far the lower neighbour of a cell along one axis lies below, 0 if none does.
struct Fall {
  std::size_t to = 0;  ///< the lower neighbour
  double height = 0.0;
};

/// Soil slides along the gradient of the surface, taken on each axis to the lower of the two
/// neighbours (upwind, Rouy and Tourin 1992), so that heaps are as steep in every direction, not
/// only along the grid.
template <typename Ground>
class Slide {
 public:
  Slide(Ground& ground, const SlopeLimits& limits) : ground_(ground), limits_(limits) {
    if constexpr (has_bank) bank_ = limits_of(ground.soil().bank);
  }

  /// One pass over the cells of the block that are awake; returns the cells that moved.
  CellBlock sweep(const CellBlock& block, int order) {
    constexpr Index far = std::numeric_limits<Index>::max() / 2;
    moved_ = {far, -far, far, -far};
    slid_ = 0;
    const Index first = (order & 2) != 0 ? block.row_end - 1 : block.row_begin;
    const Index along = (order & 2) != 0 ? -1 : 1;
    for (Index i = 0; i < block.cols(); ++i) {
      const Index col = (order & 1) != 0 ? block.col_end - 1 - i : block.col_begin + i;
      Place at = {first, col, ground_.at(first, col)};
      for (Index j = 0; j < block.rows(); ++j) {
        if (ground_.awake(at.cell)) relax(at);
        at.row += along;
        at.cell += static_cast<std::size_t>(along);
      }
    }
    return moved_.empty() ? CellBlock{} : moved_.around(1);
  }

  /// Cells from which soil slid in the last pass.
  int slid() const { return slid_; }

 private:
  static constexpr bool has_bank = std::is_same_v<Ground, GroundWindow>;

  struct BankLimits {
    double slope = 0.0;            ///< tangent of the friction angle
    double critical_height = 0.0;  ///< of a vertical wall [m]
  };

  void relax(const Place& at) {
    ground_.let_sleep(at.cell);
    if (std::isnan(ground_.height(at.cell))) return;
    ground_.let_slide(at.cell, false);
    if (ground_.loose(at.cell) > 0.0) slide_loose(at);
    if constexpr (has_bank) {
      if (!limits_.bank_stands) fail_bank(at);
    }
  }

  /// From height `top` in a cell to the lower neighbour on an axis, `step` away. On a flank, where
  /// the other neighbour is higher, the fall is the mean over both sides: the lower side alone
  /// appears too steep where contours are curved (by 0.35 cells / radius on a cone's diagonal). But
  /// never much less than on that side, or steps could remain.
  Fall fall(double top, std::size_t cell, std::size_t step) const {
    constexpr double least = 0.85;  // of the fall on the lower side; ours
    const double before = drop(top, cell, cell - step);
    const double after = drop(top, cell, cell + step);
    const bool onwards = !(before >= after);
    const double lower = std::max(std::max(before, after), 0.0);
    const double other = std::min(before, after);
    const double mean = std::min(std::max(0.5 * (lower - other), least * lower), lower);
    return {onwards ? cell + step : cell - step, other < 0.0 ? mean : lower};
  }

  /// From height `top` of a cell down to one beside it; 0 to cells that are unknown or off
  /// the map, and over the edge of a wall on larger cells, which do not see how far it is.
  double drop(double top, std::size_t cell, std::size_t beside) const {
    if constexpr (!has_bank) {
      if (ground_.wall_between(cell, beside)) return 0.0;
    }
    const double drop = top - ground_.height(beside);
    return drop == drop ? drop : 0.0;
  }

  /// How much has to leave a cell so that it falls no steeper than `slope`, if the share of each
  /// axis arrives swollen by `swell` below; 0 if it does not.
  double excess(const Fall& x, const Fall& y, double slope, double swell) const {
    const double stable = slope * ground_.cell_size();
    const double too_steep = (1.0 + limits_.slack) * stable;
    const double squared = x.height * x.height + y.height * y.height;
    if (!(squared > too_steep * too_steep)) return 0.0;
    const double steepness = std::sqrt(squared);
    const double sum = x.height + y.height;
    const double raised = stays(x.to) * x.height * x.height + stays(y.to) * y.height * y.height;
    const double leaves = steepness - (1.0 - limits_.slack) * stable;
    return leaves * steepness * sum / (sum * sum + swell * raised);
  }

  /// Share of what arrives on a cell that raises it, if the rest slides on from there.
  double stays(std::size_t cell) const {
    constexpr double share = 0.35;  // ours: none would carry soil past where it rests
    return ground_.slides(cell) ? share : 1.0;
  }

  void slide_loose(const Place& at) {
    const double top = ground_.height(at.cell);
    const Fall x = fall(top, at.cell, ground_.column_step());
    const Fall y = fall(top, at.cell, 1);
    const double swell = ground_.swollen_loose(at.cell, 1.0);
    const double needed = excess(x, y, limits_.loose_slope, swell);
    if (!(needed > 0.0)) return;
    ground_.let_slide(at.cell, true);
    const double leaving = std::min(ground_.loose(at.cell), needed);
    ground_.lower_loose(at.cell, leaving);
    arrive(leaving * swell, at, x, y);
  }

  /// Breaks undisturbed soil off a wall that is too high; it falls to the foot as loose soil.
  void fail_bank(const Place& at) {
    const BankLimits bank = bank_limits(at);
    const double top = ground_.bank(at.cell) - bank.critical_height;
    const Fall x = fall(top, at.cell, ground_.column_step());
    const Fall y = fall(top, at.cell, 1);
    if (x.height + y.height == 0.0) return;
    const double swell = ground_.swollen_bank(at.row, at.col, 1.0);
    const double broken = excess(x, y, bank.slope, swell);
    if (!(broken > 0.0)) return;
    ground_.lower_bank(at.cell, broken);
    arrive(broken * swell, at, x, y);
  }

  /// Distributes the soil that has left a cell over both axes.
  void arrive(double thickness, const Place& from, const Fall& x, const Fall& y) {
    ++slid_;
    const double along_x = thickness * x.height / (x.height + y.height);
    if (x.height != 0.0) ground_.raise_loose(x.to, along_x);
    if (y.height != 0.0) ground_.raise_loose(y.to, std::max(0.0, thickness - along_x));
    moved_.row_begin = std::min(moved_.row_begin, from.row);
    moved_.row_end = std::max(moved_.row_end, from.row + 1);
    moved_.col_begin = std::min(moved_.col_begin, from.col);
    moved_.col_end = std::max(moved_.col_end, from.col + 1);
  }

  BankLimits bank_limits(const Place& at) const {
    if (ground_.bank_is_even()) return bank_;
    return limits_of(ground_.bank_state(at.row, at.col));
  }
  static BankLimits limits_of(const SoilState& bank) {
    return {std::tan(bank.friction_angle), critical_height(bank)};
  }

  Ground& ground_;
  SlopeLimits limits_;
  BankLimits bank_;
  CellBlock moved_;
  int slid_ = 0;
};

/// Bit 0: columns backwards, bit 1: rows backwards. The next pass and the one on larger cells run
/// against the rows of this one, so that no side is favoured.
constexpr std::array<int, 4> orders = {0, 2, 3, 1};

constexpr double large_cell = 0.08;    // cells as large as these have no larger ones [m]; ours
constexpr int large_slide = 32;        // cells that slid, from which larger ones pay; ours
constexpr double steepest_bank = 2.0;  // over the repose: steeper is a wall on larger cells; ours

bool is_large(double cell) { return !(cell < large_cell); }

/// Cells around a block that soil from it can reach in one pass on cells of this size and larger.
int reach(double cell) { return is_large(cell) ? 2 : 2 * reach(2.0 * cell) + 2; }

/// The four cells of the finer ground in a cell of the ground on larger ones.
template <typename Ground>
std::array<std::size_t, 4> parts_of(const Ground& finer, Index row, Index col) {
  const std::size_t first = finer.at(2 * row, 2 * col);
  const std::size_t column = finer.column_step();
  return {first, first + 1, first + column, first + column + 1};
}

/// Takes in the cells of `block`, whose rows and columns are half those of `finer`, as they are
/// now.
template <typename Ground>
void look_at(const Ground& finer, const CellBlock& block, CoarseGround& coarse) {
  for (Index col = block.col_begin; col < block.col_end; ++col) {
    for (Index row = block.row_begin; row < block.row_end; ++row) {
      const std::array<std::size_t, 4> cells = parts_of(finer, row, col);
      std::array<CoarseGround::Part, 4> parts;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::size_t cell = cells[i];
        const double loose = finer.loose(cell);
        parts[i] = {finer.bank(cell), loose > 0.0 ? finer.swollen_loose(cell, loose) : 0.0,
                    finer.height(cell), finer.awake(cell), finer.slides(cell)};
      }
      coarse.take_in(parts, coarse.at(row, col));
    }
  }
}

/// Moves as much soil on the finer ground: each part of a cell gains as much, or loses the same
/// share of its loose layer. Returns the cells of the finer ground that changed.
template <typename Ground>
CellBlock give_back(const CoarseGround& coarse, const CellBlock& block, Ground& finer) {
  CellBlock changed;
  for (Index col = block.col_begin; col < block.col_end; ++col) {
    for (Index row = block.row_begin; row < block.row_end; ++row) {
      const std::size_t cell = coarse.at(row, col);
      const double gained = coarse.gained(cell);
      if (gained == 0.0) continue;
      for (const std::size_t part : parts_of(finer, row, col)) {
        if (gained > 0.0) {
          finer.raise_loose(part, gained);
        } else {
          finer.lower_loose(part, finer.loose(part) * coarse.lost_share(cell));
        }
      }
      changed.include({2 * row, 2 * row + 2, 2 * col, 2 * col + 2});
    }
  }
  return changed;
}

/// One pass over the block on cells of twice the size, after one on yet larger ones; returns the
/// cells that changed.
template <typename Ground>
CellBlock slide_on_larger_cells(Ground& ground, CoarseGround& coarse, const CellBlock& block,
                                const SlopeLimits& limits, int order) {
  if (is_large(ground.cell_size())) return {};
  const CellBlock whole = CoarseGround::whole(ground.cells());
  const CellBlock half = CoarseGround::half(block);
  const CellBlock seen = half.around(reach(2.0 * ground.cell_size())).common(whole);
  const CellBlock swept = half.around(1).common(whole);
  if (swept.empty()) return {};
  coarse.lay_out(ground.cells(), ground.cell_size(),
                 steepest_bank * limits.loose_slope * ground.cell_size());
  look_at(ground, seen, coarse);
  slide_on_larger_cells(coarse, coarse.coarser(), swept, limits, order ^ 2);
  Slide<CoarseGround>(coarse, limits).sweep(swept, order);
  return give_back(coarse, seen, ground);
}

}  // namespace

CellBlock slump(GroundWindow& ground, CellBlock block, const SlopeLimits& limits, int sweeps) {
  Slide<GroundWindow> slide(ground, limits);
  SlumpState& state = ground.slumping();
  for (int i = 0; i < sweeps && !block.empty(); ++i) {
    ground.cover(ground.widened(block, reach(ground.cell_size()) + 2));
    const int order = orders[static_cast<std::size_t>(state.passes++ % 4)];
    if (state.slid >= large_slide) {
      block.include(slide_on_larger_cells(ground, state.coarser, block, limits, order ^ 2));
    }
    block = slide.sweep(ground.widened(block, 1), order);
    state.slid = slide.slid();
  }
  return block;
}

void pour(GroundWindow& ground, const Eigen::Vector2d& at, double volume, double slope) {
  const HeightMap& map = ground.before().bank;
  const double row_at = std::floor((at.y() - map.origin.y()) / map.cell_size);
  const double col_at = std::floor((at.x() - map.origin.x()) / map.cell_size);
  const bool on_map = row_at >= 0.0 && col_at >= 0.0 &&
                      row_at < static_cast<double>(map.z.rows()) &&
                      col_at < static_cast<double>(map.z.cols());
  const auto row = static_cast<Index>(on_map ? row_at : 0.0);
  const auto col = static_cast<Index>(on_map ? col_at : 0.0);
  if (!on_map || std::isnan(map.z(row, col))) {
    throw Error(ErrorKind::bad_input, "dump point (" + number_text(at.x()) + ", " +
                                          number_text(at.y()) +
                                          ") m must lie on known ground of the map");
  }
  // On ground up to nearly as steep as the cone, the heap stays within a few radii of level
  // ground's.
  const double radius = std::cbrt(3.0 * volume / (pi * slope));
  const CellBlock axis = {row, row + 1, col, col + 1};
  const CellBlock block =
      ground.widened(axis, static_cast<Index>(3.0 * radius / map.cell_size) + 2);
  ground.cover(block);
  const auto raised = [&](Index r, Index c, double apex) {
    const double distance = std::hypot(map.x(c) - at.x(), map.y(r) - at.y());
    const double rise = apex - slope * distance - ground.height(r, c);
    return rise > 0.0 ? rise : 0.0;  // 0 also on unknown cells
  };
  const auto poured = [&](double apex) {
    double sum = 0.0;
    for (Index c = block.col_begin; c < block.col_end; ++c) {
      for (Index r = block.row_begin; r < block.row_end; ++r) sum += raised(r, c, apex);
    }
    return sum * map.cell_size * map.cell_size;
  };
  double low = ground.height(row, col);
  double high = low + 1.0;
  while (poured(high) < volume) high += high - low;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (poured(middle) < volume ? low : high) = middle;
  }
  const double exact = volume > 0.0 ? volume / poured(high) : 0.0;  // corrects the rounding
  for (Index c = block.col_begin; c < block.col_end; ++c) {
    for (Index r = block.row_begin; r < block.row_end; ++r) {
      if (const double rise = raised(r, c, high); rise > 0.0) {
        ground.raise_loose(ground.at(r, c), exact * rise);
      }
    }
  }
}

}  // namespace excavplan
