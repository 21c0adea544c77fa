// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/estimate_lines.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"

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

std::string volume_text(const Measured& volume) {
  return readable(volume.value, volume.sd) + " m3";
}

std::string payload_line(const PayloadDensity& payload) {
  return "payload    " + readable(payload.bulk_density.value, payload.bulk_density.sd) +
         " kg/m3 in place, density " +
         readable(payload.density_percent.value, payload.density_percent.sd) + " %; by the law " +
         readable(payload.law_density_percent.value, payload.law_density_percent.sd) + " %";
}

std::string loads_line(const LoadsDensity& loads) {
  const auto& density = loads.density_percent;
  return "loads      " + readable(loads.work.value / 1000.0, 3) + " kJ of the joints, " +
         (density ? "density " + readable(density->value, density->sd) + " %" : loads.reason) +
         "; by the scans " + readable(loads.by_scans.percent, loads.by_scans.sd_percent) + " %";
}

std::string prior_line(const SuccessiveDensity& successive) {
  const PriorDensity& prior = successive.prior;
  const double sd =
      std::hypot(prior.independent_sd_percent, prior.shared_sd_percent, prior.drift_sd_percent);
  const RelativeDensity& own = successive.this_dig;
  return "prior      " + readable(std::clamp(prior.raw_percent, 0.0, 100.0), sd) +
         " % with its drift, weight " + readable(successive.weight, 2) + "; this dig " +
         readable(own.percent, own.sd_percent) + " %";
}

/// The bulking factor and what it was corrected for.
void add_bulking(const DensityEstimate& estimate, std::vector<std::string>& lines) {
  lines.push_back("bulking    " + readable(estimate.bulking->value, estimate.bulking->sd));
  if (const auto& fallback = estimate.fallback) {
    lines.push_back("fallback   " +
                    readable(100.0 * fallback->fraction.value, 100.0 * fallback->fraction.sd) +
                    " % of the cut");
  }
  if (const BlockReport& blocks = estimate.blocks; blocks.voids) {
    lines.push_back("voids      " + volume_text(*blocks.voids) + " between blocks of " +
                    readable(*blocks.block_size, 2) + " m");
  }
  if (estimate.corrected) {
    lines.push_back("corrected  " + readable(estimate.corrected->value, estimate.corrected->sd) +
                    ", bulking factor corrected for this");
  }
}

/// The density, its law and what it holds for.
void add_density(const DensityEstimate& estimate, std::vector<std::string>& lines) {
  const RelativeDensity& d = *estimate.density;
  lines.push_back("density    " + readable(d.percent, d.sd_percent) + " %, 95 % interval " +
                  readable(d.interval_percent[0]) + " .. " + readable(d.interval_percent[1]) +
                  " %");
  lines.push_back("law        " + estimate.law.name);
  if (estimate.any_soil) lines.push_back("in soils   " + soils_text(estimate));
  lines.emplace_back("holds for  ground near this hole that is of the same soil");
  const double bias = estimate.density_without_fallback - d.raw_percent;
  if (!estimate.fallback && std::abs(bias) > 0.05) {
    lines.push_back(
        "           assumes as much fallback as in the calibration of the law; without fallback, " +
        readable(std::clamp(estimate.density_without_fallback, 0.0, 100.0)) +
        " % (--dug-path with --dug-start measures it)");
  }
}

}  // namespace

std::vector<std::string> estimate_lines(const DensityEstimate& estimate) {
  std::vector<std::string> lines = {"hole       " + volume_text(estimate.change.excavated),
                                    "spill      " + volume_text(estimate.change.spilled),
                                    "heap       " + volume_text(estimate.change.dumped)};
  if (!estimate.bulking) {
    lines.emplace_back("bulking    unknown; density unknown");
    return lines;
  }
  add_bulking(estimate, lines);
  if (estimate.payload) lines.push_back(payload_line(*estimate.payload));
  if (estimate.loads) lines.push_back(loads_line(*estimate.loads));
  if (estimate.successive) lines.push_back(prior_line(*estimate.successive));
  add_density(estimate, lines);
  return lines;
}

}  // namespace excavplan::tools
