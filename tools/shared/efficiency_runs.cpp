// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/efficiency_runs.hpp"

#include <cmath>
#include <limits>

#include "base/json.hpp"
#include "shared/efficiency_results.hpp"
#include "shared/run_sets.hpp"

namespace excavplan::tools {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Of one area alone, what the library says of dig and dump area.
const OptionNames heap_options = {
    {"; --dig-area and --dump-area take it in, if it belongs to them", ""},
    {"--dig-area and --dump-area", "--area"},
    {"BEFORE and AFTER", "--dump-before and --dump-after"},
    cell_option.back()};

DigEfficiency measure(const RunInputs& inputs, const EfficiencyInputs& all, Outcome& outcome) {
  LoggedDig dig = inputs.dig(all.frames, all.logs);
  dig.cell_size = all.cell_size;
  OptionNames names = heap_options;
  names.insert(names.end(), log_options.begin(), log_options.end());
  DigEfficiency run = naming_options(names, [&] {
    return with_frame_hint(pair_frame_hint, [&] { return measure_efficiency(dig); });
  });
  outcome.json["runs"].push_back(to_json(run));
  for (std::string& line : run_lines(run)) outcome.lines.push_back(std::move(line));
  for (const Warning& each : run.warnings) {
    outcome.warnings.push_back(
        {each.code, with_option_names(each.message, names), each.ends_trust});
  }
  outcome.trustworthy = outcome.trustworthy && run.trustworthy;
  return run;
}

/// Efficiencies of the runs of a set.
std::vector<double> measure_set(const std::string& table_or_folder, const EfficiencyInputs& all,
                                std::string& symbol, Outcome& outcome) {
  std::vector<double> values;
  for (const SetRun& run : runs_of(table_or_folder, all.first)) {
    try {
      const DigEfficiency found = measure(run.inputs, all, outcome);
      if (symbol.empty()) symbol = found.symbol();
      if (symbol != found.symbol()) {
        usage_error("the runs cannot be compared: " + found.file + " is in " + found.symbol() +
                    ", others in " + symbol);
      }
      values.push_back(found.value().value);
    } catch (const Error& error) {
      throw Error(error.kind(), run.place + error.what());
    }
  }
  return values;
}

}  // namespace

void compare_sets(const EfficiencyInputs& inputs, Outcome& outcome) {
  if (!inputs.runs || !inputs.against) usage_error("--runs and --against go together");
  if (inputs.first.log || inputs.second.any()) {
    usage_error("--runs and --against exclude RUN.csv, SECOND.csv and options of a second dig");
  }
  std::string symbol;
  const std::vector<double> first = measure_set(*inputs.against, inputs, symbol, outcome);
  const std::vector<double> second = measure_set(*inputs.runs, inputs, symbol, outcome);
  const OptionNames names = {{"the first set", "the set of --against"},
                             {"the second set", "the set of --runs"}};
  const SetComparison sets = naming_options(names, [&] { return compare_runs(first, second); });
  outcome.json["sets"] = to_json(sets);
  outcome.json["gain_percent"] = sets.gain_percent;
  outcome.json["gain_sd_percent"] = unknown;
  outcome.json["gain_interval_percent"] = {sets.gain_low_percent, sets.gain_high_percent};
  outcome.lines = set_lines(sets, symbol);
}

std::vector<DigEfficiency> compare_two(const EfficiencyInputs& inputs, Outcome& outcome) {
  if (!inputs.first.log) {
    usage_error("RUN.csv is missing: log of a dig; or a set of runs by --runs and --against");
  }
  if (inputs.second.any() && !inputs.second.log) {
    usage_error("SECOND.csv is missing, but options of a second dig are given");
  }
  std::vector<DigEfficiency> runs = {measure(inputs.first, inputs, outcome)};
  Measured better{unknown, unknown};
  if (inputs.second.log) {
    runs.push_back(measure(inputs.second, inputs, outcome));
    better = efficiency_gain(runs[0], runs[1], inputs.own_meters);
    outcome.lines.push_back("gain of the second: " + readable(better.value, better.sd) + " %");
  }
  const auto [low, high] = gain_interval(better);
  if (std::isfinite(low)) {
    outcome.lines.back() += ", 95 % interval " + readable(low) + " .. " + readable(high) + " %";
  }
  outcome.json["gain_percent"] = better.value;
  outcome.json["gain_sd_percent"] = better.sd;
  outcome.json["gain_interval_percent"] = {low, high};
  return runs;
}

}  // namespace excavplan::tools
