// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <excavplan/survey/efficiency.hpp>

#include "base/json.hpp"
#include "shared/efficiency_results.hpp"
#include "shared/logged_dig.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const About about = {
    "measure-efficiency",
    "measures the soil that a real dig lifts per fuel or energy, and the gain of a second dig. A "
    "log is a table as spreadsheets and loggers write it, with a time and one of: fuel flow "
    "(fuel_flow_ml_per_s, 'fuel flow [L/h]' and so on); power; power of each joint; torque and "
    "rate "
    "of each joint; pressures and piston speed of each cylinder. Negative joint power counts as 0.",
    {{"measure-efficiency fixed.csv planned.csv --volume 0.42 --second-volume 0.41",
      "fuel logs of two digs and the soil volume in the bucket after each"},
     {"measure-efficiency day.csv --from 61.5 --to 70 --mass 780kg", "one dig of a longer log"},
     {"measure-efficiency dig.csv --dump-before heap0.pcd --dump-after heap1.pcd",
      "the volume from scans of the dump area"}},
    true};

struct Inputs {
  RunInputs first;
  RunInputs second;
  LogInputs logs;
  bool own_meters = false;
  ScanFrames frames;
  std::optional<double> cell_size;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("RUN.csv", inputs.first.log, "log of a dig");
  arguments.require("RUN.csv");
  arguments.positional("SECOND.csv", inputs.second.log, "log of a second dig to compare");
  inputs.first.declare(arguments, "", "");
  inputs.second.declare(arguments, "second-", ", second dig");
  inputs.logs.declare(arguments);
  arguments.flag("own-meters", inputs.own_meters,
                 "each run had its own meter, whose errors are part of that of the gain");
  const auto has_scans = [&inputs] {
    return inputs.first.has_scans() || inputs.second.has_scans();
  };
  arguments.only_if({has_scans, "there are no scans"}, [&] {
    arguments.option(
        "area", inputs.frames.area,
        "ignore points of the clouds outside this area (default: where both have points)");
    declare_frames(arguments, inputs.frames);
    declare_units(arguments, inputs.frames);
    arguments.option("cell", inputs.cell_size, Quantity::length,
                     "cell size of the height maps (default: from the point density, at least "
                     "0.05)");
  });
}

/// Of one area alone, what the library says of dig and dump area.
const OptionNames heap_options = {
    {"; --dig-area and --dump-area take it in, if it belongs to them", ""},
    {"--dig-area and --dump-area", "--area"},
    {"BEFORE and AFTER", "--dump-before and --dump-after"},
    cell_option.back()};

DigEfficiency measure(const RunInputs& inputs, const Inputs& all, Outcome& outcome) {
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
        {each.code, with_option_names(each.message, heap_options), each.ends_trust});
  }
  outcome.trustworthy = outcome.trustworthy && run.trustworthy;
  return run;
}

Outcome work(const Inputs& inputs) {
  if (inputs.second.any() && !inputs.second.log) {
    usage_error("SECOND.csv is missing, but options of a second dig are given");
  }
  Outcome outcome;
  outcome.json["runs"] = nlohmann::ordered_json::array();
  const DigEfficiency first = measure(inputs.first, inputs, outcome);
  Measured better{unknown, unknown};
  if (inputs.second.log) {
    better = efficiency_gain(first, measure(inputs.second, inputs, outcome), inputs.own_meters);
    outcome.lines.push_back("gain of the second: " + readable(better.value, better.sd) + " %");
  }
  const auto [low, high] = gain_interval(better);
  if (std::isfinite(low)) {
    outcome.lines.back() += ", 95 % interval " + readable(low) + " .. " + readable(high) + " %";
  }
  outcome.json["gain_percent"] = better.value;
  outcome.json["gain_sd_percent"] = better.sd;
  outcome.json["gain_interval_percent"] = {low, high};
  outcome.json["trustworthy"] = outcome.trustworthy;
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
