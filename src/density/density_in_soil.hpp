// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/density/density_options.hpp>
#include <excavplan/density/density_result.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// The density in one kind of soil, or in any of several, by the law and by the payload
/// (docs/methods.md#soil-scatter).

namespace excavplan {

/// What the scans say of a dig.
struct DugVolumes {
  Eigen::Vector3d volumes;           ///< hole, spill, heap [m^3]
  Eigen::Matrix3d covariance;        ///< of them [m^6]
  double bulking_sd = 0.0;           ///< of bulking(); NaN: not known
  std::optional<Measured> voids;     ///< between blocks, in spill and heap [m^3]
  std::optional<Measured> fallback;  ///< loose soil in the hole, as a share of the cut [-]

  /// Spill and heap over the hole [-].
  double bulking() const { return (volumes(1) + volumes(2)) / volumes(0); }
  /// The same freed of voids and fallback, with the errors of all.
  Measured corrected() const;
};

DugVolumes volumes_of(const DensityEstimate& estimate);

/// The density in one kind of soil.
struct DensityInSoil {
  RelativeDensity density;
  double evidence = 1.0;  ///< likelihood of what was measured, up to a factor for all soils
  std::optional<PayloadDensity> payload;
};

/// The density by a law and, if the payload was weighed and the kind of soil and the errors of the
/// volumes are known, by its mass: the mean of least variance, its deviation times their
/// disagreement where that is above 1.
DensityInSoil density_in(const DensityLaw& law, const SoilKind* soil, const DugVolumes& dig,
                         const DensityOptions& options);

/// Soil that falls back in a dig, as a share of its cut, as a law expects it: what its form for
/// height maps and that freed of fallback say of one density.
double expected_fallback(const DensityLaw& law, double density_percent);

/// The density by the solids of a dig whose heap is out of sight, in known ground: what was carried
/// away, and what rose in sight, was bank.
/// @param change  with a cut
DensityInSoil density_by_solids(const DensityLaw& law, const SoilKind& soil,
                                const VolumeChange& change, const DensityOptions& options);

/// The density in any of several kinds of soil.
struct DensityInAny {
  std::vector<SoilAnswer> soils;
  RelativeDensity density;                ///< their mixture
  std::optional<PayloadDensity> payload;  ///< likewise
};

/// Without soils if there are no laws.
DensityInAny density_in_any(const std::vector<SoilLaw>& laws, const DugVolumes& dig,
                            const DensityOptions& options);

}  // namespace excavplan
