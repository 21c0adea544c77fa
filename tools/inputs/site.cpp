// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/site.hpp"

#include <filesystem>
#include <utility>

#include <excavplan/scans/scan_terrain.hpp>

#include "base/text.hpp"
#include "ground/obstacles.hpp"
#include "inputs/found_pose.hpp"
#include "inputs/scans.hpp"
#include "inputs/unit_inputs.hpp"

namespace excavplan::tools {
namespace {

/// @param read  what is asked for, from a scan
template <typename Read>
auto scanned(const TerrainInput& terrain, const Read& read) {
  Scan scan = terrain.scans->scan(*terrain.cloud);
  scan.unit = unit_length(terrain.unit);
  if (terrain.frame) scan.site_from_scan = frame_named("--terrain-frame", *terrain.frame);
  if (!terrain.attitude.is_level()) {
    Eigen::Matrix4d to_machine = Eigen::Matrix4d::Identity();
    to_machine.topLeftCorner<3, 3>() = terrain.attitude.to_site().transpose();
    scan.site_from_scan = to_machine * scan.site_from_scan;
  }
  return with_frame_hint("--terrain-frame transforms it into the site frame",
                         [&] { return read(scan); });
}

}  // namespace

void declare_terrain(Arguments& arguments, TerrainInput& terrain) {
  arguments.file("terrain", terrain.cloud,
                 std::string("cloud of the ground in the site frame, or a scan ") + recording_form +
                     " (default: level)");
  arguments.text(
      "terrain-frame", "FRAME", terrain.frame,
      std::string("transforms the terrain cloud into the site frame, of which the origin "
                  "is on the swing axis at ground level, x forward, z up: ") +
          frame_forms);
  declare_unit(arguments, "unit", terrain.unit, "unit of the coordinates in the terrain cloud");
  declare_recorded(arguments, terrain.scans->options);
}

std::vector<std::string> terrain_options(std::vector<std::string> others) {
  others.insert(others.end(), {"terrain", "terrain-frame", "unit", "tf-frame", "depth-unit"});
  return others;
}

void declare_attitude(Arguments& arguments, TerrainInput& terrain) {
  const std::string option = "--attitude";
  Arguments::Entry attitude;
  attitude.name = "attitude";
  attitude.placeholder = "ROLL,PITCH";
  attitude.help =
      "how the machine stands: roll, its left side up, and pitch, its front down, such as "
      "3deg,-5deg; the path is then in the frame of the machine (default: level) [rad]";
  attitude.assign = [&terrain, option](const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 2) {
      usage_error(option + ": '" + text + "' is not ROLL,PITCH such as 3deg,-5deg");
    }
    terrain.attitude = {parse_quantity(option, parts[0], Quantity::angle),
                        parse_quantity(option, parts[1], Quantity::angle)};
  };
  arguments.add(attitude);
}

void declare_cell(Arguments& arguments, std::optional<double>& cell_size) {
  arguments.option("cell", cell_size, Quantity::length,
                   "cell size of the simulated ground (default: 5 cm for the zx120, else in "
                   "proportion to the bucket)");
}

Site make_site(const TerrainInput& terrain, const Rectangle& extent, double cell_size,
               const std::optional<std::string>& surroundings) {
  if (terrain.frame && !terrain.cloud) {
    usage_error("--terrain-frame needs --terrain");
  }
  if (terrain.unit != TerrainInput{}.unit && !terrain.cloud) usage_error("--unit needs --terrain");
  require_recording(terrain.scans->options, (terrain.cloud && is_recorded(*terrain.cloud)) ||
                                                (surroundings && is_recorded(*surroundings)));
  return naming_options(cell_option(), [&] {
    require_simulated_cell(cell_size);
    if (!terrain.cloud) return Site{undisturbed(flat_ground(extent, cell_size)), {}};
    ScannedTerrain seen = scanned(
        terrain, [&](const Scan& scan) { return terrain_from_scan(scan, extent, cell_size); });
    return Site{with_obstacles(seen.terrain), std::move(seen.warnings)};
  });
}

void add_earlier_obstacles(const TerrainInput& earlier, const Rectangle& extent, Terrain& ground) {
  Terrain present = ground;
  ground = scanned(earlier, [&](const Scan& scan) {
    try {
      return with_earlier_obstacles(
          present, terrain_from_scan(scan, extent, present.bank.cell_size).terrain);
    } catch (const FrameError&) {  // it shows no ground there
      return present;
    }
  });
}

Terrain make_swing_ground(const TerrainInput& terrain, const Machine& machine) {
  if (!terrain.cloud) return level_swing_ground(machine);
  return scanned(terrain, [&](const Scan& scan) { return swing_terrain_from_scan(scan, machine); })
      .terrain;
}

HeightMap make_standing_ground(const TerrainInput& terrain, const Machine& machine) {
  return scanned(terrain,
                 [&](const Scan& scan) { return standing_ground_from_scan(scan, machine); });
}

}  // namespace excavplan::tools
