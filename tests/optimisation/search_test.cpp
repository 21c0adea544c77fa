// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/optimisation/search.hpp>
#include <excavplan/optimisation/search_analysis.hpp>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>
#include "base/random.hpp"

#include "base/files.hpp"
#include "base/json.hpp"
#include "support/errors.hpp"
#include "support/search_functions.hpp"

namespace excavplan {
namespace {

using Eigen::VectorXd;
using functions::hartmann;
using Origin = SearchRecord::Origin;
using Source = SearchRecord::Source;
using Status = Evaluation::Status;
using test::error_about;
using test::error_of;

constexpr double hartmann_maximum = 3.86278;

SearchBox unit_cube() { return {VectorXd::Zero(3), VectorXd::Ones(3)}; }

double hill(const VectorXd& x) { return 2.0 - (x - VectorXd::Constant(3, 0.7)).squaredNorm(); }

SearchProblem problem(Objective objective) { return {unit_cube(), std::move(objective)}; }

SearchOptions with_seed(std::uint64_t seed) {
  SearchOptions options;
  options.seed = seed;
  options.threads = 1;
  return options;
}

SearchOptions papers(GeneticAlgorithm method = {}, std::uint64_t seed = 1) {
  SearchOptions options = with_seed(seed);
  options.method = method;
  return options;
}

/// All of a result, in text: equal texts are equal bytes.
std::string text_of(const SearchResult& result) {
  const auto bytes = [](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return std::to_string(bits) + " ";
  };
  std::string text;
  for (const SearchRecord& record : result.history) {
    for (const double number : record.point) text += bytes(number);
    text += bytes(record.outcome.fitness) + bytes(record.outcome.violation);
    text += std::string(name(record.outcome.status)) + record.outcome.reason;
    text += std::to_string(static_cast<int>(record.origin)) + "," +
            std::to_string(static_cast<int>(record.source)) + "," +
            std::to_string(record.generation) + "," + std::to_string(record.polish) + ":";
    for (const int parent : record.parents) text += " " + std::to_string(parent);
    text += "\n";
  }
  for (const double number : result.best) text += bytes(number);
  for (const int count : {result.asked, result.evaluations, result.cached, result.repair,
                          result.infeasible, result.failed}) {
    text += std::to_string(count) + " ";
  }
  return text + name(result.stopped_by);
}

// The paper's algorithm -------------------------------------------------------------------------

/// Every point asked and the best fitness, mixed (FNV-1a). No function of <cmath>: the same bits on
/// every machine.
std::uint64_t course_of(const SearchOptions& options, int& evaluations) {
  std::uint64_t hash = 1469598103934665603ULL;
  const auto mix = [&](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; ++i) hash = (hash ^ ((bits >> (8 * i)) & 255)) * 1099511628211ULL;
  };
  const auto result = search(problem([&](const VectorXd& x) -> std::optional<double> {
                               for (const double number : x) mix(number);
                               if (x(1) > 0.8) return std::nullopt;
                               return 2.0 - (x(0) - 0.7) * (x(0) - 0.7) -
                                      3 * (x(1) - 0.2) * (x(1) - 0.2) -
                                      0.5 * (x(2) - x(0)) * (x(2) - x(0));
                             }),
                             options);
  mix(result.outcome.fitness);
  evaluations = result.evaluations;
  return hash;
}

TEST(PapersAlgorithm, GoesTheSameCourseAsEver) {
  struct Course {
    std::uint64_t seed;
    double mutation;
    int evaluations;
    std::uint64_t hash;
  };
  for (const Course& course :
       {Course{1, 0.1, 452, 0xb6328c3b98e3c941ULL}, Course{1, 0.3, 800, 0x625315f54dd55dc5ULL},
        Course{2, 0.1, 410, 0x51ed3be2ad60d2a2ULL}, Course{2, 0.3, 824, 0xe04ffd4a490fecd2ULL},
        Course{3, 0.1, 166, 0x3c757c16d911c98eULL}, Course{3, 0.3, 335, 0xce12cf58473c09a9ULL}}) {
    GeneticAlgorithm method;
    method.mutation = course.mutation;
    method.population = course.seed == 3 ? 21 : 50;
    SearchOptions options = papers(method, course.seed);
    if (course.seed == 2) options.start = {VectorXd::Constant(3, 0.6)};
    int evaluations = 0;
    EXPECT_EQ(course_of(options, evaluations), course.hash);
    EXPECT_EQ(evaluations, course.evaluations);
  }
}

TEST(PapersAlgorithm, FindsHartmannsMaximum) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_GT(search(problem(hartmann), papers({}, seed)).outcome.fitness, 0.95 * hartmann_maximum);
  }
}

TEST(PapersAlgorithm, GivenPointsBeyondThePopulationAreEvaluatedToo) {
  GeneticAlgorithm method;
  method.population = 2;
  method.generations = 4;
  SearchOptions options = papers(method);
  for (const double at : {0.1, 0.2, 0.3, 0.4, 0.7}) {
    options.start.push_back(VectorXd::Constant(3, at));
  }
  const SearchResult result = search(problem(hill), options);
  EXPECT_DOUBLE_EQ(result.outcome.fitness, 2.0);  // at the last of them
  EXPECT_EQ(result.asked, 5 + 3);                 // the later generations are no larger than asked
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(result.history[i].origin, Origin::given);
}

TEST(PapersAlgorithm, KeepsAsManyAsAskedAndBreedsFromTheRest) {
  GeneticAlgorithm method;
  method.population = 10;
  method.generations = 4;
  for (const int elites : {0, 1, 4}) {
    method.elites = elites;
    const SearchResult result = search(problem(hill), papers(method));
    EXPECT_EQ(result.asked, 10 + 3 * (10 - elites));
    std::vector<int> first(10);
    std::iota(first.begin(), first.end(), 0);
    std::stable_sort(first.begin(), first.end(), [&](int a, int b) {
      return better(result.history[static_cast<std::size_t>(a)].outcome,
                    result.history[static_cast<std::size_t>(b)].outcome);
    });
    for (const SearchRecord& record : result.history) {
      if (record.generation != 1) continue;
      for (const int parent : record.parents) {
        EXPECT_EQ(std::count(first.begin(), first.begin() + elites, parent), 0) << elites;
      }
    }
  }
}

