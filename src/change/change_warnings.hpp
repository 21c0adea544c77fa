// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <excavplan/base/warning.hpp>
#include <excavplan/change/change_options.hpp>
#include <excavplan/change/dig_volumes.hpp>

#include "change/objects.hpp"
#include "change/surveyed_area.hpp"

/// @file
/// The doubts about the volumes of a dig. Private to the project.

namespace excavplan {

/// Where the volumes before and after do not belong to one dig: no_hole_found, no_dumped_soil,
/// looks_swapped.
void warn_of_balance(VolumeChange& change);

/// Where less rose on the whole than the bank that was cut in known ground: no_dumped_soil.
void warn_of_missing_soil(VolumeChange& change);

/// Of changes that are neither hole, spill nor heap, and of zones that are cut off or were not
/// seen: other_change, zone_at_border, zone_unseen, zone_partly_unseen.
///
/// @param change  with volumes
void warn_of_zones(const std::vector<Area>& areas, const ChangeOptions& options,
                   VolumeChange& change);

/// Of the scans of an area: little_stable_ground, scans_do_not_fit, systematic_errors,
/// sensor_place_inferred, sensor_place_doubtful.
void warn_of_scans(const Area& area, const ChangeOptions& options, std::vector<Warning>& warnings);

/// The warning of the largest of some objects: object_on_soil, object_taken_out.
Warning object_warning(const ChangeZone& zone, const Object& object, std::size_t count);

}  // namespace excavplan
