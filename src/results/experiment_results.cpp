// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/experiment_results.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>

#include "base/json.hpp"
#include "planning/planned_digs.hpp"

namespace excavplan {
namespace {

/// Of Fig. 9: the tip, and what it sweeps below the ground at its start.
Json tip_json(const DigPath& path) {
  constexpr double step = 0.01;  // of the integral [m]
  Json tip = Json::array();
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

Json with_tip(const PlannedDig& dig, const DigPath& path) {
  Json json = dig_json(dig);
  json.update(tip_json(path));
  return json;
}

Json line_json(const DensityLine& line) {
  return {{"a_percent", line.a}, {"b_percent", line.b}, {"r2", line.r2}};
}

}  // namespace

DensityRegression density_regression(const Machine& machine, const SoilKind& soil,
                                     const ExperimentOptions& options) {
  CalibrationOptions digs;
  digs.path = options.fixed_path;
  digs.simulator = options.plan.simulator;
  digs.draws = 0;
  const DensityCalibration calibration = calibrate_density(machine, soil, digs);
  const auto line = [&](const std::string& ending) {
    return std::get<DensityLine>(calibration.form("line" + ending));
  };
  const DensityLaw paper = load_density_law(shipped_or_file("laws", "paper"));
  return {calibration.samples, line(as_measured), line(""), std::get<DensityLine>(paper.form)};
}

namespace {

/// By a measure; null where it is not known of both.
template <typename Measure>
Json gain_percent(const ExperimentResult& result, const Measure& measure) {
  const double gain = 100.0 * (measure(result.planned) / measure(result.fixed) - 1.0);
  return std::isfinite(gain) ? Json(gain) : Json(nullptr);
}

}  // namespace

Json experiment_json(const NamedExperiment& experiment) {
  const ExperimentResult& result = experiment.result;
  const HeightMapVolumes& volumes = result.volumes;
  return {{"name", experiment.condition},
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
          {"payload_gain_percent",
           gain_percent(result, [](const PlannedDig& dig) { return dig.payload_mass; })},
          {"cycle_gain_percent",
           gain_percent(result,
                        [](const PlannedDig& dig) { return dig.payload_mass / dig.cycle_energy; })},
          {"start_rule", describe(result.start_rule)},
          {"machine_held_down", !result.held_because.empty()}};
}

Json regression_json(const DensityRegression& regression) {
  auto samples = Json::array();
  for (const DensityCalibration::Sample& sample : regression.samples) {
    samples.push_back({{"density_percent", sample.density_percent},
                       {"bulking_factor", sample.bulking_factor_measured}});
  }
  return {{"samples", samples},
          {"line", line_json(regression.line)},
          {"line_without_fallback", line_json(regression.line_without_fallback)},
          {"paper_line", line_json(regression.paper_line)}};
}

Json assumption_json(const AssumptionResult& result, const DigObjective& objective) {
  const double per_si = info_of(objective.goal).per_si;
  Json json = {{"factor", result.factor},
               {"level", result.level},
               {"density_percent", result.density_percent},
               {"path", nullptr},
               {"worth", nullptr},
               {"worth_in_reference", nullptr},
               {"regret_percent", nullptr}};
  if (result.best) {
    json["path"] = dig_json(*result.best)["path"];
    json["worth"] = per_si * result.worth;
  }
  if (result.really) {
    json["worth_in_reference"] = per_si * objective.worth(*result.really);
    json["regret_percent"] = result.regret_percent;
  }
  if (!result.failure.empty()) json["failure"] = result.failure;
  return json;
}

}  // namespace excavplan
