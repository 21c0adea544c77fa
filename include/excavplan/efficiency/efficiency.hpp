// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/base/measured.hpp>
#include <excavplan/logs/dig_log.hpp>
#include <excavplan/scans/scan_surface.hpp>

/// @file
/// Efficiency of a real dig, from a log of fuel or power and the content of the bucket.

namespace excavplan {

/// What the payload is given in.
enum class Lifted { volume, mass };

/// Payload of a bucket.
struct Payload {
  Lifted kind = Lifted::volume;  ///< loose volume, or mass
  Measured amount;               ///< [m^3] or [kg], > 0; the sd is NaN if it is not known
};

/// Volume that the soil in the bucket had in the ground [m^3], > 0; the sd is NaN if unknown.
struct BankVolume {
  Measured amount;  ///< [m^3]
};

/// Scans of the dig area: the hole times the bulking factor, less the spill beside it.
struct PitScans {
  ScanPair scans;  ///< before and after the dig
};

/// Scans of the bucket in one frame, z out of its mouth: empty and loaded.
struct BucketScans {
  ScanPair scans;  ///< the empty bucket, the loaded one
};

/// From what the content of the bucket is known; a ScanPair is of the dump area.
using BucketContent = std::variant<Payload, BankVolume, ScanPair, PitScans, BucketScans>;

/// What of a log counts.
enum class Counted {
  dig,   ///< penetrate, drag and scoop; all of a log without phases
  cycle  ///< all of it, but idling before and behind a log with marked phases
};

/// One run: a log, and what it lifted.
struct LoggedDig : DigLogSource {
  BucketContent lifted;  ///< content of the bucket
  /// Loose over undisturbed volume [-], in 1 .. 3; the sd may be 0.
  std::optional<Measured> bulking_factor = {};
  std::optional<double> cell_size = {};  ///< of the height maps of scans [m]; else cell_for() them
  unsigned threads = 0;                  ///< for scans; 0: one per core
  Counted counted = Counted::dig;        ///< what of the log
  /// Fuel flow [mL/s] or power [W] of the machine at rest; else the low plateau of the log.
  std::optional<double> idle = {};
  std::optional<Spent> idle_kind = {};  ///< of which these are; else what the log records
  bool subtracts_idle = false;          ///< whether idling is no part of the cost
  /// Of the meter, relative, the same in the whole log [-]; ours,
  /// docs/efficiency.md#what-the-numbers-are.
  double meter_sd = 0.02;
};

/// Fuel [mL] or energy [kJ] of a part of a log, and its time.
struct RunShare {
  double cost = 0.0;                 ///< idling included
  std::optional<double> above_idle;  ///< without it; nothing if the idle rate is not known
  double duration = 0.0;             ///< [s]
};

/// Rate of a machine at rest.
struct IdleRate {
  double rate = 0.0;      ///< [mL/s] or [W]
  bool is_found = false;  ///< in the log, not stated
};

/// Payload per fuel or energy.
struct DigEfficiency {
  std::string file;                        ///< the log
  DigLog log;                              ///< what it holds: time and rate, for figures
  Spent spent = Spent::fuel;               ///< what the log records
  LogMeter meter = LogMeter::fuel_flow;    ///< the columns it is from
  double cost = 0.0;                       ///< fuel [mL] or energy [kJ] that counts
  double cost_sd = 0.0;                    ///< from the meter
  double duration = 0.0;                   ///< of what counts [s]
  Payload payload;                         ///< what was lifted
  std::optional<Measured> bank_volume;     ///< of the payload [m^3], if its bulking factor is known
  PhaseSource phases = PhaseSource::none;  ///< how the dig is known in the log
  std::size_t digs = 1;                    ///< in the log
  RunShare dig;                            ///< penetrate, drag and scoop of all digs
  std::optional<RunShare> cycle;           ///< of Counted::cycle, if the log has phases
  std::optional<IdleRate> idle;            ///< nothing: neither stated nor in the log
  bool trustworthy = true;                 ///< false after a warning that casts doubt on it
  std::vector<Warning> warnings;           ///< of the log and the payload

  Measured value() const;                 ///< payload per cost
  Measured per(double other_cost) const;  ///< payload per another cost of the same meter
  std::string unit() const;               ///< "m3_per_ml", "kg_per_kj"
  std::string symbol() const;             ///< the same for display: "m3/mL"
};

/// Integrates the log by the trapezoid rule over the dig and divides the payload by it. The volume
/// of scans of the dump area is that of the heap which rose between them.
///
/// Warnings, after each of which it is not trustworthy: gap_in_log (a pause of more than 10 usual
/// steps), implausible_fuel and implausible_energy (a payload, a mean rate or a reading far beyond
/// those of excavators), idle_above_dig, bucket_partly_unseen. In a log without phases also
/// dig_below_rest (the machine took less per second in the dig than in the rest of the log, which
/// is at least as long) and idle_in_dig (idling for 2 s or more counts as the dig). Of scans also
/// those of measure_change(), units and frame.
///
/// @throws Error (bad_file) as read_dig_log() or naming the rule if it adds up to nothing, or as
/// estimate_density() for scans; (bad_input) if the dig lies outside the log, the payload is not
/// positive, a bulking factor is missing or has no use, or idling is to be subtracted but not known
DigEfficiency measure_efficiency(const LoggedDig& dig);

/// Gain of the second dig over the first [%], with its standard deviation from the payloads. An
/// error that both share, as that of one meter, and the soil's density if it is the same, cancel.
/// @param own_meters  each had its own, so that their errors do not cancel
/// @throws Error (bad_input) if they are in different units, or a payload per cost is not positive
Measured efficiency_gain(const DigEfficiency& first, const DigEfficiency& second,
                         bool own_meters = false);

}  // namespace excavplan
