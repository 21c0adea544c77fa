// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <excavplan/calibration/calibration.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/table.hpp"
#include "calibrate_density/calibration_plots.hpp"
#include "calibrate_density/difference_lines.hpp"
#include "frame/tool.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/plots.hpp"
#include "inputs/simulator_inputs.hpp"
#include "inputs/site.hpp"
#include "results/calibration_results.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "calibrate-density",
    "fits the density law, which gives the relative density for a bulking factor: from simulated "
    "digs at known densities or from measured samples.",
    {{"calibrate-density --out loam.json", "simulated digs at 0, 5 .. 100 %"},
     {"calibrate-density --samples digs.csv --out site.json",
      "fit measured digs; columns bulking_factor,density_percent"},
     {"estimate-density before.pcd after.pcd --law site.json", "use the law"}}};

struct Inputs {
  std::optional<std::string> samples;
  std::string soil = "loam";
  std::string machine = "zx120";
  SimulatorInputs simulator;
  std::string densities = "0:5:100";
  std::optional<DigParameters> path;
  int draws = CalibrationOptions{}.draws;
  std::optional<double> cell_size;
  std::optional<std::string> out;
  Plots plots;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.file("samples", inputs.samples,
                 "measured samples, CSV with the columns bulking_factor,density_percent");
  arguments.only_if(
      {[&inputs] { return !inputs.samples; },
       "a law of --samples is of the digs measured and states no soil and path"},
      [&] {
        arguments.soil(inputs.soil);
        arguments.machine(inputs.machine);
        declare_simulator(arguments, inputs.simulator);
        arguments.text("densities", "FIRST:STEP:LAST", inputs.densities,
                       "relative densities of the simulated digs [%], or a list a,b,c");
        arguments.option(
            "path", inputs.path,
            "dig path that the law is for (default: the paper's, in proportion to the bucket, with "
            "the scatter of digs along others)");
        arguments.option("draws", inputs.draws,
                         "digs in drawn soils, for the scatter of the law; 0: none");
        declare_cell(arguments, inputs.cell_size);
      });
  arguments.output("out", inputs.out, "law file to write, for estimate-density --law");
  declare_plots(arguments, inputs.plots, names_of(calibration_figures()));
}

DensityCalibration from_samples(const std::string& file) {
  const Table table = Table::read(file);
  const auto& factors = table.column("bulking_factor");
  const auto& densities = table.column("density_percent");
  std::vector<BulkingSample> samples;
  for (std::size_t i = 0; i < table.rows(); ++i) samples.push_back({factors[i], densities[i]});
  try {
    return calibrate_density(samples);
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, file + ": " + error.what());
  }
}

DensityCalibration from_simulator(const Inputs& inputs, Console& console) {
  CalibrationOptions options;
  options.densities_percent = parse_densities("--densities", inputs.densities);
  options.cell_size = inputs.cell_size;
  options.path = inputs.path;
  options.draws = inputs.draws;
  options.simulator = simulator_of(inputs.simulator, console);
  OptionNames names = cell_option();
  names.push_back({"the number of draws", "--draws"});
  return naming_options(names, [&] {
    return calibrate_density(machine_named(inputs.machine), soil_named(inputs.soil), options);
  });
}

/// The formula of a form with its numbers, which the law file holds under the form's key.
std::string text(const DensityFit& fit, const nlohmann::ordered_json& file) {
  std::string text = formula(fit.form);
  for (const auto& [key, value] : file.at(fit.key).items()) {
    text += ", " + key + " " + readable(value.get<double>(), 5);
  }
  return text;
}

Outcome work(const Inputs& inputs, Console& console) {
  const DensityCalibration calibration =
      inputs.samples ? from_samples(*inputs.samples) : from_simulator(inputs, console);
  if (inputs.out) write_file(*inputs.out, to_json(calibration));
  Outcome outcome;
  outcome.json = calibration_json(calibration);
  for (const DensityFit& fit : calibration.forms) {
    std::string name = fit.key + std::string(25, ' ');
    std::replace(name.begin(), name.end(), '_', ' ');
    outcome.lines.push_back(name.substr(0, 25) + text(fit, outcome.json));
  }
  if (const auto difference = bulking_difference(calibration)) {
    for (std::string& line : difference_lines(*difference)) {
      outcome.lines.push_back(std::move(line));
    }
    outcome.lines.push_back("Scans measure what height maps measure: the law for scans is " +
                            calibration.use + ".");
  }
  write_plots(inputs.plots, calibration_figures(), calibration, outcome.lines, outcome.warnings);
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
