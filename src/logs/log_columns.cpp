// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "logs/log_columns.hpp"

#include <algorithm>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using std::string_view;

struct Unit {
  Measure measure;
  const char* text;  ///< as normalised() writes it
  double factor;
};

constexpr double litre_per_hour = 1000.0 / 3600.0;  // [mL/s]
constexpr double us_gallon = 3.785411784;           // [L]; NIST SP 811

const std::vector<Unit>& units() {
  static const std::vector<Unit> list = {{Measure::time, "s", 1.0},
                                         {Measure::time, "sec", 1.0},
                                         {Measure::time, "seconds", 1.0},
                                         {Measure::time, "ms", 1e-3},
                                         {Measure::time, "msec", 1e-3},
                                         {Measure::time, "us", 1e-6},
                                         {Measure::time, "ns", 1e-9},
                                         {Measure::time, "min", 60.0},
                                         {Measure::time, "h", 3600.0},
                                         {Measure::flow, "ml/s", 1.0},
                                         {Measure::flow, "ml/min", 1.0 / 60.0},
                                         {Measure::flow, "ml/h", 1.0 / 3600.0},
                                         {Measure::flow, "l/h", litre_per_hour},
                                         {Measure::flow, "l/hr", litre_per_hour},
                                         {Measure::flow, "l/min", 1000.0 / 60.0},
                                         {Measure::flow, "l/s", 1000.0},
                                         {Measure::flow, "cc/s", 1.0},
                                         {Measure::flow, "cc/min", 1.0 / 60.0},
                                         {Measure::flow, "cm3/s", 1.0},
                                         {Measure::flow, "cm3/min", 1.0 / 60.0},
                                         {Measure::flow, "gal/h", us_gallon * litre_per_hour},
                                         {Measure::flow, "gph", us_gallon * litre_per_hour},
                                         {Measure::power, "w", 1.0},
                                         {Measure::power, "kw", 1000.0},
                                         {Measure::torque, "nm", 1.0},
                                         {Measure::torque, "knm", 1000.0},
                                         {Measure::turn_rate, "rad/s", 1.0},
                                         {Measure::turn_rate, "deg/s", pi / 180.0},
                                         {Measure::turn_rate, "°/s", pi / 180.0},
                                         {Measure::angle, "rad", 1.0},
                                         {Measure::angle, "deg", pi / 180.0},
                                         {Measure::angle, "°", pi / 180.0},
                                         {Measure::pressure, "pa", 1.0},
                                         {Measure::pressure, "kpa", 1e3},
                                         {Measure::pressure, "mpa", 1e6},
                                         {Measure::pressure, "bar", 1e5},
                                         {Measure::pressure, "psi", 6894.757293168},
                                         {Measure::speed, "m/s", 1.0},
                                         {Measure::speed, "cm/s", 0.01},
                                         {Measure::speed, "mm/s", 0.001}};
  return list;
}

/// "mL_per_min" and "ml / min" are "ml/min", "N m" and "N·m" "nm".
std::string normalised(string_view unit) {
  std::string text = small_letters(unit);
  for (const char* word : {"_per_", " per "}) {
    for (auto at = text.find(word); at != text.npos; at = text.find(word)) text.replace(at, 5, "/");
  }
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 2, "·") == 0 || text.compare(i, 2, "³") == 0) {
      if (text.compare(i, 2, "³") == 0) out += '3';
      ++i;
    } else if (std::string("_ *.").find(text[i]) == std::string::npos) {
      out += text[i];
    }
  }
  return out;
}

bool is_unit(string_view text) {
  const std::string unit = normalised(text);
  return std::any_of(units().begin(), units().end(),
                     [&](const Unit& known) { return unit == known.text; });
}

std::string words_of(string_view text) {
  std::string words;
  for (const char c : small_letters(text)) {
    const bool is_word = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_word) words += c;
    if (!is_word && !words.empty() && words.back() != '_') words += '_';
  }
  if (!words.empty() && words.back() == '_') words.pop_back();
  return words;
}

