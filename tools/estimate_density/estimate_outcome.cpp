// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/estimate_outcome.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/scans/depth_intrinsics.hpp>
#include <excavplan/soil/compaction.hpp>

#include "base/text.hpp"
#include "clouds/cloud_units.hpp"
#include "estimate_density/estimate_lines.hpp"
#include "inputs/law_warnings.hpp"
#include "results/density_results.hpp"

namespace excavplan::tools {
namespace {

/// For counts of another unit than 1 mm.
Warning other_counts(double volume, double bucket, const std::string& found) {
  const auto as_counts = [&](const DepthUnit& unit) {
    return volume * std::pow(unit.length / 1e-3, 3);
  };
  const auto miss = [&](const DepthUnit& unit) {
    return std::abs(std::log(as_counts(unit) / bucket));
  };
  const DepthUnit likely =
      *std::min_element(other_depth_units.begin(), other_depth_units.end(),
                        [&](const DepthUnit& x, const DepthUnit& y) { return miss(x) < miss(y); });
  const std::string word = likely.word;
  return {WarningCode::units,
          found + ": if it was one dig, a count of the depth images is not 1 mm; of " + word +
              " it would be " + readable(as_counts(likely)) + " m3: --depth-unit " + word +
              ", or 1mm if it is right"};
}

std::optional<Warning> many_buckets(const DensityEstimate& estimate, const Machine& machine,
                                    const TakenUnits& units) {
  constexpr double most = 10.0;  // ours
  const double bucket = heaped_capacity(machine);
  const double buckets = estimate.change.excavated.value / bucket;
  const auto names_units = [](const Warning& warning) {
    return warning.code == WarningCode::units;
  };
  const std::vector<Warning>& known = estimate.warnings;
  if (!(buckets > most) || std::any_of(known.begin(), known.end(), names_units))
    return std::nullopt;
  const double volume = estimate.change.excavated.value;
  const std::string found = "the hole of " + readable(volume) + " m3 is " + readable(buckets, 2) +
                            " heaped buckets of " + readable(bucket, 2) + " m3 of the machine " +
                            machine.name;
  if (units.in_counts) return other_counts(volume, bucket, found);
  const std::string likely = likely_unit(volume, units.coordinates, bucket).word;
  return Warning{WarningCode::many_buckets,
                 found +
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
                          const Machine& machine, const TakenUnits& units, Outcome& outcome) {
  for (Warning& each : unlike_law(law, machine.name)) outcome.warnings.push_back(each);
  const auto many = many_buckets(estimate, machine, units);
  if (!many) return;
  outcome.warnings.push_back(*many);
  outcome.trustworthy = outcome.trustworthy && !many->ends_trust;
}

void add_compaction(const DensityEstimate& estimate, const SoilKind& soil, double proctor,
                    Outcome& outcome) {
  outcome.json["compaction_percent"] = nullptr;
  if (!estimate.density) return;
  const Compaction found = compaction_of(soil, *estimate.density, proctor);
  outcome.json["compaction_percent"] = found.percent;
  outcome.json["compaction_sd_percent"] = found.sd_percent;
  outcome.json["compaction_interval_percent"] = found.interval_percent;
  outcome.lines.push_back("compaction " + readable(found.percent, found.sd_percent) +
                          " % of Proctor, 95 % interval " + decimals(found.interval_percent[0], 1) +
                          " .. " + decimals(found.interval_percent[1], 1) + " %");
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
    outcome.warnings.emplace_back(
        warning.code, std::string("method ") + name(other.method) + ": " + warning.message, false);
  }
}

}  // namespace excavplan::tools
