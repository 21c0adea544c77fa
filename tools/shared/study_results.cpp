// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/study_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <vector>

#include "base/files.hpp"
#include "base/text.hpp"
#include "shared/study_figure.hpp"

namespace excavplan::tools {
namespace {

using nlohmann::ordered_json;

ordered_json mean_json(const StudyMean& mean) {
  if (std::isnan(mean.mean)) return nullptr;
  return {{"mean", mean.mean}, {"interval_95", {mean.interval[0], mean.interval[1]}}};
}

ordered_json condition_json(const StudyResult& result) {
  return {{"factor", result.condition.factor},
          {"level", result.condition.level},
          {"runs", result.runs.size()},
          {"failed", result.failed},
          {"compared", result.compared},
          {"held_down", result.held_down},
          {"not_trustworthy", result.untrusted},
          {"density_rms_points", result.rms},
          {"density_bias_points", result.bias},
          {"density_inside_95", result.inside},
          {"gain_percent", mean_json(result.energy_gain)},
          {"gain_path_percent", mean_json(result.path_gain)},
          {"payload_ratio", mean_json(result.energy_payload)},
          {"gain_equal_payload_percent", mean_json(result.equal_gain)},
          {"equal_payload_ratio", mean_json(result.equal_payload)},
          {"gain_cycle_percent", mean_json(result.cycle_gain)},
          {"cycle_payload_ratio", mean_json(result.cycle_payload)}};
}

/// A cell of CSV: text in quotes, nothing for what is not known.
std::string cell(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}
std::string cell(double value) { return std::isnan(value) ? "" : number_text(value); }

/// Of a run, between density and failure; what is not known is not a number.
std::vector<double> values_of(const StudyRun& run) {
  std::vector<double> values = {run.estimate_percent,
                                run.estimate_sd,
                                run.interval[0],
                                run.interval[1],
                                run.trustworthy ? 1.0 : 0.0,
                                run.held_down ? 1.0 : 0.0,
                                run.energy_gain,
                                run.path_gain,
                                run.energy_payload,
                                run.equal_gain,
                                run.equal_payload,
                                run.cycle_gain,
                                run.cycle_payload};
  constexpr std::ptrdiff_t estimated = 5;
  const double nothing = std::nan("");
  if (!run.compared) std::fill(values.begin() + estimated, values.end(), nothing);
  if (!run.failure.empty()) std::fill(values.begin(), values.end(), nothing);
  return values;
}

std::string runs_csv(const std::vector<StudyResult>& results) {
  std::string csv =
      "factor,level,density_percent,estimate_percent,estimate_sd_percent,interval_low_percent,"
      "interval_high_percent,trustworthy,held_down,gain_percent,gain_path_percent,payload_ratio,"
      "gain_equal_payload_percent,equal_payload_ratio,gain_cycle_percent,cycle_payload_ratio,"
      "failure\n";
  for (const StudyResult& result : results) {
    for (const StudyRun& run : result.runs) {
      csv += cell(result.condition.factor) + "," + cell(result.condition.level) + "," +
             cell(run.density_percent);
      for (const double value : values_of(run)) csv += "," + cell(value);
      csv += "," + (run.failure.empty() ? "" : cell(run.failure)) + "\n";
    }
  }
  return csv;
}

std::string text_of(const StudyMean& mean) {
  if (std::isnan(mean.mean)) return "-";
  return decimals(mean.mean, 1) + " (" + decimals(mean.interval[0], 1) + " .. " +
         decimals(mean.interval[1], 1) + ")";
}

std::string number_of(double value) { return std::isnan(value) ? "-" : decimals(value, 1); }

std::string ratio_of(const StudyMean& mean) {
  return std::isnan(mean.mean) ? "-" : decimals(mean.mean, 2);
}

std::string table(const std::vector<StudyResult>& results) {
  std::string text =
      "| factor | level | runs | failed | held down | not trusted | rms d | bias d | in 95 % "
      "| gain % | payload | gain at equal payload % | payload | gain per cycle % | payload |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const StudyResult& result : results) {
    text += "| " + result.condition.factor + " | " + result.condition.level + " | " +
            std::to_string(result.runs.size()) + " | " + std::to_string(result.failed) + " | " +
            std::to_string(result.held_down) + " | " + std::to_string(result.untrusted) + " | " +
            number_of(result.rms) + " | " + number_of(result.bias) + " | " +
            (std::isnan(result.inside) ? "-" : decimals(100.0 * result.inside, 0) + " %") + " | " +
            text_of(result.energy_gain) + " | " + ratio_of(result.energy_payload) + " | " +
            text_of(result.equal_gain) + " | " + ratio_of(result.equal_payload) + " | " +
            text_of(result.cycle_gain) + " | " + ratio_of(result.cycle_payload) + " |\n";
  }
  return text;
}

std::string line_of(const StudyResult& result) {
  return result.condition.factor + ", " + result.condition.level + ": density within " +
         number_of(result.rms) + " points rms; gain " + text_of(result.energy_gain) +
         " %, at equal payload " + text_of(result.equal_gain) + " %, per cycle " +
         text_of(result.cycle_gain) + " %";
}

}  // namespace

void declare_study(Arguments& arguments, StudyInputs& inputs) {
  arguments.place("study", inputs.folder,
                  "run the experiment under many conditions, one factor at a time, 30 runs each, "
                  "and write study.json, runs.csv, study.md and study.svg into this folder");
  arguments.only_if({[&inputs] { return inputs.folder.has_value(); }, "there is no --study"}, [&] {
    arguments.option("study-runs", inputs.runs, Quantity::ratio,
                     "factor on the number of runs of each condition");
  });
}

Outcome study(const Machine& machine, const StudyInputs& inputs, const Plots& plots,
              std::uint64_t seed, std::uint64_t threads, Console& console) {
  make_folder(*inputs.folder);
  for (const char* name : {"/study.json", "/runs.csv", "/study.md", "/study.svg"}) {
    require_writable(*inputs.folder + name);
  }
  StudyOptions options;
  options.seed = seed;
  options.threads = static_cast<unsigned>(threads);
  options.runs = inputs.runs;
  std::mutex one_line;
  options.progress = [&](double done, const std::string& condition) {
    const std::lock_guard<std::mutex> lock(one_line);
    console.progress(done, condition);
    return true;
  };
  const auto results = run_study(machine, default_study(machine), options);
  Outcome outcome;
  outcome.json["seed"] = seed;
  outcome.json["study"] = ordered_json::array();
  for (const StudyResult& result : results) {
    outcome.json["study"].push_back(condition_json(result));
    outcome.lines.push_back(line_of(result));
  }
  write_file(*inputs.folder + "/study.json", outcome.json.dump(2) + "\n");
  write_file(*inputs.folder + "/runs.csv", runs_csv(results));
  write_file(*inputs.folder + "/study.md", table(results));
  const Figure figure = study_figure(results);
  write_file(*inputs.folder + "/study.svg", to_svg(lay_out(figure)));
  for (const Plots::File& plot : plots.files) write_plot(plots, plot.file, figure, outcome.lines);
  return outcome;
}

}  // namespace excavplan::tools
