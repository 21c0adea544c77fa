// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/base/measured.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// What one dig tells of the density of the ground (docs/methods.md#belief).

namespace excavplan {

/// A point of the ground.
struct GroundPlace {
  double x = 0.0;      ///< site frame [m]
  double y = 0.0;      ///< site frame [m]
  double depth = 0.0;  ///< below the ground as it was before the first dig [m]
};

/// Undisturbed soil about a place.
struct BankPart {
  GroundPlace place;    ///< its centre
  double volume = 0.0;  ///< undisturbed [m^3], >= 0; weighs the place against others
};

/// At most four parts of the same sum of volumes, mean place and, along the longer axis in plan
/// and over depth, the same second moments. Four or fewer are returned as they are.
///
/// @throws Error (bad_input) unless places and volumes are finite, the volumes at least 0 and their
///         sum above 0
std::vector<BankPart> condensed(const std::vector<BankPart>& bank);

/// Part of the error of a survey that it shares with others: that of one of its two scans.
struct ScanError {
  int scan = 0;  ///< number of the scan, of the caller's own
  /// What one standard deviation of that scan's error does to the density [points], with its sign:
  /// opposite for the scan before a dig and the one after it.
  double effect_percent = 0.0;
};

/// Density by the scans of a dig.
struct SurveyReading {
  double raw_percent = 0.0;  ///< as the law gives it, also outside 0 .. 100
  /// Of the survey and of the path's scatter [points], without the error common to all digs, which
  /// is a state of the belief, and without `scans`.
  double sd_percent = 0.0;
  std::vector<ScanError> scans = {};  ///< independent of each other and of the rest
};

/// How a figure of resistance follows from the density d of the bank that was cut and from the
/// factor f on the soil's strength: ln(figure) = ln(foretold) + rise (d - at) + share ln(f).
struct ResistanceLaw {
  double at_percent = 50.0;       ///< density that it was foretold for
  double rise_per_percent = 0.0;  ///< of the logarithm with the density [1/%]
  double strength_share = 1.0;    ///< of the figure that grows with the strength, 0 .. 1
};

/// Energy or a load of a joint beside what was foretold.
struct ResistanceReading {
  double log_ratio = 0.0;  ///< ln(measured / foretold)
  double sd = 0.0;         ///< of that logarithm: meter, simulator, path
  ResistanceLaw law = {};  ///< of the figure
};

/// A limit that a dig met or not: it stalled, or a joint was at its largest torque. Known only by
/// its being met, it is weak evidence (probit).
struct LimitReading {
  bool was_met = false;     ///< the stall, the joint at its limit
  double log_margin = 0.0;  ///< ln(foretold figure / limit); above 0 the limit is met
  double sd = 0.0;          ///< of that logarithm: simulator, path
  ResistanceLaw law = {};   ///< of the figure
};

/// One dig. Readings that are missing teach nothing; errors of readings are independent of each
/// other but by the scans and the belief's common states.
struct DigEvidence {
  std::vector<BankPart> bank = {};  ///< undisturbed soil that it cut; empty: none
  double bank_share = 1.0;  ///< of all soil that it cut, 0 .. 1; below a third: no news of density
  std::optional<SurveyReading> survey = {};        ///< of two scans; nothing if there was none
  std::optional<Measured> payload_percent = {};    ///< density_of_bank() of payload and bank
  std::vector<ResistanceReading> resistance = {};  ///< energy, loads of joints
  std::vector<LimitReading> limits = {};           ///< stalls, joints at their limit
};

/// Below this share of bank in what a dig cut its readings are no news; ours.
inline constexpr double least_bank_share = 1.0 / 3.0;

/// The relative density [%] at which so much undisturbed soil has this mass, also outside 0 .. 100,
/// with what the errors of both do to it (first order).
///
/// @throws Error (bad_input) as require_soil(), unless mass [kg] and volume [m^3] are positive and
///         finite and their deviations at least 0
Measured density_of_bank(const SoilKind& soil, const Measured& mass, const Measured& volume);

}  // namespace excavplan
