// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/site.hpp"

#include <utility>

#include <excavplan/survey/scan_terrain.hpp>

#include "shared/arguments.hpp"
#include "shared/found_pose.hpp"
#include "shared/scans.hpp"

namespace excavplan::tools {

Site make_site(const TerrainInput& terrain, const Rectangle& extent, double cell_size) {
  if (terrain.frame && !terrain.cloud) {
    usage_error("--terrain-frame needs --terrain");
  }
  if (!(cell_size >= finest_cell && cell_size <= coarsest_cell)) {
    usage_error("--cell: the cell size is " + number_text(cell_size) + " m, must be in " +
                number_text(finest_cell) + " .. " + number_text(coarsest_cell) + " m");
  }
  if (!terrain.cloud) return {undisturbed(flat_ground(extent, cell_size)), {}};
  Scan scan;
  scan.files = {*terrain.cloud};
  if (terrain.frame) scan.site_from_scan = frame_named("--terrain-frame", *terrain.frame);
  ScannedTerrain seen = with_frame_hint("--terrain-frame transforms it into the site frame",
                                        [&] { return terrain_from_scan(scan, extent, cell_size); });
  return {std::move(seen.terrain), std::move(seen.warnings)};
}

}  // namespace excavplan::tools