TEST(PapersAlgorithm, WithoutMutationEveryGeneComesFromTheFirstGeneration) {
  GeneticAlgorithm method;
  method.population = 20;
  method.mutation = 0.0;
  method.crossover = 1.0;
  const SearchResult result = search(problem(hill), papers(method));
  ASSERT_GT(result.evaluations, 20);  // crossover did make new combinations
  for (const SearchRecord& record : result.history) {
    for (Eigen::Index gene = 0; gene < 3; ++gene) {
      bool inherited = false;
      for (std::size_t i = 0; i < 20; ++i) {
        inherited = inherited || result.history[i].point(gene) == record.point(gene);
      }
      EXPECT_TRUE(inherited);
    }
  }
}

// Quality ---------------------------------------------------------------------------------------

/// Evaluations until the true value of an asked point reaches a share of the maximum; 0: never.
int evaluations_to(double share, const functions::Function& function, SearchOptions options,
                   const Objective& objective) {
  if (!function.seen) options.stop.target = share * function.maximum;
  const SearchResult result = search(problem(objective), options);
  int evaluations = 0;
  for (const SearchRecord& record : result.history) {
    evaluations += record.source == Source::simulated ? 1 : 0;
    if (record.outcome.ok() && function.value(record.point) >= share * function.maximum) {
      return evaluations;
    }
  }
  return 0;
}

/// Goes on until a stop rule ends it.
MemeticSearch endless() {
  MemeticSearch method;
  method.generations = 10000;
  return method;
}

Objective seen(const functions::Function& function) {
  return [function](const VectorXd& x) -> Evaluation {
    if (function.value(x) == 0.0) return Evaluation::infeasible(0.0);
    return function.seen ? function.seen(x) : function.value(x);
  };
}

TEST(Search, FindsTheBestDigOfFiftySeedsWithinFourHundredEvaluations) {
  double log_sum = 0.0;
  for (const functions::DigFamily& family : functions::dig_families()) {
    int all = 0;
    int successes = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      const functions::Function function = family.function(seed);
      SearchOptions options = with_seed(seed);
      options.stop.evaluations = 400;
      const int needed = evaluations_to(0.99, function, options, seen(function));
      all += needed > 0 ? needed : 400;
      successes += needed > 0 ? 1 : 0;
    }
    // One per cent of noise hides the last per cent of the optimum now and then.
    EXPECT_GE(successes, family.noise > 0.0 ? 44 : 50) << family.name;
    log_sum += std::log(static_cast<double>(all) / successes) / 5.0;
  }
  EXPECT_LE(std::exp(log_sum), 90.0);
}

TEST(Search, FindsTheNarrowHumpBesideTheBroadOne) {
  SearchOptions options;
  options.method = endless();
  options.stop.evaluations = 4000;
  options.stop.target = 0.99;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    options.seed = seed;
    EXPECT_EQ(search(problem(functions::two_humps), options).stopped_by, StopReason::target)
        << seed;
  }
}

TEST(Search, AGoodStartIsEnoughWithSixtyEvaluations) {
  std::vector<functions::DigFamily> densities;  // each is searched from the one before
  for (int percent = 0; percent <= 100; percent += 5) densities.push_back({"", {0.01 * percent}});
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SearchOptions options = with_seed(seed);
    options.stop.evaluations = 400;
    for (const functions::DigFamily& density : densities) {
      const functions::Function function = density.function(seed);
      const SearchResult result = search(problem(seen(function)), options);
      EXPECT_GE(result.outcome.fitness, 0.99 * function.maximum)
          << seed << " " << density.dig.density;
      options.start = {result.best};
      options.stop.evaluations = 60;
    }
  }
}

TEST(Search, AProbeThatBeatsTheInheritedStartIsPolishedToo) {
  SearchOptions options = with_seed(1);
  options.start = {VectorXd::Constant(3, 0.02)};  // far away and low
  const SearchResult result = search(problem(hartmann), options);
  bool polished = false;
  for (const SearchRecord& record : result.history) {
    if (record.origin != Origin::polish || record.generation > 0) continue;
    const SearchRecord& parent = result.history[static_cast<std::size_t>(record.parents.at(0))];
    polished = polished || parent.origin == Origin::space_filling;
  }
  EXPECT_TRUE(polished);
  EXPECT_EQ(result.history.front().origin, Origin::given);
  EXPECT_EQ(result.history[1].origin, Origin::polish);
}

TEST(Search, FlatSidesOfTheBoxAndOneDimensionAreFine) {
  SearchProblem flat = problem(hill);
  flat.box.lower(1) = flat.box.upper(1) = 0.7;
  const SearchResult result = search(flat);
  EXPECT_NEAR(result.outcome.fitness, 2.0, 1e-3);
  EXPECT_EQ(result.best(1), 0.7);
  const SearchProblem point = {{VectorXd::Ones(2), VectorXd::Ones(2)},
                               [](const VectorXd& x) { return x.sum(); }};
  EXPECT_EQ(search(point).evaluations, 1);
  const SearchProblem line = {{VectorXd::Constant(1, -1.0), VectorXd::Constant(1, 3.0)},
                              [](const VectorXd& x) { return -std::abs(x(0) - 2.5); }};
  EXPECT_NEAR(search(line).best(0), 2.5, 0.01);
}

// What holds for both methods, and for both polishes
// -------------------------------------------------------------------

class BothMethods : public testing::TestWithParam<std::string> {
 protected:
  static SearchOptions options(std::uint64_t seed = 1) {
    if (GetParam() == "Memetic") return with_seed(seed);
    if (GetParam() == "Evolution") {
      SearchOptions options = with_seed(seed);
      std::get<MemeticSearch>(options.method).polishing = Polishing::evolution;
      return options;
    }
    GeneticAlgorithm method;
    method.population = 20;
    return papers(method, seed);
  }
};
INSTANTIATE_TEST_SUITE_P(Search, BothMethods, testing::Values("Memetic", "Evolution", "Genetic"),
                         [](const auto& method) { return method.param; });

TEST_P(BothMethods, SameBytesForAnyThreadsAndAnyOrderOfCompletion) {
  SearchOptions one = options();
  const std::string expected = text_of(search(problem(hartmann), one));
  const auto in_disorder = [](const VectorXd& x) {
    std::this_thread::sleep_for(std::chrono::microseconds(static_cast<int>(x.sum() * 1e7) % 40));
    return hartmann(x);
  };
  for (const unsigned threads : {1U, 2U, 3U, 4U, 8U, 16U, 32U}) {
    one.threads = threads;
    EXPECT_EQ(text_of(search(problem(in_disorder), one)), expected) << threads;
  }
}

