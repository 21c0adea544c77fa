// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil_scatter.hpp>

/// @file
/// Density laws fitted to digs of known density, and their files.

namespace excavplan {

/// Digs in drawn soils, from which the scatter of the forms is.
struct ScatterDigs {
  int draws = 0;        ///< number of digs; 0: the scatter is that of the samples
  SoilScatter scatter;  ///< of the soils
};

/// What a law file holds: the forms with the samples they were fitted to.
struct DensityCalibration {
  std::string name;                                ///< of the law
  std::string source;                              ///< text: origin of the samples
  std::string soil;                                ///< name of the soil; empty: not known
  std::string use;                                 ///< key of the form to use
  std::string machine = {};                        ///< as in DensityLaw
  std::string simulator = {};                      ///< likewise
  std::optional<std::array<double, 3>> path = {};  ///< likewise
  bool any_path = false;                           ///< likewise
  ScatterDigs scatter = {};                        ///< behind the residual_sd of the forms
  /// Fitted to k corrected for fallback where that is known; the keys of those fitted to k as
  /// height maps give it end in `as_measured`.
  std::vector<DensityFit> forms;
  /// One dig.
  struct Sample {
    double density_percent = 0.0;          ///< 0 .. 100
    double bulking_factor = 0.0;           ///< corrected for fallback
    double bulking_factor_measured = 0.0;  ///< from height maps; 0 where unknown
    double bulking_factor_true = 0.0;      ///< from the dry mass balance; 0 where unknown
    double fallback_fraction = 0.0;        ///< of the cut; 0 where unknown
  };
  std::vector<Sample> samples;  ///< that the forms were fitted to

  /// The form of this key. @throws Error (bad_input) if there is none
  const DensityForm& form(const std::string& key) const;
};

/// The law that a calibration gives.
DensityLaw law_of(const DensityCalibration& calibration);

/// Sets the scatter of a form so that its mean square below 50 % and above is that of the densities
/// that the form gives for these digs; at 0 % and at 100 % it is 0 at least, and then twice that at
/// 50 % at the other end. @param digs  at least one
/// @throws Error (bad_input) if there is none, or their scatter is not finite
void set_scatter(DensityForm& form, const std::vector<BulkingSample>& digs);

/// The text of a law file.
/// @throws Error (bad_input) naming a number that is not finite or a text that is not UTF-8
std::string to_json(const DensityCalibration& calibration);

}  // namespace excavplan
