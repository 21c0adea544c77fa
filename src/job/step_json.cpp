// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/step_json.hpp"

namespace excavplan {

nlohmann::ordered_json log_base_json(const BasePose& base) {
  return {{"x", base.x}, {"y", base.y}, {"z", base.z}, {"heading_rad", base.heading}};
}

nlohmann::ordered_json log_foretold_json(const ForetoldStep& foretold) {
  return {{"payload_kg", foretold.payload_mass},
          {"energy_j", foretold.energy},
          {"time_s", foretold.time},
          {"payload_kg_interval", foretold.payload_interval},
          {"energy_j_interval", foretold.energy_interval}};
}

}  // namespace excavplan
