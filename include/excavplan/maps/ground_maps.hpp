// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/change/volume_change.hpp>
#include <excavplan/ground/map_files.hpp>
#include <excavplan/planning/rehearsal.hpp>
#include <excavplan/sensing/scene.hpp>

/// @file
/// Maps of the ground that results are about, for write_map() and write_lines().

namespace excavplan {

/// A map with the name that the tools have for it.
struct NamedMap {
  std::string name;                 ///< as in `--map NAME=FILE`
  LayeredMap map = {};              ///< one layer, or all of `all`
  std::vector<MapLine> lines = {};  ///< instead of a map
};

/// Of each surveyed area all layers together, `all`, and each alone: `before`, `after`, `change`,
/// `sd` and `zones` (0 for unchanged ground, 1 hole, 2 spill, 3 heap, 4 other changes and objects);
/// those of a dump area with scans of its own are named `dump`, `dump-before`, ...
/// @param before  the ground of each area of the change, on its grid
std::vector<NamedMap> survey_maps(const VolumeChange& change, const std::vector<HeightMap>& before);

/// `all`, `before`, `after` and `change` of a simulated dig.
std::vector<NamedMap> scene_maps(const DigScene& scene);

/// `all`, `before`, `after`, `change`, `footprint` (1 where the dig lowers the ground) and `path`,
/// the path of the tip and the outline of the cut. The dig is simulated once more for the ground
/// that it leaves. Of a plan without one there is `before` alone, which is `all` then.
/// @throws Error as rehearse()
std::vector<NamedMap> plan_maps(const Machine& machine, const DigPlan& plan, const PlanSite& site);

}  // namespace excavplan
