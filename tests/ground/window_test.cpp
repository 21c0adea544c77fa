// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/window.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <Eigen/Geometry>

#include "base/random.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

TEST(Window, HighestWithinIsThatOfEachWindowOnTheMap) {
  Random random(3);
  for (const auto& [rows, cols] : {std::pair<Index, Index>{1, 1}, {7, 20}, {31, 12}, {2, 50}}) {
    Eigen::ArrayXXd z(rows, cols);
    for (Index i = 0; i < z.size(); ++i) z.data()[i] = random.uniform(-1.0, 1.0);
    for (const Index cells : {0, 1, 2, 3, 5, 9, 13, 60}) {
      const Eigen::ArrayXXd highest = highest_within(z, cells);
      for (Index col = 0; col < cols; ++col) {
        for (Index row = 0; row < rows; ++row) {
          const Index top = std::max<Index>(row - cells, 0);
          const Index left = std::max<Index>(col - cells, 0);
          const Index bottom = std::min(row + cells, rows - 1);
          const Index right = std::min(col + cells, cols - 1);
          EXPECT_EQ(highest(row, col),
                    z.block(top, left, bottom - top + 1, right - left + 1).maxCoeff());
        }
      }
    }
  }
}

/// Shares of cells in a rectangle about the middle of a grid, turned, by many points in each.
Eigen::ArrayXXd shares_in(const Eigen::Vector2d& half, double turned, Index cells) {
  constexpr int parts = 10;
  const Eigen::Rotation2Dd back(-turned);
  Eigen::ArrayXXd share(cells, cells);
  for (Index col = 0; col < cells; ++col) {
    for (Index row = 0; row < cells; ++row) {
      int inside = 0;
      for (int i = 0; i < parts * parts; ++i) {
        const Eigen::Vector2d at(static_cast<double>(col) + (i % parts + 0.5) / parts,
                                 static_cast<double>(row) + (i / parts + 0.5) / parts);
        const Eigen::Vector2d middle = Eigen::Vector2d::Constant(0.5 * static_cast<double>(cells));
        if (((back * (at - middle)).cwiseAbs().array() < half.array()).all()) ++inside;
      }
      share(row, col) = static_cast<double>(inside) / (parts * parts);
    }
  }
  return share;
}

TEST(Window, InnerCellsAreTheMarginAwayHoweverTheAreaLies) {
  constexpr Index cells = 36;
  constexpr double cell = 0.05, margin = 0.1;
  const Eigen::Vector2d half(14.3, 7.6);  // in cells
  for (const double turned : {0.0, 0.07, 0.4, 0.7853981633974483, 1.3}) {
    const Mask inner = inner_cells(shares_in(half, turned, cells), cell, margin);
    const Eigen::Rotation2Dd back(-turned);
    int within = 0;
    for (Index col = 0; col < cells; ++col) {
      for (Index row = 0; row < cells; ++row) {
        const Eigen::Vector2d at(static_cast<double>(col) + 0.5, static_cast<double>(row) + 0.5);
        const Eigen::Vector2d off =
            (back * (at - Eigen::Vector2d::Constant(0.5 * cells))).cwiseAbs();
        const double from_edge = cell * (half - off).minCoeff();
        if (from_edge > margin + 0.25 * cell) {
          EXPECT_TRUE(inner(row, col)) << turned << ": " << at.transpose();
          ++within;
        }
        if (from_edge < margin - 0.25 * cell) {
          EXPECT_FALSE(inner(row, col)) << turned << ": " << at.transpose();
        }
      }
    }
    EXPECT_GT(within, 150);
  }
}

TEST(Window, InnerCellsKeepTheMarginToTheEdgeOfTheGrid) {
  const Mask inner = inner_cells(Eigen::ArrayXXd::Ones(7, 9), 0.1, 0.2);
  EXPECT_EQ(inner.count(), 3 * 5);
  EXPECT_TRUE(inner.block(2, 2, 3, 5).all());
}

}  // namespace
}  // namespace excavplan
