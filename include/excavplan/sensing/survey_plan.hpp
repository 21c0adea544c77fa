// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/sensing/sensors.hpp>

/// @file
/// Predicted error of the density of a planned survey, from the size of the dig, the errors of the
/// sensor and its position (docs/methods.md#survey-planning).

namespace excavplan {

/// What is to be surveyed, and how. Dig area and dump area are each seen from one such place,
/// before and after.
struct SurveyPlan {
  double dig_volume = 0.50;       ///< 0.001 .. 1000 [m^3]
  double dig_depth = 0.30;        ///< 0.01 .. 30 [m]
  double bulking_factor = 1.25;   ///< expected, 0.9 .. 3 [-]
  double spill_share = 0.10;      ///< of the loose soil that lies beside the pit, not on the heap
  double wall_angle = 1.22;       ///< of the pit [rad]
  double angle_of_repose = 0.61;  ///< of heap and spill [rad]
  double surveyed_area = 25.0;    ///< around the dig and around the heap, each, 0.1 .. 1e4 [m^2]
  Sensor sensor = default_sensor();  ///< its error model
  double height = 2.5;               ///< of the sensor above the ground, 0.1 .. 100 [m]
  double offset = 1.0;               ///< from the centre of the area, horizontal, 0 .. 100 [m]
  int frames = 30;                   ///< averaged
  bool registered = false;        ///< the scans are registered on stable ground: the sensor moved
  double density_slope = 161.57;  ///< of the density law, dd/dk [%]; the paper's line
};

/// Predicted standard deviations, from scan errors alone (without the scatter of the law).
struct SurveyForecast {
  double range = 0.0;               ///< from the sensor to the centre of an area [m]
  double ray_spacing = 0.0;         ///< on the ground [m]
  double excavated_sd = 0.0;        ///< [m^3]
  double after_sd = 0.0;            ///< spill and heap [m^3]
  double bulking_sd = 0.0;          ///< [-]
  double density_sd_percent = 0.0;  ///< points of density
  double datum_sd = 0.0;            ///< of the height of one scan against the other [m]
  /// Shares of the variance of the bulking factor; they sum to 1.
  double white_share = 0.0;
  double correlated_share = 0.0;  ///< of the variance: errors that neighbouring points share
  double datum_share = 0.0;       ///< of the variance: the height between both scans
  double occlusion_share = 0.0;   ///< of the variance: ground that the sensor does not see
  double hidden_share = 0.0;      ///< of pit and heap, hidden behind rim and crest [-]
  bool in_view = true;            ///< pit and spill, and the heap, fit into the field of view
};

/// Predicts the error of a survey; within a fifth of what 60 simulated surveys scatter at 1.6 to
/// 4 m above the ground.
///
/// Volumes are sums over the zones of pit, spill and heap, 10 cm wider than these. White noise sums
/// as area * sd^2 * ray spacing^2, correlated noise as area * sd^2 * 2 pi length^2; the datum errs
/// by the same over the stable ground in view, more if two scans are registered there; a strip
/// hidden behind a rim is filled straight across and errs by half its depth.
///
/// @throws Error (bad_input) naming the value and its rule
SurveyForecast plan_survey(const SurveyPlan& plan);

/// How good one property must be for a standard deviation of the density, all others as planned.
/// Nothing where that cannot be reached by this property alone.
struct SurveyNeeds {
  std::optional<double> range;  ///< largest, at the same angle of view [m]
  std::optional<int> frames;    ///< fewest, up to 1000
  std::optional<double> noise;  ///< largest factor on noise and pattern of the sensor [-]
  double nearest_range = 0.0;   ///< from which all is in view, at the same angle [m]
};

/// @throws Error (bad_input) as plan_survey(), or unless the target is above 0 and at most 100
SurveyNeeds survey_needs(const SurveyPlan& plan, double density_sd_percent);

}  // namespace excavplan
