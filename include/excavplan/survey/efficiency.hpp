// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/ground/volume_change.hpp>
#include <excavplan/survey/scan_surface.hpp>

/// @file
/// Efficiency of a real dig, from a log of fuel or power and the payload of the bucket.

namespace excavplan {

/// What a log records.
enum class Spent { fuel, energy };
/// What the payload is given in.
enum class Lifted { volume, mass };

/// Payload of a bucket.
struct Payload {
  Lifted kind = Lifted::volume;  ///< volume or mass
  Measured amount;               ///< [m^3] or [kg], > 0; the sd is NaN if it is not known
};

/// One dig in a log: a CSV file with the column time_s and one of fuel_flow_ml_per_s,
/// fuel_flow_l_per_h, power_w, or boom_power_w with arm_power_w and bucket_power_w.
struct LoggedDig {
  std::string file;            ///< the log
  std::optional<double> from;  ///< time_s at which the dig starts [s]; else the first of the log
  std::optional<double> to;    ///< time_s at which it ends [s]; else the last of the log
  std::variant<Payload, ScanPair> lifted;  ///< or the scans of the dump area that show it
  std::optional<double> cell_size;  ///< of the height maps of scans [m]; else cell_for() them
  unsigned threads = 0;             ///< for scans; 0: one per core
  std::string prefix = {};  ///< of from, to, volume and mass in messages, such as "--" of options
};

/// Payload per fuel or energy.
struct DigEfficiency {
  std::string file;               ///< the log
  Spent spent = Spent::fuel;      ///< what the log records
  double cost = 0.0;              ///< fuel [mL] or energy [kJ]
  double duration = 0.0;          ///< [s]
  Payload payload;                ///< what was lifted
  bool trustworthy = true;        ///< false after a warning that casts doubt on it
  std::vector<Warning> warnings;  ///< of the log and the payload

  Measured value() const;      ///< payload per cost
  std::string unit() const;    ///< "m3_per_ml", "kg_per_kj"
  std::string symbol() const;  ///< the same for display: "m3/mL"
};

/// Integrates the log by the trapezoid rule over the dig, negative power of a joint counted as 0,
/// and divides the payload by it. The volume of scans is that of the heap which rose between them.
///
/// Warnings, after each of which it is not trustworthy: gap_in_log (a pause of more than 10 usual
/// steps), implausible_fuel and implausible_energy (a payload or a rate far beyond those of
/// excavators), dig_below_rest (the machine took less per second in the dig than in the rest of the
/// log, which is at least as long). Of scans also those of measure_change(), units and frame.
///
/// @throws Error (bad_file) naming file, line and rule if the log is no such table, its time does
/// not rise or it adds up to nothing, or as estimate_density() for scans; (bad_input) if the dig
/// lies outside the log, or the payload is not positive
DigEfficiency measure_efficiency(const LoggedDig& dig);

/// Gain of the second dig over the first [%]. An error that both share, as that of one meter, and
/// the soil's density if it is the same, cancel.
/// @throws Error (bad_input) if they are in different units, or a payload per cost is not positive
Measured efficiency_gain(const DigEfficiency& first, const DigEfficiency& second);

}  // namespace excavplan
