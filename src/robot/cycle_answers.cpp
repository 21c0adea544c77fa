// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/dig_cycle_session.hpp>

#include "base/json.hpp"
#include "planning/planned_digs.hpp"
#include "results/density_results.hpp"
#include "results/volume_results.hpp"

namespace excavplan {
namespace {

Json site_json(const SiteUpdate& update) {
  Json json = {{"digs", update.digs},
               {"density_percent", nullptr},
               {"density_sd_percent", nullptr},
               {"density_interval_percent", nullptr}};
  if (update.density) {
    json["density_percent"] = update.density->percent;
    json["density_sd_percent"] = update.density->sd_percent;
    json["density_interval_percent"] = update.density->interval_percent;
  }
  json["taken"] = update.taken;
  return json;
}

}  // namespace

std::string to_json(const CycleEstimate& answer) {
  const DensityEstimate& estimate = answer.estimate;
  Json json;
  Json& volume = json["volume"];
  add_measured(volume, "excavated", estimate.change.excavated, "_m3");
  add_measured(volume, "spilled", estimate.change.spilled, "_m3");
  add_measured(volume, "dumped", estimate.change.dumped, "_m3");
  json["bulking_factor"] = json["bulking_factor_sd"] = nullptr;
  if (estimate.bulking) add_measured(json, "bulking_factor", *estimate.bulking);
  json["density_percent"] = json["density_sd_percent"] = nullptr;
  json["density_interval_percent"] = nullptr;
  if (estimate.density) json.update(density_json(*estimate.density));
  json.update({{"law", estimate.law.name},
               {"law_soil", estimate.law.soil},
               {"trustworthy", estimate.trustworthy},
               {"adopted", answer.adopted},
               {"messages_before", answer.before},
               {"messages_after", answer.after},
               {"machine_points", estimate.machine_points},
               {"warnings", warnings_json(answer.warnings)}});
  if (answer.site) json["site"] = site_json(*answer.site);
  return json_text(json);
}

std::string to_json(const CyclePlan& answer) {
  const DigPlan& plan = answer.plan;
  Json json = {{"density_percent", answer.density.percent},
               {"density_sd_percent", answer.density.sd_percent},
               {"density_is_stated", answer.density_is_stated},
               {"source", name(plan.method)},
               {"path", nullptr}};
  if (plan.dig) json.update(dig_json(*plan.dig));
  if (!plan.reason.empty()) json["reason"] = plan.reason;
  json.update({{"start_rule", plan.start_rule},
               {"evaluations", plan.evaluations},
               {"trajectory_points", answer.motion.points.size()},
               {"plan_id", nullptr},
               {"scan_age_s", nullptr},
               {"trustworthy", answer.trustworthy},
               {"warnings", warnings_json(answer.warnings)}});
  if (answer.stamp) json["plan_id"] = answer.stamp->id;
  if (answer.scan_age) json["scan_age_s"] = *answer.scan_age;
  return json_text(json);
}

}  // namespace excavplan
