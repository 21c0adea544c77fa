// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/efficiency/efficiency.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.hpp"
#include "base/text.hpp"
#include "efficiency/bucket_content.hpp"
#include "efficiency/log_doubts.hpp"
#include "scans/scan_checks.hpp"

namespace excavplan {
namespace {

// ---- What was spent ---------------------------------------------------------------------------

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

std::optional<IdleRate> stated_idle(const LoggedDig& dig, Spent spent) {
  if (!dig.idle) return std::nullopt;
  require(*dig.idle >= 0.0 && std::isfinite(*dig.idle), "idle", *dig.idle, "0 or more");
  if (dig.idle_kind.value_or(spent) == spent) return IdleRate{*dig.idle, false};
  const bool is_fuel = spent == Spent::fuel;
  throw Error(ErrorKind::bad_input, std::string("the rate at rest is ") +
                                        (is_fuel ? "a power" : "a fuel flow") + ", but " +
                                        dig.file + " records " + (is_fuel ? "fuel" : "power"));
}

std::optional<IdleRate> idle_rate(const LoggedDig& dig, const DigLog& log) {
  if (dig.idle) return stated_idle(dig, log.spent);
  const auto found = idle_of(log);
  if (found) return IdleRate{*found, true};
  if (!dig.subtracts_idle) return std::nullopt;
  throw Error(ErrorKind::bad_input,
              dig.file +
                  ": idling cannot be subtracted: the log shows none for 2 s: state the "
                  "rate at rest");
}

void require_cost(const LoggedDig& dig, const DigLog& log, double cost) {
  if (cost > 0.0 && std::isfinite(cost)) return;
  throw Error(ErrorKind::bad_file,
              dig.file + ": " + name(log.meter) + (dig.subtracts_idle ? " above idling" : "") +
                  " adds up to " + number_text(cost) + (log.spent == Spent::fuel ? " mL" : " kJ") +
                  " from " + number_text(log.digs.front().from) + " to " +
                  number_text(log.digs.back().to) + " s, must be " +
                  (std::isfinite(cost) ? "above 0" : "finite"));
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
  require_in("meter-sd", dig.meter_sd, 0.0, 1.0);
  result.cost_sd = dig.meter_sd * result.cost;
  result.warnings = doubts_of(dig, result);
}

// ---- Efficiency -------------------------------------------------------------------------------

/// More than the work of lifting it by 0.34 m, and a hundredth of what digs in the simulator reach,
/// 5 .. 15 kg/kJ; ours.
std::optional<Warning> implausible_work(const DigEfficiency& dig, double most) {
  constexpr double span = 6000.0;  // from the least to the most
  const double efficiency = dig.value().value;
  if (efficiency <= most && efficiency >= most / span) return std::nullopt;
  return Warning{WarningCode::implausible_energy,
                 dig.file + ": " + readable(efficiency) + " " + dig.symbol() + " is outside " +
                     readable(most / span) + " .. " + readable(most) +
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
    return Warning{WarningCode::implausible_fuel,
                   dig.file + ": " + readable(efficiency) + " " + dig.symbol() + " is below " +
                       readable(least) +
                       ", a hundredth of what excavators reach: check the units of time and fuel, "
                       "and the dig's times"};
  }
  if (!(efficiency > most)) return std::nullopt;
  return Warning{WarningCode::implausible_fuel,
                 dig.file + ": " + readable(efficiency) + " " + dig.symbol() + " is above " +
                     readable(most) +
                     ", which a 12-t excavator would reach idling: check the unit of the fuel "
                     "flow. The gain of one run over another of the same meter still holds"};
}

}  // namespace

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
  result.trustworthy = !any_ends_trust(result.warnings);
  return result;
}

}  // namespace excavplan
