// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/data_sheet_keys.hpp"

namespace excavplan {

const std::array<DataSheetKey, 13>& data_sheet_keys() {
  constexpr const char* metres = "is it in m?";
  constexpr const char* newtons = "is it in N, not kN?";
  static const std::array<DataSheetKey, 13> keys = {
      {{"operating_mass_kg", &DataSheet::operating_mass, 300.0, 4e5, "is it in kg, not t?", true},
       {"bucket_capacity_m3", &DataSheet::bucket_capacity, 3e-3, 25.0, "is it in m3, not litres?",
        true},
       {"ground_reach_m", &DataSheet::ground_reach, 1.5, 40.0, metres, true},
       {"depth_m", &DataSheet::depth, 0.7, 30.0, metres, true},
       {"bucket_force_n", &DataSheet::bucket_force, 1.5e3, 2e6, newtons},
       {"arm_force_n", &DataSheet::arm_force, 1e3, 2e6, newtons},
       {"height_m", &DataSheet::height, 1.0, 40.0, metres},
       {"dump_height_m", &DataSheet::dump_height, 0.5, 30.0, metres},
       {"bucket_width_m", &DataSheet::bucket_width, 0.1, 6.0, metres},
       {"engine_power_w", &DataSheet::engine_power, 1.5e3, 2e6, "is it in W, not kW?"},
       {"swing_rate_rad_per_s", &DataSheet::swing_rate, 0.2, 3.0, "is it in rad/s, not rpm?"},
       {"track_gauge_m", &DataSheet::track_gauge, 0.4, 8.0, metres},
       {"track_length_m", &DataSheet::track_length, 0.7, 12.0, metres}}};
  return keys;
}

DataSheet read_data_sheet(JsonObject file) {
  DataSheet sheet;
  for (const DataSheetKey& each : data_sheet_keys()) {
    if (file.has(each.key)) sheet.*each.figure = file.number(each.key, 1e-3, 1e8);
  }
  file.ignore("sources");
  file.done();
  return sheet;
}

nlohmann::json data_sheet_json(const DataSheet& sheet) {
  nlohmann::json json;
  for (const DataSheetKey& each : data_sheet_keys()) {
    if (const auto figure = sheet.*each.figure) json[each.key] = *figure;
  }
  return json;
}

}  // namespace excavplan
