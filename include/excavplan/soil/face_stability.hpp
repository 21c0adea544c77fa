// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/soil/soil.hpp>

/// @file
/// Whether the face of a cut stands, with what lies on the ground beyond its edge.

namespace excavplan {

/// A face in a vertical section, from its toe up to its edge; the ground beyond is level.
struct SoilFace {
  double height = 0.0;        ///< of the edge over the toe, > 0 [m]
  double run = 0.0;           ///< from the toe to below the edge; 0: upright [m]
  std::vector<double> loads;  ///< on the ground from the edge on, each over one step, >= 0 [Pa]
  double load_step = 0.1;     ///< > 0 [m]
};

/// Depth of a tension crack behind the edge of cohesive soil, as a share of the height: half of it
/// at most (Terzaghi, Theoretical Soil Mechanics, 1943: an upright wall then stands 2.67 instead of
/// 4 c / gamma tan(45 deg + phi / 2)).
inline constexpr double deepest_crack = 0.5;

/// Least factor of safety of circular slip surfaces, and planes, through the toe (Bishop 1955,
/// simplified), by a search to about 1 %. Slips below the toe, to be feared in clay without
/// friction under flat faces, are not looked at.
///
/// @param crack  its depth as a share of the height, at most as deep as cohesion can hold a crack
///               open, 2 c / gamma tan(45 deg + phi / 2) (Rankine)
/// @return infinite if nothing can slip
/// @throws Error (bad_input) if a number is out of range or not finite
double factor_of_safety(const SoilState& soil, const SoilFace& face, double crack = deepest_crack);

/// The steepest face of that height and with those loads, from upright to 1 : 4, that has at least
/// this factor: run over height, to 0.05. @return nothing if none has
/// @throws Error as factor_of_safety()
std::optional<double> standing_batter(const SoilState& soil, SoilFace face, double least_factor);

}  // namespace excavplan
