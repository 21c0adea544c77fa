// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// How near searches of the default budget come to the best dig there is: four soils, slopes of
/// -20 .. 20 deg and the pit of three digs, two machines. The best dig is the best of random ones,
/// from any start, of searches with ten times the budget, and of the searches that are judged.
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

/// A machine of the same shape, larger.
Machine scaled(Machine machine, double scale) {
  const double force = scale * scale;
  machine.name += " x " + std::to_string(scale);
  for (double* length :
       {&machine.boom_length, &machine.arm_length, &machine.bucket_length, &machine.track_front,
        &machine.bucket.width_inside, &machine.bucket.width_outside}) {
    *length *= scale;
  }
  machine.boom_pin *= scale;
  for (Eigen::Vector2d& corner : machine.bucket.profile) corner *= scale;
  for (JointLimits& limits : machine.limits) limits.torque *= force * scale;
  for (LinkMass& link : machine.links) {
    link.mass *= force * scale;
    link.along *= scale;
    link.across *= scale;
  }
  if (machine.swing) {
    machine.swing->torque *= force * scale;
    machine.swing->inertia *= force * force * scale;
  }
  machine.cylinders.reset();
  machine.hydraulics.reset();
  if (machine.body) {
    machine.body->mass *= force * scale;
    machine.body->centre *= scale;
    machine.body->rear_edge *= scale;
    machine.body->front_edge *= scale;
  }
  return machine;
}

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
      best = std::max(best, searched(scene, simulator, seed, 10));
    }
    std::sort(ranks.begin(), ranks.end());
    const auto good =
        std::count_if(ranks.begin(), ranks.end(), [&](double rank) { return rank >= 0.99 * best; });
    std::printf("%-44s %2ld of %d within 1 %%, worst %5.1f %%, median %5.1f %%\n",
                scene.name.c_str(), good, seeds_, 100.0 * ranks.front() / best,
                100.0 * ranks[ranks.size() / 2] / best);
    std::fflush(stdout);
    ++scenes_;
    if (good >= seeds_ - seeds_ / 16) ++good_scenes_;
  }

  void print() const { std::printf("%d of %d scenes\n", good_scenes_, scenes_); }

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
  int scenes_ = 0;
  int good_scenes_ = 0;
};

void run(FreeScan& scan) {
  const Machine zx120 = load_machine(find_data_file("machines/zx120.json"));
  const Machine large = scaled(zx120, 1.19);  // 20 t
  const double densities[] = {20.0, 40.0, 60.0, 40.0};
  const char* names[] = {"loam", "sand", "clay", "gravel"};
  for (const Machine* machine : {&zx120, &large}) {
    for (std::size_t s = 0; s < 4; ++s) {
      const SoilKind soil = load_soil(find_data_file(std::string("soils/") + names[s] + ".json"));
      const std::string name = machine->name + ", " + soil.name;
      for (const double degrees : {-20.0, -10.0, 0.0, 10.0, 20.0}) {
        scan.judge({name + ", " + std::to_string(static_cast<int>(degrees)) + " deg", *machine,
                    soil, densities[s], slope(*machine, degrees * pi / 180.0)});
      }
      scan.judge({name + ", pit", *machine, soil, densities[s],
                  pit(*machine, soil, densities[s], scan.options())});
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
