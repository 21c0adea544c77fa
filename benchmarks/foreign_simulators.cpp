// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// What a dig costs where the simulator is in a shared library or in a program of its own, beside
/// the built-in ones: the mean and the least time of the fixed path on level ground.
///
///     foreign_simulators [--simulator FILE.so | --simulator-command COMMAND] ...

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <variant>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/foreign_simulators.hpp>

#include "simulation/foreign_dig.hpp"
#include "simulation/simulator_protocol.hpp"

using namespace excavplan;

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void time_digs(const SimulatorKind& kind, const Machine& machine, const SoilKind& soil,
               const Terrain& ground, const DigPath& path) {
  const auto simulator = kind.make(machine, soil, 40.0);
  double least = 1e300;
  double sum = 0.0;
  int digs = 0;
  for (const auto begin = Clock::now(); digs < 5 || milliseconds_since(begin) < 3000.0; ++digs) {
    const auto start = Clock::now();
    const DigResult dig = simulator->dig(ground, path);
    const double time = milliseconds_since(start);
    if (digs == 0) continue;  // starts a program
    least = std::min(least, time);
    sum += time;
  }
  std::printf("%-60s mean %8.3f ms, least %8.3f ms, %d digs\n", kind.name.c_str(), sum / (digs - 1),
              least, digs - 1);
}

}  // namespace

int main(int argc, char** argv) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind soil = load_soil(find_data_file("soils/loam.json"));
  const Terrain ground = level_planning_ground(machine);
  const auto path = std::get<DigPath>(
      make_dig_path_anywhere(machine, paper_fixed_path(), boom_plane_profile(ground)));
  const ForeignModel model(machine, soil, 40.0);
  const DigOptions options;
  const ForeignDig dig(model, ground, path, options);
  std::printf("window of %ld x %ld cells of %g m, %zu poses, request of %zu bytes\n",
              static_cast<long>(dig.bank().z.rows()), static_cast<long>(dig.bank().z.cols()),
              ground.bank.cell_size, path.poses.size(), dig_request(dig, 1).size());
  for (const SimulatorKind& kind : simulator_kinds()) time_digs(kind, machine, soil, ground, path);
  for (int i = 1; i + 1 < argc; i += 2) {
    const bool is_command = std::string(argv[i]) == "--simulator-command";
    time_digs(is_command ? command_simulator({argv[i + 1]}) : plugin_simulator(argv[i + 1]),
              machine, soil, ground, path);
  }
}
