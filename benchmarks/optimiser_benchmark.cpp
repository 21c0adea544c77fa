// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlopt.hpp>
#ifdef EXCAVPLAN_HAS_PAGMO
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#endif

#include <excavplan/optimisation/search.hpp>
#include "base/random.hpp"

#include "dig_functions.hpp"
#include "support/search_functions.hpp"

/// @file
/// optimiser_benchmark [SEEDS [BUDGET [DIGS [GRID]]]]: how many evaluations each optimiser needs to
/// find a point whose true value is >= 99 % of the maximum; a table in Markdown on standard output.
/// ERT: all evaluations of all runs over the number of successes.
///
/// With a file DIGS the functions are digs in the built-in simulator instead of closed forms. Their
/// maxima are read from it, or scanned on a grid of GRID^3 digs (45) and written to it, if it does
/// not exist. Digs that cannot be driven are no evaluations, for no optimiser.

namespace excavplan {
namespace {

using Eigen::VectorXd;
using functions::Function;

/// What is optimised: one function of the unit cube per seed.
struct Family {
  std::string name;
  std::function<Function(std::uint64_t seed)> function;
  bool in_mean;  ///< part of the geometric mean: the excavation-like ones
};

/// One run of one optimiser: counts evaluations and ends it when they are used up.
class Trial {
 public:
  struct Over : std::exception {};

  Trial(const Function& function, int budget) : function_(function), budget_(budget) {}

  int dimensions() const { return function_.dimensions; }
  bool over() const { return hit_ > 0 || evaluations_ >= budget_; }
  int evaluations() const { return evaluations_; }
  int hit() const { return hit_; }  ///< evaluations to the first success; 0: none
  double share_at(int evaluations) const {
    if (shares_.empty()) return 0.0;
    return shares_[std::min(shares_.size(), static_cast<std::size_t>(evaluations)) - 1];
  }

  /// How far from feasible a point is that costs nothing; nothing for all others.
  std::optional<double> refused(const VectorXd& x) const {
    return function_.refused ? function_.refused(x) : std::nullopt;
  }

  /// @throws Over if nothing is left to find or to spend
  double operator()(const VectorXd& x) {
    if (over()) throw Over();
    if (refused(x)) {
      if (++refused_ > most_refused) throw Over();
      return 0.0;
    }
    ++evaluations_;
    const double value = function_.value(x);
    const double share = value / function_.maximum;
    shares_.push_back(shares_.empty() ? share : std::max(share, shares_.back()));
    if (share >= 0.99) hit_ = evaluations_;
    return function_.seen && value != 0.0 ? function_.seen(x) : value;
  }

 private:
  static constexpr int most_refused = 100000;

  const Function& function_;
  int budget_;
  int evaluations_ = 0;
  int refused_ = 0;
  int hit_ = 0;
  std::vector<double> shares_;  // best so far, of the maximum
};

struct Optimiser {
  std::string name;
  std::function<void(Trial& trial, std::uint64_t seed)> run;
};

// The optimisers --------------------------------------------------------------------------------

void run_search(Trial& trial, std::uint64_t seed,
                const std::variant<MemeticSearch, GeneticAlgorithm>& method) {
  SearchOptions options;
  options.method = method;
  options.seed = seed;
  options.threads = 1;
  options.progress = [&](const SearchProgress&) { return !trial.over(); };
  const VectorXd zero = VectorXd::Zero(trial.dimensions());
  search({{zero, VectorXd::Ones(trial.dimensions())},
          [&](const VectorXd& x) -> Evaluation {
            const double value = trial(x);
            return value == 0.0 ? Evaluation::infeasible(0.0) : Evaluation(value);
          },
          [&](const VectorXd& x) -> std::variant<VectorXd, Evaluation> {
            if (const auto violation = trial.refused(x)) return Evaluation::infeasible(*violation);
            return x;
          }},
         options);
}

Optimiser ours() {
  MemeticSearch method;
  method.generations = 100000;
  return {"**excavplan, default**",
          [=](Trial& trial, std::uint64_t seed) { run_search(trial, seed, method); }};
}

Optimiser papers(int population, double mutation) {
  GeneticAlgorithm method;
  method.population = population;
  method.mutation = mutation;
  method.generations = 4000;
  char name[64];
  std::snprintf(name, sizeof name, "paper's algorithm, N %d, mutation %.1f", population, mutation);
  return {name, [=](Trial& trial, std::uint64_t seed) { run_search(trial, seed, method); }};
}

Optimiser random_search() {
  return {"random", [](Trial& trial, std::uint64_t seed) {
            Random random(seed, 1);
            VectorXd x(trial.dimensions());
            for (;;) {
              for (double& number : x) number = random.uniform();
              trial(x);
            }
          }};
}

Optimiser from_nlopt(const std::string& name, nlopt::algorithm algorithm) {
  return {"NLopt " + name, [=](Trial& trial, std::uint64_t seed) {
            nlopt::srand(seed);
            const auto n = static_cast<unsigned>(trial.dimensions());
            nlopt::opt search(algorithm, n);
            search.set_lower_bounds(0.0);
            search.set_upper_bounds(1.0);
            search.set_maxeval(1000000);
            search.set_max_objective(
                [](const std::vector<double>& x, std::vector<double>&, void* data) {
                  auto& it = *static_cast<Trial*>(data);
                  if (it.over()) throw nlopt::forced_stop();
                  return it(Eigen::Map<const VectorXd>(x.data(), it.dimensions()));
                },
                &trial);
            Random random(seed, 2);
            std::vector<double> x(n);
            for (double& number : x) number = random.uniform();
            double best = 0.0;
            search.optimize(x, best);
          }};
}

#ifdef EXCAVPLAN_HAS_PAGMO
struct PagmoProblem {
  Trial* trial = nullptr;
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    const auto n = static_cast<std::size_t>(trial ? trial->dimensions() : 1);
    return {pagmo::vector_double(n, 0.0), pagmo::vector_double(n, 1.0)};
  }
  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    return {-(*trial)(Eigen::Map<const VectorXd>(x.data(), trial->dimensions()))};
  }
};

