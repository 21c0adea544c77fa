// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/ground/volume_change.hpp>

#include "ground/surveyed_area.hpp"

namespace excavplan {

constexpr double least_after_share = 0.5;  ///< ours: with less, the heap is not in the scans

/// One or more zones that belong to the dig together or not at all.
struct Change {
  /// A zone by area and index.
  struct Place {
    std::size_t area;
    std::size_t zone;
  };
  std::string what;          ///< "a second heap", "ruts"
  std::vector<Place> zones;  ///< all of one sign
  double volume = 0.0;       ///< signed [m^3]
  double prior = 0.0;        ///< probability by shape and place that it belongs to the dig
  double probability = 0.0;  ///< likewise, with the balance of the soil
};

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

/// Enters what is open into the result, whose volumes are known: list, covariance, readings,
/// warnings (attribution_open, stirred_ground).
void state_open_changes(const std::vector<Area>& areas, const Attribution& attribution,
                        VolumeChange& result);

}  // namespace excavplan
