// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

/// @file
/// From the bulking factor k to the relative density d [%] and back: forms and their fits.
///
/// The paper fits a straight line d = a k + b. Solids that are conserved give a hyperbola: soil of
/// void ratio e that ends in one loose state has k = (1 + e_loose) / (1 + e), so
/// k = B + A / (1 - r d / 100), with r = (e_max - e_min) / (1 + e_max) and B = 0. The hyperbola is
/// exact where the line errs by 4 to 8 points (`docs/methods.md#density-law`). Clods give B > 0,
/// soil that fell back into the cut gives B < 0.

namespace excavplan {

/// d = a k + b.
struct DensityLine {
  double a = 0.0;                ///< [%]
  double b = 0.0;                ///< [%]
  double r2 = 0.0;               ///< coefficient of determination of d [-]
  double residual_sd = 0.0;      ///< scatter of d about the law, at 50 % [%]
  double residual_growth = 0.0;  ///< its relative change from there to 100 %, as residual_sd_at()
};

/// k = B + A / (1 - r d / 100), d = 100 / r (1 - A / (k - B)).
struct DensityClosedForm {
  double A = 0.0;                ///< [-], > 0
  double B = 0.0;                ///< [-]
  double r = 0.0;                ///< [-], in (0, 1)
  double r2 = 0.0;               ///< coefficient of determination of d [-]
  double residual_sd = 0.0;      ///< scatter of d about the law, at 50 % [%]
  double residual_growth = 0.0;  ///< its relative change from there to 100 %, as residual_sd_at()
};

/// The forms a law can have. Law files and fits go by this list.
using DensityForm = std::variant<DensityLine, DensityClosedForm>;

/// End of the key of a form fitted to k as height maps give it, not corrected for fallback.
inline constexpr const char* as_measured = "_as_measured";

/// Relative density by the law [%], also outside 0 .. 100. The closed form, which falls to minus
/// infinity as k comes down to B, ends at -1000 % and keeps its slope there.
double density_of_bulking(const DensityForm& form, double bulking_factor);

/// The inverse. @throws Error (bad_input) where the closed form has no factor, d >= 100 / r
double bulking_of_density(const DensityForm& form, double density_percent);

double density_slope(const DensityForm& form, double bulking_factor);  ///< dd/dk [%]

/// Scatter of d about the law at a density [%]: residual_sd (1 + residual_growth (d / 50 - 1)),
/// with d in 0 .. 100.
double residual_sd_at(const DensityForm& form, double density_percent);

/// The formula of a form in the letters of its parameters: "d = a k + b".
std::string formula(const DensityForm& form);

/// One dig of known density.
struct BulkingSample {
  double bulking_factor = 0.0;   ///< [-]
  double density_percent = 0.0;  ///< 0 .. 100
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
  std::string key;   ///< "closed_form_as_measured"
  DensityForm form;  ///< as fitted
};

/// Fits every form. Their keys are "line" and "closed_form", followed by `key_ending`.
/// @throws Error (bad_input) as the fits
std::vector<DensityFit> fit_density_forms(const std::vector<BulkingSample>& samples,
                                          const std::string& key_ending = "");

}  // namespace excavplan
