// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/site.hpp"

#include <utility>

#include <excavplan/survey/scan_terrain.hpp>

#include "shared/found_pose.hpp"
#include "shared/recordings.hpp"
#include "shared/scans.hpp"

namespace excavplan::tools {
namespace {

Site scanned(const TerrainInput& terrain, const Rectangle& extent, double cell_size) {
  auto recorded = recorded_input(*terrain.cloud, terrain.tf_frame);
  if (!recorded && !terrain.tf_frame.empty()) usage_error("--tf-frame needs a recording");
  Scan scan = scan_of_input(*terrain.cloud, recorded);
  scan.unit = unit_length(terrain.unit);
  if (terrain.frame) scan.site_from_scan = frame_named("--terrain-frame", *terrain.frame);
  ScannedTerrain seen = with_frame_hint("--terrain-frame transforms it into the site frame",
                                        [&] { return terrain_from_scan(scan, extent, cell_size); });
  return {std::move(seen.terrain), std::move(seen.warnings)};
}

}  // namespace

void declare_terrain(Arguments& arguments, TerrainInput& terrain) {
  arguments.file("terrain", terrain.cloud,
                 "cloud of the ground in the site frame, or " + std::string(recording_form) +
                     " (default: level)");
  arguments.text(
      "terrain-frame", "FRAME", terrain.frame,
      std::string("transforms the terrain cloud into the site frame, of which the origin "
                  "is on the swing axis at ground level, x forward, z up: ") +
          frame_forms);
  arguments.text("tf-frame", "NAME", terrain.tf_frame,
                 "frame of the transforms of a recording into which its scan is put");
  declare_unit(arguments, "unit", terrain.unit, "unit of the coordinates in the terrain cloud");
}

Site make_site(const TerrainInput& terrain, const Rectangle& extent, double cell_size) {
  if (terrain.frame && !terrain.cloud) {
    usage_error("--terrain-frame needs --terrain");
  }
  if (!terrain.tf_frame.empty() && !terrain.cloud) usage_error("--tf-frame needs --terrain");
  if (terrain.unit != TerrainInput{}.unit && !terrain.cloud) usage_error("--unit needs --terrain");
  return naming_options(cell_option, [&] {
    require_simulated_cell(cell_size);
    return terrain.cloud ? scanned(terrain, extent, cell_size)
                         : Site{undisturbed(flat_ground(extent, cell_size)), {}};
  });
}

}  // namespace excavplan::tools
