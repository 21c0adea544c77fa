// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/experiment_results.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/text.hpp"
#include "run_experiment/experiment_inputs.hpp"
#include "inputs/goal_inputs.hpp"
#include "results/results.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

/// What digs of an experiment are dug in once more.
struct Rehearsal {
  const Machine& machine;
  const SoilSimulator& simulator;
  const Terrain& ground;
};

/// Adds a dig of the experiment and the ground that it leaves.
void add_dig(const std::string& name, const Rehearsal& in, const DigPath& path,
             ReportScene& scene) {
  DigOptions options;
  options.history = true;
  const DigResult dig = checked_dig(in.simulator, in.machine, in.ground, path, options);
  std::vector<GroundState>& states = scene.areas.front().states;
  states.push_back({"after", dig.after(in.ground).surface()});
  scene.digs.push_back(played_dig(name, in.machine, path, dig));
  scene.digs.back().state = states.size() - 1;
}

/// Of Fig. 9: the tip, and what it sweeps below the ground at its start.
nlohmann::ordered_json tip_json(const DigPath& path) {
  constexpr double step = 0.01;  // of the integral [m]
  nlohmann::ordered_json tip = nlohmann::ordered_json::array();
  double lowest = path.ground_z, near = path.start_x, far = path.start_x;
  for (const DigPose& pose : path.poses) {
    if (pose.phase == DigPhase::lift) break;
    tip.push_back({pose.bucket.x, pose.bucket.z});
    lowest = std::min(lowest, pose.bucket.z);
    near = std::min(near, pose.bucket.x);
    far = std::max(far, pose.bucket.x);
  }
  double section = 0.0;
  for (double x = near + 0.5 * step; x < far; x += step) {
    const double z = swept_height(path, x);
    if (z < path.ground_z) section += step * (path.ground_z - z);
  }
  return {{"depth_m", path.ground_z - lowest}, {"section_m2", section}, {"tip_path_m", tip}};
}

nlohmann::ordered_json with_tip(const PlannedDig& dig, const DigPath& path) {
  nlohmann::ordered_json json = dig_json(dig);
  json.update(tip_json(path));
  return json;
}

nlohmann::ordered_json line_json(const DensityLine& line) {
  return {{"a_percent", line.a}, {"b_percent", line.b}, {"r2", line.r2}};
}

}  // namespace

nlohmann::ordered_json regression_json(const Machine& machine, const SoilKind& soil,
                                       const ExperimentOptions& options) {
  CalibrationOptions digs;
  digs.path = options.fixed_path;
  digs.simulator = options.plan.simulator;
  digs.draws = 0;
  const DensityCalibration calibration = calibrate_density(machine, soil, digs);
  nlohmann::ordered_json samples = nlohmann::ordered_json::array();
  for (const DensityCalibration::Sample& sample : calibration.samples) {
    samples.push_back({{"density_percent", sample.density_percent},
                       {"bulking_factor", sample.bulking_factor_measured}});
  }
  const auto line = [&](const std::string& ending) {
    return line_json(std::get<DensityLine>(calibration.form("line" + ending)));
  };
  const DensityLaw paper = load_density_law(shipped_or_file("laws", "paper"));
  return {{"samples", samples},
          {"line", line(as_measured)},
          {"line_without_fallback", line("")},
          {"paper_line", line_json(std::get<DensityLine>(paper.form))}};
}

std::string regression_line(const nlohmann::ordered_json& regression) {
  const auto text = [](const nlohmann::ordered_json& line) {
    return "d = " + decimals(line["a_percent"], 2) + " k - " +
           decimals(-line["b_percent"].get<double>(), 2) + ", R2 " + decimals(line["r2"], 4);
  };
  return "regression of " + std::to_string(regression["samples"].size()) +
         " digs along the fixed path: " + text(regression["line"]) +
         "; without the soil that fell back: " + text(regression["line_without_fallback"]) +
         "; the paper's: " + text(regression["paper_line"]) +
         " (void ratios of loam were derived from it)";
}

