// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/scene_results.hpp"

#include "base/json.hpp"
#include "planning/dig_layout.hpp"
#include "planning/planned_digs.hpp"
#include "planning/simulated_dig.hpp"
#include "results/joint_loads.hpp"
#include "results/volume_results.hpp"

namespace excavplan {
namespace {

Json energy_json(const EnergyLedger& energy) {
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

Json soil_json(const SoilLedger& soil) {
  return {{"bank_cut_m3", soil.bank_cut},
          {"loose_cut_m3", soil.loose_cut},
          {"payload_m3", soil.payload},
          {"spilled_m3", soil.spilled},
          {"fallen_back_m3", soil.fallen_back}};
}

Json stall_json(const Stall& stall) {
  Json json = {{"phase", name(stall.phase)},
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
Json exact_volumes_json(const HeightMapVolumes& volumes) {
  VolumeChange exact;
  exact.excavated.value = volumes.excavated;
  exact.spilled.value = volumes.spilled;
  exact.dumped.value = volumes.dumped;
  exact.before.value = volumes.excavated;
  exact.after.value = volumes.spilled + volumes.dumped;
  return volumes_json(exact);
}

}  // namespace

PlannedDig dig_of(const Machine& machine, const DigScene& scene) {
  const DigResult& result = scene.dig;
  PlannedDig dig{scene.path.parameters, scene.path.start_x,  result.payload_mass,
                 result.payload_volume, result.energy.total, scene.duration};
  dig.fill = dig.payload_volume / heaped_capacity(machine);
  if (!result.stall) add_cycle(dig, machine, scene.path, {});
  return dig;
}

Json scene_json(const Machine& machine, const DigScene& scene) {
  const DigResult& dig = scene.dig;
  Json json = {{"density_percent", scene.density_percent}, {"soil", scene.soil}};
  json.update(dig_json(dig_of(machine, scene)));
  json.update({{"peak_force_kn", dig.peak_force / 1000.0},
               {"stalled", dig.stall.has_value()},
               {"stall", dig.stall ? stall_json(*dig.stall) : Json()},
               {"volume", exact_volumes_json(scene.volumes)},
               {"bulking_factor", scene.volumes.bulking_factor},
               {"bulking_factor_true", scene.bulking_factor_true},
               {"fallback_fraction", dig.soil.fallback_fraction},
               {"solids_before_kg", dig.soil.solids_before},
               {"solids_after_kg", dig.soil.solids_after},
               {"final_angle_of_repose_rad", heap_slope(scene.before, scene.after, scene.dump_at)},
               {"energy", energy_json(dig.energy)},
               {"joints", joint_loads_json(machine, joint_loads(machine, dig.history))},
               {"soil_ledger", soil_json(dig.soil)},
               {"dump_at_m", {scene.dump_at.x(), scene.dump_at.y()}},
               {"blocks", nullptr}});
  if (!scene.dumped) json["dump_at_m"] = nullptr;
  if (const auto& blocks = scene.blocks) {
    json["blocks"] = {
        {"count", blocks->count}, {"soil_m3", blocks->soil}, {"voids_m3", blocks->voids}};
  }
  return json;
}

}  // namespace excavplan
