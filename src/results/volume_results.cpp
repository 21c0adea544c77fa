// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/volume_results.hpp"

#include "base/json.hpp"

namespace excavplan {

Json volumes_json(const VolumeChange& change) {
  auto json = Json::object();
  add_measured(json, "excavated", change.excavated, "_m3");
  add_measured(json, "spilled", change.spilled, "_m3");
  add_measured(json, "dumped", change.dumped, "_m3");
  add_measured(json, "before", change.before, "_m3");
  add_measured(json, "after", change.after, "_m3");
  return json;
}

void add_measured(Json& json, const std::string& key, const Measured& measured,
                  const std::string& unit) {
  json[key + unit] = measured.value;
  json[key + "_sd" + unit] = measured.sd;
}

}  // namespace excavplan
