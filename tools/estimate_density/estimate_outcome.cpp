// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/estimate_outcome.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "clouds/cloud_units.hpp"
#include "estimate_density/estimate_lines.hpp"
#include "inputs/law_warnings.hpp"
#include "results/density_results.hpp"

namespace excavplan::tools {
namespace {

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