/// Restarts whenever the algorithm has converged.
template <typename Make>
Optimiser from_pagmo(const std::string& name, unsigned population, const Make& make) {
  return {"pagmo " + name, [=](Trial& trial, std::uint64_t seed) {
            for (auto round = static_cast<unsigned>(seed) * 1000;; ++round) {
              pagmo::population first{pagmo::problem{PagmoProblem{&trial}}, population, round};
              pagmo::algorithm{make(round)}.evolve(first);
            }
          }};
}
#endif

std::vector<Optimiser> optimisers() {
  std::vector<Optimiser> all = {ours(),
                                papers(20, 0.1),
                                papers(20, 0.3),
                                papers(50, 0.1),
                                papers(50, 0.3),
                                random_search(),
                                from_nlopt("DIRECT-L", nlopt::GN_DIRECT_L),
                                from_nlopt("CRS2", nlopt::GN_CRS2_LM),
                                from_nlopt("ESCH", nlopt::GN_ESCH)};
#ifdef EXCAVPLAN_HAS_PAGMO
  constexpr unsigned forever = 100000;
  all.push_back(from_pagmo("cmaes, lambda 10, bounds", 10, [](unsigned seed) {
    return pagmo::cmaes(forever, -1, -1, -1, -1, 0.5, 1e-6, 1e-6, false, true, seed);
  }));
  all.push_back(from_pagmo("de, N 20", 20, [](unsigned seed) {
    return pagmo::de(forever, 0.8, 0.9, 2U, 1e-6, 1e-6, seed);
  }));
  all.push_back(from_pagmo("sga, N 20", 20, [](unsigned seed) {
    return pagmo::sga(forever, 0.9, 1.0, 0.02, 1.0, 2U, "exponential", "polynomial", "tournament",
                      seed);
  }));
#endif
  return all;
}

std::vector<Family> families() {
  std::vector<Family> all;
  for (const functions::DigFamily& family : functions::dig_families()) {
    all.push_back({family.name, [=](std::uint64_t seed) { return family.function(seed); }, true});
  }
  all.push_back({"Hartmann-3",
                 [](std::uint64_t seed) {
                   Random random(seed, 3);
                   const Eigen::Vector3d flip =
                       Eigen::Vector3d::NullaryExpr([&] { return std::round(random.uniform()); });
                   return Function{"",
                                   [=](const VectorXd& x) {
                                     return functions::hartmann((x - flip).cwiseAbs());
                                   },
                                   3.86278};
                 },
                 false});
  all.push_back({"two humps",
                 [](std::uint64_t) {
                   return Function{"", functions::two_humps, 1.0};
                 },
                 false});
  return all;
}

// The table -------------------------------------------------------------------------------------

