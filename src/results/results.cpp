// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/results.hpp"

#include <utility>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"
#include "machine/dig_path_text.hpp"
#include "planning/dig_layout.hpp"
#include "results/joint_loads.hpp"
#include "frame/quantity.hpp"

namespace excavplan {
namespace {

nlohmann::ordered_json energy_json(const EnergyLedger& energy) {
  const auto kj = [](double joule) { return joule / 1000.0; };
  return {{"by_phase_kj",
           {{"penetrate", kj(energy.by_phase[0])},
            {"drag", kj(energy.by_phase[1])},
            {"scoop", kj(energy.by_phase[2])}}},
          {"by_joint_kj",
           {{"boom", kj(energy.by_joint[0])},
            {"arm", kj(energy.by_joint[1])},
            {"bucket", kj(energy.by_joint[2])}}},
          {"by_cause_kj",
           {{"soil", kj(energy.soil)},
            {"edge", kj(energy.edge)},
            {"payload", kj(energy.payload)},
            {"links", kj(energy.links)}}},
          {"lift_kj", kj(energy.lift)}};
}

nlohmann::ordered_json soil_json(const SoilLedger& soil) {
  return {{"bank_cut_m3", soil.bank_cut},
          {"loose_cut_m3", soil.loose_cut},
          {"payload_m3", soil.payload},
          {"spilled_m3", soil.spilled},
          {"fallen_back_m3", soil.fallen_back}};
}

nlohmann::ordered_json stall_json(const Stall& stall) {
  nlohmann::ordered_json json = {{"phase", name(stall.phase)},
                                 {"joint", nullptr},
                                 {"travelled_m", stall.travelled},
                                 {"torque_nm", nullptr},
                                 {"cause", name(stall.cause)}};
  if (stall.cause == Stall::Cause::torque) {
    json["joint"] = name(stall.joint);
    json["torque_nm"] = stall.torque;
  }
  return json;
}

/// Volumes of height maps, which have no error.
nlohmann::ordered_json exact_volumes_json(const HeightMapVolumes& volumes) {
  VolumeChange exact;
  exact.excavated.value = volumes.excavated;
  exact.spilled.value = volumes.spilled;
  exact.dumped.value = volumes.dumped;
  exact.before.value = volumes.excavated;
  exact.after.value = volumes.spilled + volumes.dumped;
  return volumes_json(exact);
}

PlannedDig dig_of(const Machine& machine, const DigScene& scene) {
  const DigResult& result = scene.dig;
  PlannedDig dig{scene.path.parameters, scene.path.start_x,  result.payload_mass,
                 result.payload_volume, result.energy.total, scene.duration};
  dig.fill = dig.payload_volume / heaped_capacity(machine);
  if (!result.stall) add_cycle(dig, machine, scene.path, {});
  return dig;
}

}  // namespace

nlohmann::ordered_json volumes_json(const VolumeChange& change) {
  auto json = nlohmann::ordered_json::object();
  const auto add = [&](const char* name, const Measured& volume) {
    json[std::string(name) + "_m3"] = volume.value;
    json[std::string(name) + "_sd_m3"] = volume.sd;
  };
  add("excavated", change.excavated);
  add("spilled", change.spilled);
  add("dumped", change.dumped);
  add("before", change.before);
  add("after", change.after);
  return json;
}

std::string path_text(const PlannedDig& dig) {
  return excavplan::path_text(dig.parameters, dig.start_x);
}

std::vector<std::string> dig_lines(const PlannedDig& dig, const DigSpread& spread) {
  const double mass = dig.payload_mass;
  const auto of_cycle = [&](double value, const std::string& unit) {
    return " " + unit +
           (dig.cycle_time > 0.0 ? ", of the cycle " + readable(value) + " " + unit : "");
  };
  return {"path         " + path_text(dig),
          "payload      " + readable(mass, spread.payload_mass) + " kg, " +
              readable(dig.payload_volume) + " m3 loose, " + readable(100.0 * dig.fill) +
              " % of the heaped capacity",
          "energy       " + readable(dig.energy / 1000.0, spread.energy / 1000.0) +
              of_cycle(dig.cycle_energy / 1000.0, "kJ"),
          "efficiency   " + readable(1000.0 * dig.efficiency(), 1000.0 * spread.efficiency) +
              of_cycle(1000.0 * mass / dig.cycle_energy, "kg/kJ"),
          "duration     " + readable(dig.duration) + of_cycle(dig.cycle_time, "s"),
          "rate         " + readable(3.6 * mass / dig.duration) +
              of_cycle(3.6 * mass / dig.cycle_time, "t/h")};
}

nlohmann::ordered_json scene_json(const Machine& machine, const DigScene& scene) {
  const DigResult& dig = scene.dig;
  nlohmann::ordered_json json = {{"density_percent", scene.density_percent}, {"soil", scene.soil}};
  json.update(dig_json(dig_of(machine, scene)));
  json.update({{"peak_force_kn", dig.peak_force / 1000.0},
               {"stalled", dig.stall.has_value()},
               {"stall", dig.stall ? stall_json(*dig.stall) : nlohmann::ordered_json()},
               {"volume", exact_volumes_json(scene.volumes)},
               {"bulking_factor", scene.volumes.bulking_factor},
               {"bulking_factor_true", scene.bulking_factor_true},
               {"fallback_fraction", dig.soil.fallback_fraction},
               {"solids_before_kg", dig.soil.solids_before},
               {"solids_after_kg", dig.soil.solids_after},
               {"final_angle_of_repose_rad", heap_slope(scene.before, scene.after, scene.dump_at)},
               {"energy", energy_json(dig.energy)},
               {"joints", to_json(machine, joint_loads(machine, dig.history))},
               {"soil_ledger", soil_json(dig.soil)},
               {"dump_at_m", {scene.dump_at.x(), scene.dump_at.y()}},
               {"blocks", nullptr}});
  if (const auto& blocks = scene.blocks) {
    json["blocks"] = {
        {"count", blocks->count}, {"soil_m3", blocks->soil}, {"voids_m3", blocks->voids}};
  }
  return json;
}

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

std::vector<Warning> unlike_law(const DensityLaw& law, const std::string& machine,
                                const std::string& soil) {
  std::vector<Warning> warnings;
  const std::string measured = "the law '" + law.name + "' was measured on digs ";
  if (!law.machine.empty() && law.machine != machine) {
    warnings.push_back(
        {"law_of_other_machine", measured + "of " + law.machine + ", not of " + machine +
                                     ": how much soil falls back into the cut may differ; "
                                     "calibrate-density makes a law for a machine"});
  }
  if (!soil.empty() && !law.soil.empty() && law.soil != soil) {
    warnings.push_back({"law_of_other_soil", measured + "in " + law.soil + ", not in " + soil +
                                                 ": the estimated densities are biased"});
  }
  return warnings;
}

std::vector<double> parse_densities(const std::string& what, const std::string& text) {
  std::vector<double> densities = parse_series(what, text, Quantity::percent);
  for (const double density : densities) {
    if (density >= 0.0 && density <= 100.0) continue;
    throw Error(ErrorKind::bad_input,
                what + ": " + number_text(density) + " % is outside 0 .. 100");
  }
  return densities;
}

}  // namespace excavplan
