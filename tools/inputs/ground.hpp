// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/soil/ground_in_soil.hpp>

#include "frame/arguments.hpp"
#include "frame/tool.hpp"

/// @file
/// The options --ground and --ground-out: the state of the ground, from dig to dig.

namespace excavplan::tools {

struct GroundInput {
  std::optional<std::string> file;
  std::optional<std::string> out;
  /// Of the machine in the frame of the files, with their axes: ground is not resampled [m].
  Eigen::Vector2d base = Eigen::Vector2d::Zero();
};

/// What is special about a tool's ground files.
struct GroundUse {
  std::vector<std::string> replaced;  ///< options that --ground stands in place of
  std::string after;                  ///< what the file of --ground-out is after: "the dig"
};
void declare_ground(Arguments& arguments, GroundInput& input, const GroundUse& use);
/// The option --base, of tools that dig in the frame of the machine.
void declare_base(Arguments& arguments, GroundInput& input);

/// The ground of --ground.
struct GivenGround {
  GroundState state;                      ///< as the file tells it, in the machine's frame
  Terrain terrain;                        ///< to dig on
  std::optional<double> density_percent;  ///< that it tells of the bank where a machine digs
};

/// Nothing without --ground. @param density_percent  of the bank where the file does not tell it
/// @throws Error (bad_file), or (bad_input) unless its cells are of a size to simulate
std::optional<GivenGround> given_ground(const GroundInput& input, const Machine& machine,
                                        const SoilKind& soil, double density_percent);

/// Says in lines and in the key "ground_state" what ground was given.
void describe(const GroundInput& input, const GivenGround& given, Outcome& outcome);

/// Writes --ground-out, if it is asked for. @param given  null: `before` is all that is known
void write_ground(const GroundInput& input, const GivenGround* given, const Terrain& before,
                  const Terrain& after, const SoilKind& soil);

}  // namespace excavplan::tools
