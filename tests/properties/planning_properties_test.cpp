// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include <algorithm>

#include "planning/dig_layout.hpp"
#include "planning/planned_digs.hpp"
#include "planning/start_rule.hpp"
#include "support/cases.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

PlannedDig any_planned_dig(Random& random) {
  PlannedDig dig;
  dig.parameters.penetration_angle = random.uniform(0.2, 1.4);
  dig.parameters.penetration_length = random.uniform(0.1, 0.9);
  dig.parameters.drag_length = random.uniform(0.3, 3.0);
  dig.start_x = random.uniform(4.0, 8.0);
  for (double PlannedDig::*figure : dig_figures) dig.*figure = random.uniform(0.1, 1000.0);
  return dig;
}

std::vector<double> numbers_of(const PlannedDig& dig) {
  std::vector<double> numbers = {dig.parameters.penetration_angle,
                                 dig.parameters.penetration_length, dig.parameters.drag_length,
                                 dig.start_x};
  for (double PlannedDig::*figure : dig_figures) numbers.push_back(dig.*figure);
  return numbers;
}

void expect_near(const PlannedDig& a, const PlannedDig& b, double tolerance) {
  const std::vector<double> of_a = numbers_of(a), of_b = numbers_of(b);
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    EXPECT_NEAR(of_a[i], of_b[i], tolerance * (1.0 + std::abs(of_b[i]))) << i;
  }
}

Between any_between(Random& random) { return static_cast<Between>(random.index(4)); }

TEST(PlanningProperties, ADigBetweenTwoIsLinearOrOneOfThem) {
  for_cases([](Random& random) {
    const PlannedDig a = any_planned_dig(random);
    const PlannedDig b = any_planned_dig(random);
    const Between between = any_between(random);
    const double share = random.uniform();
    const PlannedDig found = dig_between(a, b, share, between);
    if (between == Between::mix) {
      const auto of_a = numbers_of(a), of_b = numbers_of(b), mixed = numbers_of(found);
      for (std::size_t i = 0; i < mixed.size(); ++i) {
        EXPECT_NEAR(mixed[i], (1.0 - share) * of_a[i] + share * of_b[i], 1e-10);
      }
    } else {
      const bool first = between == Between::lower || (between == Between::nearest && share < 0.5);
      EXPECT_EQ(numbers_of(found), numbers_of(first ? a : b));
    }
    EXPECT_EQ(numbers_of(dig_between(a, b, 0.0, between)), numbers_of(a));
    EXPECT_EQ(numbers_of(dig_between(a, b, 1.0, between)), numbers_of(b));
  });
}

TEST(PlanningProperties, LogPolynomialsGoThroughTheirPoints) {
  for_cases([](Random& random) {
    const double a = random.uniform(-2.0, 2.0), b = random.uniform(-0.05, 0.05);
    const double c = random.uniform(-5e-4, 5e-4);
    const auto truth = [&](double x) { return std::exp(a + b * x + c * x * x); };
    std::vector<std::pair<double, double>> known;
    for (const double x : {0.0, 30.0, 50.0}) known.emplace_back(x, truth(x));
    const double place = random.uniform(-20.0, 80.0);
    EXPECT_NEAR(log_polynomial(known, place) / truth(place), 1.0, 1e-9);
  });
}

/// A fuller bucket of the same worth never ranks lower, and one below its least fill never higher
/// than half of one above.
TEST(PlanningProperties, RankRisesWithWorthAndFill) {
  for_cases([](Random& random) {
    DigObjective objective(static_cast<DigObjective::Goal>(random.index(4)));
    objective.min_fill = random.uniform(0.0, 1.0);
    const double worth = random.uniform(0.0, 10.0), fill = random.uniform(0.0, 1.2);
    const double rank = objective.rank(worth, fill);
    EXPECT_GE(objective.rank(1.1 * worth, fill), rank);
    EXPECT_GE(objective.rank(worth, fill + 0.01), rank);
    EXPECT_LE(rank, fill >= objective.min_fill ? worth : 0.5 * worth);
    EXPECT_EQ(objective.rank(worth, objective.min_fill), worth);
  });
}

