// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/base/warning.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_settings.hpp>

#include "job/job_map.hpp"

/// @file
/// Where the soil of a dig goes. Private to the project.

namespace excavplan {

/// A place to open the bucket over.
struct DumpPlace {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the bucket pin, in the site's frame [m]
  double swing = 0.0;   ///< to it from where the front looks, to the left [rad]
  double height = 0.0;  ///< of the pin over the ground under the machine [m]
  bool in_truck = false;
  double outside = 0.0;    ///< share of a bucket that comes to lie beside the dump areas [-]
  bool overflows = false;  ///< the areas are full: beside them, as DumpRules::may_overflow
};

/// A dump_areas_full, if most of a bucket comes to lie beside them.
std::vector<Warning> dump_warnings(const DumpPlace& dump);

/// What a place for soil may be.
struct DumpRules {
  double spare_reach = 0.0;   ///< that is not used [m]
  bool may_overflow = false;  ///< where the areas are full, onto the ground around them
  double load = 1.0;          ///< share of a heaped bucket that is dumped
  double tracks = 0.0;        ///< their heading from where the front looks [rad]
  double off_line = 0.0;      ///< of the front's view: nearer, room is left for later soil [m]
};

/// So far from its line of work a machine lays soil, in order not to fill what it reaches when it
/// stands later on the other side of it [m]. @param beside  so far from the line [m]
double beyond_later_soil(const Machine& machine, double beside);

/// The place of the dump areas, or the truck, with the least swing from where the front looks,
/// where a bucket of soil stays within the area; where none does, that from which least runs out.
/// Only places to which the machine turns_clear() count.
/// @return nothing if none is within reach
std::optional<DumpPlace> dump_place(const JobSettings& settings, const JobMap& map,
                                    const Terrain& ground, const BasePose& base,
                                    const DumpRules& rules = {});

/// Of the tail from what stands on a site, where the machine turns; ours [m].
inline constexpr double off_tail = 0.3;

/// Whether the upper structure turns from looking ahead to a swing [rad] without its tail, or a
/// margin around it, over an obstacle.
bool turns_clear(const JobSettings& settings, const BasePose& base, double swing);

}  // namespace excavplan
