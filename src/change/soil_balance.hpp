// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "change/changes.hpp"

/// @file
/// Which changes belong to the dig together, by the balance of the soil. Private to the project.

namespace excavplan {

/// Changes that belong to the dig, and how likely it is that these and no others do.
struct Combination {
  std::vector<bool> counted;  ///< by change
  double weight = 0.0;        ///< those of all combinations add up to 1
};

/// The changes that are combined, largest first: the twelve largest (ours) that are open. Those
/// beyond keep the probability of their shape and place.
std::vector<std::size_t> combined_changes(const std::vector<Change>& changes);

/// All combinations of these, each as likely as its shapes, places and bulking factor; likeliest
/// first.
std::vector<Combination> combinations_of(const std::vector<Change>& changes);

/// Sets the probability of each change from the combinations.
void set_probabilities(const std::vector<Combination>& combinations, std::vector<Change>& changes);

}  // namespace excavplan
