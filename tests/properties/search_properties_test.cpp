// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/error.hpp>
#include <excavplan/optimisation/search.hpp>

#include <map>
#include <mutex>

#include "optimisation/search_points.hpp"
#include "support/cases.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

using Eigen::VectorXd;

/// A bumpy function with forbidden and failing regions; a pure function of the point.
struct AnyFunction {
  VectorXd centre;
  double waves = 0.0;

  Evaluation operator()(const VectorXd& x) const {
    const double away = (x - centre).norm();
    if (std::sin(3.0 * waves * x(0)) > 0.8) return Evaluation::infeasible(away);
    if (std::sin(7.0 * waves * x(0)) > 0.97) return Evaluation::failed("no");
    return std::cos(waves * away) - away;
  }
};

struct AnySearch {
  SearchProblem problem;
  SearchOptions options;
};

AnySearch any_search(Random& random) {
  AnySearch any;
  const Eigen::Index dimensions = drawn_int(random, 1, 4);
  any.problem.box.lower = drawn_vector(random, dimensions, -2.0, 1.0);
  any.problem.box.upper = any.problem.box.lower + drawn_vector(random, dimensions, 0.1, 3.0);
  if (random.uniform() < 0.2) any.problem.box.upper(0) = any.problem.box.lower(0);
  AnyFunction function;
  function.centre = drawn_vector(random, dimensions, -2.0, 4.0);
  function.waves = random.uniform(0.5, 5.0);
  any.problem.objective = function;
  if (random.uniform() < 0.3) {
    any.problem.step = drawn_vector(random, dimensions, 0.0, 0.2);
  }
  any.options.seed = random.bits();
  any.options.threads = 1;
  any.options.stop.evaluations = drawn_int(random, 10, 40);
  if (random.uniform() < 0.5) {
    GeneticAlgorithm method;
    method.population = drawn_int(random, 2, 10);
    method.generations = drawn_int(random, 1, 6);
    method.tournament = drawn_int(random, 1, 5);
    method.crossover = random.uniform();
    method.mutation = random.uniform();
    any.options.method = method;
  } else {
    MemeticSearch method;
    method.first_generation = drawn_int(random, 1, 8);
    method.generations = drawn_int(random, 0, 3);
    method.generation_size = drawn_int(random, 1, 6);
    method.immigrants = random.uniform();
    method.basins = drawn_int(random, 0, 3);
    method.polish_evaluations = drawn_int(random, 0, 15);
    any.options.method = method;
  }
  for (int i = drawn_int(random, 0, 2); i > 0; --i) {
    any.options.start.push_back(drawn_vector(random, dimensions, -5.0, 5.0));
  }
  return any;
}

/// A search whose evaluations all failed throws; nothing can be said of it.
std::optional<SearchResult> result_of(const AnySearch& any) {
  try {
    return search(any.problem, any.options);
  } catch (const Error&) {
    return std::nullopt;
  }
}

bool same(const Evaluation& a, const Evaluation& b) {
  return a.status == b.status && a.violation == b.violation &&
         (a.fitness == b.fitness || (std::isnan(a.fitness) && std::isnan(b.fitness)));
}

bool same(const SearchResult& a, const SearchResult& b) {
  if (a.history.size() != b.history.size() || a.best != b.best || !same(a.outcome, b.outcome)) {
    return false;
  }
  for (std::size_t i = 0; i < a.history.size(); ++i) {
    if (a.history[i].point != b.history[i].point) return false;
    if (!same(a.history[i].outcome, b.history[i].outcome)) return false;
  }
  return true;
}

constexpr int searches = 1000;  // of some 20 points each

TEST(SearchProperties, NoPointLeavesTheBoxAndTheBestIsTheBestOfAll) {
  std::size_t points = 0;
  for_cases(
      [&](Random& random) {
        const AnySearch any = any_search(random);
        const auto result = result_of(any);
        if (!result) return;
        int made = 0, cached = 0;
        for (const SearchRecord& record : result->history) {
          EXPECT_TRUE((record.point.array() >= any.problem.box.lower.array()).all());
          EXPECT_TRUE((record.point.array() <= any.problem.box.upper.array()).all());
          EXPECT_FALSE(better(record.outcome, result->outcome));
          made += record.source == SearchRecord::Source::simulated ? 1 : 0;
          cached += record.source == SearchRecord::Source::cached ? 1 : 0;
          for (const int parent : record.parents) {
            EXPECT_LT(static_cast<std::size_t>(parent), result->history.size());
          }
        }
        points += result->history.size();
        EXPECT_EQ(made, result->evaluations);
        EXPECT_EQ(cached, result->cached);
        EXPECT_LE(result->evaluations, any.options.stop.evaluations);
        EXPECT_TRUE(same(any.problem.objective(result->best), result->outcome));
      },
      searches);
  EXPECT_GT(points, static_cast<std::size_t>(many));
}

/// What is taken from before is what the objective would give. The genetic algorithm evaluates no
/// point twice; polishes that go on at the same time do not know of one another's points.
TEST(SearchProperties, TheCacheIsTransparent) {
  for_cases(
      [](Random& random) {
        AnySearch any = any_search(random);
        std::map<PointKey, int> calls;
        const Objective own = any.problem.objective;
        any.problem.objective = [&](const VectorXd& x) {
          ++calls[key_of(x)];
          return own(x);
        };
        const auto result = result_of(any);
        if (!result) return;
        const bool is_genetic = std::holds_alternative<GeneticAlgorithm>(any.options.method);
        int sum = 0;
        for (const auto& [point, count] : calls) {
          EXPECT_TRUE(count == 1 || !is_genetic);
          sum += count;
        }
        EXPECT_EQ(sum, result->evaluations);
        for (const SearchRecord& record : result->history) {
          EXPECT_TRUE(same(own(record.point), record.outcome));
        }
      },
      searches);
}

