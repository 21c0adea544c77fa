// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>

#include "base/json.hpp"
#include "results/plan_results.hpp"

namespace excavplan {
namespace {

Json path_json(const JobStep& step) {
  const DigPath& path = step.path;
  Json json;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    json[info.name] = path.parameters.*info.field;
  }
  json["start_x_m"] = path.start_x;
  json["swung_rad"] = step.swung;
  json["lane_m"] = step.lane;
  json["grade_rad"] = path.drag_grade;
  json["floor"] = path.meets_floor;
  return json;
}

Json predicted_json(const ForetoldStep& foretold) {
  const auto& energy = foretold.energy_interval;
  return {{"payload_kg", foretold.payload_mass},
          {"energy_kj", foretold.energy / 1000.0},
          {"time_s", foretold.time},
          {"payload_kg_interval", foretold.payload_interval},
          {"energy_kj_interval", {energy[0] / 1000.0, energy[1] / 1000.0}}};
}

Json whole(double value) { return std::llround(std::ceil(value)); }

/// A figure, its interval, and the deviations behind it in per cent of the figure.
void add_figure(Json& json, const std::string& key, const EstimatedFigure& figure,
                const std::function<Json(double)>& shown) {
  const auto interval = figure.interval();
  const EstimateSpread& spread = figure.spread;
  json[key] = shown(figure.value);
  json[key + "_interval"] = {shown(interval[0]), shown(interval[1])};
  json["spread_percent"][key] = {
      {"volume", 100.0 * spread.volume},      {"density", 100.0 * spread.density},
      {"played_jobs", 100.0 * spread.played}, {"unlike_played", 100.0 * spread.unlike},
      {"fuel_model", 100.0 * spread.fuel},    {"truck_fill", 100.0 * spread.fill}};
}

}  // namespace

Json job_estimate_json(const JobEstimate& estimate, const JobOutline& job,
                       const std::optional<JobCost>& cost) {
  const auto times = [](double factor) {
    return [factor](double value) { return factor * value; };
  };
  Json json;
  add_figure(json, "digs", estimate.digs, whole);
  add_figure(json, "time_min", estimate.time, times(1.0 / 60.0));
  add_figure(json, "fuel_l", estimate.fuel, times(1.0));
  add_figure(json, "truckloads", estimate.truckloads, whole);
  if (cost) {
    add_figure(json, "cost", cost->total, times(1.0));
    json["cost_parts"] = {
        {"fuel", cost->fuel}, {"machine", cost->machine}, {"truckloads", cost->truckloads}};
  }
  add_figure(json, "energy_kj", estimate.energy, times(1e-3));
  add_figure(json, "swollen_m3", estimate.swollen, times(1.0));
  add_figure(json, "mass_kg", estimate.mass, times(1.0));
  json["design_m3"] = job.shape.volume.value;
  json["design_sd_m3"] = job.shape.volume.sd;
  json["density_percent"] = job.density.percent;
  json["density_sd_percent"] = job.density.sd_percent;
  json["bulking_factor"] = estimate.swollen.value / job.shape.volume.value;
  json["truck_mass_kg"] = job.truck_mass;
  json["reference_kj_per_design_m3"] = 1e-3 * estimate.reference_energy;
  json["reference_time_min"] = estimate.reference_time / 60.0;
  json["reference_digs"] = estimate.reference_digs;
  json["reference_payload_kg"] = estimate.dig.payload_mass;
  json["reference_fill"] = estimate.dig.fill;
  json["unlike_played"] = estimate.unlike;
  json["trustworthy"] = estimate.trustworthy();
  return json;
}

Json job_step_json(const JobStep& step) {
  Json json = {{"step", step.id},
               {"what", name(step.what)},
               {"base",
                {{"x_m", step.base.x},
                 {"y_m", step.base.y},
                 {"z_m", step.base.z},
                 {"heading_rad", step.base.heading},
                 {"roll_rad", 0.0},
                 {"pitch_rad", 0.0}}},
               {"path", nullptr},
               {"dump", nullptr},
               {"predicted", nullptr}};
  if (step.moves_front()) {
    json["dump"] = {{"x_m", step.dump.x()}, {"y_m", step.dump.y()}, {"z_m", step.dump.z()}};
  }
  if (step.digs()) {
    json["path"] = path_json(step);
    json["keeps_load"] = step.keeps_load;
    json["predicted"] = predicted_json(step.predicted);
  }
  if (step.what == JobAction::scan) json["swung_rad"] = step.swung;
  json["dumps_first"] = step.dumps_first;
  json["truck"] = step.truck ? Json(*step.truck) : Json();
  json["trustworthy"] = step.trustworthy;
  json["reason"] = step.reason;
  return json;
}

Json progress_json(const JobProgress& progress) {
  return {{"finished", progress.is_finished},
          {"design_m3", progress.design_volume},
          {"left_m3", progress.left_volume},
          {"rms_m", progress.rms},
          {"p95_m", progress.p95},
          {"beyond_twice", progress.beyond_twice},
          {"seen", progress.seen},
          {"digs", progress.digs},
          {"finishing_passes", progress.finishing_passes},
          {"moves", progress.moves},
          {"scans", progress.scans},
          {"stalls", progress.stalls},
          {"payload_kg", progress.payload_mass}};
}

}  // namespace excavplan
