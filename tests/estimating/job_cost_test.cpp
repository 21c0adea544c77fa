// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/estimating/job_cost.hpp>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>

namespace excavplan {
namespace {

EstimatedFigure figure(double value, double density, double played) {
  EstimatedFigure made;
  made.value = value;
  made.spread.density = density;
  made.spread.played = played;
  return made;
}

JobEstimate half_an_hour() {
  JobEstimate estimate;
  estimate.fuel = figure(4.0, 0.3, 0.2);
  estimate.time = figure(1800.0, 0.2, 0.1);
  estimate.truckloads = figure(1.2, 0.1, 0.0);
  return estimate;
}

TEST(JobCost, IsTheSumOfWhatHasAPrice) {
  const auto cost = cost_of(half_an_hour(), {2.0, 60.0, 50.0});
  ASSERT_TRUE(cost);
  EXPECT_DOUBLE_EQ(cost->fuel, 8.0);
  EXPECT_DOUBLE_EQ(cost->machine, 30.0);
  EXPECT_DOUBLE_EQ(cost->truckloads, 100.0);  // two of them go
  EXPECT_DOUBLE_EQ(cost->total.value, 138.0);
  const auto fuel = cost_of(half_an_hour(), {2.0, {}, {}});
  EXPECT_DOUBLE_EQ(fuel->total.value, 8.0);
  EXPECT_DOUBLE_EQ(fuel->total.spread.total(), half_an_hour().fuel.spread.total());
}

TEST(JobCost, EachSourceMovesAllPartsTogether) {
  const auto cost = cost_of(half_an_hour(), {2.0, 60.0, 50.0});
  EXPECT_NEAR(cost->total.spread.density, (8.0 * 0.3 + 30.0 * 0.2 + 100.0 * 0.1) / 138.0, 1e-12);
  EXPECT_NEAR(cost->total.spread.played, (8.0 * 0.2 + 30.0 * 0.1) / 138.0, 1e-12);
  EXPECT_EQ(cost->total.spread.volume, 0.0);
}

TEST(JobCost, NothingIsSaidWithoutPrices) {
  EXPECT_FALSE(cost_of(half_an_hour(), {}));
  EXPECT_FALSE(cost_of(half_an_hour(), {0.0, {}, {}}));
  EXPECT_THROW(cost_of(half_an_hour(), {-1.0, {}, {}}), Error);
  EXPECT_THROW(cost_of(half_an_hour(), {{}, 1e12, {}}), Error);
}

}  // namespace
}  // namespace excavplan
