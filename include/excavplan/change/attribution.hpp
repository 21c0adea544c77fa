// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// @file
/// Which changes of the ground belong to the dig (`docs/methods.md#attribution`).

namespace excavplan {

/// A figure with its standard deviation.
struct Measured {
  double value = 0.0;  ///< in the unit of the figure
  double sd = 0.0;     ///< standard deviation, likewise
};

/// What a change of the ground looks like.
enum class ChangeKind {
  hole,          ///< the largest fall
  second_hole,   ///< another that is as deep as a dig
  small_hole,    ///< one of less than 3 % of the hole
  settled,       ///< ground that fell a little
  edge,          ///< low ground that a hole or a heap runs out into
  heap,          ///< the largest rise away from the hole
  second_heap,   ///< another rise away from the hole
  spill,         ///< soil beside a hole
  clods,         ///< small rises between hole and heap
  small_rises,   ///< small rises elsewhere
  lump,          ///< steep and rounded: soil, or a thing
  thing,         ///< steep, with a level top
  ruts,          ///< of tracks or wheels; a lone one may be a shallow scrape
  berms,         ///< soil that tracks pushed aside
  stirred,       ///< ground that rose and fell in many small places
  within_error,  ///< less than two standard deviations
  in_area,       ///< in an area that was given for it
  outside_area,  ///< outside of it
  earlier_soil,  ///< loose soil of an earlier dig that was dug with the hole
  pressed,       ///< ground under the heap that gave way; no scan shows it
  water,         ///< over the floor of the hole; no scan shows it
};

/// "hole", "second_hole", ...: the names above.
const char* name(ChangeKind kind);

/// A change that was left out of the volumes and might belong to the dig, or was counted and might
/// not.
struct AttributedChange {
  ChangeKind kind = ChangeKind::hole;  ///< what it looks like
  std::string what;                    ///< text: likewise, and where
  Measured volume;                     ///< of the change, > 0 where the ground rose [m^3]
  bool counted = false;                ///< it is part of hole, spill or heap
  double probability = 0.0;            ///< that it belongs to the dig, 0 .. 1
};

/// The bulking factor if some open changes are attributed the other way.
struct Reading {
  std::vector<ChangeKind> kinds;  ///< of these changes; none for the scene as it was counted
  std::string what;               ///< text: what is taken to be so
  double weight = 0.0;            ///< its probability; those of all readings add up to 1
  Measured bulking;               ///< k with the error of scans and of this reading [-]
};

/// No scan shows whether the reading is true: it has a prior weight alone, and is in no interval.
bool is_unseen(const Reading& reading);

}  // namespace excavplan
