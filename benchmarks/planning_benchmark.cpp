// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include "simulation/section_simulator.hpp"

namespace excavplan {
namespace {

const Machine& zx120() {
  static const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  return machine;
}

const SoilKind& loam() {
  static const SoilKind soil = load_soil(find_data_file("soils/loam.json"));
  return soil;
}

/// Digs in medium loam over and over.
template <typename Simulator>
void dig_repeatedly(benchmark::State& state, const Terrain& ground,
                    const DigParameters& parameters) {
  const auto path =
      make_dig_path_anywhere(zx120(), parameters, boom_plane_profile(ground.surface()));
  const Simulator simulator(zx120(), loam(), 40.0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(simulator.dig(ground, std::get<DigPath>(path)));
  }
  state.SetItemsProcessed(state.iterations());
}

/// The paper's fixed path; the argument is the cell in tenths of a millimetre.
template <typename Simulator>
void dig(benchmark::State& state) {
  const double cell = 1e-4 * static_cast<double>(state.range(0));
  dig_repeatedly<Simulator>(state, level_planning_ground(zx120(), cell), paper_fixed_path());
}
BENCHMARK(dig<HeightMapSimulator>)->Arg(500)->Arg(250)->Unit(benchmark::kMicrosecond);
BENCHMARK(dig<SectionSimulator>)->Arg(500)->Arg(250)->Unit(benchmark::kMicrosecond);

/// The same on ground so long and so wide: the size of the map should cost nothing.
void dig_on_ground(benchmark::State& state) {
  const auto length = static_cast<double>(state.range(0));
  const auto half_width = 0.5 * static_cast<double>(state.range(1));
  const Rectangle extent{2.5, -half_width, 2.5 + length, half_width};
  dig_repeatedly<HeightMapSimulator>(state, undisturbed(flat_ground(extent, 0.05)),
                                     paper_fixed_path());
}
BENCHMARK(dig_on_ground)
    ->ArgNames({"length_m", "width_m"})
    ->Args({6, 3})
    ->Args({60, 30})
    ->Unit(benchmark::kMicrosecond);

/// Digs per wall clock, all threads together.
void dig_in_threads(benchmark::State& state) {
  dig_repeatedly<HeightMapSimulator>(state, level_planning_ground(zx120()), paper_fixed_path());
}
BENCHMARK(dig_in_threads)->Threads(1)->Threads(2)->UseRealTime()->Unit(benchmark::kMicrosecond);

/// Cuts twice what the bucket holds; the argument is the cell in tenths of a millimetre.
template <typename Simulator>
void dig_overfull(benchmark::State& state) {
  const double cell = 1e-4 * static_cast<double>(state.range(0));
  dig_repeatedly<Simulator>(state, level_planning_ground(zx120(), cell),
                            {0.7853981633974483, 0.6, 2.5});
}
BENCHMARK(dig_overfull<HeightMapSimulator>)
    ->Arg(1000)
    ->Arg(500)
    ->Arg(250)
    ->Arg(125)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(dig_overfull<SectionSimulator>)->Arg(500)->Unit(benchmark::kMicrosecond);

void lay_out_dig_anywhere(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        make_dig_path_anywhere(zx120(), paper_fixed_path(), [](double) { return 0.0; }));
  }
}
BENCHMARK(lay_out_dig_anywhere)->Unit(benchmark::kMicrosecond);

void look_up_in_the_library(benchmark::State& state) {
  const PathLibrary library = load_path_library(find_data_file("libraries/zx120-loam-energy.json"));
  for (auto _ : state) benchmark::DoNotOptimize(look_up(library, 42.0));
}
BENCHMARK(look_up_in_the_library);

}  // namespace
}  // namespace excavplan
