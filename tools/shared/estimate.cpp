// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/estimate.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/ground/bulking.hpp>

#include "shared/quantity.hpp"
#include "shared/results.hpp"

namespace excavplan::tools {
namespace {

/// Volume after without the voids between blocks, over the volume before.
Measured without_voids(const VolumeChange& change, const Measured& bulking, const Measured& voids) {
  const double before = change.before.value;
  return {bulking.value - voids.value / before, std::hypot(bulking.sd, voids.sd / before)};
}

/// k = f + (1 - f) k_measured with the errors of both.
Measured freed_of(const Measured& bulking, const Measured& fallback) {
  return {free_of_fallback(bulking.value, fallback.value),
          std::hypot((1.0 - fallback.value) * bulking.sd, (1.0 - bulking.value) * fallback.sd)};
}

/// The bulking factor that the law is asked for.
std::optional<Measured> corrected(const VolumeChange& change, const Estimate& result) {
  const bool voids = result.knowledge.blocks && result.knowledge.blocks->voids;
  if (!voids && !result.knowledge.fallback) return std::nullopt;
  Measured k = *result.bulking;
  if (voids) k = without_voids(change, k, *result.knowledge.blocks->voids);
  if (result.knowledge.fallback) k = freed_of(k, result.knowledge.fallback->fraction);
  return k;
}

void warn_of_blocks(const BlockReport& report, Estimate& result) {
  std::string message = "the soil lies in blocks (score " + readable(report.score) + " of 1): ";
  for (std::size_t i = 0; i < report.reasons.size(); ++i) {
    message += (i > 0 ? "; " : "") + report.reasons[i];
  }
  message += report.voids ? "; the voids between them were estimated and taken out"
                          : "; the voids between them are in the volume, and their size cannot be "
                            "told";
  result.warnings.push_back({"blocks", message + ": the density is not to be trusted"});
  result.trustworthy = false;
}

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

}  // namespace

Estimate estimate(const VolumeChange& change, const Knowledge& knowledge, DensityLaw law) {
  Estimate result;
  result.warnings = change.warnings;
  result.bulking = bulking_factor(change);
  result.knowledge = knowledge;
  if (result.bulking) {
    result.density_without_fallback = density_of_bulking(law.freed_form, result.bulking->value);
    result.corrected = corrected(change, result);
    if (knowledge.fallback) law.form = law.freed_form;
    Measured k = result.corrected.value_or(*result.bulking);
    const bool known_error = !std::isnan(k.sd);
    if (!known_error) {
      k.sd = 0.0;
      result.warnings.push_back(
          {"volume_error_unknown",
           "this method tells no error of its volumes: the interval of the density holds the "
           "scatter of the law only"});
    }
    result.density = relative_density(law, k);
    result.trustworthy = known_error && result.density->trustworthy;
    for (const Warning& warning : result.density->warnings) result.warnings.push_back(warning);
  } else {
    result.trustworthy = false;
  }
  if (knowledge.blocks && knowledge.blocks->blocks) warn_of_blocks(*knowledge.blocks, result);
  for (const Warning& warning : change.warnings) {
    if (warning.code == "zone_at_border" || warning.code == "zone_partly_unseen") {
      result.trustworthy = false;
    }
  }
  return result;
}

nlohmann::ordered_json estimate_json(const VolumeChange& change, const Estimate& result,
                                     const DensityLaw& law) {
  nlohmann::ordered_json json;
  json["volume"] = volumes_json(change);
  json["bulking_factor"] = nullptr;
  json["bulking_factor_sd"] = nullptr;
  json["density_percent"] = nullptr;
  json["density_raw_percent"] = nullptr;
  json["density_sd_percent"] = nullptr;
  json["density_interval_percent"] = nullptr;
  if (result.bulking) {
    json["bulking_factor"] = result.bulking->value;
    json["bulking_factor_sd"] = result.bulking->sd;
    json["density_percent"] = result.density->percent;
    json["density_raw_percent"] = result.density->raw_percent;
    json["density_sd_percent"] = result.density->sd_percent;
    json["density_interval_percent"] = result.density->interval_percent;
    json["density_without_fallback_percent"] = result.density_without_fallback;
  }
  json["bulking_factor_corrected"] = nullptr;
  json["bulking_factor_corrected_sd"] = nullptr;
  if (result.corrected) {
    json["bulking_factor_corrected"] = result.corrected->value;
    json["bulking_factor_corrected_sd"] = result.corrected->sd;
  }
  const Knowledge& known = result.knowledge;
  json["fallback"] = known.fallback ? fallback_json(*known.fallback) : nullptr;
  json["blocks"] = known.blocks ? blocks_json(*known.blocks) : nullptr;
  json["law"] = law.name;
  json["law_soil"] = nullptr;
  if (!law.soil.empty()) json["law_soil"] = law.soil;
  json["trustworthy"] = result.trustworthy;
  return json;
}

std::vector<std::string> estimate_lines(const VolumeChange& change, const Estimate& result,
                                        const DensityLaw& law) {
  const auto volume = [](const Measured& v) { return readable(v.value, v.sd) + " m3"; };
  std::vector<std::string> lines = {"hole       " + volume(change.excavated),
                                    "spill      " + volume(change.spilled),
                                    "heap       " + volume(change.dumped)};
  if (!result.bulking) {
    lines.emplace_back("bulking    unknown, and so is the density");
    return lines;
  }
  const RelativeDensity& d = *result.density;
  lines.push_back("bulking    " + readable(result.bulking->value, result.bulking->sd));
  if (const auto& fallback = result.knowledge.fallback) {
    lines.push_back("fallback   " +
                    readable(100.0 * fallback->fraction.value, 100.0 * fallback->fraction.sd) +
                    " % of the cut");
  }
  if (const auto& blocks = result.knowledge.blocks; blocks && blocks->voids) {
    lines.push_back("voids      " + volume(*blocks->voids) + " between blocks of " +
                    readable(*blocks->block_size, 2) + " m");
  }
  if (result.corrected) {
    lines.push_back("corrected  " + readable(result.corrected->value, result.corrected->sd) +
                    ", bulking freed of this");
  }
  lines.push_back("density    " + readable(d.percent, d.sd_percent) + " %, 95 % interval " +
                  readable(d.interval_percent[0]) + " .. " + readable(d.interval_percent[1]) +
                  " %");
  lines.push_back("law        " + law.name + (result.trustworthy ? "" : " (NOT TRUSTWORTHY)"));
  const double bias = result.density_without_fallback - d.raw_percent;
  if (!result.knowledge.fallback && std::abs(bias) > 0.05) {
    lines.push_back(
        "           holds for digs whose bucket spilled as in its calibration; had nothing "
        "fallen back, " +
        readable(std::clamp(result.density_without_fallback, 0.0, 100.0)) +
        " % (--dug-path finds out)");
  }
  return lines;
}

}  // namespace excavplan::tools
