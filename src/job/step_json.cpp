// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/step_json.hpp"

#include <algorithm>

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array codes = {
#define EXCAVPLAN_WARNING(code, trust) WarningCode::code,
#include <excavplan/base/warning_codes.def>
};

}  // namespace

Json kept_warnings_json(const std::vector<Warning>& warnings) {
  Json list = Json::array();
  for (const Warning& each : warnings) {
    list.push_back({{"code", code_text(each.code)},
                    {"message", each.message},
                    {"ends_trust", each.ends_trust}});
  }
  return list;
}

std::vector<Warning> read_kept_warnings(std::vector<JsonObject> list) {
  std::vector<Warning> warnings;
  for (JsonObject& each : list) {
    const std::string code = each.text("code");
    const auto known = std::find_if(codes.begin(), codes.end(), [&](WarningCode candidate) {
      return code_text(candidate) == code;
    });
    if (known == codes.end()) each.fail("code", "is no code of a warning");
    warnings.emplace_back(*known, each.text("message"), each.flag("ends_trust"));
    each.done();
  }
  return warnings;
}

Json log_base_json(const BasePose& base) {
  return {{"x", base.x}, {"y", base.y}, {"z", base.z}, {"heading_rad", base.heading}};
}

Json log_foretold_json(const ForetoldStep& foretold) {
  return {{"payload_kg", foretold.payload_mass},
          {"energy_j", foretold.energy},
          {"time_s", foretold.time},
          {"payload_kg_interval", foretold.payload_interval},
          {"energy_j_interval", foretold.energy_interval}};
}

}  // namespace excavplan