TEST_P(BothMethods, AnotherSeedIsAnotherSearch) {
  EXPECT_NE(search(problem(hill), options(1)).best, search(problem(hill), options(2)).best);
}

TEST_P(BothMethods, StaysInTheBoxAndAsksNothingTwice) {
  std::vector<VectorXd> points;
  const SearchBox box{VectorXd::Constant(3, -2.0), VectorXd::Constant(3, 5.0)};
  const SearchResult result = search({box,
                                      [&](const VectorXd& x) {
                                        points.push_back(x);
                                        return hill(x);
                                      }},
                                     options());
  EXPECT_EQ(result.evaluations, static_cast<int>(points.size()));
  EXPECT_EQ(result.asked, result.evaluations + result.cached + result.repair);
  EXPECT_EQ(result.asked, static_cast<int>(result.history.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GE(points[i].minCoeff(), -2.0);
    EXPECT_LE(points[i].maxCoeff(), 5.0);
    for (std::size_t j = 0; j < i; ++j) ASSERT_NE(points[i], points[j]);
  }
}

TEST_P(BothMethods, TheBestIsTheBestOfTheHistory) {
  const SearchResult result = search(problem(hartmann), options());
  for (const SearchRecord& record : result.history) {
    EXPECT_FALSE(better(record.outcome, result.outcome));
    for (const int parent : record.parents) {
      EXPECT_LT(parent, &record - result.history.data());
    }
  }
  EXPECT_EQ(hartmann(result.best), result.outcome.fitness);
}

TEST_P(BothMethods, AGivenStartIsNeverLost) {
  SearchOptions given = options();
  given.start = {VectorXd::Constant(3, 0.7), VectorXd::Constant(3, 9.0)};
  const SearchResult result = search(problem(hill), given);
  EXPECT_DOUBLE_EQ(result.outcome.fitness, 2.0);
  EXPECT_EQ(result.history[0].origin, Origin::given);
  EXPECT_EQ(result.history[1].point, VectorXd::Ones(3));  // clipped
}

TEST_P(BothMethods, StopsForTheReasonItGives) {
  SearchOptions stop = options();
  EXPECT_EQ(search(problem(hill), stop).stopped_by, StopReason::generations);
  for (const int limit : {1, 17, 33, 100}) {
    stop = options();
    stop.stop.evaluations = limit;
    const SearchResult result = search(problem(hill), stop);
    EXPECT_EQ(result.stopped_by, StopReason::evaluations);
    EXPECT_EQ(result.evaluations, limit);
  }
  stop = options();
  stop.stop.target = 1.8;
  EXPECT_EQ(search(problem(hill), stop).stopped_by, StopReason::target);
  EXPECT_LT(search(problem(hill), stop).evaluations, search(problem(hill), options()).evaluations);
  stop = options();
  stop.stop.stall = 40;
  EXPECT_EQ(search(problem([](const VectorXd&) { return 1.0; }), stop).stopped_by,
            StopReason::stall);
  const SearchResult stalled = search(problem(hill), stop);
  int at_best = 0;
  for (const SearchRecord& record : stalled.history) {
    at_best += record.source == Source::simulated ? 1 : 0;
    if (record.outcome.fitness == stalled.outcome.fitness) break;
  }
  EXPECT_GE(stalled.evaluations - at_best, 40);
  stop = options();
  stop.stop.seconds = 1e-9;
  const SearchResult late = search(problem(hill), stop);
  EXPECT_EQ(late.stopped_by, StopReason::seconds);
  EXPECT_EQ(late.evaluations, 1);
}

TEST(Search, APolishEndsAtTheTarget) {
  SearchOptions options = with_seed(1);
  options.stop.target = 1.99;
  const SearchResult result = search(problem(hill), options);
  int reached = 0;
  for (std::size_t i = 0; i < result.history.size(); ++i) {
    const SearchRecord& record = result.history[i];
    if (record.polish == 0 || record.outcome.fitness < 1.99) continue;
    ++reached;
    EXPECT_TRUE(i + 1 == result.history.size() || result.history[i + 1].polish != record.polish);
  }
  EXPECT_GT(reached, 0);
}

TEST_P(BothMethods, AShorterSearchIsTheBeginningOfALongerOne) {
  const SearchResult whole = search(problem(hartmann), options());
  SearchOptions stop = options();
  stop.stop.evaluations = whole.evaluations / 2;
  const SearchResult half = search(problem(hartmann), stop);
  for (std::size_t i = 0; i < 18; ++i) {  // up to the first polish that had to be shorter
    EXPECT_EQ(half.history[i].point, whole.history[i].point);
  }
}

TEST_P(BothMethods, ProgressCanCancelAtAnyEvaluation) {
  for (const int moment : {1, 7, 30, 101}) {
    SearchOptions cancelled = options();
    int calls = 0;
    double last = -1.0;
    cancelled.progress = [&](const SearchProgress& progress) {
      ++calls;
      EXPECT_FALSE(progress.best < last);
      last = progress.best;
      return progress.evaluations < moment;
    };
    const SearchResult result = search(problem(hill), cancelled);
    EXPECT_EQ(result.stopped_by, StopReason::cancelled);
    EXPECT_EQ(result.evaluations, moment);
    EXPECT_GE(calls, moment);
    EXPECT_EQ(result.outcome.fitness, last);
  }
}

TEST_P(BothMethods, ProgressKnowsWhatIsLeft) {
  SearchOptions watched = options();
  watched.stop.evaluations = 120;
  SearchProgress last;
  watched.progress = [&](const SearchProgress& progress) {
    EXPECT_GE(progress.seconds_left, 0.0);
    last = progress;
    return true;
  };
  search(problem(hill), watched);
  EXPECT_EQ(last.evaluations, 120);
  EXPECT_EQ(last.planned, 120);
  EXPECT_EQ(last.seconds_left, 0.0);
  EXPECT_LE(last.mean, last.best);
}

TEST_P(BothMethods, ProgressIsToldOfEveryEvaluationAndBatch) {
  SearchOptions watched = options();
  int calls = 0;
  SearchProgress last;
  watched.progress = [&](const SearchProgress& progress) {
    ++calls;
    EXPECT_GE(progress.evaluations, last.evaluations);
    EXPECT_LE(progress.evaluations, last.evaluations + 1);
    last = progress;
    return true;
  };
  const SearchResult result = search(problem(hill), watched);
  EXPECT_EQ(last.evaluations, result.evaluations);
  EXPECT_EQ(calls, result.evaluations + last.generation + 1);
}

TEST_P(BothMethods, PlansNoMoreThanAnIntCanHold) {
  SearchOptions endless = options();
  int most = std::numeric_limits<int>::max();
  if (auto* genetic = std::get_if<GeneticAlgorithm>(&endless.method)) {
    genetic->generations = most_evaluations / genetic->population;
    most = genetic->population + (genetic->generations - 1) * (genetic->population - 1);
  } else {
    auto& memetic = std::get<MemeticSearch>(endless.method);
    memetic.polish_evaluations = most_evaluations;
    memetic.basins = most;
  }
  int planned = 0;
  endless.progress = [&](const SearchProgress& progress) {
    planned = progress.planned;
    return progress.evaluations < 40;
  };
  EXPECT_EQ(search(problem(hill), endless).evaluations, 40);
  EXPECT_EQ(planned, most);
}

TEST_P(BothMethods, AnErrorOfTheProgressCallbackArrives) {
  SearchOptions broken = options();
  broken.progress = [](const SearchProgress& progress) -> bool {
    if (progress.evaluations == 40) throw Error(ErrorKind::bad_input, "the console is gone");
    return true;
  };
  EXPECT_EQ(error_of([&] { search(problem(hill), broken); }), "the console is gone");
}

// Bad simulators --------------------------------------------------------------------------------

/// 5 % each of NaN, infinity, exception and time-out, always the same at the same point.
Objective unreliable(Objective objective, std::uint64_t seed) {
  return [objective = std::move(objective), seed](const VectorXd& x) -> Evaluation {
    const double draw = std::abs(functions::noise_at(x, 1.0, seed)) * 1e6;
    switch (static_cast<int>(draw) % 20) {
      case 0:
        return std::numeric_limits<double>::quiet_NaN();
      case 1:
        return std::numeric_limits<double>::infinity();
      case 2:
        throw std::runtime_error("engine on fire");
      case 3:
        return Evaluation::timed_out("after 60 s");
      default:
        return objective(x);
    }
  };
}

TEST(BadSimulator, CostsLessThanAThirdMore) {
  double sound_sum = 0.0;
  double bad_sum = 0.0;
  for (const functions::DigFamily& family : functions::dig_families()) {
    if (family.noise > 0.0) continue;
    int sound = 0;
    int bad = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      const functions::Function function = family.function(seed);
      SearchOptions options = with_seed(seed);
      options.stop.evaluations = 400;
      sound += evaluations_to(0.99, function, options, seen(function));
      options.method = endless();
      options.stop.evaluations = 2000;
      const int needed = evaluations_to(0.99, function, options, unreliable(seen(function), seed));
      EXPECT_GT(needed, 0) << family.name << " " << seed;
      bad += needed;
    }
    sound_sum += std::log(sound);
    bad_sum += std::log(bad);
  }
  RecordProperty("ratio", std::to_string(std::exp((bad_sum - sound_sum) / 4.0)));
  EXPECT_LE(std::exp((bad_sum - sound_sum) / 4.0), 1.3);
}

