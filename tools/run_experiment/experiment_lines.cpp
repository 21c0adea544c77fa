// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "run_experiment/experiment_lines.hpp"

#include "base/text.hpp"
#include "results/dig_lines.hpp"
#include "run_experiment/experiment_inputs.hpp"

namespace excavplan::tools {
namespace {

/// What a gain by the goal may cost.
std::string losses_text(const ExperimentResult& result) {
  const PlannedDig &fixed = result.fixed, &planned = result.planned;
  const auto change = [](double from, double to) {
    const double percent = 100.0 * (to / from - 1.0);
    return " (" + std::string(percent < 0.0 ? "" : "+") + readable(percent, 2) + " %)";
  };
  std::string text = "; payload " + readable(fixed.payload_mass) + " to " +
                     readable(planned.payload_mass) + " kg" +
                     change(fixed.payload_mass, planned.payload_mass);
  if (!(fixed.cycle_energy > 0.0 && planned.cycle_energy > 0.0)) return text;
  const double before = 1e3 * fixed.payload_mass / fixed.cycle_energy;
  const double after = 1e3 * planned.payload_mass / planned.cycle_energy;
  return text + ", over the whole cycle " + readable(before) + " to " + readable(after) + " kg/kJ" +
         change(before, after);
}

std::string experiment_line(const std::string& condition, const ExperimentResult& result) {
  return condition_text({condition, result.density_percent}) + ", k " +
         readable(result.volumes.bulking_factor, 4) + ", estimated " +
         readable(result.estimate.percent) + " %; fixed " +
         worth_text(result.objective, result.objective.worth(result.fixed)) + ", planned " +
         worth_text(result.objective, result.objective.worth(result.planned)) + " (" +
         path_text(result.planned) + "), gain " + readable(result.gain_percent()) + " % (path " +
         readable(result.path_gain_percent()) + " %, start " +
         readable(result.start_gain_percent()) + " %)" + losses_text(result);
}

}  // namespace

std::string regression_line(const DensityRegression& regression) {
  const auto text = [](const DensityLine& line) {
    return "d = " + decimals(line.a, 2) + " k - " + decimals(-line.b, 2) + ", R2 " +
           decimals(line.r2, 4);
  };
  return "regression of " + std::to_string(regression.samples.size()) +
         " digs along the fixed path: " + text(regression.line) +
         "; without the soil that fell back: " + text(regression.line_without_fallback) +
         "; the paper's: " + text(regression.paper_line) +
         " (void ratios of loam were derived from it)";
}

void add(const NamedExperiment& done, Outcome& outcome) {
  const auto& [condition, result] = done;
  outcome.json["conditions"].push_back(experiment_json(done));
  outcome.lines.push_back(experiment_line(condition, result));
  if (result.held_because.empty()) return;
  const std::string why = ": the machine is held down, as on the fixed path ";
  outcome.warnings.emplace_back(WarningCode::machine_held_down,
                                condition + why + result.held_because);
}

void add_failure(const FailedExperiment& failed, const std::string& why, Outcome& outcome) {
  outcome.json["conditions"].push_back(
      {{"name", failed.condition}, {"density_percent", failed.density_percent}, {"failure", why}});
  outcome.lines.push_back(failed.condition + ": " + why);
  outcome.warnings.emplace_back(WarningCode::condition_failed, failed.condition + ": " + why);
}

}  // namespace excavplan::tools
