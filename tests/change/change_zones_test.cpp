// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/change_zones.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

/// 6,400 cells with a noise of 2 mm tell the datum to 0.03 mm; outliers would raise it by 0.4 mm.
TEST(ChangeZones, DatumIsThatOfTheGroundWithoutSingleOutliers) {
  Eigen::ArrayXXd difference = Eigen::ArrayXXd::Zero(80, 80);
  Random random(3);
  for_each_cell(difference, [&](Cell at) {
    const bool is_off = at.row % 6 == 3 && at.col % 6 == 3;
    difference(at.row, at.col) = 0.01 + 0.002 * random.normal() + (is_off ? 0.015 : 0.0);
  });
  const ChangedGround ground = find_change(difference, {}, 0.05, {});
  EXPECT_TRUE((ground.zone < 0).all());
  EXPECT_NEAR(ground.datum, 0.01, 0.0001);
}

}  // namespace
}  // namespace excavplan