TEST_P(BothMethods, NeverBelievesAFailure) {
  const SearchResult result = search(problem(unreliable(hill, 3)), options());
  ASSERT_TRUE(result.feasible());
  EXPECT_EQ(result.outcome.fitness, hill(result.best));
  int failed = 0;
  std::vector<std::string> reasons;
  for (const SearchRecord& record : result.history) {
    if (record.source != Source::simulated || record.outcome.ok()) continue;
    ++failed;
    reasons.push_back(record.outcome.reason);
  }
  EXPECT_EQ(result.failed, failed);
  for (const char* reason :
       {"the fitness is nan", "the fitness is inf", "engine on fire", "after 60 s"}) {
    EXPECT_EQ(std::count(reasons.begin(), reasons.end(), reason) > 0, true) << reason;
  }
}

TEST_P(BothMethods, WhenAllFailsTheFirstReasonIsQuoted) {
  int calls = 0;
  const auto broken = [&](const VectorXd&) -> Evaluation {
    if (++calls == 1) throw Error(ErrorKind::bad_input, "engine on fire");
    throw std::runtime_error("again");
  };
  EXPECT_EQ(error_of([&] { search(problem(broken), options()); }),
            "search: all of the first 20 evaluations failed, the first one: engine on fire");
  EXPECT_EQ(calls, 20);
  SearchOptions shorter = options();
  shorter.stop.evaluations = 5;
  EXPECT_EQ(error_of([&] { search(problem(broken), shorter); }),
            "search: all of the first 5 evaluations failed, the first one: again");
}

TEST_P(BothMethods, NothingFeasibleIsAResult) {
  const SearchResult none =
      search(problem([](const VectorXd&) { return std::optional<double>(); }), options());
  EXPECT_FALSE(none.feasible());
  EXPECT_EQ(none.infeasible, none.evaluations);
  EXPECT_EQ(none.outcome.status, Status::infeasible);
}

TEST(Search, FollowsTheViolationToTheFeasibleCorner) {
  const auto corner = [](const VectorXd& x) -> Evaluation {
    const double outside = (x.array() - 0.03).cwiseMax(0.0).sum();
    return outside > 0.0 ? Evaluation::infeasible(outside, "off the corner") : 1.0 + x.sum();
  };
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SearchResult result = search(problem(corner), with_seed(seed));
    EXPECT_TRUE(result.feasible()) << seed;
    EXPECT_GT(result.outcome.fitness, 1.05) << seed;
  }
}

/// A hill that is feasible below a plane through its flank, from a given point on the plane.
SearchResult on_the_flank(Polishing polishing, std::uint64_t seed) {
  const Objective flank = [](const VectorXd& x) -> Evaluation {
    return x.sum() > 1.2 ? Evaluation::infeasible(0.5) : hill(x);
  };
  MemeticSearch method;
  method.first_generation = method.generations = 0;
  method.polishing = polishing;
  method.polish_evaluations = 120;
  SearchOptions options = with_seed(seed);
  options.method = method;
  options.stop.evaluations = 120;
  options.start = {Eigen::Vector3d(0.9, 0.15, 0.15)};
  return search(problem(flank), options);
}

