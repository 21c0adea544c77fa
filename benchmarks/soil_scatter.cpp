// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// How often the density interval holds the truth where soil, moisture and path vary
// (docs/validation.md#density-in-soils-that-vary): digs in soils drawn about their kind, along
// drawn paths, volumes known to 0.5 %, payload to 1 %; then digs beyond what was assumed of soil
// and path.
//   build/bin/soil_scatter [DIGS]    digs of each kind of soil and condition, twice of loam; 60

#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include <excavplan/base/data_files.hpp>

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
    {{"nothing", false, false, false, false, false},
     {"soil", true, false, false, false, false},
     {"soil, path", true, true, false, false, false},
     {"payload", false, false, true, false, false},
     {"payload, soil", true, false, true, false, false},
     {"payload, soil, moisture", true, false, true, true, false},
     {"payload, soil, moisture, void ratios", true, false, true, true, true}}};

struct Condition {
  const char* text;
  const char* simulator;  ///< word of it
  test::SoilDigOptions digs = {};
  bool assumed = false;  ///< it is what the laws assume
};

std::vector<Condition> conditions() {
  std::vector<Condition> all = {{"height-map", "height-map", {}, true},
                                {"section", "section", {}, true},
                                {"void ratios measured", "section", {}, true},
                                {"moisture +0.02", "section"},
                                {"moisture -0.02", "section"},
                                {"particles +0.03 Mg/m3", "section"},
                                {"particles -0.03 Mg/m3", "section"},
                                {"soils scatter twice", "section"},
                                {"other paths, height-map", "height-map"},
                                {"other paths, section", "section"},
                                {"all of it, section", "section"}};
  for (Condition& each : all) each.digs.simulator = simulator_of_word(each.simulator);
  all[2].digs.scatter.limit_density = 0.0;
  all[3].digs.more_water = 0.02;
  all[4].digs.more_water = -0.02;
  all[5].digs.more_particle_density = 0.03;
  all[6].digs.more_particle_density = -0.03;
  for (const std::size_t i : {7U, 10U}) {
    SoilScatter& scatter = all[i].digs.scatter;
    scatter = {2.0 * scatter.water_content, 2.0 * scatter.limit_density,
               2.0 * scatter.loose_density};
  }
  for (const std::size_t i : {8U, 9U, 10U}) all[i].digs.path_outside = true;
  all[10].digs.more_water = 0.02;
  all[10].digs.more_particle_density = 0.03;
  return all;
}

bool applies(const Knowledge& known, const Condition& condition) {
  if (known.void_ratios != (condition.digs.scatter.limit_density == 0.0)) return false;
  return condition.assumed || !known.path;
}

RelativeDensity found(const SoilDig& dig, const SoilLaw& kind, const Knowledge& known,
                      double more_water, const std::vector<SoilLaw>& laws) {
  static const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  DensityOptions options;
  options.threads = 1;
  options.soil.kind = kind.soil;
  options.soil.unknown = !known.soil;
  if (!known.soil) options.soil.possible = laws;
  if (known.path) options.dug_path = DugPath{machine, dig.path, {}};
  if (known.payload) options.payload_mass = dig.payload_mass;
  if (known.moisture) {
    options.soil.water_content = {std::max(0.0, dig.soil.water_content - more_water), 0.005};
  }
  if (known.void_ratios) options.soil.scatter.limit_density = 0.0;
  return *test::estimate_of(dig.change, kind.law, options).density;
}

std::string third_of(double density) {
  return density < 100.0 / 3.0 ? "0-33 %" : density < 200.0 / 3.0 ? "33-67 %" : "67-100 %";
}

void measure(const Condition& condition, int digs) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const std::vector<SoilLaw> laws = shipped_soil_laws();
  std::map<std::string, Coverage> rows;
  std::uint64_t seed = 20000;
  for (const SoilLaw& kind : laws) {
    const int of_kind = kind.soil.name == "loam" ? 2 * digs : digs;  // by the weights
    for (int i = 0; i < of_kind; ++i) {
      const SoilDig dig = test::random_dig(machine, kind.soil, seed++, condition.digs);
      for (const Knowledge& known : cases) {
        if (!applies(known, condition) || (known.path && i % 6 != 0)) continue;
        const RelativeDensity density = found(dig, kind, known, condition.digs.more_water, laws);
        const std::string name = std::string(condition.text) + " | " + known.text;
        for (const std::string& row :
             {name, name + " | " + kind.soil.name, name + " | " + third_of(dig.density_percent)}) {
          rows[row].add(density, dig.density_percent);
        }
      }
    }
  }
  for (const auto& [row, coverage] : rows) {
    std::printf("%-62s %5d digs  inside %5.1f %%  rms %5.2f  stated sd %5.2f points\n", row.c_str(),
                coverage.digs, 100.0 * coverage.share(), coverage.rms(), coverage.mean_sd());
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace excavplan

int main(int argc, char** argv) {
  for (const excavplan::Condition& condition : excavplan::conditions()) {
    excavplan::measure(condition, argc > 1 ? std::atoi(argv[1]) : 60);
  }
  return 0;
}
