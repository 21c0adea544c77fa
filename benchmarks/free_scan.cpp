// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// How near plans by search come to the best dig there is: four soils of three densities, slopes of
/// -15, 0 and 15 deg and the pit of three digs. The best dig is the best of random ones, from any
/// start, of searches with five times the budget, and of the searches that are judged.
///
///     free_scan [random digs a scene] [seeds] [goal]

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/dig_search.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include "base/angles.hpp"
#include "base/random.hpp"
#include "planning/dig_layout.hpp"
#include "planning/simulated_dig.hpp"

namespace excavplan {
namespace {

struct Scene {
  std::string name;
  const Machine& machine;
  const SoilKind& soil;
  double density;
  Terrain ground;
};

/// Ground that is level under the machine and rises ahead of it.
Terrain slope(const Machine& machine, double angle) {
  Terrain ground = level_planning_ground(machine);
  for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
    ground.bank.z.col(col) =
        std::tan(angle) * std::max(0.0, ground.bank.x(col) - machine.track_front);
  }
  return ground;
}

/// What three digs of a search leave.
Terrain pit(const Machine& machine, const SoilKind& soil, double density,
            const DigSearchOptions& options) {
  Terrain ground = level_planning_ground(machine);
  const HeightMapSimulator simulator(machine, soil, density);
  for (int i = 0; i < 3; ++i) {
    const auto found = search_dig(machine, simulator, ground, options);
    if (found) apply(simulator.dig(ground, found->path).patch, ground);
  }
  return ground;
}

class FreeScan {
 public:
  FreeScan(long random_digs, int seeds, DigObjective::Goal goal)
      : random_digs_(random_digs), seeds_(seeds) {
    options_ = budget_search();
    options_.objective = goal;
  }

  const DigSearchOptions& options() const { return options_; }

  void judge(const Scene& scene) {
    const HeightMapSimulator simulator(scene.machine, scene.soil, scene.density);
    std::vector<double> ranks;
    for (int seed = 1; seed <= seeds_; ++seed) {
      ranks.push_back(planned(scene, static_cast<std::uint64_t>(seed)));
    }
    double best =
        std::max(*std::max_element(ranks.begin(), ranks.end()), best_of_random(scene, simulator));
    for (std::uint64_t seed = 101; seed < 104; ++seed) {
      best = std::max(best, searched(scene, simulator, seed, 5));
    }
    std::sort(ranks.begin(), ranks.end());
    for (const double rank : ranks) losses_.push_back(1.0 - rank / best);
    const auto good =
        std::count_if(ranks.begin(), ranks.end(), [&](double rank) { return rank >= 0.99 * best; });
    std::printf("%-44s %2ld of %d within 1 %%, worst %5.1f %%, median %5.1f %%\n",
                scene.name.c_str(), good, seeds_, 100.0 * ranks.front() / best,
                100.0 * ranks[ranks.size() / 2] / best);
    std::fflush(stdout);
  }

  void print() {
    std::sort(losses_.begin(), losses_.end());
    const auto within = [&](double most) {
      return 100.0 *
             static_cast<double>(std::upper_bound(losses_.begin(), losses_.end(), most) -
                                 losses_.begin()) /
             static_cast<double>(losses_.size());
    };
    std::printf(
        "%zu plans: within 1 %% %.1f %%, within 3 %% %.1f %%, median loss %.2f %%, worst %.1f %%\n",
        losses_.size(), within(0.01), within(0.03), 100.0 * losses_[losses_.size() / 2],
        100.0 * losses_.back());
  }

 private:
  /// As plan-path --search.
  double planned(const Scene& scene, std::uint64_t seed) const {
    PlanOptions options;
    options.method = PlanMethod::search;
    options.search = options_;
    options.search.seed = seed;
    const DigPlan plan =
        plan_dig(scene.machine, scene.soil, GroundDensity(scene.density), scene.ground, options);
    return plan.dig ? options_.objective.rank(*plan.dig) : 0.0;
  }

  double searched(const Scene& scene, const SoilSimulator& simulator, std::uint64_t seed,
                  int budgets) const {
    DigSearchOptions options = options_;
    options.seed = seed;
    options.stop.evaluations = budgets * evaluation_budget(false, false);
    const auto found = search_dig(scene.machine, simulator, scene.ground, options);
    return found ? options.objective.rank(found->dig) : 0.0;
  }

  double best_of_random(const Scene& scene, const SoilSimulator& simulator) const {
    const DigLayout layout(scene.machine, scene.ground);
    const DigBounds bounds = machine_bounds(scene.machine);
    const double reach = scene.machine.boom_pin.x() + scene.machine.full_length();
    std::atomic<long> next{0};
    std::mutex mutex;
    double best = 0.0;
    const auto work = [&] {
      for (long i = next++; i < random_digs_; i = next++) {
        Random random(7, static_cast<std::uint64_t>(i));
        std::variant<DigPath, Infeasible> path = Infeasible();
        for (int tries = 0; tries < 1000 && !std::holds_alternative<DigPath>(path); ++tries) {
          DigParameters dig;
          for (const DigParameterInfo& info : dig_parameter_table()) {
            dig.*info.field = random.uniform(bounds.lower.*info.field, bounds.upper.*info.field);
          }
          path = layout.path_from(dig, random.uniform(scene.machine.track_front, reach));
        }
        if (!std::holds_alternative<DigPath>(path)) continue;
        const auto dug = dig_of_path(scene.machine, simulator, scene.ground,
                                     std::get<DigPath>(path), options_.objective);
        if (!std::holds_alternative<PlannedDig>(dug)) continue;
        const std::lock_guard<std::mutex> lock(mutex);
        best = std::max(best, options_.objective.rank(std::get<PlannedDig>(dug)));
      }
    };
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t) {
      threads.emplace_back(work);
    }
    for (std::thread& thread : threads) thread.join();
    return best;
  }

  long random_digs_;
  int seeds_;
  DigSearchOptions options_;
  std::vector<double> losses_;
};

void run(FreeScan& scan) {
  const Machine zx120 = load_machine(find_data_file("machines/zx120.json"));
  for (const char* name : {"loam", "sand", "clay", "gravel"}) {
    const SoilKind soil = load_soil(find_data_file(std::string("soils/") + name + ".json"));
    for (const double density : {10.0, 40.0, 80.0}) {
      const std::string of =
          soil.name + " of " + std::to_string(static_cast<int>(density)) + " %, ";
      for (const double degrees : {-15.0, 0.0, 15.0}) {
        scan.judge({of + std::to_string(static_cast<int>(degrees)) + " deg", zx120, soil, density,
                    slope(zx120, degrees * pi / 180.0)});
      }
      scan.judge({of + "pit", zx120, soil, density, pit(zx120, soil, density, scan.options())});
    }
  }
  scan.print();
}

}  // namespace
}  // namespace excavplan

int main(int argc, char** argv) {
  using namespace excavplan;
  const long digs = argc > 1 ? std::atol(argv[1]) : 20000;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 16;
  DigObjective::Goal goal = DigObjective::Goal::cycle;
  for (const DigGoalInfo& info : dig_goals()) {
    if (argc > 3 && info.word == std::string(argv[3])) goal = info.goal;
  }
  FreeScan scan(digs, seeds, goal);
  run(scan);
}
