// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/error.hpp>
#include <excavplan/ground/volume_change.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// From the bulking factor k to the relative density d [%] and back.
///
/// The paper fits a straight line d = a k + b. Solids that are conserved give a hyperbola: soil of
/// void ratio e that ends in one loose state has k = (1 + e_loose) / (1 + e), so
/// k = B + A / (1 - r d / 100), with r = (e_max - e_min) / (1 + e_max) and B = 0. The hyperbola is
/// exact where the line is 4 to 8 points off (docs/methods.md#density-law). Clods make B > 0, soil
/// that fell back into the cut makes B < 0.

namespace excavplan {

/// One dig of known density.
struct BulkingSample {
  double bulking_factor = 0.0;   ///< [-]
  double density_percent = 0.0;  ///< 0 .. 100
};

/// d = a k + b.
struct DensityLine {
  double a = 0.0;            ///< [%]
  double b = 0.0;            ///< [%]
  double r2 = 0.0;           ///< coefficient of determination of d [-]
  double residual_sd = 0.0;  ///< scatter of d about the law [%]
};

/// k = B + A / (1 - r d / 100), d = 100 / r (1 - A / (k - B)).
struct DensityClosedForm {
  double A = 0.0;  ///< [-], > 0
  double B = 0.0;  ///< [-]
  double r = 0.0;  ///< [-], in (0, 1)
  double r2 = 0.0;
  double residual_sd = 0.0;  ///< [%]
};

/// The forms a law can have. Law files and fits go by this list.
using DensityForm = std::variant<DensityLine, DensityClosedForm>;

/// A law with its origin. `form` is what relative_density() uses.
struct DensityLaw {
  std::string name;
  std::string source;
  DensityForm form;
  /// For k freed of what fell back into the cut (free_of_fallback()): the twin of an
  /// "..._as_measured" form where the file has one, else `form` itself.
  DensityForm freed_form{};
  std::string soil = {};  ///< name of the soil it holds for; empty: not said
};

/// Reads a law file (docs/formats.md) and takes the form that its key "use" names.
///
/// @throws Error (bad_file) naming file, key, value and rule
DensityLaw load_density_law(const std::string& path);

/// The law that conservation of solids gives a soil: the closed form from its void ratios, B = 0,
/// without scatter. It leaves out clods and soil that falls back into the cut, which a calibrated
/// law holds: where a tenth of the cut falls back, the density comes out some 4 points too high.
DensityLaw density_law_of(const SoilKind& soil);

/// Relative density by the law as it stands [%], also outside 0 .. 100. The closed form has none at
/// k <= B and runs to minus infinity above it: it ends at -1000 %, and its slope there.
double density_of_bulking(const DensityForm& form, double bulking_factor);

/// The inverse. @throws Error (bad_input) if the closed form has no factor, d >= 100 / r
double bulking_of_density(const DensityForm& form, double density_percent);

double density_slope(const DensityForm& form, double bulking_factor);  ///< dd/dk [%]

/// The formula of a form in the letters of its parameters: "d = a k + b".
std::string formula(const DensityForm& form);

/// Relative density [%] with what is known about its error.
struct RelativeDensity {
  double percent = 0.0;      ///< inside 0 .. 100
  double raw_percent = 0.0;  ///< as the law gives it
  double sd_percent = 0.0;   ///< delta method: (dd/dk sd_k)^2 + residual_sd^2
  std::array<double, 2> interval_percent = {0.0, 100.0};  ///< 95 %, inside 0 .. 100
  bool trustworthy = true;
  std::vector<Warning> warnings;
};

/// Estimates the density. Outside 0 .. 100 % the clamped and the raw value are given with a
/// warning; further outside than the error explains (1.96 sd) the estimate is not trustworthy.
///
/// @throws Error (bad_input) unless the bulking factor is finite and positive and its sd is >= 0
RelativeDensity relative_density(const DensityLaw& law, const Measured& bulking_factor);

/// The relative density of the ground, as far as it is known, for planning a dig.
struct GroundDensity {
  double percent = 0.0;     ///< 0 .. 100
  double sd_percent = 0.0;  ///< standard deviation, >= 0; 0: taken as known
  bool trustworthy = true;  ///< false: who estimated it does not trust it
  std::string soil = {};    ///< name of the soil whose law gave it; empty: not told

  GroundDensity(double d, double sd = 0.0) : percent(d), sd_percent(sd) {}  // NOLINT: is a density
};

/// Least-squares line of d on k.
/// @throws Error (bad_input) with fewer than 3 different factors, a factor that is not positive, a
/// density outside 0 .. 100, or where none fits (k must grow with d)
DensityLine fit_line(const std::vector<BulkingSample>& samples);

/// Least-squares hyperbola of k on d (A and B linear, r by NLopt).
/// @throws Error (bad_input) as fit_line(), with fewer than 4 different densities
DensityClosedForm fit_closed_form(const std::vector<BulkingSample>& samples);

/// A fitted form and its key in a law file.
struct DensityFit {
  std::string key;
  DensityForm form;
};

/// Fits every form. Their keys are "line" and "closed_form", followed by `key_ending`.
/// @throws Error (bad_input) as the fits
std::vector<DensityFit> fit_density_forms(const std::vector<BulkingSample>& samples,
                                          const std::string& key_ending = "");

/// Ends the key of a form fitted to k as height maps give it, not freed of fallback.
inline constexpr const char* as_measured = "_as_measured";

/// What calibrate-density finds, and what a law file holds.
struct DensityCalibration {
  std::string name;
  std::string source;
  std::string soil;  ///< name of the soil; empty: not known
  std::string use;   ///< key of the form that serves
  /// On k freed of fallback where it is known; the keys of those on k as height maps give it end in
  /// `as_measured`.
  std::vector<DensityFit> forms;
  struct Sample {
    double density_percent = 0.0;
    double bulking_factor = 0.0;           ///< freed of fallback
    double bulking_factor_measured = 0.0;  ///< from height maps; 0 where unknown
    double bulking_factor_true = 0.0;      ///< from the dry mass balance; 0 where unknown
    double fallback_fraction = 0.0;
  };
  std::vector<Sample> samples;

  /// The form of this key. @throws Error (bad_input) if there is none
  const DensityForm& form(const std::string& key) const;
};

/// The text of a law file. @throws nothing
std::string to_json(const DensityCalibration& calibration);

}  // namespace excavplan
