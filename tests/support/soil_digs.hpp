// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include <excavplan/base/error.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/soil/soil_scatter.hpp>

#include "base/random.hpp"
#include "density/density_of_volumes.hpp"

/// @file
/// Simulated digs in random soil along random paths, and the density found from their volumes.

namespace excavplan::test {

/// What a survey of a dig and the machine's scale would say, with their errors.
struct SoilDig {
  SoilKind soil;  ///< that was dug
  double density_percent = 0.0;
  DigParameters path;
  VolumeChange change;
  Measured payload_mass;
};

struct SoilDigOptions {
  SimulatorKind simulator = default_simulator();
  SoilScatter scatter;                         ///< of the soil about its kind
  double volume_error = 0.005;                 ///< of each volume, as a share
  double mass_error = 0.01;                    ///< likewise
  double more_water = 0.0;                     ///< than the drawn soil has, per dry mass
  double more_particle_density = 0.0;          ///< likewise [Mg/m^3]
  bool path_outside = false;                   ///< of the box that calibrate_density() draws from
  std::optional<DigParameters> path = {};      ///< else random
  std::optional<double> density_percent = {};  ///< else random
};

/// A volume change with independent errors, of which it states the deviations.
VolumeChange measured(const HeightMapVolumes& truth, double error, Random& random);

DigParameters random_path(bool outside, Random& random);

/// Paths that cannot be driven are drawn again.
SoilDig random_dig(const Machine& machine, const SoilKind& kind, std::uint64_t seed,
                   const SoilDigOptions& options = {});

/// @param known  change, and what is known of fallback and blocks
DensityEstimate estimate_of(DensityEstimate known, const DensityLaw& law,
                            const DensityOptions& options);

DensityEstimate estimate_of(const VolumeChange& change, const DensityLaw& law,
                            const DensityOptions& options);

/// How often an interval held the truth, and how far the estimate was from it.
struct Coverage {
  int digs = 0;
  int inside = 0;
  double squares = 0.0;
  double sd = 0.0;  ///< sum of those stated

  void add(const RelativeDensity& density, double truth) {
    ++digs;
    inside += density.interval_percent[0] <= truth && truth <= density.interval_percent[1];
    squares += std::pow(density.percent - truth, 2);
    sd += density.sd_percent;
  }
  double share() const { return inside / static_cast<double>(digs); }
  double rms() const { return std::sqrt(squares / digs); }
  double mean_sd() const { return sd / digs; }
};

}  // namespace excavplan::test
