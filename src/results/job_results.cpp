// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
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

}  // namespace

Json job_step_json(const JobStep& step) {
  const bool digs = step.what == JobAction::dig || step.what == JobAction::finish;
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
  if (digs) {
    json["path"] = path_json(step);
    json["keeps_load"] = step.keeps_load;
    if (!step.keeps_load)
      json["dump"] = {{"x_m", step.dump.x()}, {"y_m", step.dump.y()}, {"z_m", step.dump.z()}};
    json["predicted"] = predicted_json(step.predicted);
  }
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
