// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Digs at random in the four soils and prints how near any of them came to the bound of the energy
/// (docs/methods.md#energy). Also what a dig costs, in full and as a search asks for it.
///
///     random_digs [number] [seed]

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <numeric>
#include <thread>
#include <variant>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/dig_search.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include "base/random.hpp"
#include "simulation/section_simulator.hpp"
#include "support/energy_bound.hpp"

namespace excavplan {
namespace {

struct Tally {
  long digs = 0;
  long stalls = 0;
  long infeasible = 0;
  double nearest = 0.0;       ///< largest share of lifting; above 1 energy would come from nowhere
  double worst_solids = 0.0;  ///< largest relative error of the dry mass
  std::vector<double> times;  ///< of every simulation, on the processor [s]
};

double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

class RandomDigs {
 public:
  explicit RandomDigs(std::uint64_t seed) : seed_(seed) {}

  template <typename Simulator>
  Tally run(long number, const DigOptions& options = {}) {
    std::vector<Simulator> simulators;
    for (const SoilKind& soil : soils_) {
      for (int d = 0; d <= 100; d += 5) simulators.emplace_back(machine_, soil, d);
    }
    Tally tally;
    std::atomic<long> next{0};
    std::mutex mutex;
    const auto work = [&] {
      Tally mine;
      for (long i = next++; i < number; i = next++) {
        dig(simulators, static_cast<std::uint64_t>(i), options, mine);
      }
      const std::lock_guard<std::mutex> lock(mutex);
      tally.digs += mine.digs;
      tally.stalls += mine.stalls;
      tally.infeasible += mine.infeasible;
      tally.nearest = std::max(tally.nearest, mine.nearest);
      tally.worst_solids = std::max(tally.worst_solids, mine.worst_solids);
      tally.times.insert(tally.times.end(), mine.times.begin(), mine.times.end());
    };
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t) {
      threads.emplace_back(work);
    }
    for (std::thread& thread : threads) thread.join();
    return tally;
  }

 private:
  /// Draws until the machine can drive the path, then digs it.
  template <typename Simulator>
  void dig(const std::vector<Simulator>& simulators, std::uint64_t index, const DigOptions& options,
           Tally& tally) const {
    Random random(seed_, index);
    while (true) {
      const auto which =
          static_cast<std::size_t>(random.uniform() * static_cast<double>(simulators.size()));
      DigParameters parameters;
      for (const DigParameterInfo& info : dig_parameter_table()) {
        parameters.*info.field =
            random.uniform(bounds_.lower.*info.field, bounds_.upper.*info.field);
      }
      const auto path =
          make_dig_path(machine_, parameters, random.uniform(3.5, 7.5), [](double) { return 0.0; });
      if (!std::holds_alternative<DigPath>(path)) {
        ++tally.infeasible;
        continue;
      }
      const double begin = processor_time();
      const DigResult result = simulators[which].dig(ground_, std::get<DigPath>(path), options);
      tally.times.push_back(processor_time() - begin);
      const SoilLedger& soil = result.soil;
      tally.worst_solids =
          std::max(tally.worst_solids, std::abs(soil.solids_after / soil.solids_before - 1.0));
      if (result.stall) {
        ++tally.stalls;
        continue;
      }
      tally.nearest = std::max(tally.nearest,
                               test::share_of_lifting(machine_, std::get<DigPath>(path), result));
      ++tally.digs;
      return;
    }
  }

  std::uint64_t seed_;
  Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  DigBounds bounds_ = machine_bounds(machine_);
  std::vector<SoilKind> soils_ = {
      load_soil(find_data_file("soils/loam.json")), load_soil(find_data_file("soils/sand.json")),
      load_soil(find_data_file("soils/clay.json")), load_soil(find_data_file("soils/gravel.json"))};
  Terrain ground_ = level_planning_ground(machine_);
};

void print(const char* name, Tally tally) {
  std::printf(
      "%-20s %ld digs (%ld paths not drivable, %ld stalled): largest share of lifting %.4f, "
      "dry mass within %.1e\n",
      name, tally.digs, tally.infeasible, tally.stalls, tally.nearest, tally.worst_solids);
  if (tally.times.empty()) return;
  std::vector<double>& times = tally.times;
  std::sort(times.begin(), times.end());
  const double sum = std::accumulate(times.begin(), times.end(), 0.0);
  std::printf("    ms a dig: mean %.3f, median %.3f, 99th percentile %.3f, slowest %.3f\n",
              1e3 * sum / static_cast<double>(times.size()), 1e3 * times[times.size() / 2],
              1e3 * times[times.size() * 99 / 100], 1e3 * times.back());
}

}  // namespace
}  // namespace excavplan

int main(int argc, char** argv) {
  using namespace excavplan;
  const long number = argc > 1 ? std::atol(argv[1]) : 100000;
  RandomDigs digs(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
  print("SectionSimulator", digs.run<SectionSimulator>(number));
  print("HeightMapSimulator", digs.run<HeightMapSimulator>(number));
  DigOptions options;
  options.settle = false;
  print("... unsettled", digs.run<HeightMapSimulator>(number, options));
  options.give_up_below = 0.01;
  print("... or 0.01 kg/J", digs.run<HeightMapSimulator>(number, options));
}
