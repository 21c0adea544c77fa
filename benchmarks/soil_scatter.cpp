// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// How often the density interval holds the truth where soil, moisture and path vary
// (docs/validation.md#density-in-soils-that-vary): digs of both simulators in soils drawn about
// their kind, along drawn paths, volumes known to 0.5 %, payload to 1 %.
//   build/bin/soil_scatter [DIGS]    digs of each kind of soil and simulator, 100

#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include <excavplan/data_files.hpp>

#include "support/soil_digs.hpp"

namespace excavplan {
namespace {

using test::Coverage;
using test::SoilDig;

struct Knowledge {
  const char* text;
  bool soil;
  bool path;
  bool payload;
  bool moisture;
  bool void_ratios;
};
constexpr std::array<Knowledge, 7> cases = {
    {{"soil unknown", false, false, false, false, false},
     {"soil known", true, false, false, false, false},
     {"soil and path known", true, true, false, false, false},
     {"payload, soil unknown", false, false, true, false, false},
     {"payload, soil known", true, false, true, false, false},
     {"payload, moisture known", true, false, true, true, false},
     {"payload, moisture, void ratios known", true, false, true, true, true}}};

RelativeDensity found(const SoilDig& dig, const SoilLaw& kind, const Knowledge& known,
                      const Machine& machine, const std::vector<SoilLaw>& laws) {
  DensityOptions options;
  options.threads = 1;
  options.soil.kind = kind.soil;
  options.soil.unknown = !known.soil;
  if (!known.soil) options.soil.possible = laws;
  if (known.path) options.dug_path = DugPath{machine, dig.path, {}};
  if (known.payload) options.payload_mass = dig.payload_mass;
  if (known.moisture) options.soil.water_content = {dig.soil.water_content, 0.005};
  if (known.void_ratios) options.soil.scatter.limit_density = 0.0;
  return *test::estimate_of(dig.change, kind.law, options).density;
}

void print(const std::string& name, const Coverage& coverage) {
  std::printf("%-46s %5d digs  inside %5.1f %%  rms %5.2f  stated sd %5.2f points\n", name.c_str(),
              coverage.digs, 100.0 * coverage.share(), coverage.rms(), coverage.mean_sd());
}

int run(int digs) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const std::vector<SoilLaw> laws = shipped_soil_laws();
  for (const Knowledge& known : cases) {
    std::map<std::string, Coverage> rows;
    std::uint64_t seed = 0;
    for (const SimulatorKind& simulator : simulator_kinds()) {
      test::SoilDigOptions options;
      options.simulator = simulator;
      if (known.void_ratios) options.scatter.limit_density = 0.0;
      for (const SoilLaw& kind : laws) {
        // Where the soil is unknown, as many as its weight says; of costly laws, a third.
        const double share = !known.soil ? kind.weight * 4.0 : known.path ? 1.0 / 3.0 : 1.0;
        for (int i = 0; i < share * digs; ++i) {
          const SoilDig dig = test::random_dig(machine, kind.soil, seed++, options);
          const RelativeDensity density = found(dig, kind, known, machine, laws);
          const std::string third = dig.density_percent < 100.0 / 3.0   ? "0-33 %"
                                    : dig.density_percent < 200.0 / 3.0 ? "33-67 %"
                                                                        : "67-100 %";
          for (const std::string& row :
               {std::string(" all"), " " + simulator.word, " " + kind.soil.name, " " + third}) {
            rows[row].add(density, dig.density_percent);
          }
        }
      }
    }
    for (const auto& [row, coverage] : rows) print(known.text + row, coverage);
  }
  return 0;
}

}  // namespace
}  // namespace excavplan

int main(int argc, char** argv) { return excavplan::run(argc > 1 ? std::atoi(argv[1]) : 100); }
