// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/change/volume_change.hpp>

#include "report/dig_report.hpp"
#include "inputs/maps.hpp"

/// @file
/// The maps of the tools.

namespace excavplan {

/// all, before, after, change, sd and zones; likewise of the dump area, dump, dump-before, ...
/// @param dump  its scan, if it has one of its own; asked once all options are read
std::vector<MapName> survey_map_names(const std::optional<std::string>& dump);
/// @param before  the ground of each area of the change
std::vector<NamedMap> survey_maps(const VolumeChange& change, const std::vector<HeightMap>& before);

/// all, before, after and change.
std::vector<MapName> scene_map_names();
std::vector<NamedMap> scene_maps(const DigScene& scene);

/// all, before, after, change, footprint and path.
std::vector<MapName> plan_map_names();
/// The dig is simulated once more for the ground that it leaves. Of a plan without one there is
/// before alone, which is all then.
std::vector<NamedMap> plan_maps(const Machine& machine, const DigPlan& plan, const PlanSite& site);

}  // namespace excavplan
