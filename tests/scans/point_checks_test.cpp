// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/point_checks.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

/// Level ground of 20 x 40 cells of 5 cm: a hole 0.5 m deep in its left half, a heap in its right,
/// each cell with ten points that scatter by 5 mm.
class PointChecks : public testing::Test {
 protected:
  PointChecks() {
    pair_.before = pair_.after = scanned();
    pair_.after.height.z.leftCols(20).setConstant(-0.5);
    pair_.after.height.z.rightCols(20).setConstant(0.6);
    AreaChange area;
    area.difference = pair_.after.height;
    area.zone = Eigen::ArrayXXi::Zero(20, 40);
    area.zone.rightCols(20).setOnes();
    change_.areas = {area};
    change_.zones.resize(2);
    change_.zones[0].kind = ZoneKind::dig;
    change_.zones[1].kind = ZoneKind::dump;
    change_.before.value = 0.5;
    change_.after.value = 0.6;
  }

  std::vector<WarningCode> codes() const {
    std::vector<WarningCode> found;
    for (const Warning& warning : check_points({&pair_}, change_)) found.push_back(warning.code);
    return found;
  }

  /// Lowest points of the cells of the hole above -0.5 m [m], a share of them at -0.5 m.
  void set_floor(double highest, double share_at_limit) {
    Random random(4);
    pair_.after.below = Eigen::ArrayXXf::Constant(20, 40, 0.007F);
    for_each_cell(pair_.after.below, [&](Cell at) {
      if (at.col >= 20) return;
      const bool is_at_limit = random.uniform() < share_at_limit;
      const double lowest = is_at_limit ? random.uniform(0.0, 2e-4) : random.uniform(0.0, highest);
      pair_.after.height.z(at.row, at.col) = -0.5 + lowest + 0.007;
    });
  }

  SurfacePair pair_;
  VolumeChange change_;

 private:
  static Surface scanned() {
    Surface surface;
    surface.height = flat_ground({0.0, 0.0, 2.0, 1.0}, 0.05);
    surface.points = Eigen::ArrayXXi::Constant(20, 40, 10);
    surface.variance = Eigen::ArrayXXd::Constant(20, 40, 2.5e-6);
    return surface;
  }
};

/// What outliers raise in both scans alike changes no volume.
TEST_F(PointChecks, OutliersCountByWhatTheyRaiseMoreInOneOfTheScans) {
  pair_.before.outlier_bias = Eigen::ArrayXXf::Constant(20, 40, 0.02F);
  pair_.after.outlier_bias = pair_.before.outlier_bias;
  EXPECT_EQ(codes(), std::vector<WarningCode>());
  pair_.after.outlier_bias.rightCols(20) += 0.02F;  // of 0.6 m: 3 %
  EXPECT_EQ(codes(), std::vector<WarningCode>{WarningCode::outliers});
}

/// An eighth of the cells lies in the lowest 1.25 mm of 10 mm by chance.
TEST_F(PointChecks, AFloorIsCutWhereAThirdOfTheLowestPointsLieAtOneHeight) {
  set_floor(0.010, 0.0);
  EXPECT_EQ(codes(), std::vector<WarningCode>());
  set_floor(0.010, 0.33);
  EXPECT_EQ(codes(), std::vector<WarningCode>{WarningCode::floor_cut});
}

}  // namespace
}  // namespace excavplan
