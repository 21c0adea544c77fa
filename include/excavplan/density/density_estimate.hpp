// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/density/density_options.hpp>
#include <excavplan/density/density_result.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// From the scans of one dig to the relative density of the ground and its error
/// (docs/methods.md#density-law).

namespace excavplan {

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
