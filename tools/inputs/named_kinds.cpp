// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/named_kinds.hpp"

#include <excavplan/base/data_files.hpp>
#include <excavplan/kit/kit_files.hpp>

namespace excavplan::tools {

SoilKind soil_named(const std::string& name_or_path) {
  return load_soil(shipped_or_file("soils", name_or_path));
}

Machine machine_named(const std::string& name_or_path) {
  return load_machine(machine_path(name_or_path));
}

}  // namespace excavplan::tools
