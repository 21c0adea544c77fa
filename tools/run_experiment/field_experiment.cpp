// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "run_experiment/field_experiment.hpp"

#include <cmath>
#include <mutex>

#include <excavplan/base/data_files.hpp>
#include <excavplan/experiments/field_experiment.hpp>

#include "base/text.hpp"
#include "inputs/goal_inputs.hpp"
#include "inputs/law_warnings.hpp"
#include "inputs/named_kinds.hpp"
#include "planning/planned_digs.hpp"
#include "results/field_results.hpp"
#include "run_experiment/study.hpp"

namespace excavplan::tools {
namespace {

using nlohmann::ordered_json;

/// Mean of a number over the runs with a result.
template <typename Number>
double mean_of(const FieldResult& result, const Number& number) {
  double sum = 0.0;
  for (const FieldRun& run : result.runs) sum += run.failure.empty() ? number(run) : 0.0;
  return sum / static_cast<double>(result.runs.size() - static_cast<std::size_t>(result.failed));
}

std::string digs_line(const std::string& name, const FieldResult& result,
                      FuelledDig FieldRun::*which) {
  const auto mean = [&](const auto& number) {
    return mean_of(result, [&](const FieldRun& run) { return number(run.*which); });
  };
  return name + decimals(mean([](const FuelledDig& dig) { return dig.dig.payload_volume; }), 3) +
         " m3, " + decimals(mean([](const FuelledDig& dig) { return dig.dig.energy / 1e3; }), 1) +
         " kJ and " + decimals(mean([](const FuelledDig& dig) { return dig.fuel(); }), 2) +
         " mL in " + decimals(mean([](const FuelledDig& dig) { return dig.dig.duration; }), 1) +
         " s, " + decimals(mean([](const FuelledDig& dig) { return dig.efficiency(); }), 4) +
         " m3/mL";
}

/// Empty where no run tells any.
std::string gain_text(const StudyMean& gain, const StudyMean& energy_gain) {
  if (std::isnan(gain.mean)) return "";
  return ", gain " + decimals(gain.mean, 1) + " %" + interval_text(gain) + ", by the goal " +
         decimals(energy_gain.mean, 1) + " %";
}

std::vector<std::string> result_lines(const std::string& name, const FieldResult& result) {
  std::vector<std::string> lines = {
      condition_text({name, result.density_percent}) + ", k " +
      decimals(mean_of(result, [](const FieldRun& run) { return run.bulking_factor; }), 3) +
      ", density by the law " +
      decimals(mean_of(result, [](const FieldRun& run) { return run.density_raw; }), 1) +
      " %, trusted " + std::to_string(result.trusted) + " of " +
      std::to_string(result.runs.size())};
  lines.push_back(digs_line("  fixed    ", result, &FieldRun::fixed));
  lines.push_back(digs_line("  planned  ", result, &FieldRun::planned) +
                  gain_text(result.gain, result.energy_gain));
  lines.push_back(digs_line("  no less payload  ", result, &FieldRun::equal) +
                  gain_text(result.equal_gain, result.equal_energy_gain));
  return lines;
}

/// Those of the paper's section 4: no medium soil.
std::vector<ExperimentCondition> field_conditions(const ExperimentInputs& inputs) {
  auto conditions = conditions_of(inputs);
  if (inputs.densities == ExperimentInputs().densities) conditions.erase(conditions.begin() + 1);
  return conditions;
}

void add(const std::string& name, const FieldResult& result, Outcome& outcome) {
  outcome.json["soils"].push_back(field_json(name, result));
  for (const FieldRun& run : result.runs) {
    if (run.failure.empty()) continue;
    outcome.warnings.emplace_back(WarningCode::condition_failed, name + ": " + run.failure);
    break;
  }
  const auto digs = static_cast<int>(result.runs.size());
  if (result.failed == digs) return;
  for (std::string& line : result_lines(name, result)) outcome.lines.push_back(std::move(line));
  if (result.held_down > 0) {
    outcome.warnings.emplace_back(
        WarningCode::machine_held_down,
        name + ": in " + std::to_string(result.held_down) + " of " + std::to_string(digs) +
            " digs the fixed path would lift or drag the machine, which is "
            "held down on it; they tell no gain");
  }
  if (result.trusted + result.failed == digs) return;
  outcome.warnings.emplace_back(WarningCode::density_not_trustworthy,
                                name + ": " + std::to_string(result.trusted) + " of " +
                                    std::to_string(digs) +
                                    " estimates are trustworthy; the paper digs no second time "
                                    "where they are not");
}

FieldOptions field_options(const Machine& machine, const SoilKind& soil, const FieldInputs& field,
                           const ExperimentInputs& inputs, Console& console) {
  FieldOptions options;
  const DigParameters path = inputs.path.value_or(options.experiment.fixed_path);
  options.experiment = options_of(inputs, machine, soil, console);
  options.experiment.fixed_path = path;
  options.fuel = load_fuel_model(shipped_or_file("engines", field.fuel));
  options.digs = field.digs;
  options.seed = inputs.seed;
  options.threads = static_cast<unsigned>(inputs.threads);
  return options;
}

}  // namespace

void declare_field(Arguments& arguments, FieldInputs& inputs) {
  arguments.choice("preset", inputs.preset, {"simulation", "field"},
                   "simulation: section 3 of the paper; field: section 4, with the field's fixed "
                   "path, soft and hard soil (10, 80 %), scans of depth cameras, fuel");
  arguments.only_if({[&inputs] { return inputs.chosen(); }, "--preset field has them"}, [&] {
    arguments.option("digs", inputs.digs, "digs along each path in each soil");
    arguments.text("fuel-model", "NAME|FILE", inputs.fuel, "engine: zx120, or a fuel model file");
  });
}

Outcome field_experiment(const Machine& machine, const FieldInputs& field,
                         const ExperimentInputs& inputs, Console& console) {
  const SoilKind soil = soil_named(inputs.soil);
  const DensityLaw law = law_of(inputs, machine, soil);
  const std::vector<ExperimentCondition> conditions = field_conditions(inputs);
  std::vector<double> densities;
  densities.reserve(conditions.size());
  for (const ExperimentCondition& condition : conditions) densities.push_back(condition.density);
  FieldOptions options = field_options(machine, soil, field, inputs, console);
  std::mutex one_line;
  options.progress = [&](double done) {
    const std::lock_guard<std::mutex> lock(one_line);
    console.progress(done, "field experiment");
    return !console.stop_requested();
  };
  const auto results = naming_options({{"field experiment: digs", "--digs"}}, [&] {
    return run_field_experiment(machine, soil, law, densities, options);
  });
  Outcome outcome;
  outcome.warnings = unlike_law(law, machine.name, soil.name);
  for (Warning& each : goal_warnings(inputs.goal, {machine})) {
    outcome.warnings.push_back(std::move(each));
  }
  outcome.json = {{"preset", field.preset}, {"soils", ordered_json::array()}};
  int failed = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    add(conditions[i].name, results[i], outcome);
    failed += results[i].failed;
  }
  if (!results.empty() && failed == static_cast<int>(results.size()) * options.digs) {
    throw Error(ErrorKind::bad_input, results.front().runs.front().failure);
  }
  const FieldFigures paper;
  outcome.json["paper"] = {{"fixed_m3_per_ml", paper.fixed},
                           {"planned_m3_per_ml", paper.planned},
                           {"gain_percent", paper.gain_percent}};
  outcome.json.update(
      {{"law", law.name}, {"fuel_model", options.fuel.name}, {"seed", inputs.seed}});
  outcome.json.update(goal_json(options.experiment.plan.search.objective));
  outcome.lines.push_back("the paper, soft soil: " + decimals(paper.fixed, 3) + " and " +
                          decimals(paper.planned, 3) + " m3/mL, gain " +
                          decimals(paper.gain_percent, 1) +
                          " %; its unit is doubted (docs/efficiency.md)");
  return outcome;
}

}  // namespace excavplan::tools
