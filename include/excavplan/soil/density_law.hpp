// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/measured.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/soil/density_forms.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// Density laws: from the bulking factor of a dig to the relative density of the ground.

namespace excavplan {

/// A law with its origin.
struct DensityLaw {
  std::string name;    ///< "paper"
  std::string source;  ///< text: what it was fitted to
  DensityForm form;    ///< that relative_density() uses
  /// For k corrected by free_of_fallback(): the counterpart of an "..._as_measured" form if the
  /// file has one, else `form` itself.
  DensityForm freed_form{};
  std::string soil = {};       ///< name of the soil it is for; empty: not known
  std::string machine = {};    ///< that dug; empty: not known
  std::string simulator = {};  ///< that dug, with its version; empty: real digs, or not known
  /// Of the digs: penetration angle [rad], penetration length [m], drag length [m].
  std::optional<std::array<double, 3>> path = {};
  bool any_path = false;  ///< its scatter is that of digs along other paths too
};

/// Reads a law file (docs/formats.md). Its key "use" names the form that is used.
///
/// @throws Error (bad_file) naming file, key, value and rule
DensityLaw load_density_law(const std::string& path);

/// The law that conservation of solids gives a soil: the closed form from its void ratios, B = 0,
/// without scatter. It leaves out clods and soil that falls back into the cut, which a calibrated
/// law holds: where a tenth of the cut falls back, the density comes out some 4 points too high.
DensityLaw density_law_of(const SoilKind& soil);

/// Relative density [%] with what is known about its error.
struct RelativeDensity {
  double percent = 0.0;               ///< inside 0 .. 100
  double raw_percent = 0.0;           ///< as the law gives it
  double sd_given_law_percent = 0.0;  ///< of the bulking factor alone, dd/dk sd_k
  /// Delta method: sd_given_law^2 + residual_sd^2, and where the law gives a density below 0 or
  /// above 100 % the excess in square: it is an error whose cause is not known.
  double sd_percent = 0.0;
  std::array<double, 2> interval_percent = {0.0, 100.0};  ///< 95 %, inside 0 .. 100
  bool trustworthy = true;        ///< false: outside 0 .. 100 % by more than the error explains
  std::vector<Warning> warnings;  ///< density_above_range, density_below_range
};

/// Sets sd, interval and trust from the error of `raw_percent`; it must be set, and `percent`.
void set_error(RelativeDensity& estimate, double sd_percent);

/// Estimates the density by a law alone. Outside 0 .. 100 % there is a warning; further outside
/// than the error explains (1.96 sd) the estimate is not trustworthy.
///
/// @throws Error (bad_input) unless the bulking factor is finite and positive and its sd is >= 0
RelativeDensity relative_density(const DensityLaw& law, const Measured& bulking_factor);

/// The relative density of the ground, as far as it is known, for planning a dig.
struct GroundDensity {
  double percent = 0.0;     ///< 0 .. 100
  double sd_percent = 0.0;  ///< standard deviation, >= 0; 0: taken as known
  bool trustworthy = true;  ///< false: who estimated it does not trust it
  std::string soil = {};    ///< name of the soil whose law gave it; empty: unknown

  /// Implicit: a density is a number that may come with more.
  GroundDensity(double d, double sd = 0.0) : percent(d), sd_percent(sd) {}  // NOLINT: is a density
};

}  // namespace excavplan
