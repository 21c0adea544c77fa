// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Counts what a dig takes from the heap: a program of its own, because it replaces operator new.

#include <atomic>
#include <cstdlib>
#include <new>
#include <variant>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include "simulation/section_simulator.hpp"

namespace {
std::atomic<long> allocations{0};
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace excavplan {
namespace {

template <typename Simulator>
long allocations_of_a_dig(double step) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind soil = load_soil(find_data_file("soils/loam.json"));
  const Terrain ground = level_planning_ground(machine);
  DigPathOptions options;
  options.step = step;
  const auto path = make_dig_path(
      machine, paper_fixed_path(), 6.0, [](double) { return 0.0; }, options);
  const Simulator simulator(machine, soil, 70.0);
  const long before = allocations;
  simulator.dig(ground, std::get<DigPath>(path));
  return allocations - before;
}

TEST(Allocations, DoNotGrowWithTheStepsOfADig) {
  EXPECT_GT(allocations_of_a_dig<HeightMapSimulator>(0.025), 0);  // the counter counts
  EXPECT_EQ(allocations_of_a_dig<HeightMapSimulator>(0.025),
            allocations_of_a_dig<HeightMapSimulator>(0.005));
  // Vectors that double: two more for five times the steps.
  EXPECT_LE(allocations_of_a_dig<SectionSimulator>(0.005),
            allocations_of_a_dig<SectionSimulator>(0.025) + 4);
}

}  // namespace
}  // namespace excavplan