TEST(Search, AnEvolutionGoesAlongAnEdge) {
  const double best = hill(VectorXd::Constant(3, 0.4));
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    EXPECT_GT(on_the_flank(Polishing::evolution, seed).outcome.fitness, 0.97 * best) << seed;
  }
  EXPECT_LT(on_the_flank(Polishing::simplex, 1).outcome.fitness, 0.85 * best);
}

TEST(Search, AnEvolutionEndsAtFacesOfTheBox) {
  MemeticSearch method;
  method.first_generation = method.generations = 0;
  method.polishing = Polishing::evolution;
  SearchOptions options = with_seed(1);
  options.method = method;
  options.start = {VectorXd::Constant(3, 0.5)};
  const SearchResult found =
      search(problem([](const VectorXd& x) { return x(0) - x(1); }), options);
  EXPECT_EQ(found.best(0), 1.0);
  EXPECT_EQ(found.best(1), 0.0);
}

TEST(Evaluations, FeasibleThenViolationThenFitness) {
  const Evaluation good(2.0);
  const Evaluation poor(1.0);
  const Evaluation near = Evaluation::infeasible(0.1);
  const Evaluation far = Evaluation::infeasible(3.0);
  const Evaluation failed = Evaluation::failed("broken");
  const std::vector<Evaluation> order = {good, poor, near, far, failed};
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = 0; j < order.size(); ++j) EXPECT_EQ(better(order[i], order[j]), i < j);
  }
  EXPECT_FALSE(better(failed, Evaluation::timed_out("slow")));
  EXPECT_EQ(Evaluation::infeasible(std::nan("")).status, Status::failed);
}

// Repair and steps ------------------------------------------------------------------------------

TEST_P(BothMethods, RepairComesFirstAndIsFree) {
  SearchProblem repaired = problem([](const VectorXd& x) {
    EXPECT_GE(x(0), 0.5);
    EXPECT_LE(x(1), 0.8);
    EXPECT_LE(x(2), 1.0);
    return hill(x);
  });
  repaired.repair = [](const VectorXd& x) -> std::variant<VectorXd, Evaluation> {
    if (x(1) > 0.8) return Evaluation::infeasible(x(1) - 0.8, "too long");
    VectorXd fit = x;
    fit(0) = std::max(0.5, fit(0));
    if (x(2) > 0.9) fit(2) = 7.0;  // clipped
    return fit;
  };
  const SearchResult result = search(repaired, options());
  EXPECT_GT(result.outcome.fitness, 1.98);
  EXPECT_GT(result.repair, 0);
  EXPECT_EQ(result.asked, result.evaluations + result.cached + result.repair);
  for (const SearchRecord& record : result.history) {
    EXPECT_EQ(record.source == Source::repair, record.point(1) > 0.8);
    EXPECT_EQ(record.outcome.reason, record.source == Source::repair ? "too long" : "");
  }
}

TEST_P(BothMethods, ARepairThatRefusesAllEnds) {
  SearchProblem refused = problem(hill);
  refused.repair = [](const VectorXd&) { return Evaluation::infeasible(1.0, "no"); };
  const SearchResult result = search(refused, options());
  EXPECT_FALSE(result.feasible());
  EXPECT_EQ(result.evaluations, 0);
  EXPECT_EQ(result.outcome.reason, "no");
}

TEST_P(BothMethods, ARepairThatBreaksIsAFailureOfThePoint) {
  SearchProblem broken = problem(hill);
  broken.repair = [](const VectorXd& x) -> std::variant<VectorXd, Evaluation> {
    if (x(0) < 0.1) return VectorXd(VectorXd::Zero(2));
    if (x(0) < 0.2) return VectorXd(VectorXd::Constant(3, std::nan("")));
    if (x(0) < 0.3) return Evaluation(5.0);
    if (x(0) < 0.35) throw std::runtime_error("no spare part");
    if (x(0) < 0.4) {
      Evaluation lost = Evaluation::infeasible(1.0);
      lost.violation = std::nan("");  // would be in no order with others
      return lost;
    }
    return x;
  };
  const SearchResult result = search(broken, options());
  EXPECT_GT(result.outcome.fitness, 1.98);
  for (const SearchRecord& record : result.history) {
    EXPECT_EQ(record.outcome.status, record.point(0) < 0.4 ? Status::failed : Status::ok);
  }
}

TEST_P(BothMethods, StepsMakePointsOfAGridAndTheCacheMeetsThem) {
  SearchProblem stepped = problem([](const VectorXd& x) {
    for (const double number : x) EXPECT_NEAR(number * 10.0, std::round(number * 10.0), 1e-9);
    return hill(x);
  });
  stepped.step = VectorXd::Constant(3, 0.1);
  stepped.box.upper.setConstant(0.97);  // no multiple of the step
  const SearchResult result = search(stepped, options());
  EXPECT_GT(result.cached, 20);
  EXPECT_NEAR(result.outcome.fitness, 2.0, 1e-12);
}

// Checkpoint ------------------------------------------------------------------------------------

class SearchCheckpointFile : public testing::Test {
 protected:
  void TearDown() override { std::remove(file_.c_str()); }

  SearchOptions options(unsigned threads = 1) const {
    SearchOptions options = with_seed(4);
    options.threads = threads;
    options.checkpoint = file_;
    options.checkpoint_interval = 0.0;
    options.resume = true;
    options.stop.evaluations = 250;
    return options;
  }
  static SearchProblem with_fingerprint(Objective objective) {
    SearchProblem named = problem(std::move(objective));
    named.fingerprint = "hartmann 3";
    return named;
  }
  /// What is said of a changed file.
  std::string refusal(const std::string& content) const {
    std::ofstream(file_, std::ios::binary) << content;
    const std::string text =
        error_of([&] { search(with_fingerprint(hartmann), options()); }, ErrorKind::bad_file);
    return text.rfind(file_, 0) == 0 ? text.substr(file_.size()) : text;
  }
  /// A search cut off after some evaluations.
  void cut_off(int evaluations, SearchOptions options, const Objective& objective) const {
    options.progress = [evaluations](const SearchProgress& progress) {
      return progress.evaluations < evaluations;
    };
    search(with_fingerprint(objective), options);
  }