nlohmann::ordered_json experiment_json(const std::string& condition,
                                       const ExperimentResult& result) {
  const HeightMapVolumes& volumes = result.volumes;
  return {{"name", condition},
          {"density_percent", result.density_percent},
          {"volume",
           {{"excavated_m3", volumes.excavated},
            {"spilled_m3", volumes.spilled},
            {"dumped_m3", volumes.dumped}}},
          {"bulking_factor", volumes.bulking_factor},
          {"density_estimated_percent", result.estimate.percent},
          {"fixed", with_tip(result.fixed, result.fixed_path)},
          {"planned", with_tip(result.planned, result.planned_path)},
          {"gain_percent", result.gain_percent()},
          {"gain_path_percent", result.path_gain_percent()},
          {"gain_start_percent", result.start_gain_percent()},
          {"start_rule", describe(result.start_rule)},
          {"machine_held_down", !result.held_because.empty()}};
}

std::string experiment_line(const std::string& condition, const ExperimentResult& result) {
  return condition_text({condition, result.density_percent}) + ", k " +
         readable(result.volumes.bulking_factor, 4) + ", estimated " +
         readable(result.estimate.percent) + " %; fixed " +
         worth_text(result.objective, result.objective.worth(result.fixed)) + ", planned " +
         worth_text(result.objective, result.objective.worth(result.planned)) + " (" +
         path_text(result.planned) + "), gain " + readable(result.gain_percent()) + " % (path " +
         readable(result.path_gain_percent()) + " %, start " +
         readable(result.start_gain_percent()) + " %)";
}

void add(const NamedExperiment& done, Outcome& outcome) {
  const auto& [condition, result] = done;
  outcome.json["conditions"].push_back(experiment_json(condition, result));
  outcome.lines.push_back(experiment_line(condition, result));
  if (result.held_because.empty()) return;
  const std::string why = ": the machine is held down, as on the fixed path ";
  outcome.warnings.push_back({"machine_held_down", condition + why + result.held_because});
}

void add_failure(const std::string& condition, double density, const std::string& why,
                 Outcome& outcome) {
  outcome.json["conditions"].push_back(
      {{"name", condition}, {"density_percent", density}, {"failure", why}});
  outcome.lines.push_back(condition + ": " + why);
  outcome.warnings.push_back({"condition_failed", condition + ": " + why});
}

Report experiment_report(const Machine& machine, const SoilKind& soil, const PlanOptions& options,
                         const Experiments& experiments) {
  Report report;
  report.title = "Fixed path against planned path in " + soil.name;
  report.plot_always = true;
  report.scene.machine = machine;
  const Terrain ground =
      level_planning_ground(machine, options.cell_size.value_or(usual_cell(machine)));
  report.scene.areas = {{{{"before", ground.surface()}}}};
  for (const auto& [condition, result] : experiments.done) {
    Machine standing = machine;
    if (!result.held_because.empty()) standing.body.reset();
    const auto simulator =
        make_simulator(options.simulator, standing, soil, result.density_percent);
    const Rehearsal in = {standing, *simulator, ground};
    add_dig(condition + ", planned path", in, result.planned_path, report.scene);
    add_dig(condition + ", fixed path", in, result.fixed_path, report.scene);
  }
  for (std::size_t i = 0; i < experiments.done.size() && i < 6; ++i) {  // ours
    report.headline.push_back("conditions." + std::to_string(i) + ".gain_percent");
  }
  Figure plot = paths_figure(experiments);
  plot.rows.push_back(efficiency_figure(experiments).rows.front());
  report.plot = to_svg(lay_out(plot));
  report.note =
      "Ground and loads are those of the dig that is chosen, on level ground; the payload "
      "stays in the bucket.";
  return report;
}

}  // namespace excavplan
