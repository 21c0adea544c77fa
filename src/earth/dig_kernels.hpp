// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// @file
/// The loops in which a dig spends its time, over plain arrays. Each result is of one element alone
/// and no product is fused with a sum: the bytes are the same however many elements a processor
/// takes at once. Sums are taken elsewhere, in the order of the elements.

namespace excavplan {

constexpr std::size_t most_cells_of_a_line = 64;

/// A line of cells across the pile ahead, at most most_cells_of_a_line.
struct PileLine {
  double along = 0.0;    ///< of all cells, from the level top [m]
  double reach = 0.0;    ///< from the level top, up to which soil is sought [m]
  double slope = 0.0;    ///< of the pile
  double seen_to = 0.0;  ///< top of the pile [m]
  std::size_t count = 0;
  const double* height = nullptr;  ///< of the cells
  const double* across = nullptr;  ///< of the cells beyond the sides of the bucket, >= 0 [m]
};
/// The cells from the first that can be covered to the last; both 0 if there is none.
struct CoveredCells {
  std::size_t first = 0;
  std::size_t end = 0;
};
/// For each cell the level of the top from which on it is covered; that is infinite where it is out
/// of reach or above `seen_to`.
CoveredCells find_bases(const PileLine& line, double* base);

/// Cells in succession.
struct CellLayers {
  std::size_t count = 0;
  const double* bank = nullptr;
  double* loose = nullptr;
  double* height = nullptr;
};
/// A share of a pile with its top at this level.
struct PileShare {
  double top = 0.0;
  double part = 0.0;
};
/// Adds to the loose layer what lies between the bases of the cells and the top of the pile.
void raise_to(const PileShare& pile, const double* base, const CellLayers& cells);

/// A side of the bucket's profile, over the slices from `from` on and below `end` [m].
struct ProfileSide {
  double from = 0.0;
  double end = 0.0;
  double x = 0.0;  ///< of a point on it, with z
  double z = 0.0;
  double slope = 0.0;
};
/// Extent of the cavity above the middle x of each slice, from the lip.
struct SliceBounds {
  std::size_t count = 0;
  const double* x = nullptr;
  double* low = nullptr;
  double* high = nullptr;
};
/// Widens the slices that a side crosses down or up to there.
void bound_slices(const ProfileSide& side, const SliceBounds& slices);
/// The same for the mouth, the last side: `lid` is 0 where it is the upper bound, else 1, and
/// `open` 1 for slices that have room and not the mouth as their lower bound, else 0.
void close_slices(const ProfileSide& mouth, const SliceBounds& slices, double* lid, double* open);

/// The cavity of the bucket in slices: from `low` up to `high`, both from the lip.
struct CavitySlices {
  std::size_t count = 0;
  const double* low = nullptr;
  const double* high = nullptr;
  const double* lid = nullptr;           ///< 0 where open above, else 1
  const double* ahead = nullptr;         ///< of the lip, >= 0 [m]
  const double* short_of_top = nullptr;  ///< of the top edge, >= 0 [m]
};
/// What is put into the cavity.
struct CavityLoad {
  double support = 0.0;  ///< level of the soil ahead, above the lip [m]
  double face = 0.0;     ///< slope behind the lip
  double heap = 0.0;     ///< slope before the top edge
  double top = 0.0;      ///< of the top edge, above the lip [m]
  double flank = 0.0;    ///< height at which the slopes of both sides meet [m]
};
/// Height of the soil that each slice holds, mean over the width.
void fill_slices(const CavitySlices& slices, const CavityLoad& load, double* height);
/// Height up to a level, in slices that are open above whatever their height.
void push_into_slices(const CavitySlices& slices, double level, double* height);

/// A stretch of the tip's line through one column of cells.
struct CutLine {
  double z0 = 0.0;      ///< where the stretch is in the column at its lower x [m]
  double z1 = 0.0;      ///< at its higher x [m]
  double share = 0.0;   ///< of the column's length
  double ahead = 0.0;   ///< share of the column that the lip has not passed before
  double behind = 0.0;  ///< mean level of the lip where it has passed the column [m]
};
/// The rows of a column.
struct CutColumn {
  std::size_t count = 0;
  const double* top = nullptr;    ///< of what was undisturbed before the dig [m]
  const double* lying = nullptr;  ///< loose soil [m]
  const double* cover = nullptr;  ///< of the row by the bucket
};
/// For each row what lies above the line.
void cut_cells(const CutLine& line, const CutColumn& column, double* bank, double* loose);

/// Columns of cells one after another, of which each is a wedge's next: `step` from one to the
/// next.
struct PiledColumns {
  std::size_t rows = 0;
  const double* loose = nullptr;  ///< of the first column, now [m]
  const double* lay = nullptr;    ///< before the dig [m]
  std::ptrdiff_t loose_step = 0;
  std::ptrdiff_t lay_step = 0;
};
/// Adds to `sum` what was pushed up on so many columns of a wedge, of which `cells` cells were left
/// before, at most 1 of each.
void add_piles(const PiledColumns& columns, std::size_t count, double* cells, double* sum);

}  // namespace excavplan
