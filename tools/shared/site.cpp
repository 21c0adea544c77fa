// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/site.hpp"

#include <utility>

#include <excavplan/survey/scan_terrain.hpp>

#include "shared/arguments.hpp"
#include "shared/found_pose.hpp"
#include "shared/scans.hpp"

namespace excavplan::tools {
namespace {

Site scanned(const TerrainInput& terrain, const Rectangle& extent, double cell_size) {
  Scan scan;
  scan.files = {*terrain.cloud};
  if (terrain.frame) scan.site_from_scan = frame_named("--terrain-frame", *terrain.frame);
  ScannedTerrain seen = with_frame_hint("--terrain-frame transforms it into the site frame",
                                        [&] { return terrain_from_scan(scan, extent, cell_size); });
  return {std::move(seen.terrain), std::move(seen.warnings)};
}

}  // namespace

void declare_terrain(Arguments& arguments, TerrainInput& terrain) {
  arguments.file("terrain", terrain.cloud,
                 "cloud of the ground in the site frame (default: level)");
  arguments.file("terrain-frame", terrain.frame,
                 "4 x 4 matrix that transforms the terrain cloud into the site frame");
}

Site make_site(const TerrainInput& terrain, const Rectangle& extent, double cell_size) {
  if (terrain.frame && !terrain.cloud) {
    usage_error("--terrain-frame needs --terrain");
  }
  return naming_options(cell_option, [&] {
    require_simulated_cell(cell_size);
    return terrain.cloud ? scanned(terrain, extent, cell_size)
                         : Site{undisturbed(flat_ground(extent, cell_size)), {}};
  });
}

}  // namespace excavplan::tools
