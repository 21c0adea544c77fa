// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <excavplan/change/change_options.hpp>

#include "change/changes.hpp"
#include "change/surveyed_area.hpp"

/// @file
/// Which changes belong to the dig together, by shape, place and the balance of the soil. Private
/// to the project.

namespace excavplan {

constexpr double least_after_share = 0.5;   ///< ours: with less, the heap is not in the scans
constexpr double least_bulking = 0.97;      ///< loosest soil keeps its volume; ours: 3 % below that
constexpr double least_dumped_share = 0.2;  ///< ours: a smaller rise away from the hole is no heap

/// Changes that belong to the dig, and how likely it is that these and no others do.
struct Combination {
  std::vector<bool> counted;  ///< by change
  double weight = 0.0;        ///< those of all combinations add up to 1
};

/// What the changes of a scene are.
struct Attribution {
  std::vector<Change> changes;
  std::vector<Combination> combinations;  ///< likeliest first: the one whose volumes are given
};

/// Decides by shape, place and the balance of the soil what each zone is, and sets its kind: of all
/// combinations of changes the one that is likeliest.
///
/// @param areas one for a whole scene; the dig area and the dump area otherwise
Attribution attribute(std::vector<Area>& areas, const ChangeOptions& options);

/// Likelihood of a bulking factor: even from 1.02 to 1.65, in any soil, and 0.3 of that up to 2.5,
/// in ground that breaks into blocks (docs/methods.md#attribution).
double likelihood_of_bulking(double k);

/// The changes that are combined, largest first: the twelve largest (ours) that are open. Those
/// beyond keep the probability of their shape and place.
std::vector<std::size_t> combined_changes(const std::vector<Change>& changes);

}  // namespace excavplan
