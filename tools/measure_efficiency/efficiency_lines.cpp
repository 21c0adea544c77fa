// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "measure_efficiency/efficiency_lines.hpp"

#include "base/text.hpp"
#include "results/efficiency_results.hpp"

namespace excavplan::tools {
namespace {

std::string cost_unit(const DigEfficiency& run) { return run.spent == Spent::fuel ? "mL" : "kJ"; }

std::string share_line(const DigEfficiency& run, const char* name, const RunShare& share) {
  const auto count = static_cast<double>(run.digs);
  const auto spent = [&](double cost) {
    return readable(cost / count) + " " + cost_unit(run) + ", " +
           (cost > 0.0 ? readable(run.per(cost).value) : "unknown") + " " + run.symbol();
  };
  std::string line = std::string("  per ") + name + ": " + spent(share.cost) + " in " +
                     readable(share.duration / count) + " s";
  if (share.above_idle) line += "; above idling " + spent(*share.above_idle);
  return line;
}

}  // namespace

std::vector<std::string> run_lines(const DigEfficiency& run) {
  const Measured& payload = run.payload.amount;
  std::vector<std::string> lines = {
      run.file + ": " + readable(payload.value, payload.sd) +
      (run.payload.kind == Lifted::volume ? " m3, " : " kg, ") + readable(run.cost, run.cost_sd) +
      " " + cost_unit(run) + " in " + readable(run.duration) +
      " s: " + readable(run.value().value, run.value().sd) + " " + run.symbol()};
  if (run.idle || run.cycle) lines.push_back(share_line(run, "dig", run.dig));
  if (run.cycle) lines.push_back(share_line(run, "cycle", *run.cycle));
  if (run.idle) {
    const bool is_fuel = run.spent == Spent::fuel;
    const double litres_per_hour = 3.6 * run.idle->rate;
    lines.push_back(
        "  idling: " +
        (is_fuel ? readable(litres_per_hour) + " L/h" : readable(run.idle->rate / 1000.0) + " kW") +
        (run.idle->is_found ? ", the low plateau of the log" : ""));
  }
  if (run.bank_volume) {
    lines.push_back("  in the ground: " + readable(run.bank_volume->value, run.bank_volume->sd) +
                    " m3");
  }
  return lines;
}

std::vector<std::string> set_lines(const SetComparison& sets, const std::string& symbol) {
  const auto line = [&](const char* name, const RunSet& set) {
    return name + std::to_string(set.runs) + " runs, " + readable(set.mean) + " " + symbol +
           " on average, standard deviation " + readable(set.sd, 2);
  };
  std::vector<std::string> lines = {line("against: ", sets.first), line("runs:    ", sets.second),
                                    gain_text(sets)};
  constexpr double level = 0.05;  // of an interval of 95 %
  const bool interval_shows = sets.gain_low_percent > 0.0 || sets.gain_high_percent < 0.0;
  if (interval_shows != (sets.p_value() < level)) {
    lines.emplace_back(
        "the interval, which takes the scatter for normal, says otherwise than the permutation "
        "test, which does not and decides: more runs are needed");
  }
  return lines;
}

}  // namespace excavplan::tools