/// All seeds of one optimiser on one family.
struct Score {
  std::vector<int> hits;
  long evaluations = 0;
  int runs = 0;
  std::vector<double> at_100;
  std::vector<double> at_200;

  double ert() const {
    return hits.empty() ? HUGE_VAL
                        : static_cast<double>(evaluations) / static_cast<double>(hits.size());
  }
  std::string median() {
    const int failed = runs - static_cast<int>(hits.size());
    const std::string fails =
        failed > 0 ? " (" + std::to_string(100 * failed / runs) + " % fail)" : "";
    const auto middle = static_cast<std::size_t>(runs / 2);
    std::sort(hits.begin(), hits.end());
    return (middle < hits.size() ? std::to_string(hits[middle]) : "-") + fails;
  }
};

Score score(const Optimiser& optimiser, const Family& family, int seeds, int budget) {
  Score result;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Function function = family.function(static_cast<std::uint64_t>(seed));
    Trial trial(function, budget);
    try {
      optimiser.run(trial, static_cast<std::uint64_t>(seed));
    } catch (const std::exception&) {
      // Trial::Over, or what NLopt makes of it; also an optimiser that gives up.
    }
    ++result.runs;
    result.evaluations += trial.evaluations();
    if (trial.hit() > 0) result.hits.push_back(trial.hit());
    result.at_100.push_back(trial.share_at(100));
    result.at_200.push_back(trial.share_at(200));
  }
  return result;
}

/// "98.5 / 97.3": mean, and mean of the worst tenth [%].
std::string mean_and_worst(std::vector<double> shares) {
  std::sort(shares.begin(), shares.end());
  const auto mean = [&](std::size_t count) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += shares[i];
    return 100.0 * sum / static_cast<double>(count);
  };
  char text[32];
  std::snprintf(text, sizeof text, "%.1f / %.1f", mean(shares.size()),
                mean(std::max<std::size_t>(1, shares.size() / 10)));
  return text;
}

void print_row(const Optimiser& optimiser, const std::vector<Family>& all, int seeds, int budget) {
  std::string cells;
  double log_sum = 0.0;
  int in_mean = 0;
  std::vector<double> at_100;
  std::vector<double> at_200;
  for (const Family& family : all) {
    Score result = score(optimiser, family, seeds, budget);
    cells += " " + result.median() + " |";
    if (!family.in_mean) continue;
    log_sum += std::log(result.ert());
    ++in_mean;
    at_100.insert(at_100.end(), result.at_100.begin(), result.at_100.end());
    at_200.insert(at_200.end(), result.at_200.begin(), result.at_200.end());
  }
  std::printf("| %s |%s %.0f | %s | %s |\n", optimiser.name.c_str(), cells.c_str(),
              std::exp(log_sum / in_mean), mean_and_worst(at_100).c_str(),
              mean_and_worst(at_200).c_str());
  std::fflush(stdout);
}

std::vector<Family> dig_families(const std::string& file, int grid) {
  std::vector<Family> all;
  for (const DigCondition& condition : dig_conditions(file, grid)) {
    all.push_back(
        {condition.name(), [=](std::uint64_t seed) { return condition.function(seed); }, true});
  }
  return all;
}

void print_table(const std::vector<Family>& all, int seeds, int budget) {
  std::string head = "| optimiser |";
  std::string rule = "|---|";
  for (const Family& family : all) {
    head += " " + family.name + " |";
    rule += "---|";
  }
  std::printf(
      "Evaluations to 99 %% of the maximum: median of %d seeds, budget %d. Then over the "
      "excavation-like functions, or all digs: geometric mean of ERT; %% of the maximum after 100 "
      "and "
      "200 evaluations, mean / worst tenth.\n\n%s ERT | at 100 | at 200 |\n%s---|---|---|\n",
      seeds, budget, head.c_str(), rule.c_str());
  for (const Optimiser& optimiser : optimisers()) print_row(optimiser, all, seeds, budget);
}

}  // namespace
}  // namespace excavplan

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 50;
  const int budget = argc > 2 ? std::atoi(argv[2]) : 4000;
  const int grid = argc > 4 ? std::atoi(argv[4]) : 45;
  if (argc > 5 || seeds < 1 || budget < 1 || grid < 2) {
    std::fprintf(stderr, "usage: optimiser_benchmark [SEEDS [BUDGET [DIGS [GRID]]]]\n");
    return 2;
  }
  excavplan::print_table(argc > 3 ? excavplan::dig_families(argv[3], grid) : excavplan::families(),
                         seeds, budget);
}
