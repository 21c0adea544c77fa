// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/density_results.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/change/bulking.hpp>

#include "base/json.hpp"
#include "results/volume_results.hpp"

namespace excavplan {
namespace {

Json fallback_json(const Fallback& fallback) {
  return {{"fraction", fallback.fraction.value},
          {"fraction_sd", fallback.fraction.sd},
          {"cut_m3", fallback.cut},
          {"in_pit_m3", fallback.in_pit},
          {"seen_share", fallback.seen_share}};
}

Json blocks_json(const BlockReport& report) {
  Json json = {{"score", report.score}, {"found", report.blocks}, {"block_size_m", nullptr},
               {"voids_m3", nullptr},   {"voids_sd_m3", nullptr}, {"reasons", report.reasons}};
  if (report.block_size) json["block_size_m"] = *report.block_size;
  if (report.voids) {
    json["voids_m3"] = report.voids->value;
    json["voids_sd_m3"] = report.voids->sd;
  }
  return json;
}

/// Null without a registration.
Json registration_json(const std::optional<ScanRegistration>& registration) {
  if (!registration) return nullptr;
  const Alignment& alignment = registration->found;
  const auto numbers = [](const Motion& motion) {
    return Json(std::vector<double>(motion.data(), motion.data() + 6));
  };
  Json correction = Json::array();
  for (const auto& row : registration->correction.rowwise()) {
    correction.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return {{"correction", correction},
          {"found", numbers(alignment.found)},
          {"found_sd", numbers(alignment.covariance.diagonal().cwiseMax(0.0).cwiseSqrt())},
          {"vertical_is_significant", alignment.vertical_is_significant},
          {"lateral_is_significant", alignment.lateral_is_significant},
          {"residual_sd_m", alignment.residual_sd},
          {"stable_share", alignment.stable_share}};
}

Json zones_json(const VolumeChange& change) {
  auto list = Json::array();
  for (const ChangeZone& zone : change.zones) {
    list.push_back(
        {{"kind", name(zone.kind)},
         {"volume_m3", zone.volume.value},
         {"volume_sd_m3", zone.volume.sd},
         {"area_m2", zone.area},
         {"unseen_share", zone.unknown_share},
         {"extent_m",
          {zone.extent.x_min, zone.extent.y_min, zone.extent.x_max, zone.extent.y_max}}});
  }
  return list;
}

Json attribution_json(const VolumeChange& change) {
  auto list = Json::array();
  for (const AttributedChange& open : change.attribution) {
    list.push_back({{"kind", name(open.kind)},
                    {"what", open.what},
                    {"volume_m3", open.volume.value},
                    {"volume_sd_m3", open.volume.sd},
                    {"counted", open.counted},
                    {"probability", open.probability}});
  }
  return list;
}

Json readings_json(const DensityEstimate& estimate) {
  auto list = Json::array();
  for (const DensityReading& each : estimate.readings) {
    auto kinds = Json::array();
    for (const ChangeKind kind : each.reading.kinds) kinds.push_back(name(kind));
    list.push_back({{"kinds", std::move(kinds)},
                    {"what", each.reading.what},
                    {"weight", each.reading.weight},
                    {"bulking_factor", each.reading.bulking.value},
                    {"bulking_factor_sd", each.reading.bulking.sd},
                    {"density_percent", std::clamp(each.density_percent, 0.0, 100.0)}});
  }
  return list;
}

Json payload_json(const PayloadDensity& payload) {
  return {{"mass_kg", payload.mass.value},
          {"mass_sd_kg", payload.mass.sd},
          {"dug_mass_kg", payload.dug_mass.value},
          {"bulk_density_kg_m3", payload.bulk_density.value},
          {"bulk_density_sd_kg_m3", payload.bulk_density.sd},
          {"density_percent", payload.density_percent.value},
          {"density_sd_percent", payload.density_percent.sd},
          {"law_density_percent", payload.law_density_percent.value},
          {"law_density_sd_percent", payload.law_density_percent.sd},
          {"disagreement_sds", payload.disagreement}};
}

Json loads_json(const LoadsDensity& loads) {
  Json json = {{"work_kj", loads.work.value / 1000.0},
               {"work_sd_kj", loads.work.sd / 1000.0},
               {"density_percent", nullptr},
               {"density_sd_percent", nullptr},
               {"density_interval_percent", nullptr},
               {"reason", nullptr},
               {"scans_density_percent", loads.by_scans.percent},
               {"scans_density_sd_percent", loads.by_scans.sd_percent},
               {"weight", loads.weight},
               {"disagreement_sds", loads.disagreement}};
  if (loads.density_percent) {
    json["density_percent"] = loads.density_percent->value;
    json["density_sd_percent"] = loads.density_percent->sd;
    json["density_interval_percent"] = loads.interval_percent;
  } else {
    json["reason"] = loads.reason;
  }
  return json;
}

Json prior_json(const SuccessiveDensity& successive) {
  const PriorDensity& prior = successive.prior;
  return {{"density_percent", std::clamp(prior.raw_percent, 0.0, 100.0)},
          {"independent_sd_percent", prior.independent_sd_percent},
          {"shared_sd_percent", prior.shared_sd_percent},
          {"drift_sd_percent", prior.drift_sd_percent},
          {"this_dig_density_percent", successive.this_dig.percent},
          {"this_dig_density_sd_percent", successive.this_dig.sd_percent},
          {"combined_independent_sd_percent", successive.density.sd_given_law_percent},
          {"combined_shared_sd_percent", successive.shared_sd_percent},
          {"weight", successive.weight},
          {"disagreement_sds", successive.disagreement}};
}

Json soils_json(const std::vector<SoilAnswer>& soils) {
  auto list = Json::array();
  for (const SoilAnswer& soil : soils) {
    Json json = {{"name", soil.name}, {"weight", soil.weight}};
    json.update(density_json(soil.density));
    json["payload"] = nullptr;
    if (soil.payload) json["payload"] = payload_json(*soil.payload);
    list.push_back(std::move(json));
  }
  return list;
}

/// The bulking factor and the density that it gives; null where they are not known.
void add_bulking(const DensityEstimate& estimate, Json& json) {
  json["bulking_factor"] = nullptr;
  json["bulking_factor_sd"] = nullptr;
  json["bulking_factor_sd_scans"] = nullptr;
  json["bulking_factor_interval"] = nullptr;
  json["density_percent"] = nullptr;
  json["density_raw_percent"] = nullptr;
  json["density_sd_given_law_percent"] = nullptr;
  json["density_sd_percent"] = nullptr;
  json["density_interval_percent"] = nullptr;
  json["density_without_fallback_percent"] = nullptr;
  if (estimate.bulking) {
    json["bulking_factor"] = estimate.bulking->value;
    json["bulking_factor_sd"] = estimate.bulking->sd;
    if (!std::isnan(estimate.bulking->sd)) {
      json["bulking_factor_sd_scans"] = bulking_errors(estimate.change).scans;
    }
    if (const auto interval = bulking_interval(estimate.change)) {
      json["bulking_factor_interval"] = *interval;
    }
    json["density_without_fallback_percent"] = estimate.density_without_fallback;
  }
  if (estimate.density) {
    json["density_raw_percent"] = estimate.density->raw_percent;
    json["density_sd_given_law_percent"] = estimate.density->sd_given_law_percent;
    json.update(density_json(*estimate.density));
  }
  json["bulking_factor_corrected"] = nullptr;
  json["bulking_factor_corrected_sd"] = nullptr;
  if (estimate.corrected) {
    json["bulking_factor_corrected"] = estimate.corrected->value;
    json["bulking_factor_corrected_sd"] = estimate.corrected->sd;
  }
}

}  // namespace

const char* name(VolumeMethod method) {
  return method == VolumeMethod::paper ? "paper" : "surface";
}

Json density_json(const RelativeDensity& density) {
  return {{"density_percent", density.percent},
          {"density_sd_percent", density.sd_percent},
          {"density_interval_percent", density.interval_percent}};
}

Json estimate_json(const DensityEstimate& estimate) {
  auto json = Json::object();
  json["volume"] = volumes_json(estimate.change);
  add_measured(json["volume"], "outside", estimate.change.outside, "_m3");
  add_measured(json["volume"], "strewn", estimate.change.strewn, "_m3");
  add_bulking(estimate, json);
  json["soils"] = soils_json(estimate.soils);
  json["any_soil"] = nullptr;
  if (estimate.any_soil) json["any_soil"] = density_json(*estimate.any_soil);
  json["payload"] = nullptr;
  if (estimate.payload) json["payload"] = payload_json(*estimate.payload);
  json["density_by_loads"] = nullptr;
  if (estimate.loads) json["density_by_loads"] = loads_json(*estimate.loads);
  json["prior"] = nullptr;
  if (estimate.successive) json["prior"] = prior_json(*estimate.successive);
  if (const auto& cut = estimate.change.cut) {
    json["bank_share"] = cut->bank_share();
    add_measured(json["volume"], "loose_dug", cut->loose, "_m3");
    add_measured(json["volume"], "bank_cut", cut->bank, "_m3");
  }
  json["fallback"] = estimate.fallback ? fallback_json(*estimate.fallback) : nullptr;
  json["blocks"] = blocks_json(estimate.blocks);
  json["law"] = estimate.law.name;
  json["law_soil"] = nullptr;
  if (!estimate.law.soil.empty()) json["law_soil"] = estimate.law.soil;
  json["trustworthy"] = estimate.trustworthy;
  json["method"] = name(estimate.method);
  return json;
}

Json survey_json(const DensityEstimate& estimate) {
  Json json = {{"cell_m", estimate.cell_size},
               {"machine_points", estimate.machine_points},
               {"registration", nullptr}};
  if (estimate.registration) {
    json["registration"] = {{"dig", registration_json(estimate.registration)},
                            {"dump", registration_json(estimate.dump_registration)}};
  }
  json["zones"] = zones_json(estimate.change);
  json["attribution"] = attribution_json(estimate.change);
  json["readings"] = readings_json(estimate);
  return json;
}

Json soil_knowledge_json(const SoilKnowledge& soil) {
  const bool is_known = soil.kind && !soil.unknown;
  return {{"soil", is_known ? Json(soil.kind->name) : Json()}, {"soil_assumed", soil.assumed}};
}

}  // namespace excavplan
