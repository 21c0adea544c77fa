// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "measure_efficiency/efficiency_runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "measure_efficiency/efficiency_lines.hpp"
#include "measure_efficiency/run_sets.hpp"

namespace excavplan::tools {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Of one area alone, what the library says of dig and dump area.
const OptionNames heap_options = {
    {"; --dig-area and --dump-area take it in, if it belongs to them", ""},
    {"--dig-area and --dump-area", "--area"},
    {"BEFORE and AFTER", "--dump-before and --dump-after"},
    cell_option().back()};

DigEfficiency measure(const RunInputs& inputs, const EfficiencyInputs& all, Outcome& outcome) {
  LoggedDig dig = inputs.dig(all.frames, all.logs);
  dig.cell_size = all.cell_size;
  OptionNames names = heap_options;
  names.insert(names.end(), log_options.begin(), log_options.end());
  DigEfficiency run = naming_options(names, [&] {
    return with_frame_hint(pair_frame_hint, [&] { return measure_efficiency(dig); });
  });
  outcome.json["runs"].push_back(run_json(run));
  for (std::string& line : run_lines(run)) outcome.lines.push_back(std::move(line));
  for (const Warning& each : run.warnings) {
    outcome.warnings.emplace_back(each.code, with_option_names(each.message, names),
                                  each.ends_trust);
  }
  outcome.trustworthy = outcome.trustworthy && run.trustworthy;
  return run;
}

std::vector<DigEfficiency> measure_set(const std::string& table_or_folder,
                                       const EfficiencyInputs& all, Outcome& outcome) {
  std::vector<DigEfficiency> measured;
  for (const SetRun& run : runs_of(table_or_folder, all.first)) {
    try {
      measured.push_back(measure(run.inputs, all, outcome));
    } catch (const Error& error) {
      const std::string message = with_option_names(error.what(), run.columns);
      const bool is_of_table = message != error.what();
      throw Error(is_of_table ? ErrorKind::bad_file : error.kind(), run.place + message);
    }
  }
  return measured;
}

/// Efficiencies in one unit.
std::vector<double> values_of(const std::vector<DigEfficiency>& runs, const std::string& symbol) {
  std::vector<double> values;
  for (const DigEfficiency& run : runs) {
    if (run.symbol() != symbol) {
      usage_error("the runs cannot be compared: " + run.file + " is in " + run.symbol() +
                  ", others in " + symbol);
    }
    values.push_back(run.value().value);
  }
  return values;
}

bool is_same_recording(const DigLog& a, const DigLog& b) {
  const bool overlap = a.whole.from < b.whole.to && b.whole.from < a.whole.to;
  return overlap && a.time == b.time && a.rates == b.rates;
}

/// By content, as a copy of a file has another name.
void warn_of_repeated(const ComparedSets& sets, Outcome& outcome) {
  std::vector<const DigEfficiency*> seen;
  for (const std::vector<DigEfficiency>* set : {&sets.against, &sets.runs}) {
    for (const DigEfficiency& run : *set) {
      const auto same = std::find_if(seen.begin(), seen.end(), [&](const DigEfficiency* other) {
        return is_same_recording(run.log, other->log);
      });
      if (same == seen.end()) {
        seen.push_back(&run);
        continue;
      }
      outcome.trustworthy = false;
      outcome.warnings.emplace_back(WarningCode::repeated_run,
                                    run.file + ": the same recording as that of " + (*same)->file +
                                        ": it counts as two runs, and the test takes them for "
                                        "independent ones");
    }
  }
}

}  // namespace

ComparedSets compare_sets(const EfficiencyInputs& inputs, Outcome& outcome) {
  if (!inputs.runs || !inputs.against) usage_error("--runs and --against go together");
  if (inputs.first.log || inputs.second.any()) {
    usage_error("--runs and --against exclude RUN.csv, SECOND.csv and options of a second dig");
  }
  ComparedSets sets;
  sets.against = measure_set(*inputs.against, inputs, outcome);
  sets.runs = measure_set(*inputs.runs, inputs, outcome);
  const std::string symbol = sets.against.front().symbol();
  const OptionNames names = {{"the first set", "the set of --against"},
                             {"the second set", "the set of --runs"}};
  sets.comparison = naming_options(names, [&] {
    return compare_runs(values_of(sets.against, symbol), values_of(sets.runs, symbol));
  });
  warn_of_repeated(sets, outcome);
  const SetComparison& found = sets.comparison;
  outcome.json["sets"] = comparison_json(found);
  outcome.json["gain_percent"] = found.gain_percent;
  outcome.json["gain_sd_percent"] = unknown;
  outcome.json["gain_interval_percent"] = {found.gain_low_percent, found.gain_high_percent};
  outcome.lines = set_lines(found, symbol);
  return sets;
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
