// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/survey/efficiency.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.hpp"
#include "base/table.hpp"
#include "base/text.hpp"
#include "ground/too_few_cells.hpp"
#include "survey/scan_checks.hpp"
#include "survey/scan_reading.hpp"

namespace excavplan {
namespace {

// ---- What was spent ---------------------------------------------------------------------------

/// A kind of column in which a log records what was spent.
struct Meter {
  std::vector<std::string> columns;
  Spent spent = Spent::fuel;
  double scale = 1.0;  ///< integral of the columns over seconds to mL or kJ
};

const std::array<Meter, 4>& meters() {
  static const std::array<Meter, 4> list = {
      {{{"fuel_flow_ml_per_s"}, Spent::fuel, 1.0},
       {{"fuel_flow_l_per_h"}, Spent::fuel, 1000.0 / 3600.0},
       {{"power_w"}, Spent::energy, 0.001},
       {{"boom_power_w", "arm_power_w", "bucket_power_w"}, Spent::energy, 0.001}}};
  return list;
}

/// The one meter whose columns the log holds.
const Meter& meter_of(const Table& log, const std::string& file) {
  const Meter* found = nullptr;
  for (const Meter& meter : meters()) {
    const bool present = std::any_of(meter.columns.begin(), meter.columns.end(),
                                     [&](const std::string& name) { return log.has(name); });
    if (!present) continue;
    if (found) {
      throw Error(ErrorKind::bad_file, file + ": holds both " + found->columns.front() + " and " +
                                           meter.columns.front() + ", expected one of them");
    }
    found = &meter;
  }
  if (!found) {
    throw Error(ErrorKind::bad_file,
                file +
                    ": has no column of fuel or power, expected one of fuel_flow_ml_per_s, "
                    "fuel_flow_l_per_h, power_w, or boom_power_w with arm_power_w and "
                    "bucket_power_w");
  }
  return *found;
}

void require_increasing(const std::vector<double>& time, const std::string& file) {
  if (time.size() < 2) {
    throw Error(ErrorKind::bad_file, file + ": holds one row, at least 2 are needed");
  }
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (time[i] > time[i - 1]) continue;
    throw Error(ErrorKind::bad_file, file + ": row " + std::to_string(i + 1) +
                                         " of the numbers: time_s is " + number_text(time[i]) +
                                         ", must be above " + number_text(time[i - 1]) +
                                         " of the row before");
  }
}

struct Interval {
  double from = 0.0;
  double to = 0.0;
};

Interval interval_of(const LoggedDig& dig, const std::vector<double>& time) {
  const Interval log{time.front(), time.back()};
  const Interval interval{dig.from.value_or(log.from), dig.to.value_or(log.to)};
  const auto require_inside = [&](const char* name, double value) {
    if (value >= log.from && value <= log.to) return;
    throw Error(ErrorKind::bad_input, dig.prefix + name + ": " + number_text(value) +
                                          " s is outside " + dig.file + ", which runs from " +
                                          number_text(log.from) + " to " + number_text(log.to) +
                                          " s");
  };
  require_inside("from", interval.from);
  require_inside("to", interval.to);
  if (!(interval.from < interval.to)) {
    throw Error(ErrorKind::bad_input, dig.prefix + "from: " + number_text(interval.from) +
                                          " s must be before " + dig.prefix + "to, " +
                                          number_text(interval.to) + " s");
  }
  return interval;
}

/// Integral of a straight line from a to b, of its positive part if only that counts.
double area_under(double a, double b, double width, bool only_positive) {
  if (!only_positive || (a >= 0.0 && b >= 0.0)) return 0.5 * (a + b) * width;
  const double top = std::max(a, b);
  return top > 0.0 ? 0.5 * top * top / std::abs(b - a) * width : 0.0;
}

/// Trapezoid rule over the part of the log inside the dig.
double integral(const std::vector<double>& time, const std::vector<double>& rate,
                const Interval& dig, bool only_positive) {
  double sum = 0.0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double from = std::max(time[i - 1], dig.from);
    const double to = std::min(time[i], dig.to);
    if (!(from < to)) continue;
    const double slope = (rate[i] - rate[i - 1]) / (time[i] - time[i - 1]);
    const auto at = [&](double t) { return rate[i - 1] + slope * (t - time[i - 1]); };
    sum += area_under(at(from), at(to), to - from, only_positive);
  }
  return sum;
}

