// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "trial/trial_json.hpp"

#include <cmath>

#include "base/json.hpp"
#include "job/step_json.hpp"

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

Json dig_json(const TrialStep& at) {
  Json line = {{"type", "dig"},
               {"time_s", at.done.time - at.done.scan_time},
               {"energy_j", at.done.energy},
               {"payload_kg", at.done.report.payload_mass.value_or(0.0)},
               {"payload_true_kg", at.done.payload_mass},
               {"stall", at.done.stall.has_value()},
               {"base", log_base_json(at.step.base)},
               {"plan_s", at.planning_time},
               {"pass", at.step.what == JobAction::finish ? "finish" : "bulk"}};
  if (at.done.stall) line["stall_cause"] = name(at.done.stall->cause);
  if (at.step.predicted.payload_mass > 0.0)
    line["predicted"] = log_foretold_json(at.step.predicted);
  if (at.step.truck) line["truck"] = *at.step.truck;
  line["lane_m"] = at.step.lane;
  line["swung_rad"] = at.step.swung;
  line["keeps_load"] = at.step.keeps_load;
  line["dumps_first"] = at.step.dumps_first;
  line["dump"] = {{"x", at.step.dump.x()}, {"y", at.step.dump.y()}, {"z", at.step.dump.z()}};
  return line;
}

Json action_json(const TrialStep& at) {
  switch (at.step.what) {
    case JobAction::dig:
    case JobAction::finish:
      return dig_json(at);
    case JobAction::move:
      return {{"type", "move"},
              {"time_s", at.done.time},
              {"energy_j", at.done.energy},
              {"base", log_base_json(at.done.report.base.value_or(at.step.base))},
              {"plan_s", at.planning_time}};
    default: {
      Json line = {{"type", name(at.step.what)},
                   {"time_s", at.done.time},
                   {"plan_s", at.planning_time},
                   {"reason", at.step.reason}};
      if (at.step.dumps_first) line["energy_j"] = at.done.energy;
      return line;
    }
  }
}

Json line_of(const TrialStep& at) {
  Json line = action_json(at);
  line["trustworthy"] = at.step.trustworthy;
  return line;
}

}  // namespace

nlohmann::ordered_json trial_json(const JobTrial& trial) {
  const JobScore& score = trial.score;
  nlohmann::ordered_json json;
  json["finished"] = score.finished;
  json["reason"] = trial.reason;
  json["rms_m"] = score.rms;
  json["p95_m"] = score.p95;
  json["beyond_twice_percent"] = 100.0 * score.beyond_twice;
  json["seen_percent"] = 100.0 * score.seen;
  json["left_percent"] = score.left_percent();
  json["overdig_percent"] = score.overdig_percent();
  json["overdig_inside_percent"] = 100.0 * score.overdig_inside / score.design_cut;
  json["overdig_beside_percent"] = 100.0 * score.overdig_beside / score.design_cut;
  json["spill_percent"] = score.spill_percent();
  json["keep_out_l"] = 1e3 * score.keep_out;
  json["design_cut_m3"] = score.design_cut;
  json["digs"] = trial.digs;
  json["finishing"] = trial.finishing;
  json["moves"] = trial.moves;
  json["scans"] = trial.scans;
  json["stalls"] = trial.stalls;
  json["untrusted_steps"] = trial.untrusted;
  json["energy_kj"] = 1e-3 * trial.energy;
  json["energy_kj_per_design_m3"] = 1e-3 * trial.energy_per_design();
  json["time_min"] = trial.time / 60.0;
  json["planning_s"] = trial.planning_time;
  json["hauled_kg"] = trial.hauled;
  json["trucks_kg"] = nlohmann::ordered_json::array();
  for (const auto& [number, mass] : trial.trucks) json["trucks_kg"].push_back(mass);
  return json;
}

nlohmann::ordered_json reference_json(const JobReference& reference) {
  return {{"density_percent", reference.density_percent},
          {"design_cut_m3", reference.design_cut},
          {"swollen_m3", reference.swollen},
          {"reference_kj_per_design_m3", 1e-3 * reference.energy},
          {"reference_time_min", reference.time * reference.design_cut / 60.0},
          {"reference_digs", reference.digs},
          {"reference_payload_kg", reference.dig.payload_mass},
          {"reference_fill", reference.dig.fill},
          {"bound_kj_per_design_m3", 1e-3 * reference.bound},
          {"least_loads", reference.least_loads}};
}

std::string log_lines(const TrialStep& at) {
  std::string lines = json_text(line_of(at)) + '\n';
  const bool scanned_after = at.done.report.scan && at.step.what != JobAction::scan;
  if (scanned_after) {
    lines += json_text(Json{{"type", "scan"}, {"time_s", at.done.scan_time}}) + '\n';
  }
  return lines;
}

std::string log_end(const JobTrial& trial) {
  return json_text(Json{{"type", "end"},
                        {"reason", trial.reason},
                        {"seen", trial.score.seen},
                        {"untrusted_steps", trial.untrusted},
                        {"finished", trial.score.finished}}) +
         '\n';
}

}  // namespace excavplan
