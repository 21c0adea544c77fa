// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "run_experiment/study.hpp"

#include <cmath>
#include <mutex>
#include <vector>

#include "base/files.hpp"
#include "base/text.hpp"
#include "figures/study_figure.hpp"
#include "results/study_results.hpp"

namespace excavplan::tools {
namespace {

using nlohmann::ordered_json;

/// What a study writes into its folder.
struct StudyFiles {
  explicit StudyFiles(const std::string& folder)
      : results(folder + "/study.json"),
        runs(folder + "/runs.csv"),
        tables(folder + "/study.md"),
        figure(folder + "/study.svg") {}
  std::vector<std::string> all() const { return {results, runs, tables, figure}; }

  std::string results, runs, tables, figure;
};

std::string text_of(const StudyMean& mean) {
  if (mean.values == 0) return "-";
  return decimals(mean.mean, 1) + interval_text(mean);
}

std::string number_of(double value, int digits = 1) {
  return std::isnan(value) ? "-" : decimals(value, digits);
}

std::string joined_cells(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& each : cells) row += " " + each + " |";
  return row + "\n";
}

std::string heading_of(const std::vector<std::string>& columns) {
  return joined_cells(columns) + joined_cells(std::vector<std::string>(columns.size(), "---"));
}

std::string density_table(const std::vector<StudyResult>& results) {
  std::string text = heading_of({"factor", "level", "runs", "no estimate", "not trusted",
                                 "rms [points]", "bias [points]", "in 95 %"});
  for (const StudyResult& result : results) {
    text += joined_cells(
        {result.condition.factor, result.condition.level, std::to_string(result.runs.size()),
         std::to_string(result.failed), std::to_string(result.untrusted), number_of(result.rms),
         number_of(result.bias),
         std::isnan(result.inside) ? "-" : decimals(100.0 * result.inside, 0) + " %"});
  }
  return text;
}

/// With the paths' part for the paper's goal; the difference to the reference is of equal runs.
std::string gain_table(const std::vector<StudyResult>& results) {
  std::string text = heading_of(
      {"factor", "level", "held down", "no plan", "n", "densities [%]", "gain [%]",
       "of the path [%]", "payload", "over the reference [points]", "gain at no less payload [%]",
       "payload", "gain per cycle [%]", "payload", "over the reference [points]"});
  for (const StudyResult& result : results) {
    const int n = result.energy.gain.values;
    text += joined_cells(
        {result.condition.factor, result.condition.level, std::to_string(result.held_down),
         std::to_string(result.unplanned), std::to_string(n),
         n == 0 ? "-"
                : decimals(result.densities[0], 0) + " .. " + decimals(result.densities[1], 0),
         text_of(result.energy.gain), number_of(result.energy.of_path.mean),
         number_of(result.energy.payload.mean, 2), text_of(result.energy.over_first),
         text_of(result.equal.gain), number_of(result.equal.payload.mean, 2),
         text_of(result.cycle.gain), number_of(result.cycle.payload.mean, 2),
         text_of(result.cycle.over_first)});
  }
  return text;
}

std::string tables(const std::vector<StudyResult>& results) {
  return "Density\n\n" + density_table(results) + "\nGains\n\n" + gain_table(results);
}

std::string line_of(const StudyResult& result) {
  return result.condition.factor + ", " + result.condition.level + ": density within " +
         number_of(result.rms) + " points rms; gain " + text_of(result.energy.gain) +
         " %, at no less payload " + text_of(result.equal.gain) + " %, per cycle " +
         text_of(result.cycle.gain) + " % (" + std::to_string(result.energy.gain.values) + " runs)";
}

}  // namespace

std::string interval_text(const StudyMean& mean) {
  if (mean.values < 2) return "";
  return " (" + decimals(mean.interval[0], 1) + " .. " + decimals(mean.interval[1], 1) + ")";
}

void declare_study(Arguments& arguments, StudyInputs& inputs) {
  arguments.folder("study", inputs.folder,
                   "run the experiment under many conditions, one factor at a time, 30 runs each, "
                   "and write study.json, runs.csv, study.md and study.svg into this folder",
                   [](const std::string& folder) { return StudyFiles(folder).all(); });
  arguments.only_if({[&inputs] { return inputs.folder.has_value(); }, "there is no --study"}, [&] {
    arguments.option("study-runs", inputs.runs, Quantity::ratio,
                     "factor on the number of runs of each condition");
  });
}

Outcome study(const Machine& machine, const StudyInputs& inputs, const Plots& plots,
              StudyOptions options, Console& console) {
  if (!(inputs.runs > 0.0 && inputs.runs <= most_study_runs)) {
    usage_error("--study-runs: " + number_text(inputs.runs) + " must be above 0 and at most " +
                number_text(most_study_runs));
  }
  const StudyFiles files(*inputs.folder);
  make_folder(*inputs.folder);
  for (const std::string& file : files.all()) require_writable(file);
  options.runs = inputs.runs;
  std::mutex one_line;
  options.progress = [&](double done, const std::string& condition) {
    const std::lock_guard<std::mutex> lock(one_line);
    console.progress(done, condition);
    return true;
  };
  const auto results = run_study(machine, default_study(machine), options);
  Outcome outcome;
  outcome.json["seed"] = options.seed;
  outcome.json["study"] = ordered_json::array();
  for (const StudyResult& result : results) {
    outcome.json["study"].push_back(condition_json(result));
    outcome.lines.push_back(line_of(result));
  }
  write_file(files.results, outcome.json.dump(2) + "\n");
  write_file(files.runs, runs_csv(results));
  write_file(files.tables, tables(results));
  const Figure figure = study_figure(results);
  write_file(files.figure, to_svg(lay_out(figure)));
  for (const Plots::File& plot : plots.files) {
    write_plot(plots, plot.file, figure, outcome.lines, outcome.warnings);
  }
  return outcome;
}

}  // namespace excavplan::tools
