// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "frame/arguments.hpp"
#include "inputs/recordings.hpp"

namespace excavplan::tools {

/// A measured ground from the command line.
struct TerrainInput {
  std::optional<std::string> cloud;  ///< or a scan of a recording
  const char* option = "--terrain";  ///< of the cloud
  std::optional<std::string>
      frame;  ///< that transforms the cloud into the site frame, as frame_named() takes it
  std::string unit = "m";  ///< of the coordinates in the cloud
  Attitude attitude = {};  ///< of the machine, into whose frame the cloud is taken from the site's

  std::shared_ptr<RecordedScans> scans = std::make_shared<RecordedScans>();

  bool is_level() const { return !cloud && attitude.is_level(); }
};

/// --terrain, --terrain-frame, --unit, --tf-frame and --depth-unit.
void declare_terrain(Arguments& arguments, TerrainInput& terrain);
/// The names of these, and others, that something stands in place of.
std::vector<std::string> terrain_options(std::vector<std::string> others);

/// --attitude, of TerrainInput::attitude.
void declare_attitude(Arguments& arguments, TerrainInput& terrain);

/// Option --cell of tools that simulate digs of a machine; by default usual_cell() of the machine.
void declare_cell(Arguments& arguments, std::optional<double>& cell_size);

/// Ground to dig on, with its warnings.
struct Site {
  Terrain ground;
  std::vector<Warning> warnings;
};

/// Ground that a motion must be clear of: swing_terrain_from_scan() of a cloud, else level.
/// @throws Error as make_site()
Terrain make_swing_ground(const TerrainInput& terrain, const Machine& machine);

/// Ground that the machine stands on: standing_ground_from_scan() of the cloud, which must be
/// given.
/// @throws Error as make_site()
HeightMap make_standing_ground(const TerrainInput& terrain, const Machine& machine);

/// The ground of `extent` on cells of this size: terrain_from_scan() with all obstacles, as
/// plan_dig() digs it, if a cloud is given, else level.
///
/// @param surroundings  another scan, that add_earlier_obstacles() and others read
/// @throws Error (bad_file) if the cloud cannot be read or holds hardly a point in the extent
/// @throws Error (bad_input) if a frame or a unit is given without a cloud, or an option of
/// recordings without one
Site make_site(const TerrainInput& terrain, const Rectangle& extent, double cell_size,
               const std::optional<std::string>& surroundings = {});

/// with_earlier_obstacles() of the cloud of `earlier`, if it shows the ground of make_site().
/// @throws Error as make_site()
void add_earlier_obstacles(const TerrainInput& earlier, const Rectangle& extent, Terrain& ground);

}  // namespace excavplan::tools
