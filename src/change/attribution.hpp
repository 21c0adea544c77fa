// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/change/change_options.hpp>

#include "change/changes.hpp"
#include "change/soil_balance.hpp"
#include "change/surveyed_area.hpp"

namespace excavplan {

constexpr double least_after_share = 0.5;  ///< ours: with less, the heap is not in the scans

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

}  // namespace excavplan
