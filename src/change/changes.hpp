// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <excavplan/change/change_options.hpp>
#include <excavplan/change/dig_volumes.hpp>

#include "change/surveyed_area.hpp"

/// @file
/// The changes of a scene and what they look like. Private to the project.

namespace excavplan {

constexpr double certain = 0.98;   ///< ours: a change of this probability is not open
constexpr double excluded = 0.02;  ///< ours: nor one of this, which the given areas leave out

/// One or more zones that belong to the dig together or not at all.
struct Change {
  /// A zone by area and index.
  struct Place {
    std::size_t area;
    std::size_t zone;
  };
  ChangeKind kind;
  std::string what;          ///< "a second heap around (3.2, 1) m"
  std::vector<Place> zones;  ///< all of one sign
  double volume = 0.0;       ///< signed [m^3]
  double loose = 0.0;        ///< loose soil that a fall took, part of its volume [m^3]
  double prior = 0.0;        ///< probability by shape and place that it belongs to the dig
  double probability = 0.0;  ///< likewise, with the balance of the soil

  bool is_open() const { return prior > excluded && prior < certain; }
};

/// All changes of a scene. Only the first area can have a hole.
///
/// @param areas one for a whole scene; the dig area and the dump area otherwise
std::vector<Change> read_changes(const std::vector<Area>& areas, const ChangeOptions& options);

}  // namespace excavplan
