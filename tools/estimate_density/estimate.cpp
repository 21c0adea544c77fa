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
#include "results/density_results.hpp"

namespace excavplan::tools {
namespace {

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
  const auto names_units = [](const Warning& warning) {
    return warning.code == WarningCode::units;
  };
  const std::vector<Warning>& known = estimate.warnings;
  if (!(buckets > most) || std::any_of(known.begin(), known.end(), names_units))
    return std::nullopt;
  const std::string likely = likely_unit(estimate.change.excavated.value, unit, bucket).word;
  return Warning{WarningCode::many_buckets,
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
  outcome.json.update(soil_knowledge_json(soil));
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
  page.title = "Relative density of the ground from two scans";
  page.plot = to_svg(lay_out(height_change_figure(drawn.sheet)));
  outcome.page = page_of(std::move(page), *report);
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