/// Longest interval between two rows of the dig, if it is an outlier.
std::optional<Warning> gap_in(const std::vector<double>& time, const Interval& dig,
                              const std::string& file) {
  constexpr double most_usual_steps = 10.0;  // ours
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (time[i] > dig.from && time[i - 1] < dig.to) steps.push_back(time[i] - time[i - 1]);
  }
  const double longest = *std::max_element(steps.begin(), steps.end());
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  if (!(longest > most_usual_steps * *middle)) return std::nullopt;
  return Warning{"gap_in_log", file + ": no row for " + readable(longest) + " s, where " +
                                   readable(*middle) +
                                   " s are usual: the consumption during the gap is interpolated"};
}

/// A rate that no machine has, or one that is higher outside the dig.
void warn_of_rate(const LoggedDig& dig, const Interval& interval, const Interval& log, double whole,
                  DigEfficiency& result) {
  const bool is_fuel = result.spent == Spent::fuel;
  const double most = is_fuel ? 28.0 : 2000.0;  // [mL/s], 100 L/h; [kW]; ours: of a 100-t machine
  constexpr double much_less = 0.8;             // ours
  const double rate = result.cost / result.duration;
  const std::string unit = is_fuel ? " mL/s" : " kW";
  if (rate > most) {
    result.warnings.push_back({is_fuel ? "implausible_fuel" : "implausible_energy",
                               dig.file + ": " + readable(rate) + unit + " on average is above " +
                                   readable(most) +
                                   ", more than a 100-t excavator takes: check the unit"});
  }
  const double rest = (log.to - log.from) - result.duration;
  const double beside = (whole - result.cost) / rest;
  if (rest >= result.duration && rate < much_less * beside) {
    result.warnings.push_back(
        {"dig_below_rest", dig.file + ": " + readable(rate) + unit + " on average from " +
                               number_text(interval.from) + " to " + number_text(interval.to) +
                               " s, but " + readable(beside) + unit +
                               " in the rest of the log: that is no dig, unless the machine works "
                               "harder before or after; check its times"});
  }
}

void read_cost(const LoggedDig& dig, DigEfficiency& result) {
  const Table log = Table::read(dig.file);
  const Meter& meter = meter_of(log, dig.file);
  const std::vector<double>& time = log.column("time_s");
  require_increasing(time, dig.file);
  const Interval interval = interval_of(dig, time);
  result.spent = meter.spent;
  result.duration = interval.to - interval.from;
  const Interval all{time.front(), time.back()};
  double whole = 0.0;
  for (const std::string& name : meter.columns) {
    const auto spent = [&](const Interval& during) {
      return meter.scale * integral(time, log.column(name), during, meter.spent == Spent::energy);
    };
    result.cost += spent(interval);
    whole += spent(all);
  }
  if (!(result.cost > 0.0)) {
    throw Error(ErrorKind::bad_file, dig.file + ": " + meter.columns.front() + " adds up to " +
                                         number_text(result.cost) +
                                         (result.spent == Spent::fuel ? " mL" : " kJ") + " from " +
                                         number_text(interval.from) + " to " +
                                         number_text(interval.to) + " s, must be above 0");
  }
  if (auto gap = gap_in(time, interval, dig.file)) result.warnings.push_back(std::move(*gap));
  warn_of_rate(dig, interval, all, whole, result);
}

// ---- What was lifted --------------------------------------------------------------------------

Payload stated(const LoggedDig& dig, const Payload& payload) {
  const std::string name = dig.prefix + (payload.kind == Lifted::mass ? "mass" : "volume");
  const auto check = [](bool holds, const std::string& what, double value, const char* rule) {
    if (holds) return;
    throw Error(ErrorKind::bad_input, what + ": " + number_text(value) + ", must be " + rule);
  };
  const auto [value, sd] = payload.amount;
  check(value > 0.0 && std::isfinite(value), name, value, "above 0");
  check(!(sd < 0.0) && !std::isinf(sd), name + "-sd", sd, "0 or more");
  return payload;
}

/// Volume of the heap between two scans of the dump area.
Payload heap_between(const ScanPair& scans, const LoggedDig& dig, DigEfficiency& result) {
  const OutlinedPair seen = outlined(scans, dig.threads);
  const std::string names = seen.names() + ": ";
  const double cell = dig.cell_size.value_or(seen.cell_size());
  const std::vector<Warning> doubts = check_outlines(seen);
  const SurfacePair surfaces =
      with_doubts(doubts, [&] { return survey_pair(seen, cell, false, dig.threads).surfaces; });
  const HeightMapPair dump{surfaces.before.height, surfaces.after.height};
  const HeightMapPair no_dig{dump.before, dump.before};
  const auto add = [&](const std::vector<Warning>& warnings) {
    for (const Warning& warning : warnings) {
      if (warning.code == "no_hole_found") continue;
      result.warnings.push_back({warning.code, names + warning.message, warning.ends_trust});
    }
  };
  try {
    const VolumeChange change = measure_change(no_dig, dump);
    if (!(change.dumped.value > 0.0)) {
      throw Error(ErrorKind::bad_file, "no ground rose by more than the noise of the scans");
    }
    add(doubts);
    add(check_points({nullptr, &surfaces}, change));
    add(check_volumes(change, scans.after.unit));
    add(change.warnings);
    return {Lifted::volume, change.dumped};
  } catch (const TooFewCells& few) {
    throw few.of_scans(seen.names());
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, names + error.what());
  }
}

