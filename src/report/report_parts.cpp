// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report_parts.hpp"

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

constexpr Eigen::Index most_cells = 250000;  // ours

Json pin_json(const PolarPin& pin) { return {number(pin.distance), number(pin.angle)}; }

Json cylinder_json(const Cylinder& cylinder) {
  const CylinderGeometry& geometry = cylinder.geometry();
  Json json = {{"count", geometry.count},
               {"foot", pin_json(geometry.foot)},
               {"shortest_m", number(cylinder.shortest())}};
  if (const auto* pin = std::get_if<PolarPin>(&geometry.rod)) {
    json["rod"] = pin_json(*pin);
    return json;
  }
  const auto& bars = std::get<FourBar>(geometry.rod);
  const auto bar = [](const Bar& each) -> Json {
    return {{"pin", pin_json(each.pin)}, {"length_m", number(each.length)}};
  };
  json["rocker"] = bar(bars.rocker);
  json["link"] = bar(bars.link);
  return json;
}

}  // namespace

Eigen::Index coarsening(Eigen::Index rows, Eigen::Index cols) {
  Eigen::Index by = 1;
  while ((rows / by) * (cols / by) > most_cells) ++by;
  return by;
}

nlohmann::ordered_json machine_json(const Machine& machine) {
  const Bucket& bucket = machine.bucket;
  Json json = {{"name", machine.name},
               {"boom_pin_m", {machine.boom_pin.x(), machine.boom_pin.y()}},
               {"lengths_m", {machine.boom_length, machine.arm_length, machine.bucket_length}},
               {"track_front_m", machine.track_front},
               {"torque_limits_kn_m", Json::array()},
               {"profile_m", Json::array()},
               {"width_m", bucket.width_outside},
               {"width_inside_m", bucket.width_inside}};
  for (const auto& limit : machine.limits) {
    json["torque_limits_kn_m"].push_back(number(limit.torque / 1000.0));
  }
  for (const Eigen::Vector2d& corner : bucket.profile) {
    json["profile_m"].push_back({number(corner.x()), number(corner.y())});
  }
  if (bucket.teeth) {
    json["teeth"] = {{"count", bucket.teeth->count},
                     {"width_m", bucket.teeth->width},
                     {"length_m", bucket.teeth->length}};
  }
  if (!machine.cylinders) return json;
  for (const Cylinder& cylinder : *machine.cylinders) {
    json["cylinders"].push_back(cylinder_json(cylinder));
  }
  return json;
}

}  // namespace excavplan
