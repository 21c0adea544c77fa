// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/return_gaps.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/non_finite.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;

constexpr double cell = 0.05;
constexpr Index rows = 20, cols = 12, middle = 6;

/// A trench along the columns: rows 8 and on are its floor.
ArrayXXd trench() {
  ArrayXXd z = ArrayXXd::Zero(rows, cols);
  z.bottomRows(rows - 8).setConstant(-0.5);
  return z;
}

ArrayXXd without_rows(ArrayXXd z, Index first, Index count) {
  z.middleRows(first, count).setConstant(nan);
  return z;
}

TEST(ReturnGaps, ANarrowGapChangedAsTheGroundBesideIt) {
  const ArrayXXd known = trench();
  const ArrayXXd seen = without_rows(known + 0.02, 12, 5);
  const ArrayXXd heights = heights_between_returns(seen, known, cell);
  for (Index row = 0; row < rows; ++row) {
    if (row >= 12 && row < 17) {
      EXPECT_NEAR(heights(row, middle), -0.48, 1e-12) << row;
    } else {
      EXPECT_TRUE(std::isnan(heights(row, middle))) << row;
    }
  }
}

TEST(ReturnGaps, AWideGapTellsNothing) {
  const ArrayXXd known = trench();
  EXPECT_TRUE(heights_between_returns(without_rows(known, 10, 6), known, cell).isNaN().all());
  EXPECT_TRUE(heights_between_returns(without_rows(known, 15, 5), known, cell).isNaN().all());
}

TEST(ReturnGaps, TheShadowBehindAKnownEdgeKeepsTheShapeOfTheEdge) {
  const ArrayXXd known = trench();
  const ArrayXXd heights = heights_between_returns(without_rows(known, 8, 4), known, cell);
  for (Index row = 8; row < 12; ++row) EXPECT_NEAR(heights(row, middle), -0.5, 1e-12) << row;
}

TEST(ReturnGaps, TheShadowBehindANewEdgeTellsNothing) {
  const ArrayXXd level = ArrayXXd::Zero(rows, cols);
  const ArrayXXd seen = without_rows(trench(), 8, 3);
  EXPECT_TRUE(heights_between_returns(seen, level, cell).isNaN().all());
  EXPECT_TRUE(heights_between_returns(seen, {}, cell).isNaN().all());
}

TEST(ReturnGaps, UnknownGroundGoesOnInLine) {
  ArrayXXd slope(rows, cols);
  for (Index row = 0; row < rows; ++row) slope.row(row) = 0.03 * static_cast<double>(row);
  const ArrayXXd heights = heights_between_returns(without_rows(slope, 8, 4), {}, cell);
  for (Index row = 8; row < 12; ++row) {
    EXPECT_NEAR(heights(row, middle), 0.03 * static_cast<double>(row), 1e-12) << row;
  }
}

TEST(ReturnGaps, UnknownGroundDoesNotGoOnDownAWall) {
  ArrayXXd seen = trench();
  seen.row(7).setConstant(-0.3);  // of the wall
  EXPECT_TRUE(heights_between_returns(without_rows(seen, 8, 3), {}, cell).isNaN().all());
}

TEST(ReturnGaps, CellsBetweenSparseReturnsAreTold) {
  ArrayXXd seen = ArrayXXd::Constant(rows, cols, nan);
  for (Index row = 1; row < rows; row += 3) {
    for (Index col = 1; col < cols; col += 3) seen(row, col) = 0.01;
  }
  const ArrayXXd heights = heights_between_returns(seen, {}, cell);
  EXPECT_TRUE((!seen.isNaN() || !heights.isNaN()).block(1, 1, 16, 10).all());
}

TEST(ReturnGaps, OfTwoWaysAcrossAGapBothMustTell) {
  const ArrayXXd level = ArrayXXd::Zero(rows, cols);
  ArrayXXd seen = trench();
  seen.block(8, 5, 3, 3).setConstant(nan);  // floor on both sides along x, an edge along y
  const ArrayXXd heights = heights_between_returns(seen, level, cell);
  EXPECT_TRUE(heights.block(8, 5, 3, 3).isNaN().all());
}

}  // namespace
}  // namespace excavplan
