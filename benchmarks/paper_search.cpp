// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/simulation/dig_ground.hpp>

/// @file
/// What the paper's genetic algorithm finds from random digs on, beside the default search with as
/// many digs: docs/generated/paper-search.md, most mass per energy of the dig, seeds 1 .. 10.

namespace {

using namespace excavplan;

constexpr int seeds = 10;

struct Bench {
  Machine machine = load_machine(shipped_or_file("machines", "zx120"));
  SoilKind loam = load_soil(shipped_or_file("soils", "loam"));
  Terrain level = level_planning_ground(machine);

  /// From random digs on, with the start of least work.
  DigSearchResult cold(double density, const DigSearchOptions& options) const {
    const auto simulator = default_simulator().make(machine, loam, density);
    return *search_dig(machine, *simulator, level, options);
  }
  /// From the library's dig on, with its start.
  double warm(double density, DigSearchOptions options) const {
    PlanOptions plan;
    plan.method = PlanMethod::search;
    options.start_rule = plan.search.start_rule;
    plan.search = options;
    return plan_dig(machine, loam, density, level, plan).search->worth;
  }
};

void print(double density, const char* name, const std::vector<double>& digs,
           std::vector<double> worths) {
  std::sort(worths.begin(), worths.end());
  const double mean = std::accumulate(digs.begin(), digs.end(), 0.0) / seeds;
  const double median = 500.0 * (worths[seeds / 2 - 1] + worths[seeds / 2]);
  std::printf("| %.0f %% | %s | %.0f | %.2f | %.2f .. %.2f |\n", density, name, mean, median,
              1000.0 * worths.front(), 1000.0 * worths.back());
  std::fflush(stdout);
}

void compare(const Bench& bench, double density) {
  std::vector<double> digs, paper, low_mutation, cold, warm;
  for (int seed = 1; seed <= seeds; ++seed) {
    DigSearchOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    GeneticAlgorithm genetic;
    options.method = genetic;
    const DigSearchResult found = bench.cold(density, options);
    paper.push_back(found.worth);
    digs.push_back(found.evaluations);
    genetic.mutation = 0.1;
    options.method = genetic;
    options.stop.evaluations = found.evaluations;
    low_mutation.push_back(bench.cold(density, options).worth);
    options.method = budget_search().method;
    cold.push_back(bench.cold(density, options).worth);
    warm.push_back(bench.warm(density, options));
  }
  print(density, "paper, as published", digs, paper);
  print(density, "paper, mutation 0.1", digs, low_mutation);
  print(density, "default, cold", digs, cold);
  print(density, "default, from the library, its start searched", digs, warm);
}

}  // namespace

int main() {
  const Bench bench;
  for (const double density : {10.0, 40.0, 80.0}) compare(bench, density);
}
