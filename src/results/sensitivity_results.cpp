// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/sensitivity_results.hpp"

#include "base/json.hpp"
#include "planning/planned_digs.hpp"

namespace excavplan {

Json assumption_json(const AssumptionResult& result, const DigObjective& objective) {
  const double per_si = info_of(objective.goal).per_si;
  Json json = {{"factor", result.factor},
               {"level", result.level},
               {"density_percent", result.density_percent},
               {"path", nullptr},
               {"worth", nullptr},
               {"worth_in_reference", nullptr},
               {"regret_percent", nullptr}};
  if (result.best) {
    json["path"] = dig_json(*result.best)["path"];
    json["worth"] = per_si * result.worth;
  }
  if (result.really) {
    json["worth_in_reference"] = per_si * objective.worth(*result.really);
    json["regret_percent"] = result.regret_percent;
  }
  if (!result.failure.empty()) json["failure"] = result.failure;
  return json;
}

}  // namespace excavplan
