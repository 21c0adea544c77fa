// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/machine_file.hpp"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

namespace excavplan::test {

std::string zx120_path() { return find_data_file("machines/zx120.json"); }

const Machine& zx120() {
  static const Machine machine = load_machine(zx120_path());
  return machine;
}

const SoilKind& loam() {
  static const SoilKind soil = load_soil(find_data_file("soils/loam.json"));
  return soil;
}

Machine zx120_held_down() {
  Machine machine = zx120();
  machine.body.reset();
  return machine;
}

std::string complaint_about_file(const nlohmann::json& file) {
  const std::string path = testing::TempDir() + "machine" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << file;
  const std::string complaint = error_about([&] { load_machine(path); }, path);
  std::remove(path.c_str());
  return complaint;
}

}  // namespace excavplan::test
