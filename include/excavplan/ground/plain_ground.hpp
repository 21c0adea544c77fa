// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>

#include <excavplan/ground/ground_state.hpp>

namespace excavplan {

/// Ground of another program, with its densities as percentages; what they are as void ratios,
/// ground_in_soil() says (soil/ground_in_soil.hpp).
struct PlainGround {
  GroundState ground;                     ///< without void ratios
  Eigen::ArrayXXd bank_density_percent;   ///< relative density 0 .. 100; empty: not told
  Eigen::ArrayXXd loose_density_percent;  ///< likewise; empty: 0, the loosest state
};

/// Reads a JSON that names ESRI ASCII grids (docs/formats.md#ground), which must lie in its own
/// folder and be of equal grid.
/// @throws Error (bad_file) naming file, key, value and rule
PlainGround load_plain_ground(const std::string& file);

}  // namespace excavplan
