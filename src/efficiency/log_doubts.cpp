// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "efficiency/log_doubts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/statistics.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

/// How the rate of a log is shown.
struct ShownRate {
  WarningCode code;
  const char* unit;
  double scale;  ///< from mL/s or W
  double most;   ///< on average [mL/s], 100 L/h, or [W]; ours: of a 100-t machine
};

ShownRate shown(Spent spent) {
  if (spent == Spent::fuel) return {WarningCode::implausible_fuel, " mL/s", 1.0, 28.0};
  return {WarningCode::implausible_energy, " kW", 1e-3, 2e6};
}

std::string rate_text(double rate, Spent spent) {
  return readable(shown(spent).scale * rate) + shown(spent).unit;
}

/// Mean rate of a share [mL/s] or [W].
double mean_rate(const RunShare& share, Spent spent) {
  return share.cost / (spent == Spent::fuel ? 1.0 : 0.001) / share.duration;
}

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
  const double usual = median(steps);
  if (!(longest > most_usual_steps * usual)) return std::nullopt;
  return Warning{WarningCode::gap_in_log,
                 log.file + ": no row for " + readable(longest) + " s, where " + readable(usual) +
                     " s are usual: the consumption during the gap is interpolated"};
}

std::optional<Warning> too_high_a_mean(const DigLog& log, double rate) {
  const ShownRate limits = shown(log.spent);
  if (!(rate > limits.most)) return std::nullopt;
  return Warning{limits.code,
                 log.file + ": " + rate_text(rate, log.spent) + " on average is above " +
                     rate_text(limits.most, log.spent) +
                     ", more than a 100-t excavator takes: check the unit",
                 true};
}

/// The first reading that no meter of a machine gives. Noise about 0 and short peaks are none.
std::optional<Warning> bad_reading(const DigLog& log, double mean) {
  constexpr double peak = 10.0;   // over the highest mean; ours
  constexpr double noise = 0.05;  // of the mean, below 0; ours
  const double most = peak * shown(log.spent).most;
  const double least = log.spent == Spent::fuel ? -noise * mean : -most;
  const LogRows rows = rows_around(log.time, log.whole);
  for (const std::vector<double>& part : log.rates) {
    for (std::size_t i = rows.first; i < rows.last; ++i) {
      if (part[i] >= least && part[i] <= most) continue;
      const bool is_flow_back = log.spent == Spent::fuel && part[i] < 0.0;
      return Warning{
          shown(log.spent).code,
          log.file + ": " + rate_text(part[i], log.spent) + " at " + number_text(log.time[i]) +
              " s, " +
              (is_flow_back ? "where a fuel flow is 0 or more" : "which no excavator takes") +
              ": the meter failed there, or the column is another",
          true};
    }
  }
  return std::nullopt;
}

std::optional<Warning> less_than_beside(const DigLog& log, const RunShare& dig, double rate) {
  constexpr double much_less = 0.8;  // ours
  const LogInterval all{log.time.front(), log.time.back()};
  const double rest = (all.to - all.from) - dig.duration;
  if (log.phases != PhaseSource::none || rest < dig.duration) return std::nullopt;
  const double beside = (log.integral(all) - rate * dig.duration) / rest;
  if (!(rate < much_less * beside)) return std::nullopt;
  return Warning{WarningCode::dig_below_rest,
                 log.file + ": " + rate_text(rate, log.spent) + " on average from " +
                     number_text(log.digs.front().from) + " to " + number_text(log.digs.back().to) +
                     " s, but " + rate_text(beside, log.spent) +
                     " in the rest of the log: that is no dig, unless the machine works harder "
                     "before or after; check its times"};
}

/// Time in an interval in which the machine rests, for 2 s or longer at a time [s].
double time_at_rest(const DigLog& log, const LogInterval& during, double idle) {
  constexpr double shortest = 2.0;    // [s]; as of idle_of()
  constexpr double steadiness = 0.1;  // likewise
  const std::vector<double> rate = log.rate();
  const LogRows rows = rows_around(log.time, during);
  double sum = 0.0;
  double rest = 0.0;
  const auto add_rest = [&] {
    if (rest >= shortest) sum += rest;
    rest = 0.0;
  };
  const auto is_idle = [&](std::size_t i) { return std::abs(rate[i] - idle) <= steadiness * idle; };
  for (std::size_t i = rows.first + 1; i < rows.last; ++i) {
    if (!is_idle(i - 1) || !is_idle(i)) {
      add_rest();
      continue;
    }
    rest += std::min(log.time[i], during.to) - std::max(log.time[i - 1], during.from);
  }
  add_rest();
  return sum;
}

/// Of a log without phases all of which is the dig.
std::optional<Warning> rest_in_dig(const LoggedDig& dig, const DigEfficiency& result) {
  const DigLog& log = result.log;
  if (log.phases != PhaseSource::none || dig.counted == Counted::cycle || dig.subtracts_idle ||
      !result.idle) {
    return std::nullopt;
  }
  const double rest = time_at_rest(log, log.whole, result.idle->rate);
  if (!(rest > 0.0)) return std::nullopt;
  return Warning{WarningCode::idle_in_dig,
                 log.file + ": the machine idles for " + readable(rest) + " of the " +
                     readable(result.dig.duration) +
                     " s that count as the dig, as the log has no phases: state when the dig "
                     "begins and ends, or what counts"};
}

std::optional<Warning> idle_above(const DigEfficiency& result) {
  const auto is_above = [](const RunShare& share) { return *share.above_idle <= 0.0; };
  if (!result.idle) return std::nullopt;
  if (!is_above(result.dig) && !(result.cycle && is_above(*result.cycle))) return std::nullopt;
  const RunShare& share = is_above(result.dig) ? result.dig : *result.cycle;
  return Warning{WarningCode::idle_above_dig,
                 result.file + ": idling takes " + rate_text(result.idle->rate, result.spent) +
                     ", more than the " + rate_text(mean_rate(share, result.spent), result.spent) +
                     " on average of the " + (&share == &result.dig ? "dig" : "cycle") +
                     ": check the rate at rest and its unit"};
}

}  // namespace

std::vector<Warning> doubts_of(const LoggedDig& dig, const DigEfficiency& result) {
  const DigLog& log = result.log;
  const double rate = mean_rate(result.dig, log.spent);
  std::vector<Warning> warnings;
  for (auto& doubt :
       {gap_in(log), too_high_a_mean(log, rate), bad_reading(log, rate),
        less_than_beside(log, result.dig, rate), idle_above(result), rest_in_dig(dig, result)}) {
    if (doubt) warnings.push_back(*doubt);
  }
  return warnings;
}

}  // namespace excavplan