  const std::string file_ =
      testing::TempDir() + "excavplan_search_" + std::to_string(::getpid()) + ".json";
};

TEST_F(SearchCheckpointFile, KilledAtAHundredMomentsAndResumedGivesTheSameBytes) {
  const Objective objective = unreliable(hartmann, 8);
  SearchOptions uninterrupted = options();
  uninterrupted.checkpoint.clear();
  uninterrupted.resume = false;
  const std::string expected = text_of(search(with_fingerprint(objective), uninterrupted));
  Random random(11);
  for (int round = 0; round < 100; ++round) {
    std::remove(file_.c_str());
    SearchOptions often = options(1 + static_cast<unsigned>(round) % 4);
    often.checkpoint_interval = round % 20 == 0 ? 0.0 : 1e9;
    for (int at = 0; at < 240;) {
      at += 1 + static_cast<int>(random.index(200));
      cut_off(at, often, objective);
    }
    std::atomic<int> calls{0};
    const auto counting = [&](const VectorXd& x) {
      ++calls;
      return objective(x);
    };
    ASSERT_EQ(text_of(search(with_fingerprint(counting), often)), expected) << round;
    EXPECT_LT(calls.load(), 40);
  }
}

TEST_F(SearchCheckpointFile, AFinishedSearchIsNotSimulatedAgainAndMayGoFurther) {
  search(with_fingerprint(hartmann), options());
  int calls = 0;
  const auto counting = [&](const VectorXd& x) {
    ++calls;
    return hartmann(x);
  };
  search(with_fingerprint(counting), options());
  EXPECT_EQ(calls, 1);  // the best, to see whether the file holds
  SearchOptions further = options();
  further.stop.evaluations = 300;
  const SearchResult result = search(with_fingerprint(counting), further);
  EXPECT_EQ(result.evaluations, 300);
  EXPECT_LE(calls, 100);
  further.checkpoint.clear();
  EXPECT_EQ(text_of(result), text_of(search(with_fingerprint(hartmann), further)));
}

TEST_F(SearchCheckpointFile, KnowsWhatASearchFromOtherPointsAsksAgain) {
  search(with_fingerprint(hartmann), options());
  SearchOptions from_there = options();
  from_there.start = {VectorXd::Constant(3, 0.4)};
  int calls = 0;
  const auto counting = [&](const VectorXd& x) {
    ++calls;
    return hartmann(x);
  };
  const SearchResult resumed = search(with_fingerprint(counting), from_there);
  EXPECT_LT(calls, resumed.evaluations);
  from_there.checkpoint.clear();
  EXPECT_EQ(text_of(resumed), text_of(search(with_fingerprint(hartmann), from_there)));
}

TEST_F(SearchCheckpointFile, IsRefusedForAnotherSettingOfThePapersAlgorithm) {
  const GeneticAlgorithm usual;
  const auto resumed_with = [&](const GeneticAlgorithm& method) {
    SearchOptions genetic = options();
    genetic.method = method;
    return error_about([&] { search(with_fingerprint(hartmann), genetic); }, file_);
  };
  std::vector<GeneticAlgorithm> others(6, usual);
  others[0].population = 49;
  others[1].generations = 21;
  others[2].tournament = 4;
  others[3].crossover = 0.8;
  others[4].mutation = 0.2;
  others[5].elites = 2;
  SearchOptions genetic = options();
  genetic.method = usual;
  cut_off(20, genetic, hartmann);
  for (const GeneticAlgorithm& other : others) {
    const std::string refused = resumed_with(other);
    EXPECT_EQ(refused.rfind("search: is 'genetic algorithm: ", 0), 0U) << refused;
  }
}

TEST_F(SearchCheckpointFile, IsRefusedForAnotherSettingOfTheMemeticSearch) {
  MemeticSearch by_evolution;
  by_evolution.polishing = Polishing::evolution;
  MemeticSearch more_restarts;
  more_restarts.restarts = 2;
  cut_off(20, options(), hartmann);
  for (const MemeticSearch& other : {by_evolution, more_restarts}) {
    SearchOptions changed = options();
    changed.method = other;
    EXPECT_NE(error_about([&] { search(with_fingerprint(hartmann), changed); }, file_), "");
  }
}

TEST_F(SearchCheckpointFile, IsRefusedForAnotherSearch) {
  cut_off(20, options(), hartmann);
  SearchProblem other = with_fingerprint(hartmann);
  other.fingerprint = "hartmann 6";
  EXPECT_EQ(error_about([&] { search(other, options()); }, file_),
            "problem: is 'hartmann 3, box 0 0 0 to 1 1 1', which differs from "
            "'hartmann 6, box 0 0 0 to 1 1 1'");
  SearchOptions seeded = options();
  seeded.seed = 5;
  EXPECT_NE(error_about([&] { search(with_fingerprint(hartmann), seeded); }, file_).find("seed 5"),
            std::string::npos);
  other.fingerprint = "";
  EXPECT_EQ(error_of([&] { search(other, options()); }),
            "search: a checkpoint needs the fingerprint of the problem, it is empty");
}

TEST_F(SearchCheckpointFile, WhatNoRunCouldResumeFromIsRefusedAtTheBeginning) {
  SearchProblem problem = with_fingerprint([](const Eigen::VectorXd&) -> Evaluation {
    ADD_FAILURE() << "was called";
    return 0.0;
  });
  const std::string start =
      "search: a checkpoint holds the fingerprint and the box of the problem, ";
  const auto refusal = [&](const std::string& fingerprint) {
    problem.fingerprint = fingerprint;
    return error_of([&] { search(problem, options()); });
  };
  EXPECT_EQ(refusal("zx\n120").rfind(start + "which is 'zx?120, box", 0), 0U);
  EXPECT_EQ(refusal("zx\xff"), start + "which is not UTF-8");
  EXPECT_EQ(refusal(std::string(70000, 'x')).rfind(start + "which is a text of 700", 0), 0U);
  EXPECT_FALSE(std::ifstream(file_).is_open());
}

