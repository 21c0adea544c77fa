// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/joint_loads.hpp"

#include <algorithm>
#include <cmath>

#include "base/json.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

double larger(double a, double b) { return std::abs(b) > std::abs(a) ? b : a; }

void add_sample(const Cylinder& cylinder, double joint, double torque,
                std::optional<CylinderUse>& use) {
  const double length = cylinder.at(joint).length;
  if (!use) use = CylinderUse{0.0, length, length};
  use->peak_force = larger(use->peak_force, cylinder.force(joint, torque));
  use->shortest = std::min(use->shortest, length);
  use->longest = std::max(use->longest, length);
}

Json cylinder_json(const Cylinder& cylinder, const CylinderUse& use) {
  return {{"count", cylinder.count()},     {"peak_force_kn", use.peak_force / 1000.0},
          {"shortest_m", use.shortest},    {"longest_m", use.longest},
          {"stroke_m", cylinder.stroke()}, {"stroke_share", stroke_share(cylinder, use)}};
}

}  // namespace

double stroke_share(const Cylinder& cylinder, const CylinderUse& use) {
  return (use.longest - use.shortest) / cylinder.stroke();
}

JointLoads joint_loads(const Machine& machine, const std::vector<ForceSample>& history) {
  JointLoads loads;
  for (const ForceSample& sample : history) {
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const double torque = sample.torque[static_cast<int>(i)];
      loads[i].peak_torque = larger(loads[i].peak_torque, torque);
      if (!machine.cylinders) continue;
      add_sample((*machine.cylinders)[i], sample.joints[static_cast<int>(i)], torque,
                 loads[i].cylinder);
    }
  }
  return loads;
}

Json joint_loads_json(const Machine& machine, const JointLoads& loads) {
  auto json = Json::object();
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const auto& use = loads[i].cylinder;
    json[name(joint_order[i])] = {
        {"peak_torque_kn_m", loads[i].peak_torque / 1000.0},
        {"limit_kn_m", machine.limits[i].torque / 1000.0},
        {"cylinder", use ? cylinder_json((*machine.cylinders)[i], *use) : Json()}};
  }
  return json;
}

}  // namespace excavplan
