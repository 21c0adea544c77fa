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
#include <excavplan/density/other_volumes.hpp>
#include <excavplan/density/soil_answers.hpp>
#include <excavplan/density/successive_density.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/scans/scan_surface.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// From the scans of one dig to the relative density of the ground and its error
/// (docs/methods.md#density-law).

namespace excavplan {

/// The scans of one dig.
struct DigScans {
  Scan before;                        ///< of the whole scene or, with `dump`, of the dig area alone
  Scan after;                         ///< of the same area as `before`
  std::optional<ScanPair> dump = {};  ///< of the dump area: the paper's four clouds
};

/// How volumes are found.
enum class VolumeMethod {
  surface,  ///< signed change of one height map, measure_change()
  paper,    ///< DensityOptions::paper, as published, in the areas that the first finds
};

/// The dig as driven, for a law of digs along this path. With its start, which needs scans in the
/// site frame, the soil that fell back into the cut is measured too.
struct DugPath {
  Machine machine;                ///< that drove it
  DigParameters parameters;       ///< of the path
  std::optional<double> start_x;  ///< where the path enters the ground [m]
};

/// Settings of estimate_density().
struct DensityOptions {
  VolumeMethod method = VolumeMethod::surface;  ///< how volumes are found
  std::optional<double> cell_size;  ///< of the height map, and voxel of the paper's method [m];
                                    ///< else cell_for() the sparsest scan
  bool registered = true;           ///< false: the sensor did not move, scans are not registered
  ChangeOptions change;             ///< dig area, dump area and more
  OtherVolumes paper;               ///< of VolumeMethod::paper: paper_change()
  std::optional<DugPath> dug_path;  ///< if it is known
  SoilKnowledge soil;               ///< its kind, or the kinds that it may be
  std::optional<Measured> payload_mass;  ///< moist soil that was dumped, if it was weighed [kg]
  /// Of the joints in the dig, joint_work() [J]; needs the dug path with its start and the kind.
  std::optional<Measured> joint_work;
  std::optional<PriorDensity> prior;  ///< by digs before this one in the same soil
  unsigned threads = 0;               ///< 0: one per core; the result is the same for any number
};

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
/// neither bulking factor nor density.
struct DensityEstimate {
  VolumeMethod method = VolumeMethod::surface;  ///< how volumes were found
  /// Volumes, their covariance, zones and height change. Zones and height change are those of the
  /// surface for both methods.
  VolumeChange change;
  std::vector<HeightMap> before;                 ///< the ground before, of each area of `change`
  std::optional<Measured> bulking;               ///< k as the scans give it [-]
  std::optional<Fallback> fallback;              ///< if the path that was dug is known
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
  std::optional<ScanRegistration> dump_registration;  ///< if the dump area has scans of its own

  /// The density for plan_dig(); nothing where there is none.
  std::optional<GroundDensity> ground_density() const;
};

/// Estimates the density of the ground before a dig.
///
/// Scans become height maps, registered on the ground that did not change. Their change gives the
/// volumes (the paper's eqs. 3, 4) and the bulking factor (eq. 1), corrected for the soil that fell
/// back and for the voids between blocks as far as these are known, each with its error; the law
/// gives the density. Where the path that was dug and the kind of soil are known and the law is of
/// the built-in simulator, it is one fitted for that path. Warnings beside those of the volumes:
/// soil_assumed, law_of_other_path, dug_path_doubtful (ends trust), loads_not_used,
/// prior_not_trustworthy, payload_disagrees, loads_disagree and prior_disagrees (which end trust),
/// density_above_range, density_below_range, volume_error_unknown, blocks. It is not trustworthy if
/// a zone was cut off or partly unseen, if the soil lies in blocks, if the error of the volumes is
/// not known, or if the density is further outside 0
/// .. 100 % than the error explains.
///
/// @throws Error (bad_file) naming the scans if one cannot be read, holds fewer than 100 finite
/// points, or they do not overlap (FrameError) or are probably swapped; (bad_input) if an option is
/// out of range, the path that was dug cannot be driven or VolumeMethod::paper lacks its volumes
DensityEstimate estimate_density(const DigScans& scans, const DensityLaw& law,
                                 const DensityOptions& options = {});

/// The same by density_law_of() the soil, which does not include soil that falls back: give the
/// path that was dug, or a calibrated law.
DensityEstimate estimate_density(const DigScans& scans, const SoilKind& soil,
                                 const DensityOptions& options = {});

/// Results of both methods for the same scans.
struct BothEstimates {
  DensityEstimate surface;  ///< by VolumeMethod::surface
  DensityEstimate paper;    ///< by VolumeMethod::paper
};

/// As estimate_density() by both methods; `options.method` is ignored, `options.paper` needed.
BothEstimates estimate_by_both(const DigScans& scans, const DensityLaw& law,
                               const DensityOptions& options = {});

}  // namespace excavplan
