// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/study_results.hpp"

#include <cmath>

#include "base/json.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

Json counted_json(const StudyMean& mean) {
  Json json = mean_json(mean);
  if (!json.is_null()) json["runs"] = mean.values;
  return json;
}

Json gains_json(const StudyGains& gains) {
  return {{"gain_percent", counted_json(gains.gain)},
          {"gain_path_percent", counted_json(gains.of_path)},
          {"payload_ratio", counted_json(gains.payload)},
          {"gain_over_reference_points", counted_json(gains.over_first)}};
}

/// Empty where the value is not known.
std::string csv_number(double value) { return std::isnan(value) ? "" : number_text(value); }

/// Of a run, between density and failure; what is not known is not a number.
std::vector<double> values_of(const StudyRun& run) {
  const double nothing = std::nan("");
  std::vector<double> values(5, nothing);
  if (run.failure.empty()) {
    values = {run.estimate_percent, run.estimate_sd, run.interval[0], run.interval[1],
              run.trustworthy ? 1.0 : 0.0};
  }
  const bool compared = run.failure.empty() && run.compared;
  values.push_back(compared ? (run.held_down ? 1.0 : 0.0) : nothing);
  for (const StudyGain& of : {run.energy, run.equal, run.cycle}) {
    values.insert(values.end(), {of.gain, of.of_path, of.payload});
  }
  return values;
}

}  // namespace

Json mean_json(const StudyMean& mean) {
  if (mean.values == 0) return nullptr;
  Json json = {{"mean", mean.mean}, {"interval_95", nullptr}};
  if (mean.values > 1) json["interval_95"] = mean.interval;
  return json;
}

Json condition_json(const StudyResult& result) {
  return {{"factor", result.condition.factor},
          {"level", result.condition.level},
          {"runs", result.runs.size()},
          {"failed", result.failed},
          {"not_trustworthy", result.untrusted},
          {"density_rms_points", result.rms},
          {"density_bias_points", result.bias},
          {"density_inside_95", result.inside},
          {"compared", result.compared},
          {"held_down", result.held_down},
          {"not_planned", result.unplanned},
          {"densities_percent", {result.densities[0], result.densities[1]}},
          {"energy", gains_json(result.energy)},
          {"equal_payload", gains_json(result.equal)},
          {"cycle", gains_json(result.cycle)}};
}

std::string runs_csv(const std::vector<StudyResult>& results) {
  std::string csv =
      "factor,level,density_percent,estimate_percent,estimate_sd_percent,interval_low_percent,"
      "interval_high_percent,trustworthy,held_down";
  for (const std::string goal : {"energy", "equal_payload", "cycle"}) {
    csv += "," + goal + "_gain_percent," + goal + "_gain_path_percent," + goal + "_payload_ratio";
  }
  csv += ",failure,plan_failure\n";
  for (const StudyResult& result : results) {
    for (const StudyRun& run : result.runs) {
      csv += csv_field(result.condition.factor) + "," + csv_field(result.condition.level) + "," +
             csv_number(run.density_percent);
      for (const double value : values_of(run)) csv += "," + csv_number(value);
      for (const std::string& why : {run.failure, run.plan_failure}) {
        csv += "," + (why.empty() ? "" : csv_field(why));
      }
      csv += "\n";
    }
  }
  return csv;
}

}  // namespace excavplan
