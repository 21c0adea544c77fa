// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "earth/dig_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "earth/each_processor.hpp"

namespace excavplan {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

inline double height_at(const ProfileSide& side, double x) {
  return side.z + side.slope * (x - side.x);
}

/// Bit i of number i.
struct CellBits {
  constexpr CellBits() {
    for (std::size_t i = 0; i < most_cells_of_a_line; ++i) bit[i] = std::uint64_t{1} << i;
  }
  std::uint64_t bit[most_cells_of_a_line] = {};
};
constexpr CellBits cell_bits;

inline CoveredCells ends_of(std::uint64_t covered) {
  if (covered == 0) return {};
  return {static_cast<std::size_t>(__builtin_ctzll(covered)),
          most_cells_of_a_line - static_cast<std::size_t>(__builtin_clzll(covered))};
}

}  // namespace

EXCAVPLAN_FOR_EACH_PROCESSOR
CoveredCells find_bases(const PileLine& line, double* __restrict base) {
  const double* __restrict height = line.height;
  const double* __restrict across = line.across;
  const std::size_t count = line.count;
  const double along = line.along;
  const double along_square = along * along;
  const double reach = line.reach;
  const double slope = line.slope;
  const double seen_to = line.seen_to;
  std::uint64_t covered = 0;
  if (along == 0.0) {  // spares the roots: that of a square is exact
    for (std::size_t i = 0; i < count; ++i) {
      const double away = across[i];
      const double level = height[i] + slope * away;
      const bool covers = (away <= reach) & (level < seen_to);
      base[i] = covers ? level : none;
      covered |= covers ? cell_bits.bit[i] : 0;
    }
    return ends_of(covered);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double root = std::sqrt(along_square + across[i] * across[i]);
    const double away = across[i] > 0.0 ? root : along;
    const double level = height[i] + slope * away;
    const bool covers = (away <= reach) & (level < seen_to);  // not on unknown ground
    base[i] = covers ? level : none;
    covered |= covers ? cell_bits.bit[i] : 0;
  }
  return ends_of(covered);
}

EXCAVPLAN_FOR_EACH_PROCESSOR
void raise_to(const PileShare& pile, const double* __restrict base, const CellLayers& cells) {
  const double top = pile.top;
  const double part = pile.part;
  const double* __restrict bank = cells.bank;
  double* __restrict loose = cells.loose;
  double* __restrict height = cells.height;
  const std::size_t count = cells.count;
  for (std::size_t i = 0; i < count; ++i) {
    const double above = part * (top - base[i]);
    const double raised = loose[i] + (top > base[i] ? above : 0.0);
    loose[i] = raised;
    height[i] = bank[i] + raised;
  }
}

EXCAVPLAN_FOR_EACH_PROCESSOR
void bound_slices(const ProfileSide& side, const SliceBounds& slices) {
  const double* __restrict x = slices.x;
  double* __restrict low = slices.low;
  double* __restrict high = slices.high;
  const ProfileSide s = side;
  for (std::size_t i = 0; i < slices.count; ++i) {
    const bool crossed = (s.from <= x[i]) & (x[i] < s.end);
    const double z = height_at(s, x[i]);
    low[i] = std::min(low[i], crossed ? z : none);
    high[i] = std::max(high[i], crossed ? z : -none);
  }
}

EXCAVPLAN_FOR_EACH_PROCESSOR
void close_slices(const ProfileSide& mouth, const SliceBounds& slices, double* __restrict lid,
                  double* __restrict open) {
  const double* __restrict x = slices.x;
  double* __restrict low = slices.low;
  double* __restrict high = slices.high;
  const ProfileSide s = mouth;
  for (std::size_t i = 0; i < slices.count; ++i) {
    const bool crossed = (s.from <= x[i]) & (x[i] < s.end);
    const double z = height_at(s, x[i]);
    const double below = crossed ? z : none;
    const double above = crossed ? z : -none;
    const bool opens_below = below < low[i];
    const double bottom = std::min(low[i], below);
    const double top = std::max(high[i], above);
    lid[i] = above > high[i] ? 0.0 : 1.0;
    open[i] = ((top > bottom) & !opens_below) ? 1.0 : 0.0;
    low[i] = bottom;
    high[i] = top;
  }
}

