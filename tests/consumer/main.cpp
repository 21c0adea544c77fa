// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include <excavplan/data_files.hpp>
#include <excavplan/error.hpp>
#include <excavplan/planning/planner.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

int main() {
  using namespace excavplan;
  try {
    const Machine machine = load_machine(find_data_file("machines/zx120.json"));
    const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
    const HeightMapSimulator simulator(machine, loam, 40.0);

    DigSearchOptions options;
    options.genetic.population = 10;  // a quick search; the defaults find more
    options.genetic.generations = 3;
    const auto found = search_dig(machine, simulator, level_planning_ground(machine, 0.1), options);
    if (!found) {
      std::printf("no dig is feasible\n");
      return 1;
    }
    std::printf("start at %.2f m, lift %.0f kg for %.1f kJ\n", found->dig.start_x,
                found->dig.payload_mass, found->dig.energy / 1000.0);
  } catch (const Error& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
