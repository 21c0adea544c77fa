// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/efficiency/run_comparison.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "efficiency/student.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

using test::error_of;

TEST(Student, HasTheQuantilesOfTheTables) {
  // Two-sided 95 % (Fisher and Yates): 1, 4, 10, 30 degrees of freedom; 99 %: 5.
  EXPECT_NEAR(student_quantile(0.95, 1.0), 12.7062, 5e-5);
  EXPECT_NEAR(student_quantile(0.95, 4.0), 2.77645, 5e-6);
  EXPECT_NEAR(student_quantile(0.95, 10.0), 2.22814, 5e-6);
  EXPECT_NEAR(student_quantile(0.95, 30.0), 2.04227, 5e-6);
  EXPECT_NEAR(student_quantile(0.99, 5.0), 4.03214, 5e-6);
}

TEST(Student, IsCauchyWithOneDegreeOfFreedomAndClosedWithTwo) {
  const double pi = std::acos(-1.0);
  for (const double t : {0.0, 0.3, 1.0, 4.0, 50.0}) {
    EXPECT_NEAR(student_two_sided(t, 1.0), 1.0 - 2.0 / pi * std::atan(t), 1e-12);
    EXPECT_NEAR(student_two_sided(-t, 2.0), 1.0 - t / std::sqrt(2.0 + t * t), 1e-12);
  }
}

std::vector<double> exponentials(const std::vector<double>& values) {
  std::vector<double> list;
  for (const double value : values) list.push_back(std::exp(0.1 * value));
  return list;
}

TEST(RunComparison, WelchHasThePublishedNumbers) {
  // The example of unequal sizes and scatter in Wikipedia, "Welch's t-test": 2.22, 24.5, 0.036.
  const std::vector<double> a = {19.8, 20.4, 19.6, 17.8, 18.5, 18.9, 18.3, 18.9, 19.5, 22.0};
  const std::vector<double> b = {28.2, 26.6, 20.1, 23.3, 25.2, 22.1, 17.7, 27.6, 20.6, 13.7,
                                 23.2, 17.5, 20.6, 18.0, 23.9, 21.6, 24.3, 20.4, 23.9, 13.3};
  const SetComparison found = compare_runs(exponentials(a), exponentials(b));
  EXPECT_NEAR(found.welch.t, 2.22, 0.01);
  EXPECT_NEAR(found.welch.degrees_of_freedom, 24.5, 0.05);
  EXPECT_NEAR(found.welch.p_value, 0.036, 0.001);
  EXPECT_FALSE(found.by_permutation);
  EXPECT_FALSE(found.permutation.is_exact);
  EXPECT_NEAR(found.permutation.p_value, found.welch.p_value, 0.01);
}

TEST(RunComparison, IntervalIsThatOfTheTable) {
  // Two sets of 2 with logarithms 0 +- s and g +- s: 2 degrees of freedom, t = 4.30265.
  const double s = 0.01;
  const double g = std::log(1.277);
  const SetComparison found =
      compare_runs({std::exp(-s), std::exp(s)}, {std::exp(g - s), std::exp(g + s)});
  EXPECT_NEAR(found.gain_percent, 27.7, 1e-9);
  const double reach = 4.302652729911275 * std::sqrt(2.0 * s * s);
  EXPECT_NEAR(found.gain_low_percent, 100.0 * std::expm1(g - reach), 1e-6);
  EXPECT_NEAR(found.gain_high_percent, 100.0 * std::expm1(g + reach), 1e-6);
  EXPECT_NEAR(found.first.geometric_mean, 1.0, 1e-12);
}

TEST(RunComparison, FewRunsArePermutedAllWays) {
  // All of one set below all of the other: 2 of the C(8, 4) = 70 divisions are as far apart.
  const SetComparison found = compare_runs({1.0, 1.1, 1.2, 1.3}, {1.4, 1.5, 1.6, 1.7});
  EXPECT_TRUE(found.by_permutation);
  EXPECT_TRUE(found.permutation.is_exact);
  EXPECT_EQ(found.permutation.divisions, 70U);
  EXPECT_NEAR(found.p_value(), 2.0 / 70.0, 1e-12);
  EXPECT_NEAR(compare_runs({1.0, 2.0}, {1.0, 2.0}).p_value(), 1.0, 1e-12);
}

TEST(RunComparison, PValuesOfEqualSetsAreUniform) {
  Random random(3);
  const int trials = 400;
  int rejected = 0;
  for (int i = 0; i < trials; ++i) {
    std::vector<double> sets[2];
    for (auto& set : sets) {
      for (int k = 0; k < 6; ++k) set.push_back(std::exp(0.2 * random.normal()));
    }
    if (compare_runs(sets[0], sets[1]).p_value() < 0.05) ++rejected;
  }
  EXPECT_NEAR(rejected, 0.05 * trials, 3.0 * std::sqrt(0.05 * 0.95 * trials));
}

TEST(RunComparison, RunsWithoutScatterDifferSurely) {
  const SetComparison found = compare_runs({2.0, 2.0}, {3.0, 3.0});
  EXPECT_EQ(found.welch.p_value, 0.0);
  EXPECT_NEAR(found.gain_low_percent, 50.0, 1e-9);
  EXPECT_NEAR(found.p_value(), 2.0 / 6.0, 1e-12);
}

TEST(RunComparison, OneRunIsNoSet) {
  EXPECT_EQ(error_of([] {
              compare_runs({1.0}, {1.0, 2.0});
            }),
            "the first set has 1 run, a comparison needs 2 or more");
  EXPECT_EQ(error_of([] {
              compare_runs({1.0, 2.0}, {1.0, -2.0});
            }),
            "efficiency of a run in the second set is -2, must be above 0 and finite");
}

}  // namespace
}  // namespace excavplan
