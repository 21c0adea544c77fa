// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <excavplan/data_files.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include <excavplan/simulation/section_simulator.hpp>

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

/// The paper's fixed path; the argument is the cell in tenths of a millimetre.
template <typename Simulator>
void dig(benchmark::State& state) {
  const Terrain ground = level_planning_ground(zx120(), 1e-4 * static_cast<double>(state.range(0)));
  const auto path =
      make_dig_path_anywhere(zx120(), paper_fixed_path(), boom_plane_profile(ground.surface()));
  const Simulator simulator(zx120(), loam(), 40.0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(simulator.dig(ground, std::get<DigPath>(path)));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(dig<HeightMapSimulator>)->Arg(500)->Arg(250)->Unit(benchmark::kMicrosecond);
BENCHMARK(dig<SectionSimulator>)->Arg(500)->Arg(250)->Unit(benchmark::kMicrosecond);

void lay_out_dig_anywhere(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        make_dig_path_anywhere(zx120(), paper_fixed_path(), [](double) { return 0.0; }));
  }
}
BENCHMARK(lay_out_dig_anywhere)->Unit(benchmark::kMicrosecond);

void closed_form_inverse_kinematics(benchmark::State& state) {
  const BucketPose pose{5.0, -0.3, 0.5};
  for (auto _ : state) benchmark::DoNotOptimize(inverse_kinematics(zx120(), pose));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(closed_form_inverse_kinematics);

void look_up_in_the_library(benchmark::State& state) {
  const PathLibrary library = load_path_library(find_data_file("libraries/zx120-loam.json"));
  for (auto _ : state) benchmark::DoNotOptimize(look_up(library, 42.0));
}
BENCHMARK(look_up_in_the_library);

}  // namespace
}  // namespace excavplan
