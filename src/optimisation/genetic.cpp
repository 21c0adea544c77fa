// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "base/random.hpp"
#include "optimisation/search_methods.hpp"

namespace excavplan {
namespace {

using Eigen::VectorXd;
using Origin = SearchRecord::Origin;

class Population {
 public:
  Population(const GeneticAlgorithm& method, const SearchTask& task, SearchLog& log)
      : method_(method), elites_(static_cast<std::size_t>(method.elites)), task_(task), log_(log) {
    std::vector<Candidate> first;
    for (const VectorXd& point : task.start) first.push_back({point, Origin::given, {}});
    for (int i = static_cast<int>(first.size()); i < method.population; ++i) {
      Random random = stream(0, i);
      first.push_back({random_point(random), Origin::random, {}});
    }
    individuals_ = log_.evaluate(0, first);
    sort();
    const auto population = static_cast<std::size_t>(method.population);
    individuals_.resize(std::min(individuals_.size(), population));
  }

  void breed(int generation) {
    const std::size_t children = individuals_.size() - elites_;
    std::vector<Candidate> next;
    for (int i = 0; next.size() < children; ++i) {
      Random random = stream(generation, i);
      const int mother = tournament(random);
      const int father = tournament(random);
      Candidate a{log_[mother].point, Origin::crossover, {mother, father}};
      Candidate b{log_[father].point, Origin::crossover, {father, mother}};
      cross(a.point, b.point, random);
      mutate(a, random);
      mutate(b, random);
      next.push_back(std::move(a));
      if (next.size() < children) next.push_back(std::move(b));
    }
    individuals_.resize(elites_);  // sorted: the best are in front
    const std::vector<int> born = log_.evaluate(generation, next);
    individuals_.insert(individuals_.end(), born.begin(), born.end());
    sort();
  }

 private:
  Random stream(int generation, int individual) const {
    return Random(task_.seed, static_cast<std::uint64_t>(generation),
                  static_cast<std::uint64_t>(individual));
  }

  VectorXd random_point(Random& random) const {
    VectorXd point(task_.box.lower.size());
    for (Eigen::Index i = 0; i < point.size(); ++i) {
      point(i) = random.uniform(task_.box.lower(i), task_.box.upper(i));
    }
    return point;
  }

  int tournament(Random& random) const {
    const std::size_t rest = individuals_.size() - elites_;
    const auto draw = [&] { return elites_ + static_cast<std::size_t>(random.index(rest)); };
    std::size_t winner = draw();
    for (int i = 1; i < method_.tournament; ++i) winner = std::min(winner, draw());
    return individuals_[winner];  // sorted: the lowest index is the fittest
  }

  void cross(VectorXd& a, VectorXd& b, Random& random) const {
    if (random.uniform() >= method_.crossover) return;
    const auto genes = static_cast<std::uint64_t>(a.size());
    auto first = static_cast<Eigen::Index>(random.index(genes + 1));
    auto last = static_cast<Eigen::Index>(random.index(genes + 1));
    if (first > last) std::swap(first, last);
    for (Eigen::Index i = first; i < last; ++i) std::swap(a(i), b(i));
  }

  void mutate(Candidate& child, Random& random) const {
    for (Eigen::Index i = 0; i < child.point.size(); ++i) {
      if (random.uniform() >= method_.mutation) continue;
      child.point(i) = random.uniform(task_.box.lower(i), task_.box.upper(i));
      child.origin = Origin::mutation;
    }
  }

  /// Fittest first, ties in the order of birth.
  void sort() {
    std::stable_sort(individuals_.begin(), individuals_.end(),
                     [&](int a, int b) { return better(log_[a].outcome, log_[b].outcome); });
  }

  const GeneticAlgorithm& method_;
  std::size_t elites_;
  const SearchTask& task_;
  SearchLog& log_;
  std::vector<int> individuals_;  // places in the log
};

}  // namespace

void run(const GeneticAlgorithm& method, const SearchTask& task, SearchLog& log) {
  Population population(method, task, log);
  for (int generation = 1; generation < method.generations && !log.stopped(); ++generation) {
    population.breed(generation);
  }
}

}  // namespace excavplan