// ---- Efficiency -------------------------------------------------------------------------------

/// More than the work of lifting it by 0.34 m, and a hundredth of what digs in the simulator reach,
/// 5 .. 15 kg/kJ; ours.
std::optional<Warning> implausible_work(const DigEfficiency& dig, double most) {
  constexpr double span = 6000.0;  // from the least to the most
  const double efficiency = dig.value().value;
  if (efficiency <= most && efficiency >= most / span) return std::nullopt;
  return Warning{"implausible_energy", dig.file + ": " + readable(efficiency) + " " + dig.symbol() +
                                           " is outside " + readable(most / span) + " .. " +
                                           readable(most) +
                                           ": check the units of power, time and payload"};
}

/// More than a 12-t excavator could lift while it idles: 0.45 m^3 (of 1500 kg/m^3) in 8 s at 2 L/h.
/// Digging takes 6 .. 10 L/h, which makes 0.02 .. 0.034 m^3/mL. Ours.
std::optional<Warning> implausible(const DigEfficiency& dig) {
  const bool is_volume = dig.payload.kind == Lifted::volume;
  const double efficiency = dig.value().value;
  if (dig.spent == Spent::energy) return implausible_work(dig, is_volume ? 0.2 : 300.0);
  const double most = is_volume ? 0.1 : 150.0;
  const double least = is_volume ? 0.0003 : 0.45;
  if (efficiency < least) {
    return Warning{"implausible_fuel",
                   dig.file + ": " + readable(efficiency) + " " + dig.symbol() + " is below " +
                       readable(least) +
                       ", a hundredth of what excavators reach: check the units of time and fuel, "
                       "and the dig's times"};
  }
  if (!(efficiency > most)) return std::nullopt;
  return Warning{"implausible_fuel",
                 dig.file + ": " + readable(efficiency) + " " + dig.symbol() + " is above " +
                     readable(most) +
                     ", which a 12-t excavator would reach idling: check the unit of the fuel "
                     "flow. The gain of one run over another of the same meter still holds"};
}

bool casts_doubt(const Warning& warning) {
  const auto codes = {"implausible_fuel", "implausible_energy", "gap_in_log", "dig_below_rest"};
  return warning.ends_trust || std::find(codes.begin(), codes.end(), warning.code) != codes.end();
}

}  // namespace

Measured DigEfficiency::value() const {
  return {payload.amount.value / cost, payload.amount.sd / cost};
}

std::string DigEfficiency::unit() const {
  return std::string(payload.kind == Lifted::volume ? "m3" : "kg") + "_per_" +
         (spent == Spent::fuel ? "ml" : "kj");
}

std::string DigEfficiency::symbol() const {
  return std::string(payload.kind == Lifted::volume ? "m3" : "kg") + "/" +
         (spent == Spent::fuel ? "mL" : "kJ");
}

DigEfficiency measure_efficiency(const LoggedDig& dig) {
  DigEfficiency result;
  result.file = dig.file;
  read_cost(dig, result);
  const auto* scans = std::get_if<ScanPair>(&dig.lifted);
  result.payload =
      scans ? heap_between(*scans, dig, result) : stated(dig, std::get<Payload>(dig.lifted));
  if (auto warning = implausible(result)) result.warnings.push_back(std::move(*warning));
  result.warnings = causes_of(std::move(result.warnings));
  result.trustworthy = std::none_of(result.warnings.begin(), result.warnings.end(), casts_doubt);
  return result;
}

Measured efficiency_gain(const DigEfficiency& first, const DigEfficiency& second) {
  if (first.unit() != second.unit()) {
    throw Error(ErrorKind::bad_input, "the runs cannot be compared: " + first.file + " is in " +
                                          first.symbol() + ", " + second.file + " in " +
                                          second.symbol());
  }
  const Measured a = first.value();
  const Measured b = second.value();
  for (const Measured& value : {a, b}) {
    require(value.value > 0.0 && std::isfinite(value.value), "payload per cost of a run",
            value.value, "above 0 and finite");
  }
  const double ratio = b.value / a.value;
  return {100.0 * (ratio - 1.0), 100.0 * ratio * std::hypot(a.sd / a.value, b.sd / b.value)};
}

}  // namespace excavplan
