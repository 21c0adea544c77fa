// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/estimate.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/change/bulking.hpp>

#include "base/files.hpp"
#include "clouds/cloud_units.hpp"
#include "figures/density_figure.hpp"
#include "frame/quantity.hpp"
#include "report/report.hpp"
#include "results/results.hpp"

namespace excavplan::tools {
namespace {

nlohmann::ordered_json fallback_json(const Fallback& fallback) {
  return {{"fraction", fallback.fraction.value},
          {"fraction_sd", fallback.fraction.sd},
          {"cut_m3", fallback.cut},
          {"in_pit_m3", fallback.in_pit},
          {"seen_share", fallback.seen_share}};
}

nlohmann::ordered_json blocks_json(const BlockReport& report) {
  nlohmann::ordered_json json = {{"score", report.score},   {"found", report.blocks},
                                 {"block_size_m", nullptr}, {"voids_m3", nullptr},
                                 {"voids_sd_m3", nullptr},  {"reasons", report.reasons}};
  if (report.block_size) json["block_size_m"] = *report.block_size;
  if (report.voids) {
    json["voids_m3"] = report.voids->value;
    json["voids_sd_m3"] = report.voids->sd;
  }
  return json;
}

/// Null without a registration.
nlohmann::ordered_json registration_json(const std::optional<ScanRegistration>& registration) {
  if (!registration) return nullptr;
  const Alignment& alignment = registration->found;
  const auto numbers = [](const Motion& motion) {
    return nlohmann::ordered_json(std::vector<double>(motion.data(), motion.data() + 6));
  };
  nlohmann::ordered_json correction = nlohmann::ordered_json::array();
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

nlohmann::ordered_json zones_json(const VolumeChange& change) {
  auto list = nlohmann::ordered_json::array();
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

nlohmann::ordered_json attribution_json(const VolumeChange& change) {
  auto list = nlohmann::ordered_json::array();
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

nlohmann::ordered_json readings_json(const DensityEstimate& estimate) {
  auto list = nlohmann::ordered_json::array();
  for (const DensityReading& each : estimate.readings) {
    auto kinds = nlohmann::ordered_json::array();
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

const char* name(VolumeMethod method) {
  return method == VolumeMethod::paper ? "paper" : "surface";
}

nlohmann::ordered_json density_json(const RelativeDensity& density) {
  return {{"density_percent", density.percent},
          {"density_sd_percent", density.sd_percent},
          {"density_interval_percent", density.interval_percent}};
}

nlohmann::ordered_json payload_json(const PayloadDensity& payload) {
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

nlohmann::ordered_json loads_json(const LoadsDensity& loads) {
  nlohmann::ordered_json json = {{"work_kj", loads.work.value / 1000.0},
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

nlohmann::ordered_json prior_json(const SuccessiveDensity& successive) {
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

nlohmann::ordered_json soils_json(const std::vector<SoilAnswer>& soils) {
  auto list = nlohmann::ordered_json::array();
  for (const SoilAnswer& soil : soils) {
    nlohmann::ordered_json json = {{"name", soil.name}, {"weight", soil.weight}};
    json.update(density_json(soil.density));
    json["payload"] = nullptr;
    if (soil.payload) json["payload"] = payload_json(*soil.payload);
    list.push_back(std::move(json));
  }
  return list;
}

nlohmann::ordered_json estimate_json(const DensityEstimate& estimate) {
  auto json = nlohmann::ordered_json::object();
  json["volume"] = volumes_json(estimate.change);
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
    json["density_raw_percent"] = estimate.density->raw_percent;
    json["density_sd_given_law_percent"] = estimate.density->sd_given_law_percent;
    json.update(density_json(*estimate.density));
    json["density_without_fallback_percent"] = estimate.density_without_fallback;
  }
  json["bulking_factor_corrected"] = nullptr;
  json["bulking_factor_corrected_sd"] = nullptr;
  if (estimate.corrected) {
    json["bulking_factor_corrected"] = estimate.corrected->value;
    json["bulking_factor_corrected_sd"] = estimate.corrected->sd;
  }
  json["soils"] = soils_json(estimate.soils);
  json["any_soil"] = nullptr;
  if (estimate.any_soil) json["any_soil"] = density_json(*estimate.any_soil);
  json["payload"] = nullptr;
  if (estimate.payload) json["payload"] = payload_json(*estimate.payload);
  json["density_by_loads"] = nullptr;
  if (estimate.loads) json["density_by_loads"] = loads_json(*estimate.loads);
  json["prior"] = nullptr;
  if (estimate.successive) json["prior"] = prior_json(*estimate.successive);
  json["fallback"] = estimate.fallback ? fallback_json(*estimate.fallback) : nullptr;
  json["blocks"] = blocks_json(estimate.blocks);
  json["law"] = estimate.law.name;
  json["law_soil"] = nullptr;
  if (!estimate.law.soil.empty()) json["law_soil"] = estimate.law.soil;
  json["trustworthy"] = estimate.trustworthy;
  json["method"] = name(estimate.method);
  return json;
}

nlohmann::ordered_json survey_json(const DensityEstimate& estimate) {
  nlohmann::ordered_json json = {{"cell_m", estimate.cell_size},
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

/// "loam 41.0 ± 4.1, sand 69.1 ± 7.0; any of them 52.3 ± 17.4 %"
std::string soils_text(const DensityEstimate& estimate) {
  std::string text;
  for (const SoilAnswer& soil : estimate.soils) {
    text += (text.empty() ? "" : ", ") + soil.name + " " +
            readable(soil.density.percent, soil.density.sd_percent);
  }
  const RelativeDensity& any = *estimate.any_soil;
  return text + "; any of them " + readable(any.percent, any.sd_percent) + " %";
}

std::vector<std::string> estimate_lines(const DensityEstimate& estimate) {
  const auto volume = [](const Measured& v) { return readable(v.value, v.sd) + " m3"; };
  std::vector<std::string> lines = {"hole       " + volume(estimate.change.excavated),
                                    "spill      " + volume(estimate.change.spilled),
                                    "heap       " + volume(estimate.change.dumped)};
  if (!estimate.bulking) {
    lines.emplace_back("bulking    unknown; density unknown");
    return lines;
  }
  const RelativeDensity& d = *estimate.density;
  lines.push_back("bulking    " + readable(estimate.bulking->value, estimate.bulking->sd));
  if (const auto& fallback = estimate.fallback) {
    lines.push_back("fallback   " +
                    readable(100.0 * fallback->fraction.value, 100.0 * fallback->fraction.sd) +
                    " % of the cut");
  }
  if (const BlockReport& blocks = estimate.blocks; blocks.voids) {
    lines.push_back("voids      " + volume(*blocks.voids) + " between blocks of " +
                    readable(*blocks.block_size, 2) + " m");
  }
  if (estimate.corrected) {
    lines.push_back("corrected  " + readable(estimate.corrected->value, estimate.corrected->sd) +
                    ", bulking factor corrected for this");
  }
  if (const auto& payload = estimate.payload) {
    lines.push_back(
        "payload    " + readable(payload->bulk_density.value, payload->bulk_density.sd) +
        " kg/m3 in place, density " +
        readable(payload->density_percent.value, payload->density_percent.sd) + " %; by the law " +
        readable(payload->law_density_percent.value, payload->law_density_percent.sd) + " %");
  }
  if (const auto& loads = estimate.loads) {
    const auto& density = loads->density_percent;
    lines.push_back(
        "loads      " + readable(loads->work.value / 1000.0, 3) + " kJ of the joints, " +
        (density ? "density " + readable(density->value, density->sd) + " %" : loads->reason) +
        "; by the scans " + readable(loads->by_scans.percent, loads->by_scans.sd_percent) + " %");
  }
  if (const auto& successive = estimate.successive) {
    const PriorDensity& prior = successive->prior;
    const double sd =
        std::hypot(prior.independent_sd_percent, prior.shared_sd_percent, prior.drift_sd_percent);
    const RelativeDensity& own = successive->this_dig;
    lines.push_back("prior      " + readable(std::clamp(prior.raw_percent, 0.0, 100.0), sd) +
                    " % with its drift, weight " + readable(successive->weight, 2) + "; this dig " +
                    readable(own.percent, own.sd_percent) + " %");
  }
  lines.push_back("density    " + readable(d.percent, d.sd_percent) + " %, 95 % interval " +
                  readable(d.interval_percent[0]) + " .. " + readable(d.interval_percent[1]) +
                  " %");
  lines.push_back("law        " + estimate.law.name +
                  (estimate.trustworthy ? "" : " (NOT TRUSTWORTHY)"));
  if (estimate.any_soil) lines.push_back("in soils   " + soils_text(estimate));
  lines.emplace_back("holds for  ground near this hole that is of the same soil");
  const double bias = estimate.density_without_fallback - d.raw_percent;
  if (!estimate.fallback && std::abs(bias) > 0.05) {
    lines.push_back(
        "           assumes as much fallback as in the calibration of the law; without fallback, " +
        readable(std::clamp(estimate.density_without_fallback, 0.0, 100.0)) +
        " % (--dug-path with --dug-start measures it)");
  }
  return lines;
}

std::optional<Warning> many_buckets(const DensityEstimate& estimate, const Machine& machine,
                                    double unit) {
  constexpr double most = 10.0;  // ours
  const double bucket = heaped_capacity(machine);
  const double buckets = estimate.change.excavated.value / bucket;
  const auto names_units = [](const Warning& warning) { return warning.code == "units"; };
  const std::vector<Warning>& known = estimate.warnings;
  if (!(buckets > most) || std::any_of(known.begin(), known.end(), names_units))
    return std::nullopt;
  const std::string likely = likely_unit(estimate.change.excavated.value, unit, bucket).word;
  return Warning{"many_buckets",
                 "the hole of " + readable(estimate.change.excavated.value) + " m3 is " +
                     readable(buckets, 2) + " heaped buckets of " + readable(bucket, 2) +
                     " m3 of the machine " + machine.name +
                     ": right for a pit of many digs or another --machine; if it was one dig, the "
                     "scans may be in " +
                     likely + ": --unit " + likely};
}

}  // namespace

Outcome estimate_outcome(const DensityEstimate& estimate, const SoilKnowledge& soil) {
  Outcome outcome;
  outcome.json = estimate_json(estimate);
  outcome.json["soil"] = nullptr;
  if (soil.kind && !soil.unknown) outcome.json["soil"] = soil.kind->name;
  outcome.json["soil_assumed"] = soil.assumed;
  outcome.json.update(survey_json(estimate));
  outcome.lines = estimate_lines(estimate);
  outcome.warnings = estimate.warnings;
  outcome.trustworthy = estimate.trustworthy;
  return outcome;
}

void add_machine_warnings(const DensityEstimate& estimate, const DensityLaw& law,
                          const Machine& machine, double unit, Outcome& outcome) {
  for (Warning& each : unlike_law(law, machine.name)) outcome.warnings.push_back(each);
  const auto many = many_buckets(estimate, machine, unit);
  if (many) outcome.warnings.push_back(*many);
}

const FigureTable<DrawnEstimate>& estimate_figures() {
  static const FigureTable<DrawnEstimate> figures = {
      {{"change", "height change with its zones, and sections"},
       [](const DrawnEstimate& drawn) { return height_change_figure(drawn.sheet); }},
      {{"density", "density with its 95 % interval, and the law with the measured bulking factor"},
       [](const DrawnEstimate& drawn) { return density_figure(drawn.estimate); }}};
  return figures;
}

void draw_estimate(const Plots& plots, const std::optional<std::string>& report,
                   const DensityEstimate& estimate, Outcome& outcome) {
  const DrawnEstimate drawn = {estimate,
                               {estimate.change, estimate.before, outcome.lines, outcome.warnings}};
  write_plots(plots, estimate_figures(), drawn, change_table(drawn.sheet), outcome.warnings);
  if (!report) return;
  Report page;
  page.headline = {"density_percent", "bulking_factor", "volume.excavated_m3", "volume.spilled_m3",
                   "volume.dumped_m3"};
  page.plot_always = true;
  page.scene.areas = surveyed_areas(estimate.change, estimate.before);
  page.scene.zones = estimate.change.zones;
  page.note =
      "The ground after the dig is that before it plus the height change that was measured.";
  outcome.report = titled(std::move(page), *report, "Relative density of the ground from two scans",
                          to_svg(lay_out(height_change_figure(drawn.sheet))));
}

void add_comparison(const BothEstimates& both, const DensityEstimate& counts, Outcome& outcome) {
  const DensityEstimate& other = &counts == &both.paper ? both.surface : both.paper;
  for (const DensityEstimate* each : {&both.surface, &both.paper}) {
    outcome.json["methods"][name(each->method)] = estimate_json(*each);
  }
  outcome.lines.push_back(std::string("method ") + name(other.method) + " gives");
  for (const std::string& line : estimate_lines(other)) outcome.lines.push_back("  " + line);
  for (const Warning& warning : other.warnings) {
    const auto same = [&](const Warning& w) { return w.message == warning.message; };
    if (std::any_of(counts.warnings.begin(), counts.warnings.end(), same)) continue;
    outcome.warnings.push_back(
        {warning.code, std::string("method ") + name(other.method) + ": " + warning.message});
  }
}

}  // namespace excavplan::tools
