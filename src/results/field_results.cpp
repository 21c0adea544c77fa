// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/field_results.hpp"

#include "base/json.hpp"
#include "planning/planned_digs.hpp"
#include "results/study_results.hpp"

namespace excavplan {
namespace {

Json fuelled_json(const FuelledDig& fuelled) {
  Json json = dig_json(fuelled.dig);
  json.update({{"fuel_ml", fuelled.fuel()},
               {"fuel_idle_ml", fuelled.idle_fuel},
               {"fuel_work_ml", fuelled.work_fuel},
               {"efficiency_m3_per_ml", fuelled.efficiency()}});
  return json;
}

Json codes_of(const std::vector<Warning>& warnings) {
  Json codes = Json::array();
  for (const Warning& warning : warnings) codes.push_back(code_text(warning.code));
  return codes;
}

Json run_json(const FieldRun& run) {
  if (!run.failure.empty()) return {{"failure", run.failure}};
  return {{"bulking_factor", run.bulking_factor},
          {"density_raw_percent", run.density_raw},
          {"density_estimated_percent", run.estimate.percent},
          {"density_sd_percent", run.estimate.sd_percent},
          {"trustworthy", run.estimate.trustworthy},
          {"warnings", codes_of(run.warnings)},
          {"machine_held_down", run.held_down},
          {"fixed", fuelled_json(run.fixed)},
          {"planned", fuelled_json(run.planned)},
          {"planned_equal_payload", fuelled_json(run.equal)},
          {"gain_percent", run.energy_gain},
          {"gain_equal_payload_percent", run.equal_energy_gain},
          {"gain_path_equal_payload_percent", run.equal_path_gain},
          {"gain_fuel_percent", fuel_gain_percent(run.planned, run.fixed)},
          {"gain_fuel_equal_payload_percent", fuel_gain_percent(run.equal, run.fixed)}};
}

}  // namespace

Json field_json(const std::string& name, const FieldResult& result) {
  Json json = {{"name", name},
               {"density_percent", result.density_percent},
               {"digs", result.runs.size()},
               {"failed", result.failed},
               {"held_down", result.held_down},
               {"trustworthy", result.trusted},
               {"gain_percent", mean_json(result.energy_gain)},
               {"gain_equal_payload_percent", mean_json(result.equal_energy_gain)},
               {"gain_path_equal_payload_percent", mean_json(result.equal_path_gain)},
               {"gain_fuel_percent", mean_json(result.gain)},
               {"volume_ratio", mean_json(result.volume_ratio)},
               {"gain_fuel_equal_payload_percent", mean_json(result.equal_gain)},
               {"equal_volume_ratio", mean_json(result.equal_volume_ratio)},
               {"runs", Json::array()}};
  for (const FieldRun& run : result.runs) json["runs"].push_back(run_json(run));
  return json;
}

}  // namespace excavplan