/// Probabilities add up, and the mean is that of the distribution cut off at 0 and 100 %, by the
/// density and the distribution function of the normal.
TEST(PlanningProperties, PossibleDensitiesHaveTheMomentsOfTheCutNormal) {
  for_cases([](Random& random) {
    const double mean = random.uniform(0.0, 100.0), sd = random.uniform(1.0, 60.0);
    const int count = drawn_int(random, 2, 6);
    const auto densities = possible_densities(mean, sd, count);
    ASSERT_EQ(densities.size(), static_cast<std::size_t>(count));
    double sum = 0.0, first = 0.0, second = 0.0;
    for (const auto& [percent, probability] : densities) {
      EXPECT_TRUE(percent > 0.0 && percent < 100.0 && probability > 0.0);
      sum += probability;
      first += probability * percent;
      second += probability * percent * percent;
    }
    const auto phi = [](double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI); };
    const auto cdf = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
    const double a = (0.0 - mean) / sd, b = (100.0 - mean) / sd;
    const double inside = cdf(b) - cdf(a);
    const double shift = (phi(a) - phi(b)) / inside;
    const double variance = sd * sd * (1.0 + (a * phi(a) - b * phi(b)) / inside - shift * shift);
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_NEAR(first, mean + sd * shift, 1e-3);
    EXPECT_NEAR(second - first * first, variance, 0.1);
  });
}

/// Two or three slopes with some densities each.
PathLibrary any_library(Random& random) {
  PathLibrary library;
  library.machine = "machine";
  library.soil = "soil";
  library.machine_fingerprint = "0123456789abcdef";
  library.soil_fingerprint = "fedcba9876543210";
  library.simulator = "height-map 1";
  library.cell_size = 0.05;
  library.seed = random.index(1000000);
  library.search = "by hand";
  const int slopes = drawn_int(random, 1, 3), densities = drawn_int(random, 1, 4);
  for (int s = 0; s < slopes; ++s) {
    for (int d = 0; d < densities; ++d) {
      PathLibraryEntry entry;
      entry.slope = -0.1 + 0.1 * s;
      entry.density_percent = 10.0 + 20.0 * d;
      entry.dig = any_planned_dig(random);
      entry.evaluations = drawn_int(random, 0, 1000);
      const auto next = [&] {
        Interpolation to;
        to.midway.loss = random.uniform();
        to.midway.expectation = random.uniform(-0.5, 0.5);
        to.between = any_between(random);
        return to;
      };
      if (d + 1 < densities) entry.to_next_density = next();
      if (s + 1 < slopes) entry.to_next_slope = next();
      library.entries.push_back(entry);
    }
  }
  return library;
}

TEST(PlanningProperties, EntriesAreLookedUpAsTheyAreAndBetweenThemInBounds) {
  for_cases([](Random& random) {
    const PathLibrary library = any_library(random);
    const PathLibraryEntry& entry = library.entries[random.index(library.entries.size())];
    expect_near(look_up(library, entry.density_percent, entry.slope), entry.dig, 1e-12);
    EXPECT_EQ(look_up_error(library, entry.density_percent, entry.slope).loss, 0.0);

    const double density = random.uniform(library.entries.front().density_percent,
                                          library.entries.back().density_percent);
    const double slope =
        random.uniform(library.entries.front().slope, library.entries.back().slope);
    const PlannedDig dig = look_up(library, density, slope);
    const MidwayError error = look_up_error(library, density, slope);
    EXPECT_TRUE(error.loss >= 0.0 && error.loss <= 1.0);
    const auto found = numbers_of(dig);
    for (std::size_t i = 0; i < found.size(); ++i) {
      double low = 1e9, high = -1e9;
      for (const PathLibraryEntry& other : library.entries) {
        low = std::min(low, numbers_of(other.dig)[i]);
        high = std::max(high, numbers_of(other.dig)[i]);
      }
      EXPECT_TRUE(low - 1e-9 <= found[i] && found[i] <= high + 1e-9);
    }
  });
}

/// A density without a dig closes its own gap and no other, on its own slope and no other.
TEST(PlanningProperties, GapsCloseWhatTheyLieIn) {
  for_cases([](Random& random) {
    PathLibrary library = any_library(random);
    const PathLibraryEntry first = library.entries.front(), last = library.entries.back();
    PathLibraryGap gap;
    gap.slope = library.entries[random.index(library.entries.size())].slope;
    gap.density_percent = 20.0 + 20.0 * static_cast<double>(random.index(3));
    library.gaps = {gap};
    const double density = random.uniform(first.density_percent, last.density_percent);
    const double slope = random.uniform(first.slope, last.slope);
    if (std::fmod(density, 20.0) == 10.0) return;
    // the entries around stand at 10, 30, .. % and on slopes a tenth apart
    const bool same_density = std::abs(density - gap.density_percent) < 10.0 &&
                              gap.density_percent < last.density_percent;
    const bool beside = std::abs(slope - gap.slope) < 0.1 - 1e-12;
    if (first.density_percent == last.density_percent || (slope == gap.slope && !beside)) return;
    if (same_density && beside) {
      EXPECT_THROW(look_up(library, density, slope), Error);
    } else {
      EXPECT_NO_THROW(look_up(library, density, slope));
    }
  });
}

