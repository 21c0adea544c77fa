// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <excavplan/density/density_estimate.hpp>
#include <excavplan/experiments/study_condition.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/scans/scan_surface.hpp>

namespace excavplan {

/// How a survey is simulated.
struct StudyScan {
  StudySensor sensor = StudySensor::none;
  std::uint64_t seed = 1;
  int frames = 10;  ///< of a camera, averaged; most of the time of a survey
};

/// What a sensor's scans of a dig tell. @throws Error if they give no density
DensityEstimate surveyed_dig(const DigScene& scene, const StudyScan& scan, const SoilKind& soil,
                             const DensityLaw& law);

/// The density that a sensor's scans of a dig give. @throws Error if they give none
RelativeDensity surveyed_density(const DigScene& scene, const StudyScan& scan, const SoilKind& soil,
                                 const DensityLaw& law);

/// The ground as the sensor shows it to the planner.
Terrain surveyed_ground(const Terrain& ground, const Machine& machine, const StudyScan& scan);

}  // namespace excavplan
