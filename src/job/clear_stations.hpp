// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_settings.hpp>

#include "job/job_map.hpp"
#include "job/job_stations.hpp"

/// @file
/// Places of a job out of the way of what stands beside it. Private to the project.

namespace excavplan {

/// Whether the upper structure turns from looking ahead to a swing [rad] without its tail, or a
/// margin around it, over an obstacle.
bool turns_clear(const JobSettings& settings, const BasePose& base, double swing);

/// Stations of one lane group, moved along their line so that the machine turns clear from each to
/// its dump and no gap is left between what is dug from them; one that cannot stays.
/// @param ground  before the job
std::vector<JobStation> clear_of_obstacles(std::vector<JobStation> stations, const JobFrame& frame,
                                           const JobSettings& settings, const JobMap& map,
                                           const Terrain& ground);

}  // namespace excavplan
