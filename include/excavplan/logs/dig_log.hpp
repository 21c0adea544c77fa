// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/machine/machine.hpp>

/// @file
/// Recordings of a dig: fuel flow or power over time, as tables of spreadsheets and loggers.

namespace excavplan {

/// What a log records.
enum class Spent { fuel, energy };

/// By what columns a log records it.
enum class LogMeter { fuel_flow, power, joint_powers, torques, pressures };
/// "fuel flow", "power", "joint powers", "torques and rates", "pressures and speeds".
const char* name(LogMeter meter);

/// How the parts of a dig are known in a log.
enum class PhaseSource {
  none,    ///< they are not: all of it is the dig
  marked,  ///< by a column
  found    ///< by the joint angles
};

/// Both sides of the pistons of a joint, of all its cylinders [m^2].
struct PistonAreas {
  double head = 0.0;  ///< pushes
  double rod = 0.0;   ///< pulls
};
/// Of boom, arm and bucket; nothing if the machine does not state its hydraulics.
std::optional<std::array<PistonAreas, 3>> piston_areas(const Machine& machine);

/// A log and how it is written; what is not stated is found from it.
struct DigLogSource {
  std::string file;                 ///< the table
  std::optional<double> from = {};  ///< time at which it starts to count [s]; else its first
  std::optional<double> to = {};    ///< time at which that ends [s]; else its last
  std::optional<std::string> time_column = {};  ///< its name
  std::string time_unit = {};                   ///< if the name does not say it: "ms"
  std::optional<std::string> rate_column = {};  ///< of fuel flow or power
  std::string rate_unit = {};                   ///< if the name does not say it: "mL/min"
  std::optional<LogMeter> meter = {};           ///< of several; else the only one
  std::optional<char> delimiter = {};           ///< ',', ';', tab or '|'
  std::optional<char> decimal_mark = {};        ///< '.' or ','
  /// none: phases of the log are not used; unset: those of its column, if it has one.
  std::optional<PhaseSource> phases = {};
  /// For pressures of cylinders.
  std::optional<std::array<PistonAreas, 3>> pistons = {};
  std::string prefix = {};  ///< of from and to in messages, such as "--" of options
};

/// A stretch of time [s].
struct LogInterval {
  double from = 0.0;  ///< its begin
  double to = 0.0;    ///< its end
};

/// Rows of a log, from first up to, without, last.
struct LogRows {
  std::size_t first = 0;  ///< the first of them
  std::size_t last = 0;   ///< behind the last of them
};
/// Those in an interval of the log and one beside either end, if there is one, by bisection.
LogRows rows_around(const std::vector<double>& time, const LogInterval& interval);

/// What a log records, in SI units but for fuel.
struct DigLog {
  std::string file;                      ///< for messages
  Spent spent = Spent::fuel;             ///< kind of the rate
  LogMeter meter = LogMeter::fuel_flow;  ///< its columns
  bool of_joints = false;                ///< power of the joints, not of engine, shaft or pump
  std::vector<double> time;              ///< strictly increasing [s]
  /// Fuel flow [mL/s], or power [W]: of the machine, or of each joint, whose negative part does not
  /// count. One row of the log each.
  std::vector<std::vector<double>> rates;
  PhaseSource phases = PhaseSource::none;  ///< how the digs are known
  std::vector<LogInterval> digs;           ///< penetrate, drag and scoop of each; one or more
  LogInterval cycle;  ///< all but idling before and behind it, as far as phases tell
  LogInterval whole;  ///< what counts of the log

  /// Rate of the machine at each time: the sum of the parts that count [mL/s] or [W]. For figures.
  std::vector<double> rate() const;
  /// Integral of what counts of the rate [mL] or [J], without `idle` of it at any time.
  double integral(const LogInterval& during, double idle = 0.0) const;
};

/// Reads a log (docs/formats.md#efficiency-log).
///
/// @throws Error (bad_file) naming file, line, column and rule if it is no such table, its time
/// does not rise, its columns can be read in two ways or lack a unit; (bad_input) if from and to
/// lie outside of it
DigLog read_dig_log(const DigLogSource& source);

/// The rate of a machine at rest: the lowest mean over 2 s in which it stays within 10 % of it, if
/// that is below 0.8 times the mean of the log [mL/s] or [W]. Numbers are ours.
std::optional<double> idle_of(const DigLog& log);

}  // namespace excavplan