EXCAVPLAN_FOR_EACH_PROCESSOR
void fill_slices(const CavitySlices& slices, const CavityLoad& load, double* __restrict height) {
  const double* __restrict low = slices.low;
  const double* __restrict high = slices.high;
  const double* __restrict lid = slices.lid;
  const double* __restrict ahead = slices.ahead;
  const double* __restrict short_of_top = slices.short_of_top;
  const double support = std::max(0.0, load.support);
  const double face = load.face;
  const double heap_slope = load.heap;
  const double top = load.top;
  const double flank = load.flank;
  for (std::size_t i = 0; i < slices.count; ++i) {
    const double rises = support + face * ahead[i];
    const double room = high[i] - low[i];
    const double in = rises - low[i];
    const double not_below = in < 0.0 ? 0.0 : in;
    const double closed = room < not_below ? room : not_below;
    // The walls of the cut hold the soil beside the plates up to the level of the ground; behind
    // the top edge the cut is open.
    const double side = std::max(high[i], support > 0.0 ? support : high[i]);
    const double surface = std::min(rises, top + heap_slope * short_of_top[i]);
    const double heap = std::max(0.0, surface - side);
    const double mean_heap = heap < flank ? heap - 0.5 * heap * heap / flank : 0.5 * flank;
    const double open = std::max(0.0, std::min(surface, side) - low[i]) + mean_heap;
    height[i] = lid[i] > 0.0 ? closed : open;
  }
}

EXCAVPLAN_FOR_EACH_PROCESSOR
void push_into_slices(const CavitySlices& slices, double level, double* __restrict height) {
  const double* __restrict low = slices.low;
  const double* __restrict high = slices.high;
  const double* __restrict lid = slices.lid;
  for (std::size_t i = 0; i < slices.count; ++i) {
    const double up = std::max(0.0, level - low[i]);
    const double closed = std::min(up, high[i] - low[i]);
    height[i] = lid[i] > 0.0 ? closed : up;
  }
}

namespace {

/// Mean over an interval of max(0, height - z), z running linearly from z0 to z1.
inline double mean_above(double height, double z0, double z1) {
  const double a = height - z0;
  const double b = height - z1;
  const double positive = std::max(a, b);
  const double in_part = 0.5 * positive * positive / std::abs(a - b);
  const double below = ((a <= 0.0) & (b <= 0.0)) ? 0.0 : in_part;
  return ((a >= 0.0) & (b >= 0.0)) ? 0.5 * (a + b) : below;
}

}  // namespace

EXCAVPLAN_FOR_EACH_PROCESSOR
void cut_cells(const CutLine& line, const CutColumn& column, double* __restrict bank,
               double* __restrict loose) {
  const double* __restrict top = column.top;
  const double* __restrict lying = column.lying;
  const double* __restrict cover = column.cover;
  const std::size_t count = column.count;
  const CutLine l = line;
  for (std::size_t i = 0; i < count; ++i) {
    const double covered = l.share * cover[i];
    const double above = mean_above(top[i], l.z0, l.z1);
    bank[i] = covered * above;
    // Where the lip has passed, loose soil lies only under its line; the rest is ahead.
    const double under = l.behind - top[i];
    const double filled = under < 0.0 ? 0.0 : under;
    const double passed = lying[i] < filled ? lying[i] : filled;
    const double thickness = (lying[i] - (1.0 - l.ahead) * passed) / l.ahead;
    loose[i] = std::min(lying[i], covered * (mean_above(top[i] + thickness, l.z0, l.z1) - above));
  }
}

EXCAVPLAN_FOR_EACH_PROCESSOR
void add_piles(const PiledColumns& columns, std::size_t count, double* __restrict cells,
               double* __restrict sum) {
  const std::size_t rows = columns.rows;
  const double* __restrict loose = columns.loose;
  const double* __restrict lay = columns.lay;
  for (; count > 0; --count) {
    for (std::size_t i = 0; i < rows; ++i) {
      const double left = cells[i] - 1.0;
      const double share = left > 0.0 ? std::min(1.0, left) : 0.0;
      cells[i] = left;
      sum[i] += share * std::max(0.0, loose[i] - lay[i]);
    }
    loose += columns.loose_step;
    lay += columns.lay_step;
  }
}

}  // namespace excavplan
