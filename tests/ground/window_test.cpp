// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/window.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace excavplan
