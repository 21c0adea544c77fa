// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/efficiency_results.hpp"

#include <cmath>

#include "base/json.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

const char* word_of(PhaseSource source) {
  switch (source) {
    case PhaseSource::none:
      return "none";
    case PhaseSource::marked:
      return "marked";
    case PhaseSource::found:
      return "found";
  }
  return "";
}

/// A dig, or a cycle: the mean of those of the log.
Json share_json(const DigEfficiency& run, const RunShare& share) {
  const auto count = static_cast<double>(run.digs);
  const std::string cost = run.spent == Spent::fuel ? "fuel_ml" : "energy_kj";
  const auto efficiency = [&](const std::optional<double>& spent) {
    return spent && *spent > 0.0 ? Json(run.per(*spent).value) : Json();
  };
  Json json = {{"duration_s", share.duration / count}, {cost, share.cost / count}};
  json[cost + "_above_idle"] = share.above_idle ? Json(*share.above_idle / count) : Json();
  json["efficiency"] = efficiency(share.cost);
  json["efficiency_above_idle"] = efficiency(share.above_idle);
  return json;
}

Json idle_json(const DigEfficiency& run) {
  if (!run.idle) return nullptr;
  const bool is_fuel = run.spent == Spent::fuel;
  return {{is_fuel ? "fuel_flow_ml_per_s" : "power_w", run.idle->rate},
          {"found", run.idle->is_found}};
}

}  // namespace

Json run_json(const DigEfficiency& run) {
  Json json = {{"file", run.file}, {"duration_s", run.duration}};
  for (const char* key :
       {"volume_m3", "volume_sd_m3", "mass_kg", "mass_sd_kg", "fuel_ml", "fuel_sd_ml", "energy_kj",
        "energy_sd_kj", "efficiency", "efficiency_sd", "efficiency_unit", "efficiency_m3_per_ml",
        "efficiency_m3_per_kj", "efficiency_kg_per_ml", "efficiency_kg_per_kj"}) {
    json[key] = nullptr;
  }
  const bool is_volume = run.payload.kind == Lifted::volume;
  const bool is_fuel = run.spent == Spent::fuel;
  json[is_volume ? "volume_m3" : "mass_kg"] = run.payload.amount.value;
  json[is_volume ? "volume_sd_m3" : "mass_sd_kg"] = run.payload.amount.sd;
  json[is_fuel ? "fuel_ml" : "energy_kj"] = run.cost;
  json[is_fuel ? "fuel_sd_ml" : "energy_sd_kj"] = run.cost_sd;
  json["efficiency"] = run.value().value;
  json["efficiency_sd"] = run.value().sd;
  json["efficiency_unit"] = run.unit();
  json["efficiency_" + run.unit()] = run.value().value;
  json["bank_volume_m3"] =
      number_or_null(run.bank_volume ? std::optional(run.bank_volume->value) : std::nullopt);
  json["bank_volume_sd_m3"] =
      number_or_null(run.bank_volume ? std::optional(run.bank_volume->sd) : std::nullopt);
  json["meter"] = name(run.meter);
  json["phases"] = word_of(run.phases);
  json["digs"] = run.digs;
  json["idle"] = idle_json(run);
  json["dig"] = share_json(run, run.dig);
  json["cycle"] = run.cycle ? share_json(run, *run.cycle) : Json();
  return json;
}

Json comparison_json(const SetComparison& sets) {
  const auto set = [](const RunSet& runs) -> Json {
    return {{"runs", runs.runs},
            {"efficiency_mean", runs.mean},
            {"efficiency_sd", runs.sd},
            {"efficiency_geometric_mean", runs.geometric_mean}};
  };
  return {{"against", set(sets.first)},
          {"runs", set(sets.second)},
          {"test", sets.by_permutation ? "permutation" : "welch"},
          {"p_value", sets.p_value()},
          {"welch",
           {{"t", sets.welch.t},
            {"degrees_of_freedom", sets.welch.degrees_of_freedom},
            {"p_value", sets.welch.p_value}}},
          {"permutation",
           {{"p_value", sets.permutation.p_value},
            {"exact", sets.permutation.is_exact},
            {"divisions", sets.permutation.divisions}}}};
}

std::string gain_text(const SetComparison& sets) {
  const std::string divisions = std::to_string(sets.permutation.divisions);
  const std::string test = sets.by_permutation
                               ? "permutation test over " +
                                     std::string(sets.permutation.is_exact ? "all " : "") +
                                     divisions + " divisions"
                               : std::string("Welch's t-test");
  return "gain: " + readable(sets.gain_percent) + " %, 95 % interval " +
         readable(sets.gain_low_percent) + " .. " + readable(sets.gain_high_percent) +
         " %; p = " + readable(sets.p_value(), 2) + " (" + test + ")";
}

std::pair<double, double> gain_interval(const Measured& gain_percent) {
  constexpr double normal_quantile = 1.959963984540054;  // of 0.975
  const double ratio = 1.0 + gain_percent.value / 100.0;
  const double spread = std::exp(normal_quantile * gain_percent.sd / 100.0 / ratio);
  return {100.0 * (ratio / spread - 1.0), 100.0 * (ratio * spread - 1.0)};
}

}  // namespace excavplan
