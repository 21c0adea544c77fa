// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/genetic.hpp>

#include <atomic>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

using Eigen::VectorXd;

SearchBox unit_cube() { return {VectorXd::Zero(3), VectorXd::Ones(3)}; }

double hill(const VectorXd& x) { return 2.0 - (x - VectorXd::Constant(3, 0.7)).squaredNorm(); }

// Hartmann's function in three dimensions; maximum 3.86278 at (0.114614, 0.555649, 0.852547)
// (Hartmann 1972; Dixon and Szegoe 1978).
double hartmann(const VectorXd& x) {
  const double a[4][3] = {{3, 10, 30}, {0.1, 10, 35}, {3, 10, 30}, {0.1, 10, 35}};
  const double p[4][3] = {{0.3689, 0.1170, 0.2673},
                          {0.4699, 0.4387, 0.7470},
                          {0.1091, 0.8732, 0.5547},
                          {0.0381, 0.5743, 0.8828}};
  const double c[4] = {1.0, 1.2, 3.0, 3.2};
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    double distance = 0.0;
    for (int j = 0; j < 3; ++j) distance += a[i][j] * std::pow(x(j) - p[i][j], 2);
    sum += c[i] * std::exp(-distance);
  }
  return sum;
}

TEST(Genetic, FindsHartmannsMaximum) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    GeneticOptions options;
    options.seed = seed;
    const auto found = search_genetic(unit_cube(), hartmann, options);
    ASSERT_TRUE(found);
    EXPECT_GT(found->fitness, 0.95 * 3.86278);
    const SearchResult polished = polish(unit_cube(), hartmann, found->best, 200);
    EXPECT_NEAR(polished.fitness, 3.86278, 1e-3);
    EXPECT_LE(polished.evaluations, 200);
  }
}

TEST(Genetic, GivesTheSameBytesForAnyNumberOfThreads) {
  GeneticOptions options;
  options.threads = 1;
  const auto one = search_genetic(unit_cube(), hartmann, options);
  for (const unsigned threads : {2U, 8U}) {
    options.threads = threads;
    const auto many = search_genetic(unit_cube(), hartmann, options);
    EXPECT_EQ(one->best, many->best);
    EXPECT_EQ(one->evaluations, many->evaluations);
    for (std::size_t i = 0; i < one->history.size(); ++i) {
      EXPECT_EQ(one->history[i].mean, many->history[i].mean);
    }
  }
}

TEST(Genetic, AnotherSeedIsAnotherSearch) {
  GeneticOptions options;
  const auto one = search_genetic(unit_cube(), hill, options);
  options.seed = 2;
  EXPECT_NE(one->best, search_genetic(unit_cube(), hill, options)->best);
}

TEST(Genetic, NeverLosesItsBestAndStaysInTheBox) {
  const Objective objective = [](const VectorXd& x) -> std::optional<double> {
    EXPECT_GE(x.minCoeff(), 0.0);
    EXPECT_LE(x.maxCoeff(), 1.0);
    return hill(x);
  };
  const auto found = search_genetic(unit_cube(), objective, {});
  for (std::size_t i = 1; i < found->history.size(); ++i) {
    EXPECT_GE(found->history[i].best, found->history[i - 1].best);
  }
  EXPECT_GE(polish(unit_cube(), objective, found->best, 50).fitness, found->fitness);
}

TEST(Genetic, WithoutMutationEveryGeneComesFromTheFirstGeneration) {
  GeneticOptions options;
  options.population = 20;
  options.threads = 1;
  options.mutation = 0.0;
  options.crossover = 1.0;
  std::vector<VectorXd> seen;
  const Objective record = [&](const VectorXd& x) -> std::optional<double> {
    seen.push_back(x);
    return hill(x);
  };
  ASSERT_TRUE(search_genetic(unit_cube(), record, options));
  ASSERT_GT(seen.size(), 20U);  // crossover did make new combinations
  for (const VectorXd& x : seen) {
    for (Eigen::Index gene = 0; gene < 3; ++gene) {
      bool inherited = false;
      for (std::size_t i = 0; i < 20; ++i) inherited = inherited || seen[i](gene) == x(gene);
      EXPECT_TRUE(inherited);
    }
  }
}

TEST(Genetic, GivenStartTakesPartAndIsNeverLost) {
  GeneticOptions options;
  options.generations = 2;
  options.start = {VectorXd::Constant(3, 0.7)};
  EXPECT_DOUBLE_EQ(search_genetic(unit_cube(), hill, options)->fitness, 2.0);
}

TEST(Genetic, DoesNotEvaluateAPointTwice) {
  std::atomic<int> calls{0};
  const Objective counting = [&](const VectorXd& x) -> std::optional<double> {
    ++calls;
    return hill(x);
  };
  GeneticOptions options;
  options.mutation = 0.1;
  const auto found = search_genetic(unit_cube(), counting, options);
  EXPECT_EQ(found->evaluations, calls.load());
  EXPECT_LT(found->evaluations, options.population * options.generations);
}

TEST(Genetic, InfinityAndNaNAreNotBelieved) {
  const Objective liar = [](const VectorXd& x) -> std::optional<double> {
    if (x(0) < 0.2) return std::numeric_limits<double>::infinity();
    if (x(0) < 0.4) return std::numeric_limits<double>::quiet_NaN();
    if (x(0) < 0.5) return std::nullopt;
    return hill(x);
  };
  const auto found = search_genetic(unit_cube(), liar, {});
  ASSERT_TRUE(found);
  EXPECT_GE(found->best(0), 0.5);
  EXPECT_TRUE(std::isfinite(found->fitness));
  EXPECT_GT(found->infeasible, 0);
  EXPECT_TRUE(std::isfinite(polish(unit_cube(), liar, found->best, 60).fitness));
}

TEST(Genetic, NothingFeasibleIsAResult) {
  EXPECT_FALSE(search_genetic(
      unit_cube(), [](const VectorXd&) -> std::optional<double> { return std::nullopt; }, {}));
}

TEST(Genetic, TextOfTheObjectivesErrorArrives) {
  const Objective broken = [](const VectorXd&) -> std::optional<double> {
    throw Error(ErrorKind::bad_input, "engine on fire");
  };
  const auto text = [](const auto& call) {
    try {
      call();
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(text([&] { search_genetic(unit_cube(), broken, {}); }), "engine on fire");
  EXPECT_EQ(text([&] { polish(unit_cube(), broken, VectorXd::Constant(3, 0.5), 10); }),
            "engine on fire");
}

TEST(Genetic, ProgressCanStopIt) {
  GeneticOptions options;
  options.progress = [](const SearchProgress& p) { return p.generation < 3; };
  const auto found = search_genetic(unit_cube(), hill, options);
  EXPECT_TRUE(found->stopped);
  EXPECT_EQ(found->history.size(), 3U);
}

TEST(Genetic, MessageNamesTheRuleAndTheValue) {
  GeneticOptions options;
  options.population = 1;
  try {
    search_genetic(unit_cube(), hill, options);
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "search: population must be >= 2, got 1.000000");
  }
  EXPECT_THROW(search_genetic({VectorXd::Ones(3), VectorXd::Zero(3)}, hill, {}), Error);
  EXPECT_THROW(polish(unit_cube(), hill, VectorXd::Constant(3, 2.0), 10), Error);
}

}  // namespace
}  // namespace excavplan
