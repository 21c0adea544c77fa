// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/joint_loads.hpp"

#include <algorithm>
#include <cmath>

#include "base/json.hpp"
#include "base/text.hpp"
#include "results/dig_timing.hpp"

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

std::string force_history_csv(const Machine& machine, const DigScene& scene) {
  const std::vector<TimedStep> steps = timed_steps(machine, scene.path, scene.dig);
  std::string csv =
      "phase,travelled_m,boom_rad,arm_rad,bucket_rad,soil_x_n,soil_z_n,boom_torque_n_m,"
      "arm_torque_n_m,bucket_torque_n_m,bucket_fill_m3";
  if (machine.cylinders) {
    csv +=
        ",boom_cylinder_m,arm_cylinder_m,bucket_cylinder_m,boom_cylinder_n,arm_cylinder_n,"
        "bucket_cylinder_n";
  }
  csv += ",time_s,joint_power_w";
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const ForceSample& sample = scene.dig.history[i];
    const JointAngles& joints = sample.joints;
    const JointAngles& torque = sample.torque;
    std::vector<double> row = {sample.travelled, joints[0],         joints[1], joints[2],
                               sample.soil.x(),  sample.soil.y(),   torque[0], torque[1],
                               torque[2],        sample.bucket_fill};
    if (machine.cylinders) {
      for (const CylinderState& state : cylinder_states(*machine.cylinders, joints)) {
        row.push_back(state.length);
      }
      const Eigen::Vector3d forces = cylinder_forces(*machine.cylinders, joints, torque);
      row.insert(row.end(), {forces[0], forces[1], forces[2]});
    }
    row.insert(row.end(), {steps[i].time, steps[i].power});
    csv += '\n' + std::string(name(sample.phase));
    for (const double value : row) csv += ',' + number_text(value);
  }
  return csv + '\n';
}

}  // namespace excavplan