/// What stands in brackets at the end, with or without a unit that is known.
std::optional<ColumnName> bracketed(string_view name) {
  if (name.size() < 3 || (name.back() != ']' && name.back() != ')')) return std::nullopt;
  const std::size_t open = name.rfind(name.back() == ']' ? '[' : '(');
  if (open == name.npos || open == 0) return std::nullopt;
  const string_view unit = name.substr(open + 1, name.size() - open - 2);
  return ColumnName{words_of(name.substr(0, open)), std::string(unit)};
}

/// The longest unit behind a blank or '_', or " / " or " in ".
std::optional<ColumnName> suffixed(string_view name) {
  for (std::size_t at = 1; at + 1 < name.size(); ++at) {
    if (name[at] != '_' && name[at] != ' ') continue;
    string_view unit = name.substr(at + 1);
    for (const string_view word : {"/ ", "in ", "in_"}) {
      if (unit.substr(0, word.size()) == word) unit.remove_prefix(word.size());
    }
    if (is_unit(unit)) return ColumnName{words_of(name.substr(0, at)), std::string(unit)};
  }
  return std::nullopt;
}

/// Of the unit that the column's name says, or else of the stated one.
double factor_in(const std::string& file, const std::string& name, Measure measure,
                 const std::string& stated) {
  const std::string column = "column " + in_quotes(name);
  const std::string own = column_name(name).unit.value_or("");
  const auto of_own = factor_of(own, measure);
  const auto of_stated = factor_of(stated, measure);
  if (of_own && !stated.empty() && of_own != of_stated) {
    refuse_log(file, column + " is in " + in_quotes(own) + " by its name, but " +
                         in_quotes(stated) + " is stated as its unit");
  }
  if (of_own) return *of_own;
  const std::string& unit = stated.empty() ? own : stated;
  if (unit.empty()) {
    refuse_log(file, column + " states no unit, expected one as in 'NAME [UNIT]', of " +
                         usual_units(measure) + ": state the unit");
  }
  if (of_stated) return *of_stated;
  refuse_log(file,
             column + " is in " + in_quotes(unit) + ", expected one of " + usual_units(measure));
}

}  // namespace

void refuse_log(const std::string& file, const std::string& why) {
  throw Error(ErrorKind::bad_file, file + ": " + why);
}

std::optional<double> factor_of(string_view unit, Measure measure) {
  const std::string text = normalised(unit);
  for (const Unit& known : units()) {
    if (known.measure == measure && text == known.text) return known.factor;
  }
  return std::nullopt;
}

std::string usual_units(Measure measure) {
  switch (measure) {
    case Measure::time:
      return "s, ms, min, h";
    case Measure::flow:
      return "mL/s, mL/min, L/h, L/min, gal/h";
    case Measure::power:
      return "W, kW";
    case Measure::torque:
      return "N m, kN m";
    case Measure::turn_rate:
      return "rad/s, deg/s";
    case Measure::angle:
      return "rad, deg";
    case Measure::pressure:
      return "Pa, kPa, MPa, bar, psi";
    case Measure::speed:
      return "m/s, mm/s";
  }
  return {};
}

ColumnName column_name(string_view name) {
  if (auto found = bracketed(name)) return *found;
  if (auto found = suffixed(name)) return *found;
  return {words_of(name), std::nullopt};
}

std::optional<FoundColumn> find_column(const std::string& file,
                                       const std::vector<std::string>& names,
                                       const Channel& channel, const std::string& unit) {
  std::optional<FoundColumn> found;
  const bool is_rate = channel.measure == Measure::flow || channel.measure == Measure::power;
  for (const std::string& name : names) {
    const ColumnName parts = column_name(name);
    const auto& known = channel.names;
    if (std::find(known.begin(), known.end(), parts.base) == known.end()) continue;
    // Such as "power [L/h]": the name of one quantity in the unit of another.
    if (parts.unit && is_unit(*parts.unit) && !factor_of(*parts.unit, channel.measure)) continue;
    if (found) {
      refuse_log(file, "holds both " + safe_text(found->name, 40) + " and " + safe_text(name, 40) +
                           ", expected one of them" +
                           (is_rate ? ": state the column of fuel or power" : ""));
    }
    found = FoundColumn{name, factor_in(file, name, channel.measure, unit)};
  }
  return found;
}

FoundColumn named_column(const std::string& file, const std::string& name, Measure measure,
                         const std::string& unit) {
  return {name, factor_in(file, name, measure, unit)};
}

}  // namespace excavplan
