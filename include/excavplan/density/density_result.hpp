// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/calibration/fallback.hpp>
#include <excavplan/change/blocks.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/density/density_by_loads.hpp>
#include <excavplan/density/density_options.hpp>
#include <excavplan/density/soil_answers.hpp>
#include <excavplan/density/successive_density.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// What estimate_density() answers.

namespace excavplan {

/// Registration of the scan after to the scan before.
struct ScanRegistration {
  Eigen::Matrix4d correction = Eigen::Matrix4d::Identity();  ///< as in RegisteredPair
  Alignment found;                                           ///< before anything was corrected
};

/// A reading of the scene with its density.
struct DensityReading {
  Reading reading;               ///< bulking factor as the scans give it
  double density_percent = 0.0;  ///< by the law, also outside 0 .. 100
};

/// Result of estimate_density(). Without dumped soil in the scans it holds volumes, a warning, and
/// no bulking factor; a density only in known ground by the mass of the payload.
struct DensityEstimate {
  VolumeMethod method = VolumeMethod::surface;  ///< how volumes were found
  /// Volumes, their covariance, zones and height change. Zones and height change are those of the
  /// surface for both methods.
  VolumeChange change;
  std::vector<HeightMap> before;    ///< the ground before, of each area of `change`
  std::optional<Measured> bulking;  ///< k as the scans give it [-]
  /// If the path that was dug is known. In known ground `bulking` is already of the whole cut.
  std::optional<Fallback> fallback;
  BlockReport blocks;                            ///< voids between blocks of hard soil
  std::optional<Measured> corrected;             ///< k corrected for fallback and voids, if any [-]
  std::optional<RelativeDensity> density;        ///< percent, raw, sd, 95 % interval
  std::vector<SoilAnswer> soils;                 ///< in each of SoilKnowledge::possible
  std::optional<RelativeDensity> any_soil;       ///< in any of them: their mixture
  std::optional<PayloadDensity> payload;         ///< if the payload was weighed, in a kind of soil
  std::optional<LoadsDensity> loads;             ///< if the work of the joints was measured
  std::optional<SuccessiveDensity> successive;   ///< if earlier digs gave a density to trust
  std::vector<DensityReading> readings;          ///< as VolumeChange::readings; of the scans alone
  double density_without_fallback = 0.0;         ///< assuming no fallback, where k is known [%]
  DensityLaw law;                                ///< that was used, or fitted for the dug path
  bool trustworthy = true;                       ///< false: see the warnings
  std::vector<Warning> warnings;                 ///< of volumes, density and blocks, each once
  double cell_size = 0.0;                        ///< [m]
  std::uint64_t machine_points = 0;              ///< of the machine, left out of all scans
  std::optional<ScanRegistration> registration;  ///< none without a registration
  /// Of the variance of `bulking` by the scans, what the scan before made: two digs that share a
  /// scan, after the one and before the other, err by it in opposite directions [-].
  double shared_with_before = 0.0;
  std::optional<GroundState> ground_after;            ///< if the ground before is known
  std::optional<ScanRegistration> dump_registration;  ///< if the dump area has scans of its own

  /// The density for plan_dig(); nothing where there is none.
  std::optional<GroundDensity> ground_density() const;
};

}  // namespace excavplan
