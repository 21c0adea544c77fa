// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/measured.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>
#include <excavplan/soil/soil_scatter.hpp>

/// @file
/// What is known of the soil that was dug, and what its kind means for the density
/// (docs/methods.md#soil-scatter).

namespace excavplan {

/// What is known of the soil before the scans are read.
struct SoilKnowledge {
  /// Kind that the law is for. Needed by a law for the path that was dug and by the payload.
  std::optional<SoilKind> kind = {};
  bool assumed = false;                ///< nobody said which kind it is: warning soil_assumed
  bool unknown = false;                ///< the answer is that of any soil in `possible`
  std::vector<SoilLaw> possible = {};  ///< kinds that the soil may be, with their laws
  /// Of the soil about its kind, for the payload. A soil whose void ratios were measured on the
  /// site has a smaller one.
  SoilScatter scatter = {};
  /// Measured water per dry mass [-]; else that of the kind with its scatter.
  std::optional<Measured> water_content = {};
};

/// The density by the mass of the payload. Where the soil is unknown: means over the soils, their
/// standard deviation, and the disagreement in the soil of at least 5 % where it is least.
struct PayloadDensity {
  Measured mass;                 ///< moist, of one dump [kg]
  Measured dug_mass;             ///< with the spill: mass after / dumped, sd of the mass [kg]
  Measured bulk_density;         ///< moist, in place, without the voids between blocks [kg/m^3]
  Measured density_percent;      ///< by bulk density, water content and void ratios
  Measured law_density_percent;  ///< by the law alone
  /// Difference of the two over its standard deviation; both know the hole's volume [-].
  double disagreement = 0.0;
};

/// The density if the soil is of one kind.
struct SoilAnswer {
  std::string name;  ///< of the kind
  /// Its probability: the one before the dig, times that of the measured bulking factor and payload
  /// in this soil if all densities in 0 .. 100 % are equally likely.
  double weight = 0.0;
  RelativeDensity density;                ///< in this soil
  std::optional<PayloadDensity> payload;  ///< likewise, if the payload was weighed
};

}  // namespace excavplan
