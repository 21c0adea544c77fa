// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_settings.hpp>

#include "job/job_map.hpp"
#include "job/job_stations.hpp"

/// @file
/// Where the machine can stand and turn, before the job and as the ground is now. Private to the
/// project.

namespace excavplan {

/// Places beside a design with the tracks along it, and their line across it.
struct PlacesBeside {
  JobFrame line;
  std::vector<JobStation> places;  ///< where the machine can stand, turn and dump
};

/// Those on the side that has more of them; nothing where no face runs along the line of work, as
/// many do across it, the front does not reach all across, or there is no such place.
/// @param first  ground before the job
/// @param frame  of the line of work
std::optional<PlacesBeside> places_beside(const JobSettings& settings, const JobMap& map,
                                          const Terrain& first, const JobFrame& frame);

/// What tells where a machine can stand.
struct Standing {
  const JobSettings& settings;
  const JobMap& map;
  const Terrain& first;  ///< before the job
  const Terrain& now;    ///< on the same grid
};

/// Whether the tracks stand on ground that nothing was dug from or laid on, off what must not be
/// touched and no nearer to an edge than it is deep, and the tail swings clear of obstacles and of
/// the truck.
bool can_stand_now(const Standing& on, const JobFrame& frame, const JobStation& station);

/// The place nearest to that of a station where the machine can stand and its soil has a place, in
/// the dump areas if that is not far.
std::optional<JobStation> nearest_place(const Standing& on, const JobFrame& frame,
                                        const JobStation& station);

/// Whether the machine, a little off there too, turns clear of obstacles to a place for soil.
bool stands_clear(const JobStation& station, const JobFrame& frame, const JobSettings& settings,
                  const JobMap& map, const Terrain& ground);

/// Stations of one lane group, moved along their line so that the machine turns clear from each to
/// its dump and no gap is left between what is dug from them; what one place cannot serve, two do;
/// one that cannot stays.
/// @param ground  before the job
std::vector<JobStation> clear_of_obstacles(std::vector<JobStation> stations, const JobFrame& frame,
                                           const JobSettings& settings, const JobMap& map,
                                           const Terrain& ground);

}  // namespace excavplan
