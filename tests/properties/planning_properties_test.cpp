// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/library/path_library.hpp>
#include <excavplan/planning/uncertain_soil.hpp>

#include <algorithm>

#include "planning/planned_digs.hpp"
#include "support/cases.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

PlannedDig any_dig(Random& random) {
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
    const PlannedDig a = any_dig(random);
    const PlannedDig b = any_dig(random);
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
      entry.dig = any_dig(random);
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
