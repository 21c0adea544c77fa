// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/genetic.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <string>

#include <nlopt.hpp>

#include <excavplan/error.hpp>
#include <excavplan/random.hpp>

#include "../parallel.hpp"

namespace excavplan {
namespace {

using Eigen::VectorXd;

void require(bool holds, const char* rule, double value) {
  if (!holds) {
    throw Error(ErrorKind::bad_input,
                std::string("search: ") + rule + ", got " + std::to_string(value));
  }
}

void check(const SearchBox& box) {
  require(box.lower.size() > 0 && box.lower.size() == box.upper.size(),
          "the box needs as many lower as upper bounds, at least one",
          static_cast<double>(box.lower.size()));
  for (Eigen::Index i = 0; i < box.lower.size(); ++i) {
    require(
        std::isfinite(box.lower(i)) && std::isfinite(box.upper(i)) && box.lower(i) <= box.upper(i),
        "bounds must be finite and lower <= upper", box.lower(i));
  }
}

void check(const GeneticOptions& options) {
  require(options.population >= 2, "population must be >= 2", options.population);
  require(options.generations >= 1, "generations must be >= 1", options.generations);
  require(options.tournament >= 1, "tournament must be >= 1", options.tournament);
  require(options.crossover >= 0.0 && options.crossover <= 1.0, "crossover must be in 0 .. 1",
          options.crossover);
  require(options.mutation >= 0.0 && options.mutation <= 1.0, "mutation must be in 0 .. 1",
          options.mutation);
}

constexpr double infeasible = -std::numeric_limits<double>::infinity();

double fitness_of(const Objective& objective, const VectorXd& point) {
  const std::optional<double> fitness = objective(point);
  return fitness && std::isfinite(*fitness) ? *fitness : infeasible;
}

VectorXd clipped(const SearchBox& box, const VectorXd& point) {
  return point.cwiseMax(box.lower).cwiseMin(box.upper);
}

struct Individual {
  VectorXd genes;
  double fitness = infeasible;
};

class Population {
 public:
  Population(const SearchBox& box, const Objective& objective, const GeneticOptions& options)
      : box_(box), objective_(objective), options_(options) {
    for (int i = 0; i < options.population; ++i) {
      Random random = stream(0, i);
      const auto given = static_cast<std::size_t>(i);
      individuals_.push_back({given < options.start.size() ? clipped(box, options.start[given])
                                                           : random_point(random)});
    }
    evaluate();
  }

  void breed(int generation) {
    std::vector<Individual> next;
    next.push_back(individuals_.front());  // elitism; evaluate() sorts the best to the front
    for (int i = 0; next.size() < individuals_.size(); ++i) {
      Random random = stream(generation, i);
      VectorXd a = tournament(random).genes;
      VectorXd b = tournament(random).genes;
      cross(a, b, random);
      mutate(a, random);
      mutate(b, random);
      next.push_back({a});
      if (next.size() < individuals_.size()) next.push_back({b});
    }
    individuals_ = std::move(next);
    evaluate();
  }

