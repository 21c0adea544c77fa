// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/ground/blocks.hpp>
#include <excavplan/ground/volume_change.hpp>
#include <excavplan/simulation/fallback.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// From the volumes of a dig to its density, and both as JSON and as lines for people.

namespace excavplan::tools {

/// What is known of a dig beside its volumes.
struct Knowledge {
  std::optional<Fallback> fallback;   ///< its path was known
  std::optional<BlockReport> blocks;  ///< its surface was looked at
};

struct Estimate {
  std::optional<Measured> bulking;  ///< as the height maps give it
  Knowledge knowledge;
  std::optional<Measured> corrected;  ///< bulking, freed of fallback and voids
  std::optional<RelativeDensity> density;
  double density_without_fallback = 0.0;  ///< were `bulking` free of it [%]
  bool trustworthy = true;
  std::vector<Warning> warnings;
};

Estimate estimate(const VolumeChange& change, const Knowledge& knowledge, DensityLaw law);

nlohmann::ordered_json estimate_json(const VolumeChange& change, const Estimate& result,
                                     const DensityLaw& law);
std::vector<std::string> estimate_lines(const VolumeChange& change, const Estimate& result,
                                        const DensityLaw& law);

}  // namespace excavplan::tools
