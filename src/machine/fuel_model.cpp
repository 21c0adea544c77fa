// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/fuel_model.hpp>

#include <algorithm>

#include "base/json.hpp"
#include "base/text.hpp"

namespace excavplan {

double FuelModel::flow(double joint_power) const {
  const double per_watt = (rated_flow - idle_flow) / rated_power;
  return std::min(rated_flow, idle_flow + per_watt * joint_power / drive_efficiency);
}

FuelModel load_fuel_model(const std::string& path) {
  constexpr double litre_per_hour = 1000.0 / 3600.0;  // [mL/s]
  constexpr double least = 0.2;                       // of a diesel engine at full load; ours
  constexpr double most = 0.5;
  JsonObject file = JsonObject::open(path, "excavplan-fuel-model");
  file.ignore("sources");
  file.ignore("description");
  FuelModel model;
  model.name = file.text("name");
  model.rated_power = file.number("rated_power_w", 1e3, 1e7);
  model.rated_flow = litre_per_hour * file.number("rated_flow_l_per_h", 0.01, 1e4);
  model.idle_flow = litre_per_hour * file.number("idle_flow_l_per_h", 0.01, 1e4);
  model.drive_efficiency = file.number("drive_efficiency", 0.05, 1.0);
  model.heating_value = 1e3 * file.number("heating_value_mj_per_l", 1.0, 100.0);
  file.done();
  if (!(model.idle_flow < model.rated_flow)) {
    file.fail("idle_flow_l_per_h", "must be below rated_flow_l_per_h");
  }
  const double efficiency = model.rated_efficiency();
  if (!(efficiency >= least && efficiency <= most)) {
    file.fail("rated_flow_l_per_h", "makes an engine with an efficiency of " +
                                        readable(efficiency) + " at the rated power, must be in " +
                                        number_text(least) + " .. " + number_text(most));
  }
  return model;
}

}  // namespace excavplan