  SearchProgress state(int generation) const {
    double sum = 0.0;
    int feasible = 0;
    for (const Individual& individual : individuals_) {
      if (individual.fitness == infeasible) continue;
      sum += individual.fitness;
      ++feasible;
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {generation + 1, options_.generations, evaluations_,
            feasible > 0 ? best().fitness : none, feasible > 0 ? sum / feasible : none};
  }

  const Individual& best() const { return individuals_.front(); }
  int evaluations() const { return evaluations_; }
  int infeasible_count() const { return infeasible_; }

 private:
  Random stream(int generation, int individual) const {
    return Random(options_.seed, static_cast<std::uint64_t>(generation),
                  static_cast<std::uint64_t>(individual));
  }

  VectorXd random_point(Random& random) const {
    VectorXd point(box_.lower.size());
    for (Eigen::Index i = 0; i < point.size(); ++i) {
      point(i) = random.uniform(box_.lower(i), box_.upper(i));
    }
    return point;
  }

  const Individual& tournament(Random& random) const {
    const std::size_t rest = individuals_.size() - 1;
    const auto draw = [&] { return 1 + static_cast<std::size_t>(random.index(rest)); };
    std::size_t winner = draw();
    for (int i = 1; i < options_.tournament; ++i) winner = std::min(winner, draw());
    return individuals_[winner];  // sorted: the lowest index is the fittest
  }

  void cross(VectorXd& a, VectorXd& b, Random& random) const {
    if (random.uniform() >= options_.crossover) return;
    const auto genes = static_cast<std::uint64_t>(a.size());
    auto first = static_cast<Eigen::Index>(random.index(genes + 1));
    auto last = static_cast<Eigen::Index>(random.index(genes + 1));
    if (first > last) std::swap(first, last);
    for (Eigen::Index i = first; i < last; ++i) std::swap(a(i), b(i));
  }

  void mutate(VectorXd& point, Random& random) const {
    for (Eigen::Index i = 0; i < point.size(); ++i) {
      if (random.uniform() >= options_.mutation) continue;
      point(i) = random.uniform(box_.lower(i), box_.upper(i));
    }
  }

  /// Evaluates what was not seen before, then sorts: fittest first, ties in the order of birth.
  void evaluate() {
    std::vector<Individual*> fresh;
    for (Individual& individual : individuals_) {
      const auto [entry, is_new] = seen_.try_emplace(key(individual.genes), infeasible);
      if (is_new) fresh.push_back(&individual);
    }
    parallel_for(fresh.size(), options_.threads, [&](std::size_t i) {
      fresh[i]->fitness = fitness_of(objective_, fresh[i]->genes);
    });
    for (const Individual* individual : fresh) {
      seen_[key(individual->genes)] = individual->fitness;
      infeasible_ += individual->fitness == infeasible ? 1 : 0;
    }
    evaluations_ += static_cast<int>(fresh.size());
    for (Individual& individual : individuals_) individual.fitness = seen_[key(individual.genes)];
    std::stable_sort(
        individuals_.begin(), individuals_.end(),
        [](const Individual& a, const Individual& b) { return a.fitness > b.fitness; });
  }

  static std::vector<double> key(const VectorXd& genes) {
    return {genes.data(), genes.data() + genes.size()};
  }

  const SearchBox& box_;
  const Objective& objective_;
  const GeneticOptions& options_;
  std::vector<Individual> individuals_;
  std::map<std::vector<double>, double> seen_;
  int evaluations_ = 0;
  int infeasible_ = 0;
};

}  // namespace

std::optional<SearchResult> search_genetic(const SearchBox& box, const Objective& objective,
                                           const GeneticOptions& options) {
  check(box);
  check(options);
  SearchResult result;
  Population population(box, objective, options);
  for (int generation = 0;; ++generation) {
    if (generation > 0) population.breed(generation);
    result.history.push_back(population.state(generation));
    if (options.progress && !options.progress(result.history.back())) {
      result.stopped = true;
      break;
    }
    if (generation + 1 == options.generations) break;
  }
  if (population.best().fitness == infeasible) return std::nullopt;
  result.best = population.best().genes;
  result.fitness = population.best().fitness;
  result.evaluations = population.evaluations();
  result.infeasible = population.infeasible_count();
  return result;
}

SearchResult polish(const SearchBox& box, const Objective& objective, const VectorXd& start,
                    int max_evaluations) {
  check(box);
  require(start.size() == box.lower.size() && clipped(box, start) == start,
          "the start must lie in the box, first coordinate", start.size() > 0 ? start(0) : 0.0);
  require(max_evaluations >= 1, "evaluations must be >= 1", max_evaluations);
  SearchResult result;
  result.best = start;
  result.fitness = infeasible;
  std::exception_ptr failure;  // NLopt swallows exceptions, texts included
  const auto evaluate = [&](const std::vector<double>& x) {
    const VectorXd point = Eigen::Map<const VectorXd>(x.data(), start.size());
    double fitness = infeasible;
    try {
      fitness = fitness_of(objective, point);
    } catch (...) {
      failure = std::current_exception();
      throw nlopt::forced_stop();
    }
    ++result.evaluations;
    result.infeasible += fitness == infeasible ? 1 : 0;
    if (fitness > result.fitness) {
      result.fitness = fitness;
      result.best = point;
    }
    return fitness == infeasible ? -1e30 : fitness;  // finite: Nelder-Mead must compare it
  };
  using Evaluate = decltype(evaluate);
  nlopt::opt search(nlopt::LN_NELDERMEAD, static_cast<unsigned>(start.size()));
  search.set_max_objective([](const std::vector<double>& x, std::vector<double>&,
                              void* data) { return (*static_cast<const Evaluate*>(data))(x); },
                           const_cast<void*>(static_cast<const void*>(&evaluate)));
  search.set_lower_bounds({box.lower.data(), box.lower.data() + box.lower.size()});
  search.set_upper_bounds({box.upper.data(), box.upper.data() + box.upper.size()});
  const VectorXd step = (0.05 * (box.upper - box.lower)).cwiseMax(1e-12);
  search.set_initial_step({step.data(), step.data() + step.size()});
  search.set_xtol_rel(1e-4);
  search.set_maxeval(max_evaluations);
  std::vector<double> x(start.data(), start.data() + start.size());
  double fitness = 0.0;
  try {
    search.optimize(x, fitness);
  } catch (const nlopt::forced_stop&) {
    if (failure) std::rethrow_exception(failure);
  } catch (const nlopt::roundoff_limited&) {
    // As good as it gets: result holds the best point.
  }
  return result;
}

}  // namespace excavplan
