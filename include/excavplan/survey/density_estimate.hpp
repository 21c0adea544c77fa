// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/blocks.hpp>
#include <excavplan/ground/volume_change.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/fallback.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/survey/scan_surface.hpp>

/// @file
/// From the scans of one dig to the relative density of the ground, with what is known about its
/// error (docs/methods.md#density-law).

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
  paper,    ///< paper_volumes(), as published, in the areas that the first finds
};

/// The dig as it was driven. It tells what fell back into the cut; scans must be in the site frame.
struct DugPath {
  Machine machine;           ///< that drove it
  DigParameters parameters;  ///< of the path
  double start_x = 0.0;      ///< where the path met the ground [m]
};

/// Settings of estimate_density().
struct DensityOptions {
  VolumeMethod method = VolumeMethod::surface;  ///< how volumes are found
  std::optional<double> cell_size;  ///< of the height map, and voxel of the paper's method [m];
                                    ///< else cell_for() the sparsest scan
  bool registered = true;  ///< false: the sensor stood still, scans are not brought onto each other
  ChangeOptions change;    ///< dig area, dump area and more
  std::optional<DugPath> dug_path;  ///< if it is known
  unsigned threads = 0;             ///< 0: one per core; the result is the same for any number
};

/// How the scan after was brought onto the one before.
struct ScanRegistration {
  Eigen::Matrix4d correction = Eigen::Matrix4d::Identity();  ///< as in RegisteredPair
  Alignment found;                                           ///< before anything was corrected
};

/// What the scans of a dig tell. Without dumped soil in the scans there are volumes but no bulking
/// factor and no density, which a warning says.
struct DensityEstimate {
  VolumeMethod method = VolumeMethod::surface;  ///< how volumes were found
  /// Volumes, their covariance, zones and height change. Zones and height change are those of the
  /// surface for both methods.
  VolumeChange change;
  std::optional<Measured> bulking;    ///< k as the scans give it [-]
  std::optional<Fallback> fallback;   ///< if the path that was dug is known
  BlockReport blocks;                 ///< voids between blocks of hard soil
  std::optional<Measured> corrected;  ///< k freed of fallback and voids, if there is either [-]
  std::optional<RelativeDensity> density;        ///< percent, raw, sd, 95 % interval
  double density_without_fallback = 0.0;         ///< had nothing fallen back, where k is known [%]
  DensityLaw law;                                ///< that was used
  bool trustworthy = true;                       ///< false: see the warnings
  std::vector<Warning> warnings;                 ///< of volumes, density and blocks, each once
  double cell_size = 0.0;                        ///< [m]
  std::optional<ScanRegistration> registration;  ///< nothing if the sensor stood still
  std::optional<ScanRegistration> dump_registration;  ///< if the dump area has scans of its own

  /// The density for plan_dig(); nothing where there is none.
  std::optional<GroundDensity> ground_density() const;
};

/// Estimates the density of the ground before a dig.
///
/// Scans become height maps, brought onto each other by the ground that did not change; their
/// change gives the volumes (the paper's eqs. 3, 4) and the bulking factor (eq. 1), freed of the
/// soil that fell back and of the voids between blocks as far as these are known, each with its
/// error; the law gives the density. It is not trustworthy if a zone was cut off or partly unseen,
/// if the soil lies in blocks, if the error of the volumes is not known, or if the density is
/// further outside 0 .. 100 % than the error explains.
///
/// @throws Error (bad_file) naming the scans if one cannot be read, holds fewer than 100 finite
/// points, or they do not overlap (FrameError) or look swapped; (bad_input) if an option is out of
/// range or the path that was dug cannot be driven
DensityEstimate estimate_density(const DigScans& scans, const DensityLaw& law,
                                 const DensityOptions& options = {});

/// The same by density_law_of() the soil, which knows nothing of soil that falls back: give the
/// path that was dug, or a calibrated law.
DensityEstimate estimate_density(const DigScans& scans, const SoilKind& soil,
                                 const DensityOptions& options = {});

/// What both methods make of the same scans.
struct BothEstimates {
  DensityEstimate surface;  ///< by VolumeMethod::surface
  DensityEstimate paper;    ///< by VolumeMethod::paper
};

/// As estimate_density(), whatever the options say of the method.
BothEstimates estimate_by_both(const DigScans& scans, const DensityLaw& law,
                               const DensityOptions& options = {});

}  // namespace excavplan
