// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// The soil of a terrain where the terrain states no void ratio.
struct GroundSoil {
  const SoilKind& kind;
  const SoilState& bank;
  const SoilState& loose;
};

/// The cells of a window, with a frame of one cell of unknown ground around them. Flags are not
/// bytes, which may alias all members: the compiler would read these again after each write.
struct GroundLayers {
  std::vector<double> bank;
  std::vector<double> loose;
  std::vector<double> height;
  std::vector<double> void_ratio;  ///< of the loose layer; empty if that of dug soil
  std::vector<std::uint16_t> awake;
  std::vector<std::uint16_t> slides;
};

}  // namespace excavplan
