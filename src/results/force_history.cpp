// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/results/force_history.hpp>

#include <excavplan/machine/kinematics.hpp>

#include "base/text.hpp"
#include "results/dig_timing.hpp"

namespace excavplan {

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
