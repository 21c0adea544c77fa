// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_dig/scene_lines.hpp"

#include "base/text.hpp"
#include "results/dig_lines.hpp"
#include "results/joint_loads.hpp"
#include "results/scene_results.hpp"

namespace excavplan::tools {
namespace {

std::string cylinder_text(const Cylinder& cylinder, const CylinderUse& use) {
  const std::string times =
      cylinder.count() == 1 ? std::string() : std::to_string(cylinder.count()) + " x ";
  return times + readable(use.peak_force / 1000.0) + " kN over " +
         readable(100.0 * stroke_share(cylinder, use)) + " %";
}

/// A line of torques and, where there are cylinders, one of theirs.
std::vector<std::string> load_lines(const Machine& machine, const JointLoads& loads) {
  std::string torques = "peak torque  ";
  std::string cylinders = "cylinders    ";
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::string joint = (i == 0 ? "" : ", ") + std::string(name(joint_order[i])) + " ";
    torques += joint + readable(loads[i].peak_torque / 1000.0) + " of " +
               readable(machine.limits[i].torque / 1000.0);
    if (loads[i].cylinder) {
      cylinders += joint + cylinder_text((*machine.cylinders)[i], *loads[i].cylinder);
    }
  }
  std::vector<std::string> lines = {torques + " kN m"};
  if (loads[0].cylinder) lines.push_back(cylinders + " of the stroke");
  return lines;
}

}  // namespace

std::vector<std::string> scene_lines(const Machine& machine, const DigScene& scene) {
  const DigResult& dig = scene.dig;
  const HeightMapVolumes& volumes = scene.volumes;
  const auto kilo = [](double value) { return readable(value / 1000.0); };
  std::vector<std::string> lines = dig_lines(dig_of(machine, scene));
  const std::string shares = "  of which   soil " + kilo(dig.energy.soil) + " (lip and teeth " +
                             kilo(dig.energy.edge) + "), payload " + kilo(dig.energy.payload) +
                             ", links " + kilo(dig.energy.links) + " kJ";
  lines.insert(lines.begin() + 3, shares);  // below the energy
  lines.push_back("peak force   " + kilo(dig.peak_force) + " kN");
  for (std::string& line : load_lines(machine, joint_loads(machine, dig.history))) {
    lines.push_back(std::move(line));
  }
  lines.push_back("volumes      hole " + readable(volumes.excavated) + ", spill " +
                  readable(volumes.spilled) + ", heap " + readable(volumes.dumped) + " m3");
  lines.push_back("bulking      " + readable(volumes.bulking_factor, 4) +
                  " from the height maps, " + readable(scene.bulking_factor_true, 4) +
                  " by dry mass, fallback " + readable(100.0 * dig.soil.fallback_fraction) + " %");
  if (const auto& blocks = scene.blocks) {
    lines.push_back("blocks       " + std::to_string(blocks->count) + ", with fines " +
                    readable(blocks->soil) + " m3, voids " + readable(blocks->voids) + " m3");
  }
  return lines;
}

}  // namespace excavplan::tools
