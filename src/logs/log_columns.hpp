// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// @file
/// Names of columns as loggers write them: what is measured, and in what unit. Private to the
/// library.

namespace excavplan {

/// @throws Error (bad_file) of a log
[[noreturn]] void refuse_log(const std::string& file, const std::string& why);

/// What a column measures.
enum class Measure { time, flow, power, torque, turn_rate, angle, pressure, speed };

/// Factor from a unit to s, mL/s, W, N m, rad/s, rad, Pa or m/s; nothing if it is none of the
/// measure.
std::optional<double> factor_of(std::string_view unit, Measure measure);
/// "mL/s, mL/min, L/h", for messages.
std::string usual_units(Measure measure);

/// A name in its parts: "Fuel flow [mL/min]", "fuel_flow_ml_per_min" and "Fuel flow / mL/min" are
/// both "fuel_flow" in "mL/min".
struct ColumnName {
  std::string base;                 ///< small letters and digits, words parted by '_'
  std::optional<std::string> unit;  ///< as it is written
};
ColumnName column_name(std::string_view name);

/// A quantity and what columns of it are called, the usual name first.
struct Channel {
  Measure measure = Measure::time;
  std::vector<std::string> names;
};

/// A column of a channel.
struct FoundColumn {
  std::string name;
  double factor = 1.0;
};

/// The column of these names that is one of the channel: none, or the only one. `unit` is of a
/// column that does not say its own; may be empty.
/// @throws Error (bad_file) if there are two, or one lacks a unit, has another, or one that is not
/// the stated one
std::optional<FoundColumn> find_column(const std::string& file,
                                       const std::vector<std::string>& names,
                                       const Channel& channel, const std::string& unit);
/// The column of this name. @throws Error (bad_file) as find_column()
FoundColumn named_column(const std::string& file, const std::string& name, Measure measure,
                         const std::string& unit);

}  // namespace excavplan