TEST_F(SearchCheckpointFile, ReplacesNoOtherFileResumedOrNot) {
  for (const bool resume : {false, true}) {
    SearchOptions begun = options();
    begun.resume = resume;
    std::ofstream(file_) << "# Notes";
    EXPECT_EQ(error_of([&] { search(with_fingerprint(hartmann), begun); }, ErrorKind::bad_file),
              file_ + ": is no checkpoint of a search; name another file, or remove this one");
    EXPECT_EQ(read_file(file_), "# Notes");
    std::ofstream(file_).flush();  // empty
    if (!resume) search(with_fingerprint(hartmann), begun);
  }
}

TEST_F(SearchCheckpointFile, TruncatedOrAlteredIsRefusedAtEveryByte) {
  cut_off(3, options(), hartmann);
  const std::string good = read_file(file_);
  EXPECT_EQ(refusal(good), "no error");
  for (std::size_t length = 0; length < good.size(); length += 3) {
    EXPECT_NE(refusal(good.substr(0, length)), "no error") << length;
  }
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string altered = good;
    altered[at] = static_cast<char>(altered[at] ^ (1 << (at % 8)));
    EXPECT_NE(refusal(altered), "no error") << at;
  }
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return refusal(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_EQ(with("\"version\": 1", "\"version\": 2"),
            ": version: is 2, this program reads version 1");
  EXPECT_EQ(with("\"fitness\":", "\"fitness\":1"),
            ": checksum: does not match the content: the file was modified");
  EXPECT_EQ(with("excavplan-search", "excavplan-soil"),
            ": is no checkpoint of a search; name another file, or remove this one");
}

TEST_F(SearchCheckpointFile, AlteredWithItsChecksumItIsRefusedForItsBest) {
  cut_off(40, options(), hartmann);
  const auto good = nlohmann::ordered_json::parse(read_file(file_));
  const auto altered = [&](const char* key, const nlohmann::json& value) {
    nlohmann::ordered_json json = good;
    json.erase("checksum");
    auto& all = json["evaluations"];
    auto best = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
      return a["fitness"] < b["fitness"];
    });
    (*best)[key] = value;
    return refusal(sealed_text(json));
  };
  EXPECT_EQ(altered("status", "ok"), "no error");
  const std::string lie = altered("fitness", 99.5);
  EXPECT_EQ(lie.rfind(": evaluations: the best point, ", 0), 0U) << lie;
  EXPECT_NE(lie.find(", is ok with fitness 99.5, but evaluated again it is ok with fitness "),
            std::string::npos)
      << lie;
  for (const double fitness : {4.0, 1e300}) EXPECT_NE(altered("fitness", fitness), "no error");
  EXPECT_NE(altered("fitness", nullptr), "no error");
  EXPECT_NE(altered("point", {0.5, 0.5, 0.5}), "no error");
  const std::string outside = altered("point", {0.5, 0.5, 1.5});
  EXPECT_NE(outside.find(".point: is 0.5 0.5 1.5, outside the box of the search"),
            std::string::npos)
      << outside;
}

TEST_F(SearchCheckpointFile, ReasonsInAnyEncodingAndLengthComeBackTheSame) {
  const auto muttering = [](const VectorXd& x) -> Evaluation {
    if (x(0) < 0.3) return Evaluation::failed("\xff\xfe gr\xfc\xdf " + std::string(9000, 'x'));
    if (x(0) < 0.5)
      return Evaluation::infeasible(0.5 - x(0), "\"quoted\"\n\t\xe6\x8e\x98\xe5\x89\x8a");
    return hill(x);
  };
  SearchOptions uninterrupted = options();
  uninterrupted.checkpoint.clear();
  const std::string expected = text_of(search(with_fingerprint(muttering), uninterrupted));
  cut_off(60, options(), muttering);
  EXPECT_EQ(text_of(search(with_fingerprint(muttering), options())), expected);
}

/// What no constructor of Evaluation gives, and a user may fill in.
Evaluation by_hand(const VectorXd& x) {
  Evaluation outcome = hill(x);
  if (x(0) < 0.5) {
    outcome.status = x(0) < 0.1   ? Status::ok
                     : x(0) < 0.2 ? Status::failed
                     : x(0) < 0.3 ? Status::timed_out
                                  : Status::infeasible;
    outcome.violation = x(0) < 0.3    ? 3.0
                        : x(0) < 0.35 ? std::numeric_limits<double>::infinity()
                        : x(0) < 0.4  ? std::nan("")
                        : x(0) < 0.45 ? -1.0
                                      : x(0);
    outcome.reason = "by hand";
  }
  return outcome;
}

TEST_F(SearchCheckpointFile, OutcomesFilledInByHandComeBackTheSame) {
  SearchOptions uninterrupted = options();
  uninterrupted.checkpoint.clear();
  const SearchResult result = search(with_fingerprint(by_hand), uninterrupted);
  std::set<Status> seen;
  for (const SearchRecord& record : result.history) {
    const auto& [status, fitness, violation, reason] = record.outcome;
    seen.insert(status);
    EXPECT_EQ(std::isfinite(fitness), status == Status::ok);
    EXPECT_TRUE(violation >= 0.0 && std::isfinite(violation));
    EXPECT_TRUE(violation == 0.0 || status == Status::infeasible);
    EXPECT_EQ(reason.empty(), status == Status::ok);
  }
  EXPECT_EQ(seen.size(), 4U);
  cut_off(60, options(), by_hand);
  EXPECT_EQ(text_of(search(with_fingerprint(by_hand), options())), text_of(result));
}

TEST_F(SearchCheckpointFile, AFolderThatDoesNotExistIsNoticedBeforeTheSearch) {
  SearchOptions nowhere = options();
  nowhere.checkpoint = "/nowhere/at/all.json";
  const auto never = [](const VectorXd&) -> Evaluation {
    ADD_FAILURE();
    return 0.0;
  };
  EXPECT_EQ(error_about([&] { search(with_fingerprint(never), nowhere); }, nowhere.checkpoint),
            "there is no folder /nowhere/at");
}

// What a search found out ------------------------------------------------------------------------

