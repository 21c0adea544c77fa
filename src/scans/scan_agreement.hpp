// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// Why two maps of the same ground, on one grid, are doubted to be in one frame; nothing: they
/// agree, or share too little to tell.
///
/// Where both are known: the median of their differences in height is at most 0.1 m; 60 % of them
/// are at most 0.15 m, the rest was dug, dumped or moved; and of the earlier relief, more than 0.2
/// m above or below its median, 60 % is there still, or no shift (to 1.5 m) and turn (to 8 degrees)
/// shows a quarter more of it. All numbers ours. Level ground with nothing on it shows neither
/// shift nor turn.
std::optional<std::string> disagreement(const HeightMap& present, const HeightMap& earlier);

}  // namespace excavplan
