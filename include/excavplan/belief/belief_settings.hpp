// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// What is believed of the density of the ground before the first dig.

namespace excavplan {

/// What is believed before the first dig. The numbers are ours, all of them here
/// (docs/methods.md#belief says where they are from).
struct BeliefSettings {
  double mean_percent = 50.0;           ///< of the site's mean density
  double level_sd_percent = 25.0;       ///< of it [points]
  double trend_sd_percent_per_m = 5.0;  ///< of a linear change over depth
  double spread_percent = 10.0;     ///< root mean square deviation about these, from place to place
  double length = 4.0;              ///< of the Matern 3/2 covariance in plan [m]
  double depth_length = 1.0;        ///< of that over depth [m]
  double law_sd_percent = 4.2;      ///< error of the density law, common to all surveys
  double payload_sd_percent = 3.0;  ///< error of the payload's scale, common to all payloads
  double log_strength_sd = 0.4;     ///< of ln(factor on the soil's strength)
};

}  // namespace excavplan
