// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/dig_cycle_session.hpp>

#include "base/json.hpp"
#include "planning/planned_digs.hpp"

namespace excavplan {
namespace {

nlohmann::ordered_json list_of(const std::vector<Warning>& warnings) {
  auto list = nlohmann::ordered_json::array();
  for (const Warning& warning : warnings) {
    list.push_back({{"code", code_text(warning.code)}, {"message", warning.message}});
  }
  return list;
}

void add(nlohmann::ordered_json& json, const std::string& key, const Measured& measured,
         const std::string& unit = "") {
  json[key + unit] = measured.value;
  json[key + "_sd" + unit] = measured.sd;
}

}  // namespace

std::string to_json(const CycleEstimate& answer) {
  const DensityEstimate& estimate = answer.estimate;
  nlohmann::ordered_json json;
  add(json["volume"], "excavated", estimate.change.excavated, "_m3");
  add(json["volume"], "spilled", estimate.change.spilled, "_m3");
  add(json["volume"], "dumped", estimate.change.dumped, "_m3");
  json["bulking_factor"] = json["bulking_factor_sd"] = nullptr;
  if (estimate.bulking) add(json, "bulking_factor", *estimate.bulking);
  json["density_percent"] = json["density_sd_percent"] = nullptr;
  json["density_interval_percent"] = nullptr;
  if (estimate.density) {
    json["density_percent"] = estimate.density->percent;
    json["density_sd_percent"] = estimate.density->sd_percent;
    json["density_interval_percent"] = estimate.density->interval_percent;
  }
  json.update({{"law", estimate.law.name},
               {"law_soil", estimate.law.soil},
               {"trustworthy", estimate.trustworthy},
               {"adopted", answer.adopted},
               {"messages_before", answer.before},
               {"messages_after", answer.after},
               {"machine_points", estimate.machine_points},
               {"warnings", list_of(answer.warnings)}});
  return json_text(json);
}

std::string to_json(const CyclePlan& answer) {
  const DigPlan& plan = answer.plan;
  nlohmann::ordered_json json = {{"density_percent", answer.density.percent},
                                 {"density_sd_percent", answer.density.sd_percent},
                                 {"density_is_stated", answer.density_is_stated},
                                 {"source", name(plan.method)},
                                 {"path", nullptr}};
  if (plan.dig) json.update(dig_json(*plan.dig));
  if (!plan.reason.empty()) json["reason"] = plan.reason;
  json.update({{"start_rule", plan.start_rule},
               {"evaluations", plan.evaluations},
               {"trajectory_points", answer.motion.points.size()},
               {"trustworthy", answer.trustworthy},
               {"warnings", list_of(answer.warnings)}});
  return json_text(json);
}

}  // namespace excavplan
