// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/density_input.hpp"

#include <algorithm>
#include <utility>

#include <excavplan/base/error.hpp>
#include <excavplan/results/stated_density.hpp>

#include "base/text.hpp"
#include "results/plan_results.hpp"

namespace excavplan::tools {
namespace {

/// Of a plan for the density of a file.
std::vector<Warning> source_warnings(const DigPlan& plan, const std::string& file,
                                     const Terrain* scanned) {
  const StatedDensity stated = stated_density(file);
  std::vector<Warning> warnings;
  if (scanned) {
    if (const auto older = older_ground(stated, file, scanned->surface())) {
      warnings.push_back(*older);
    }
  }
  if (scanned && plan.dig) {
    const double x = plan.dig->start_x;
    if (const auto far = elsewhere(stated, file, {x, 0.0, x, 0.0})) warnings.push_back(*far);
  }
  if (stated.of_any_soil) {
    warnings.emplace_back(WarningCode::density_of_unknown_soil,
                          file +
                              ": the soil was not known: its density is the mean over all shipped "
                              "soils, the dig is planned in one of them");
  }
  return warnings;
}

}  // namespace

void declare_density(Arguments& arguments, DensityInput& input) {
  arguments.option("density", input.percent, Quantity::percent,
                   "relative density of the ground; this or --density-from is needed");
  arguments.option(
      "density-sd", input.sd, Quantity::percent,
      "standard deviation of the density, propagated to the results; --search then finds the "
      "path with the best expected goal value");
  arguments.file(
      "density-from", input.file,
      "take the density and its uncertainty from this result of estimate-density --json");
  arguments.exclude("density", {"density-from"});
}

void check(const DensityInput& input) {
  if (input.sd && !(*input.sd >= 0.0 && *input.sd <= most_density_sd)) {
    usage_error("--density-sd: " + number_text(*input.sd) + " % is outside 0 .. " +
                number_text(most_density_sd));
  }
  if (!input.percent && !input.file && !input.by_site) {
    usage_error("give either --density, --density-from or --site");
  }
  if (input.percent && !(*input.percent >= 0.0 && *input.percent <= 100.0)) {
    usage_error("--density: " + number_text(*input.percent) + " % is outside 0 .. 100");
  }
}

GroundDensity density_of(const DensityInput& input) {
  GroundDensity density =
      input.percent ? GroundDensity(*input.percent) : stated_density(*input.file).density;
  density.sd_percent = input.sd.value_or(density.sd_percent);
  return density;
}

std::vector<Warning> plan_warnings(const DigPlan& plan, const DensityInput& input,
                                   const Terrain* scanned) {
  std::vector<Warning> warnings = plan.warnings;
  if (input.file) {
    for (Warning& each : source_warnings(plan, *input.file, scanned)) {
      warnings.push_back(std::move(each));
    }
  }
  if (!plan.reason.empty()) warnings.emplace_back(WarningCode::no_dig, reason_of(plan));
  for (Warning& warning : warnings) {
    const bool of_density = warning.code == WarningCode::density_not_trustworthy ||
                            warning.code == WarningCode::law_of_other_soil;
    if (of_density && input.file) warning.message = *input.file + ": " + warning.message;
  }
  return warnings;
}

}  // namespace excavplan::tools
