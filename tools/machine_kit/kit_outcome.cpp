// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine_kit/kit_outcome.hpp"

#include <excavplan/kit/kit_files.hpp>
#include <excavplan/kit/workspace.hpp>

#include "base/files.hpp"
#include "base/text.hpp"
#include "inputs/named_kinds.hpp"
#include "results/dig_lines.hpp"
#include "results/kit_results.hpp"

namespace excavplan::tools {

Outcome examined(const MachineFile& file, const std::string& folder) {
  const Machine& machine = file.machine;
  const Reach reach = reach_of(machine);
  Outcome outcome;
  outcome.warnings = file.warnings;
  for (Warning& each : check_machine(machine, file.data_sheet)) {
    outcome.trustworthy = outcome.trustworthy && !each.ends_trust;
    outcome.warnings.push_back(std::move(each));
  }
  outcome.json = examined_json(machine, folder);
  outcome.lines = {machine.name + ": reaches " + readable(reach.ground) + " m on the ground, " +
                       readable(reach.depth) + " m deep, " + readable(reach.height) + " m high",
                   "digging force: bucket " + readable(1e-3 * bucket_force(machine)) + " kN, arm " +
                       readable(1e-3 * arm_force(machine)) + " kN; bucket holds " +
                       readable(heaped_capacity(machine)) + " m3 heaped"};
  return outcome;
}

std::vector<SoilKind> soils_named(const std::string& list) {
  std::vector<SoilKind> soils;
  for (const std::string& name : split(list, ',')) soils.push_back(soil_named(name));
  return soils;
}

void add_kit(const KitSoil& kit, const Machine& machine, const SoilKind& soil,
             const std::string& folder, Outcome& outcome) {
  const std::string law = law_file(machine.name, soil.name);
  make_folder(folder + "/laws");
  write_file(folder + "/" + law, to_json(kit.law));
  if (kit.library.entries.empty()) {
    outcome.trustworthy = false;
    outcome.warnings.emplace_back(WarningCode::no_library,
                                  soil.name + ": there is no library: " + kit.reason);
    outcome.json["soils"].push_back(kit_json(soil, law, kit.library, {}));
    return;
  }
  const std::string library = "libraries/" + file_name(kit.library);
  make_folder(folder + "/libraries");
  write_file(folder + "/" + library, to_json(kit.library));
  const PathLibraryEntry& entry = shown_entry(kit.library);
  outcome.json["soils"].push_back(kit_json(soil, law, kit.library, library));
  outcome.lines.push_back(soil.name + ": " + std::to_string(kit.library.entries.size()) +
                          " digs; at " + readable(entry.density_percent) +
                          " %: " + path_text(entry.dig) + ", " + readable(entry.dig.payload_mass) +
                          " kg, " + readable(100.0 * entry.dig.fill, 2) + " % full, " +
                          readable(1e-3 * entry.dig.energy) + " kJ, " +
                          readable(entry.dig.duration, 2) + " s");
}

}  // namespace excavplan::tools