TEST(PlanningProperties, GoalsWithNumbersOutOfRangeAreRefused) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  for_cases([&](Random& random) {
    const auto& parameters = objective_parameters();
    DigObjective objective(DigObjective::Goal::priced);
    EXPECT_NO_THROW(check(objective, machine));
    const DigObjectiveParameter& parameter = parameters[random.index(parameters.size())];
    objective.*parameter.field = random.uniform() < 0.5
                                     ? parameter.lowest - random.uniform(1e-9, 1.0)
                                     : 1.001 * parameter.highest;
    EXPECT_THROW(check(objective, machine), Error);
  });
}

/// Lifts 100 kg at a cost of its own.
class OwnSimulator : public SoilSimulator {
 public:
  DigResult dig(const Terrain&, const DigPath& path, const DigOptions&) const override {
    DigResult result;
    result.payload_mass = 100.0;
    result.payload_volume = 0.4;
    result.energy.total = 1e3 + 1e4 * std::pow(path.parameters.drag_length - 1.2, 2);
    return result;
  }
};

/// Planned paths keep 0.035 rad off the limits of the joints while they dig.
TEST(PlanningProperties, StartsOfLeastWorkKeepOffTheJointLimits) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const Terrain ground = level_planning_ground(machine, 0.5);
  const DigLayout layout(machine, ground);
  int laid = 0;
  for_cases(
      [&](Random& random) {
        const auto path =
            path_by(layout, any_planned_dig(random).parameters, StartRule::Kind::least_work);
        const auto* found = std::get_if<DigPath>(&path);
        if (found == nullptr) return;
        ++laid;
        for (const DigPose& pose : found->poses) {
          if (pose.phase == DigPhase::lift) continue;
          EXPECT_GE(limit_margin(machine, pose.joints).margin, 0.035 - 1e-9);
        }
      },
      150);
  EXPECT_GT(laid, 30);
}

TEST(PlanningProperties, ProbabilitiesThatDoNotAddUpAreRefused) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const Terrain ground = level_planning_ground(machine, 0.5);
  const OwnSimulator soil;
  const DigPath path = std::get<DigPath>(
      make_dig_path(machine, paper_fixed_path(), 6.0, [](double) { return 0.0; }));
  for_cases(
      [&](Random& random) {
        const double first = random.uniform(0.1, 0.9), off = random.uniform(1e-6, 0.09);
        const auto spread = [&](double second) {
          return dig_spread(machine, {{&soil, first}, {&soil, second}}, ground, {}, path);
        };
        EXPECT_THROW(spread(1.0 - first + (random.uniform() < 0.5 ? off : -off)), Error);
        EXPECT_NO_THROW(spread(1.0 - first));
      },
      100);
}

/// The digs of a plan are counted through all of its searches.
TEST(PlanningProperties, ProgressOfAPlanNeverFalls) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind soil = load_soil(find_data_file("soils/loam.json"));
  PlanOptions options;
  options.method = PlanMethod::search;
  options.simulator = {"own", "own 1", [](const Machine&, const SoilKind&, double) {
                         return std::make_unique<const OwnSimulator>();
                       }};
  options.search.threads = 1;
  for (const int budget : {150, 300, 600}) {
    options.search.stop.evaluations = budget;
    int last = 0;
    bool fell = false;
    options.search.progress = [&](const SearchProgress& now) {
      fell = fell || now.evaluations < last;
      last = now.evaluations;
      return true;
    };
    const DigPlan plan = plan_dig(machine, soil, 40.0, options);
    EXPECT_FALSE(fell) << budget;
    EXPECT_EQ(last, plan.evaluations);
    EXPECT_LE(plan.evaluations, budget);
  }
}

TEST(PlanningProperties, LibrariesReadBack) {
  const TemporaryFolder folder;
  for_cases(
      [&](Random& random) {
        const PathLibrary library = any_library(random);
        const PathLibrary read =
            load_path_library(folder.write(std::to_string(random.bits()), to_json(library)));
        ASSERT_EQ(read.entries.size(), library.entries.size());
        EXPECT_EQ(read.seed, library.seed);
        for (std::size_t i = 0; i < read.entries.size(); ++i) {
          expect_near(read.entries[i].dig, library.entries[i].dig, 1e-12);
          EXPECT_EQ(read.entries[i].evaluations, library.entries[i].evaluations);
        }
      },
      1000);
}

}  // namespace
}  // namespace excavplan::test