TEST(SearchInsights, RangesOfAQuadraticAreItsEllipsoid) {
  // 10 - d' M d, M with a cross term; worth 98 % where d' M d <= 0.2: half-widths of the ellipsoid
  // are sqrt(0.2 (M^-1)_ii).
  const SearchBox box{VectorXd::Zero(2), VectorXd::Constant(2, 2.0)};
  const auto bowl = [](const VectorXd& x) {
    const double u = x(0) - 0.9;
    const double v = x(1) - 1.1;
    return 10.0 - (2.0 * u * u + 8.0 * v * v + 4.0 * u * v);
  };
  const SearchResult result = search({box, bowl}, with_seed(2));
  const SearchInsight insight = explain(box, result);
  ASSERT_EQ(insight.fitted.size(), 2U);
  const double half[2] = {std::sqrt(0.2 * 8.0 / 12.0), std::sqrt(0.2 * 2.0 / 12.0)};
  const double centre[2] = {0.9, 1.1};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(insight.fitted[i].low, centre[i] - half[i], 1e-3);
    EXPECT_NEAR(insight.fitted[i].high, centre[i] + half[i], 1e-3);
    EXPECT_GE(insight.seen[i].low, insight.fitted[i].low - 1e-3);
    EXPECT_LE(insight.seen[i].high, insight.fitted[i].high + 1e-3);
    EXPECT_GT(insight.seen[i].high - insight.seen[i].low, half[i]);
  }
}

TEST(SearchInsights, NameTheSecondBasin) {
  const auto twin = [](const VectorXd& x) {
    const auto hump = [&](double height, double place) {
      return height * std::exp(-10.0 * (x.array() - place).square().sum());
    };
    return std::max(hump(1.0, 0.2), hump(0.9, 0.8));
  };
  const SearchResult result = search(problem(twin), with_seed(1));
  const SearchInsight insight = explain(unit_cube(), result);
  EXPECT_LT((result.best - VectorXd::Constant(3, 0.2)).norm(), 0.05);
  ASSERT_TRUE(insight.second_basin);
  const SearchRecord& second = result.history[static_cast<std::size_t>(*insight.second_basin)];
  EXPECT_LT((second.point - VectorXd::Constant(3, 0.8)).norm(), 0.05);
  for (const ParameterRange& range : insight.seen) EXPECT_LT(range.high, 0.5);
}

TEST(SearchInsights, SayNothingOfASearchThatFoundNothing) {
  const SearchResult none =
      search(problem([](const VectorXd&) { return std::optional<double>(); }), with_seed(1));
  const SearchInsight insight = explain(unit_cube(), none);
  EXPECT_FALSE(insight.second_basin);
  EXPECT_TRUE(insight.seen.empty() && insight.fitted.empty());
  EXPECT_TRUE(evaluate_again(none, [](const VectorXd&, int) { return 1.0; }).empty());
}

TEST(SearchInsights, RepeatsTakeTheLuckOutOfTheBest) {
  const auto noisy = [](const VectorXd& x, int repeat) {
    return hartmann(x) * functions::noise_at(x, 0.03, 100 + static_cast<std::uint64_t>(repeat));
  };
  double too_good = 0.0;
  double fair = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SearchResult result =
        search(problem([&](const VectorXd& x) { return noisy(x, -1); }), with_seed(seed));
    const auto again = evaluate_again(result, noisy, 5, 8, 2);
    ASSERT_EQ(again.size(), 5U);
    EXPECT_EQ(again[0].ok, 8);
    EXPECT_GE(again[0].mean, again[1].mean);
    EXPECT_NEAR(again[0].sd, 0.03 * hartmann_maximum, 0.1);
    too_good += result.outcome.fitness / hartmann(result.best) - 1.0;
    fair += again[0].mean / hartmann(again[0].point) - 1.0;
  }
  EXPECT_GT(too_good / 20.0, 0.03);
  EXPECT_LT(std::abs(fair) / 20.0, 0.015);
  EXPECT_LT(fair, too_good / 3.0);
}

TEST(SearchInsights, WhateverARepeatThrowsItIsNotOk) {
  const SearchResult result = search(problem(hill), with_seed(1));
  const auto throwing = [](const VectorXd&, int repeat) -> Evaluation {
    if (repeat == 0) throw 42;
    if (repeat == 1) throw std::runtime_error("no more");
    Evaluation odd = 1.0;
    if (repeat == 2) odd.fitness = std::nan("");
    return odd;
  };
  for (const RepeatedEvaluation& point : evaluate_again(result, throwing, 3, 5)) {
    EXPECT_EQ(point.ok, 2);
    EXPECT_EQ(point.mean, 1.0);
  }
}

TEST(SearchInsights, HistoryAsCsvRedrawsTheSearch) {
  SearchOptions options = with_seed(1);
  options.stop.evaluations = 30;
  const SearchResult result = search(problem([](const VectorXd& x) -> Evaluation {
                                       if (x(0) < 0.5) return Evaluation::failed("a \"b\", c");
                                       return hill(x);
                                     }),
                                     options);
  const std::string csv = to_csv(result);
  EXPECT_EQ(csv.find("place,generation,origin,polish,parents,source,status,fitness,violation,"
                     "reason,x1,x2,x3\n0,0,space filling,0,,simulated,"),
            0U);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), result.asked + 1);
  EXPECT_NE(csv.find(",failed,,0,\"a \"\"b\"\", c\","), std::string::npos);
  EXPECT_NE(csv.find(",polish,1,"), std::string::npos);
}

// Bad input -------------------------------------------------------------------------------------

TEST(Search, MessageNamesTheRuleAndTheValue) {
  GeneticAlgorithm method;
  method.population = 1;
  EXPECT_EQ(error_of([&] { search(problem(hill), papers(method)); }),
            "search: population must be >= 2, got 1");
  method.population = 8;
  for (const int elites : {-1, 8}) {
    method.elites = elites;
    EXPECT_EQ(error_of([&] { search(problem(hill), papers(method)); }),
              "search: elites must be in 0 .. population - 1 = 7, got " + std::to_string(elites));
  }
  MemeticSearch memetic;
  memetic.first_generation = 0;
  SearchOptions options;
  options.method = memetic;
  EXPECT_EQ(error_of([&] { search(problem(hill), options); }),
            "search: first_generation must be >= 1 without given points, got 0");
  options = {};
  options.start = {VectorXd::Constant(3, std::nan(""))};
  EXPECT_EQ(error_of([&] { search(problem(hill), options); }),
            "search: a start must be finite, got nan");
  EXPECT_EQ(error_of([&] {
              search({{VectorXd::Ones(3), VectorXd::Zero(3)}, hill});
            }),
            "search: bounds must be finite and lower <= upper, got 1");
  EXPECT_EQ(error_of([&] { search({unit_cube(), nullptr}); }), "search: the objective is empty");
}

}  // namespace
}  // namespace excavplan
