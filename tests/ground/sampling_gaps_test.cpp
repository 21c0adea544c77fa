// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/sampling_gaps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/non_finite.hpp"
#include "base/random.hpp"
#include "change/systematic_errors.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr Index side = 80;

/// Heights of a map of cells of 5 cm, with points where `is_known`.
template <typename Height, typename Known>
Surface sampled(Height height, Known is_known) {
  Surface surface;
  surface.height.cell_size = 0.05;
  surface.height.z = Eigen::ArrayXXd::Constant(side, side, nan);
  surface.variance = surface.height.z;
  surface.points = Eigen::ArrayXXi::Zero(side, side);
  for (Index col = 0; col < side; ++col) {
    for (Index row = 0; row < side; ++row) {
      if (!is_known(row, col)) continue;
      surface.height.z(row, col) = height(row, col);
      surface.points(row, col) = 2;
    }
  }
  return surface;
}

bool on_line(Index row, Index) { return row % 5 == 2; }

double slope(Index row, Index col) {
  return 0.02 * static_cast<double>(row) - 0.01 * static_cast<double>(col);
}

TEST(SamplingGaps, AreFilledBetweenLinesAndNotBeyondThem) {
  Surface surface = sampled(slope, on_line);
  fill_sampling_gaps(surface);
  for (Index col = 0; col < side; ++col) {
    for (Index row = 2; row < 78; ++row) {
      ASSERT_NEAR(surface.height.z(row, col), slope(row, col), 1e-3) << row << " " << col;
    }
    EXPECT_TRUE(std::isnan(surface.height.z(0, col)));
    EXPECT_TRUE(std::isnan(surface.height.z(79, col)));
  }
  EXPECT_EQ((surface.points > 0).count(), 16 * side);
}

TEST(SamplingGaps, StayOpenInADenseScan) {
  const auto in_shadow = [](Index row, Index col) {
    return row >= 30 && row < 38 && col >= 20 && col < 50;
  };
  Surface surface = sampled(slope, [&](Index row, Index col) { return !in_shadow(row, col); });
  fill_sampling_gaps(surface);
  EXPECT_EQ(surface.height.z.isNaN().count(), 8 * 30);
}

TEST(SamplingGaps, OfAFewScatteredPointsAreFilled) {
  Random random(4);
  Surface surface = sampled(slope, [&](Index, Index) { return random.uniform() < 0.6; });
  fill_sampling_gaps(surface);
  const auto inside = surface.height.z.block(3, 3, side - 6, side - 6);
  EXPECT_EQ(inside.isNaN().count(), 0);
}

/// A pit of 2 m x 1 m with upright walls, 0.3 m deep, its upper wall at `edge` [m].
struct Pit {
  double edge;
  double operator()(Index row, Index col) const {
    const double y = 0.05 * (static_cast<double>(row) + 0.5);
    return y > 1.5 && y < edge && col >= 20 && col < 60 ? -0.3 : 0.0;
  }
};

TEST(BetweenPoints, ErrorOfAFaceSomewhereBetweenLines) {
  Eigen::ArrayXXi zone = Eigen::ArrayXXi::Constant(side, side, -1);
  zone.block(26, 16, 32, 48) = 0;
  double squares = 0.0;
  double variance = 0.0;
  for (int i = 0; i < 25; ++i) {
    const Pit pit{2.5 + 0.01 * i};
    Surface surface = sampled(pit, on_line);
    fill_sampling_gaps(surface);
    variance += variance_between_points(surface, zone, 1).front() / 25.0;
    const double volume =
        0.0025 * (zone == 0).select(surface.height.z, 0.0).sum() + 0.3 * 2.0 * (pit.edge - 1.5);
    squares += volume * volume / 25.0;
  }
  EXPECT_GT(variance, 0.5 * squares);  // faces along the lines are the worst case
  EXPECT_LT(variance, 20.0 * squares);
}

TEST(BetweenPoints, NoErrorOnSmoothGroundOrWithManyPoints) {
  Eigen::ArrayXXi zone = Eigen::ArrayXXi::Constant(side, side, -1);
  zone.block(26, 16, 32, 48) = 0;
  Surface smooth = sampled(slope, on_line);
  fill_sampling_gaps(smooth);
  EXPECT_LT(variance_between_points(smooth, zone, 1).front(), 1e-12);
  Surface dense = sampled(Pit{2.5}, [](Index, Index) { return true; });
  dense.points.setConstant(6);
  EXPECT_EQ(variance_between_points(dense, zone, 1).front(), 0.0);
  dense.points.setConstant(2);
  EXPECT_GT(variance_between_points(dense, zone, 1).front(), 1e-6);
}

// ---- Stripes ----------------------------------------------------------------------------------

/// Noise of 1 mm, with stripes of some cells' width along a direction.
ChangedGround striped(double stripes, double angle) {
  ChangedGround ground;
  ground.difference = Eigen::ArrayXXd::Zero(side, side);
  ground.zone = Eigen::ArrayXXi::Constant(side, side, -1);
  ground.zone.block(30, 30, 20, 20) = 0;
  ground.zone_is_cut = {false};
  Random random(5);
  for (Index col = 0; col < side; ++col) {
    for (Index row = 0; row < side; ++row) {
      const double place = static_cast<double>(col) * std::cos(angle) +
                           static_cast<double>(row) * std::sin(angle) + 1000.0;
      Random line(6, static_cast<std::uint64_t>(place / 2.0));
      ground.difference(row, col) = 0.001 * random.normal() + stripes * line.normal();
    }
  }
  ground.residual = (ground.zone >= 0).select(nan, ground.difference);
  return ground;
}

TEST(Stripes, AreTakenOffStableGroundAndZones) {
  for (const double angle : {0.0, 0.6, 1.571}) {
    ChangedGround ground = striped(0.004, angle);
    const double before = ground.difference.block(30, 30, 20, 20).square().mean();
    const double variance = take_stripes_off(ground).front();
    const auto zone = ground.difference.block(30, 30, 20, 20);
    EXPECT_LT(zone.square().mean(), 0.5 * before) << angle;
    EXPECT_GT(variance, 0.0);
    const Eigen::ArrayXXd& rest = ground.residual;
    const double mean = rest.isNaN().select(0.0, rest).sum() /
                        static_cast<double>(rest.size() - rest.isNaN().count());
    EXPECT_LT(std::abs((zone - mean).sum()), 4.0 * std::sqrt(variance + 400.0 * 1e-6)) << angle;
  }
}

TEST(Stripes, OfTwoScansAreTakenOffAlongBothDirections) {
  ChangedGround ground = striped(0.004, 0.2);
  const Eigen::ArrayXXd other = striped(0.004, 1.3).difference;
  ground.difference += other;
  ground.residual += other;
  const double before = ground.difference.block(30, 30, 20, 20).square().mean();
  take_stripes_off(ground);
  EXPECT_LT(ground.difference.block(30, 30, 20, 20).square().mean(), 0.3 * before);
}

TEST(Stripes, AreNotFoundInPlainNoise) {
  ChangedGround ground = striped(0.0, 0.6);
  const Eigen::ArrayXXd before = ground.difference;
  EXPECT_EQ(take_stripes_off(ground).front(), 0.0);
  EXPECT_TRUE((ground.difference == before).all());
}

}  // namespace
}  // namespace excavplan
