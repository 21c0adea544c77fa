// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/survey/efficiency.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.hpp"
#include "base/text.hpp"
#include "survey/bucket_content.hpp"
#include "survey/scan_checks.hpp"

namespace excavplan {
namespace {

// ---- What was spent ---------------------------------------------------------------------------

/// Longest interval between two rows of what counts, if it is an outlier.
std::optional<Warning> gap_in(const DigLog& log) {
  constexpr double most_usual_steps = 10.0;  // ours
  const std::vector<double>& time = log.time;
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (time[i] > log.whole.from && time[i - 1] < log.whole.to) {
      steps.push_back(time[i] - time[i - 1]);
    }
  }
  const double longest = *std::max_element(steps.begin(), steps.end());
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  if (!(longest > most_usual_steps * *middle)) return std::nullopt;
  return Warning{"gap_in_log", log.file + ": no row for " + readable(longest) + " s, where " +
                                   readable(*middle) +
                                   " s are usual: the consumption during the gap is interpolated"};
}

/// A rate that no machine has, or one that is higher outside the dig.
void warn_of_rate(const DigLog& log, double scale, DigEfficiency& result) {
  const bool is_fuel = result.spent == Spent::fuel;
  const double most = is_fuel ? 28.0 : 2000.0;  // [mL/s], 100 L/h; [kW]; ours: of a 100-t machine
  constexpr double much_less = 0.8;             // ours
  const RunShare& dig = result.dig;
  const double rate = dig.cost / dig.duration;
  const std::string unit = is_fuel ? " mL/s" : " kW";
  if (rate > most) {
    result.warnings.push_back({is_fuel ? "implausible_fuel" : "implausible_energy",
                               log.file + ": " + readable(rate) + unit + " on average is above " +
                                   readable(most) +
                                   ", more than a 100-t excavator takes: check the unit"});
  }
  const LogInterval all{log.time.front(), log.time.back()};
  const double rest = (all.to - all.from) - dig.duration;
  const double beside = (scale * log.integral(all) - dig.cost) / rest;
  if (log.phases == PhaseSource::none && rest >= dig.duration && rate < much_less * beside) {
    result.warnings.push_back(
        {"dig_below_rest", log.file + ": " + readable(rate) + unit + " on average from " +
                               number_text(log.digs.front().from) + " to " +
                               number_text(log.digs.back().to) + " s, but " + readable(beside) +
                               unit +
                               " in the rest of the log: that is no dig, unless the machine works "
                               "harder before or after; check its times"});
  }
}

RunShare share_of(const DigLog& log, const std::vector<LogInterval>& parts, double scale,
                  const std::optional<IdleRate>& idle) {
  RunShare share;
  double above = 0.0;
  for (const LogInterval& part : parts) {
    share.cost += scale * log.integral(part);
    if (idle) above += scale * log.integral(part, idle->rate);
    share.duration += part.to - part.from;
  }
  if (idle) share.above_idle = above;
  return share;
}

std::optional<IdleRate> idle_rate(const LoggedDig& dig, const DigLog& log) {
  if (dig.idle) {
    require(*dig.idle >= 0.0 && std::isfinite(*dig.idle), dig.prefix + "idle", *dig.idle,
            "0 or more");
    return IdleRate{*dig.idle, false};
  }
  const auto found = idle_of(log);
  if (found) return IdleRate{*found, true};
  if (!dig.subtracts_idle) return std::nullopt;
  throw Error(ErrorKind::bad_input,
              dig.file + ": idling cannot be subtracted: the log shows none for 2 s, and " +
                  dig.prefix + "idle is not given");
}

void require_cost(const LoggedDig& dig, const DigLog& log, double cost) {
  if (cost > 0.0) return;
  throw Error(ErrorKind::bad_file,
              dig.file + ": " + name(log.meter) + (dig.subtracts_idle ? " above idling" : "") +
                  " adds up to " + number_text(cost) + (log.spent == Spent::fuel ? " mL" : " kJ") +
                  " from " + number_text(log.digs.front().from) + " to " +
                  number_text(log.digs.back().to) + " s, must be above 0");
}

void read_cost(const LoggedDig& dig, DigEfficiency& result) {
  result.log = read_dig_log(dig);
  const DigLog& log = result.log;
  const double scale = log.spent == Spent::fuel ? 1.0 : 0.001;
  result.spent = log.spent;
  result.meter = log.meter;
  result.phases = log.phases;
  result.digs = log.digs.size();
  result.idle = idle_rate(dig, log);
  result.dig = share_of(log, log.digs, scale, result.idle);
  const RunShare all = share_of(log, {log.cycle}, scale, result.idle);
  if (log.phases != PhaseSource::none) result.cycle = all;
  const RunShare& counted = dig.counted == Counted::cycle ? all : result.dig;
  result.cost = dig.subtracts_idle ? *counted.above_idle : counted.cost;
  result.duration = counted.duration;
  require_cost(dig, log, result.cost);
  require_in(dig.prefix + "meter-sd", dig.meter_sd, 0.0, 1.0);
  result.cost_sd = dig.meter_sd * result.cost;
  if (auto gap = gap_in(log)) result.warnings.push_back(std::move(*gap));
  warn_of_rate(log, scale, result);
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

Measured DigEfficiency::per(double other_cost) const {
  const double value = payload.amount.value / other_cost;
  return {value, value * std::hypot(payload.amount.sd / payload.amount.value, cost_sd / cost)};
}

Measured DigEfficiency::value() const { return per(cost); }

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
  LiftedSoil lifted = lifted_soil(dig);
  result.payload = lifted.payload;
  result.bank_volume = lifted.bank_volume;
  result.warnings.insert(result.warnings.end(), lifted.warnings.begin(), lifted.warnings.end());
  if (auto warning = implausible(result)) result.warnings.push_back(std::move(*warning));
  result.warnings = causes_of(std::move(result.warnings));
  result.trustworthy = std::none_of(result.warnings.begin(), result.warnings.end(), casts_doubt);
  return result;
}

Measured efficiency_gain(const DigEfficiency& first, const DigEfficiency& second, bool own_meters) {
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
  const auto relative = [own_meters](const DigEfficiency& run) {
    const Measured& payload = run.payload.amount;
    return std::hypot(payload.sd / payload.value, own_meters ? run.cost_sd / run.cost : 0.0);
  };
  const double ratio = b.value / a.value;
  return {100.0 * (ratio - 1.0), 100.0 * ratio * std::hypot(relative(first), relative(second))};
}

}  // namespace excavplan
