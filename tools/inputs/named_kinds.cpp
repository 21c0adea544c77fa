// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/named_kinds.hpp"

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/kit/kit_files.hpp>

namespace excavplan::tools {

SoilKind soil_named(const std::string& name_or_path) {
  return load_soil(shipped_or_file("soils", name_or_path));
}

Machine machine_named(const std::string& name_or_path) {
  return load_machine(machine_path(name_or_path));
}

std::string law_path(const std::string& machine_word, const Machine& machine,
                     const std::string& soil) {
  if (const auto kit = kit_law(machine_word, machine, soil)) return *kit;
  try {
    return find_data_file(law_file(machine.name, soil));
  } catch (const Error&) {
    return {};
  }
}

DensityLaw law_in(const std::string& path, const SoilKind& soil) {
  return path.empty() ? density_law_of(soil) : load_density_law(path);
}

}  // namespace excavplan::tools