/// The best so far of a longer search is never worse.
TEST(SearchProperties, MoreEvaluationsAreNeverWorse) {
  for_cases(
      [](Random& random) {
        AnySearch any = any_search(random);
        any.options.stop.evaluations = 12;
        const auto shorter = result_of(any);
        any.options.stop.evaluations = 25;
        const auto longer = result_of(any);
        if (shorter && longer) {
          EXPECT_FALSE(better(shorter->outcome, longer->outcome));
        }
      },
      searches);
}

TEST(SearchProperties, ThreadsDoNotChangeTheResult) {
  for_cases(
      [](Random& random) {
        AnySearch any = any_search(random);
        const auto alone = result_of(any);
        any.options.threads = 3;
        const auto together = result_of(any);
        ASSERT_EQ(alone.has_value(), together.has_value());
        if (alone) {
          EXPECT_TRUE(same(*alone, *together));
        }
      },
      100);
}

TEST(SearchProperties, AResumedSearchIsTheUninterruptedOne) {
  const TemporaryFolder folder;
  for_cases(
      [&](Random& random) {
        AnySearch any = any_search(random);
        const auto whole = result_of(any);
        if (!whole) return;
        any.problem.fingerprint = "any";
        any.options.checkpoint = folder.file("checkpoint");
        const int stop = drawn_int(random, 1, any.options.stop.evaluations);
        any.options.progress = [&](const SearchProgress& now) { return now.evaluations < stop; };
        result_of(any);
        any.options.progress = nullptr;
        any.options.resume = true;
        const auto resumed = result_of(any);
        ASSERT_TRUE(resumed);
        EXPECT_TRUE(same(*whole, *resumed));
        std::filesystem::remove(any.options.checkpoint);
      },
      100);
}

Evaluation any_evaluation(Random& random) {
  const double value = std::round(random.uniform(-2.0, 2.0));
  const double kind = random.uniform();
  if (kind < 0.4) return value;
  if (kind < 0.7) return Evaluation::infeasible(std::abs(value));
  return kind < 0.85 ? Evaluation::failed("no") : Evaluation::timed_out("late");
}

/// A strict weak order: what sorting and the choice of the best rely on.
TEST(SearchProperties, BetterIsAnOrder) {
  for_cases([](Random& random) {
    const Evaluation a = any_evaluation(random);
    const Evaluation b = any_evaluation(random);
    const Evaluation c = any_evaluation(random);
    EXPECT_FALSE(better(a, a));
    EXPECT_FALSE(better(a, b) && better(b, a));
    if (better(a, b) && better(b, c)) {
      EXPECT_TRUE(better(a, c));
    }
    const auto tie = [](const Evaluation& x, const Evaluation& y) {
      return !better(x, y) && !better(y, x);
    };
    if (tie(a, b) && tie(b, c)) {
      EXPECT_TRUE(tie(a, c));
    }
    if (a.ok() && !b.ok()) {
      EXPECT_TRUE(better(a, b));
    }
    if (a.ok() && b.ok()) {
      EXPECT_EQ(better(a, b), a.fitness > b.fitness);
    }
  });
}

/// A violation is how far from feasible a point is, never less than nothing.
TEST(SearchProperties, ViolationsAreNeverNegative) {
  for_cases([](Random& random) {
    const double value = drawn_number(random);
    EXPECT_EQ(Evaluation::infeasible(value).violation, value > 0.0 ? value : 0.0);
  });
}

TEST(SearchProperties, SettingsOutsideTheirRangeAreRefused) {
  for_cases([](Random& random) {
    AnySearch any = any_search(random);
    GeneticAlgorithm method;
    int* const counts[] = {&method.population, &method.generations, &method.tournament};
    const int least[] = {2, 1, 1};
    const auto which = random.index(3);
    *counts[which] = least[which] - drawn_int(random, 1, 5);
    any.options.method = method;
    EXPECT_THROW(search(any.problem, any.options), Error);
    method = GeneticAlgorithm{};
    (random.uniform() < 0.5 ? method.crossover : method.mutation) =
        random.uniform() < 0.5 ? random.uniform(-1.0, -1e-9) : random.uniform(1.0 + 1e-9, 2.0);
    any.options.method = method;
    EXPECT_THROW(search(any.problem, any.options), Error);
  });
}

TEST(SearchProperties, SharesOfABoxAreInverse) {
  for_cases([](Random& random) {
    SearchBox box;
    box.lower = drawn_vector(random, 3, -5.0, 5.0);
    box.upper = box.lower + drawn_vector(random, 3, 0.1, 5.0);
    const UnitCube cube(box);
    const VectorXd u = drawn_vector(random, 3, 0.0, 1.0);
    const VectorXd v = drawn_vector(random, 3, 0.0, 1.0);
    EXPECT_LT((cube.inside(cube.point(u)) - u).norm(), 1e-13);
    EXPECT_NEAR(cube.distance(cube.point(u), cube.point(v)), (u - v).cwiseAbs().maxCoeff(), 1e-13);
  });
}

}  // namespace
}  // namespace excavplan::test
