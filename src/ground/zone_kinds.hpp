// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/ground/volume_change.hpp>

#include "ground/surveyed_area.hpp"

namespace excavplan {

constexpr double least_after_share = 0.5;  ///< ours: with less, the heap is not in the scans

using Chosen = std::vector<bool>;  ///< by index of the zone

/// Marks the hole; what rose beside it is spill. Returns the zones beside the hole.
Chosen classify_hole(Area& area, const ChangeOptions& options);

/// Marks hole, spill and heap. The heap is what rose away from the hole. Where nothing did, but the
/// largest rise beside the hole could hold the dug soil, that is the heap.
void classify_scene(Area& area, const ChangeOptions& options);

/// Marks the heap of an area without a hole.
void classify_heap(Area& area, const ChangeOptions& options);

}  // namespace excavplan
