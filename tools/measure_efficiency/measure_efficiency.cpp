// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/tool.hpp"
#include "measure_efficiency/efficiency_plots.hpp"
#include "measure_efficiency/efficiency_runs.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "measure-efficiency",
    "measures the soil that a real dig lifts per fuel or energy, and the gain of a second dig. A "
    "log is a table as spreadsheets and loggers write it, with a time and one of: fuel flow "
    "(fuel_flow_ml_per_s, 'fuel flow [L/h]' and so on); power; power of each joint; torque and "
    "rate of each joint; pressures and piston speed of each cylinder. Negative joint power counts "
    "as 0.",
    {{"measure-efficiency fixed.csv planned.csv --volume 0.42 --second-volume 0.41",
      "fuel logs of two digs and the soil volume in the bucket after each"},
     {"measure-efficiency day.csv --from 61.5 --to 70 --mass 780kg", "one dig of a longer log"},
     {"measure-efficiency dig.csv --dump-before heap0.pcd --dump-after heap1.pcd",
      "the volume from scans of the dump area"},
     {"measure-efficiency --runs plan.csv --against operator.csv",
      "two sets of runs, with a test"}},
    true};

struct Inputs : EfficiencyInputs {
  Plots plots;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("RUN.csv", inputs.first.log, "log of a dig");
  arguments.positional("SECOND.csv", inputs.second.log, "log of a second dig to compare");
  inputs.first.declare(arguments, "", "");
  inputs.second.declare(arguments, "second-", ", second dig");
  arguments.text(
      "runs", "TABLE|FOLDER", inputs.runs,
      "instead of RUN.csv a set of runs: a table with a column file, or a folder of logs");
  arguments.text("against", "TABLE|FOLDER", inputs.against, "set of runs to compare it with");
  inputs.logs.declare(arguments);
  arguments.flag("own-meters", inputs.own_meters,
                 "each run had its own meter, whose errors are part of that of the gain");
  std::vector<FigureName> figures =
      names_of(run_figures({[&inputs] { return !inputs.runs && !inputs.against; },
                            "it is of RUN.csv and SECOND.csv, not of --runs"}));
  for (const FigureName& figure :
       names_of(set_figures({[&inputs] { return inputs.runs && inputs.against; },
                             "it is of --runs and --against"}))) {
    figures.push_back(figure);
  }
  declare_plots(arguments, inputs.plots, figures);
  const auto has_scans = [&inputs] {
    return inputs.first.has_scans() || inputs.second.has_scans() || inputs.runs;
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

Outcome work(const Inputs& inputs) {
  Outcome outcome;
  outcome.json["runs"] = nlohmann::ordered_json::array();
  if (inputs.runs || inputs.against) {
    const ComparedSets sets = compare_sets(inputs, outcome);
    write_plots(inputs.plots, set_figures({}), sets, outcome.lines, outcome.warnings);
  } else {
    const std::vector<DigEfficiency> runs = compare_two(inputs, outcome);
    write_plots(inputs.plots, run_figures({}), {runs, inputs.own_meters}, outcome.lines,
                outcome.warnings);
  }
  outcome.json["trustworthy"] = outcome.trustworthy;
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
