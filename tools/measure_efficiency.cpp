// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <excavplan/survey/efficiency.hpp>

#include "base/json.hpp"
#include "shared/logged_dig.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const About about = {
    "measure-efficiency",
    "measures the soil that a real dig lifts per fuel or energy, and the gain of a second dig. A "
    "log is a CSV file with the column time_s and one of: fuel_flow_ml_per_s; fuel_flow_l_per_h; "
    "power_w; boom_power_w, arm_power_w and bucket_power_w (negative joint power counts as 0).",
    {{"measure-efficiency fixed.csv planned.csv --volume 0.42 --second-volume 0.41",
      "fuel logs of two digs and the soil volume in the bucket after each"},
     {"measure-efficiency day.csv --from 61.5 --to 70 --mass 780kg", "one dig of a longer log"},
     {"measure-efficiency dig.csv --dump-before heap0.pcd --dump-after heap1.pcd",
      "the volume from scans of the dump area"}},
    true};

struct Inputs {
  RunInputs first;
  RunInputs second;
  ScanFrames frames;
  std::optional<double> cell_size;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("RUN.csv", inputs.first.log, "log of a dig");
  arguments.require("RUN.csv");
  arguments.positional("SECOND.csv", inputs.second.log, "log of a second dig to compare");
  inputs.first.declare(arguments, "", "");
  inputs.second.declare(arguments, "second-", ", second dig");
  const auto has_scans = [&inputs] {
    return inputs.first.dump_before.has_value() || inputs.second.dump_before.has_value();
  };
  arguments.only_if({has_scans, "there are no scans of a dump area"}, [&] {
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

/// Of the dump area alone, what the library says of dig and dump area.
const OptionNames heap_options = {
    {"; --dig-area and --dump-area take it in, if it belongs to them", ""},
    {"--dig-area and --dump-area", "--area"},
    {"BEFORE and AFTER", "--dump-before and --dump-after"},
    cell_option.back()};

nlohmann::ordered_json to_json(const DigEfficiency& run) {
  nlohmann::ordered_json json = {{"file", run.file}, {"duration_s", run.duration}};
  for (const char* key :
       {"volume_m3", "volume_sd_m3", "mass_kg", "mass_sd_kg", "fuel_ml", "energy_kj", "efficiency",
        "efficiency_sd", "efficiency_unit", "efficiency_m3_per_ml", "efficiency_m3_per_kj",
        "efficiency_kg_per_ml", "efficiency_kg_per_kj"}) {
    json[key] = nullptr;
  }
  const bool is_volume = run.payload.kind == Lifted::volume;
  json[is_volume ? "volume_m3" : "mass_kg"] = run.payload.amount.value;
  json[is_volume ? "volume_sd_m3" : "mass_sd_kg"] = run.payload.amount.sd;
  json[run.spent == Spent::fuel ? "fuel_ml" : "energy_kj"] = run.cost;
  json["efficiency"] = run.value().value;
  json["efficiency_sd"] = run.value().sd;
  json["efficiency_unit"] = run.unit();
  json["efficiency_" + run.unit()] = run.value().value;
  return json;
}

std::string line(const DigEfficiency& run) {
  const Measured& payload = run.payload.amount;
  return run.file + ": " + readable(payload.value, payload.sd) +
         (run.payload.kind == Lifted::volume ? " m3, " : " kg, ") + readable(run.cost) +
         (run.spent == Spent::fuel ? " mL in " : " kJ in ") + readable(run.duration) +
         " s: " + readable(run.value().value, run.value().sd) + " " + run.symbol();
}

DigEfficiency measure(const RunInputs& inputs, const Inputs& all, Outcome& outcome) {
  LoggedDig dig = inputs.dig(all.frames);
  dig.cell_size = all.cell_size;
  DigEfficiency run = naming_options(heap_options, [&] {
    return with_frame_hint(pair_frame_hint, [&] { return measure_efficiency(dig); });
  });
  outcome.json["runs"].push_back(to_json(run));
  outcome.lines.push_back(line(run));
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
    better = efficiency_gain(first, measure(inputs.second, inputs, outcome));
    outcome.lines.push_back("gain of the second: " + readable(better.value, better.sd) + " %");
  }
  outcome.json["gain_percent"] = better.value;
  outcome.json["gain_sd_percent"] = better.sd;
  outcome.json["trustworthy"] = outcome.trustworthy;
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
