// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/density/density_estimate.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// "paper" or "surface"
const char* name(VolumeMethod method);

/// A density with its standard deviation and its interval.
Json density_json(const RelativeDensity& density);

/// Volumes, bulking factor and density, with all that they were combined of.
Json estimate_json(const DensityEstimate& estimate);

/// How the scans were compared: cells, registration, zones, attribution, readings.
Json survey_json(const DensityEstimate& estimate);

/// What was known of the soil.
Json soil_knowledge_json(const SoilKnowledge& soil);

}  // namespace excavplan
