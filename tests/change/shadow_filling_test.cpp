// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/shadow_filling.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/change/volume_change.hpp>

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "change/change_zones.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

using Shape = std::function<double(double x, double y)>;

constexpr double cell_size = 0.05;
constexpr int divisions = 5;  // points along a cell

double repose() { return std::tan(35.0 * degree); }

/// Level on top, its flanks at the angle of repose, its ends upright.
struct Windrow {
  double foot;  ///< x of it, on the left
  static constexpr double width = 1.7;
  static constexpr double height = 0.35;
  static constexpr double length = 2.4;
  double operator()(double x, double y) const {
    const double inside = std::min(x - foot, foot + width - x);
    if (std::abs(y - 2.0) > 0.5 * length) return 0.0;
    return std::clamp(inside * repose(), 0.0, height);
  }
  static double flank_volume() { return 0.5 * height * height * length / repose(); }
  static double flank_volume_per_radian() {
    return 0.5 * height * height * length / std::pow(std::sin(35.0 * degree), 2);
  }
};

/// A hole below level ground, its walls falling inwards from its rim.
struct Pit {
  Rectangle rim;
  double depth;
  double slope;
  double operator()(double x, double y) const {
    const double inside = std::min({x - rim.x_min, rim.x_max - x, y - rim.y_min, rim.y_max - y});
    return -std::clamp(inside * slope, 0.0, depth);
  }
};

bool is_seen(const Shape& shape, const Eigen::Vector3d& point, const Eigen::Vector3d& sensor) {
  constexpr double step = 0.02;
  constexpr double highest = 0.6;
  const Eigen::Vector3d way = sensor - point;
  const Eigen::Vector3d stride = way * step / way.head<2>().norm();
  const double dx = stride.x(), dy = stride.y(), dz = stride.z();
  double x = point.x() + 0.1 * dx, y = point.y() + 0.1 * dy, z = point.z() + 0.1 * dz;
  for (; z < highest; x += dx, y += dy, z += dz) {
    if (shape(x, y) > z + 1e-9) return false;
  }
  return true;
}

/// Mean height of the points of each cell, of all of them or of those that are seen, NaN where most
/// are hidden.
HeightMap scanned(const Shape& shape, const std::optional<Eigen::Vector3d>& sensor) {
  HeightMap map = flat_ground({0.0, 0.0, 4.0, 4.0}, cell_size);
  for_each_cell(map.z, [&](Cell cell) {
    double sum = 0.0;
    int seen = 0;
    for (int n = 0; n < divisions * divisions; ++n) {
      const double x = map.x(cell.col) + cell_size * ((n % divisions + 0.5) / divisions - 0.5);
      const double y = map.y(cell.row) + cell_size * ((n / divisions + 0.5) / divisions - 0.5);
      const double z = shape(x, y);
      if (sensor && !is_seen(shape, {x, y, z}, *sensor)) continue;
      sum += z;
      ++seen;
    }
    map.z(cell.row, cell.col) = 2 * seen > divisions * divisions ? sum / seen : nan;
  });
  return map;
}

struct Filled {
  HeightMap scan;
  HeightMap map;
  ChangedGround ground;
  std::vector<double> variance;
};

Filled filled(const HeightMap& after, const Eigen::Vector3d& sensor) {
  Filled filled{after, after, {}, {}};
  const HeightMap before = flat_ground({0.0, 0.0, 4.0, 4.0}, cell_size);
  filled.ground = find_change(after.z - before.z, {}, cell_size, {});
  const Eigen::ArrayXXi mixed = Eigen::ArrayXXi::Zero(after.z.rows(), after.z.cols());
  Surface places;
  places.sensors = {sensor};
  const std::optional<SensorPlace> told;
  filled.variance = fill_shadows({before, filled.map, mixed, places, told, {}}, filled.ground);
  return filled;
}

/// From so far away that its rays are parallel; the flank behind the top of the heap is hidden.
class FarFlank : public testing::TestWithParam<double> {
 protected:
  FarFlank()
      : sensor(2.0 + GetParam() * 200.0, 2.0, 90.0),
        heap{GetParam() < 0.0 ? 0.9 : 1.4},
        result(filled(scanned(heap, sensor), sensor)) {}

  const Eigen::Vector3d sensor;
  const Windrow heap;
  const Filled result;
};

TEST_P(FarFlank, FallsFromTheTopAtTheSlopeOfTheFlankThatIsSeen) {
  const Eigen::ArrayXXd& z = result.map.z;
  const double hidden = result.scan.z.isNaN().select(z, 0.0).sum() * cell_size * cell_size;
  EXPECT_NEAR(hidden, Windrow::flank_volume(), 0.02 * Windrow::flank_volume());
}

TEST_P(FarFlank, ErrsByTwoDegreesInTheVolumeOfTheHeap) {
  const int zone = result.ground.zone(40, GetParam() < 0.0 ? 30 : 50);
  ASSERT_GE(zone, 0);
  const double variance = result.variance[static_cast<std::size_t>(zone)];
  const double sd = std::sqrt(variance) * cell_size * cell_size;
  const double expected = 2.0 * degree * Windrow::flank_volume_per_radian();
  EXPECT_NEAR(sd, expected, 0.05 * expected);
}

INSTANTIATE_TEST_SUITE_P(From, FarFlank, testing::Values(-1.0, 1.0), [](const auto& side) {
  return std::string(side.param < 0.0 ? "TheLeft" : "TheRight");
});

/// What is hidden of the cell behind the edge lies below what was seen of it.
TEST(ShadowFilling, ALedgeInAHoleKeepsItsHeightUpToItsEdge) {
  const double wall = std::tan(70.0 * degree);
  const Pit upper{{0.6, 0.8, 3.6, 3.2}, 0.2, wall};
  const Pit lower{{1.53, 1.2, 3.1, 2.8}, 0.3, wall};
  const Shape shape = [&](double x, double y) { return upper(x, y) + lower(x, y); };
  const Eigen::Vector3d sensor(-20.0, 2.0, 18.0);
  const Filled result = filled(scanned(shape, sensor), sensor);
  const Cell edge = {40, 30};
  const double seen = result.scan.z(edge.row, edge.col);
  ASSERT_FALSE(std::isnan(seen));
  ASSERT_TRUE(std::isnan(result.scan.z(edge.row, edge.col + 1)));
  const double height = result.map.z(edge.row, edge.col);
  EXPECT_NEAR(height, scanned(shape, std::nullopt).z(edge.row, edge.col), 0.015);
  EXPECT_LE(height, seen);
}

/// The change by a shape that one far sensor sees.
VolumeChange change_by(const Shape& shape, double fall_of_rays) {
  SurfacePair pair;
  pair.before.height = flat_ground({0.0, 0.0, 4.0, 4.0}, cell_size);
  pair.after.sensors = {{2.0 - 200.0, 2.0, 200.0 * fall_of_rays}};
  pair.after.height = scanned(shape, pair.after.sensors[0]);
  const Eigen::ArrayXXd& z = pair.after.height.z;
  pair.after.points = z.isNaN().select(Eigen::ArrayXXi::Zero(z.rows(), z.cols()), 20);
  pair.after.variance = z.isNaN().select(z, 1e-6);
  return measure_change(pair);
}

class PitInShadow : public testing::TestWithParam<double> {};

TEST_P(PitInShadow, HasAnErrorThatCoversWhatALedgeHides) {
  const double wall = std::tan(70.0 * degree);
  const Pit plain{{0.6, 0.8, 3.6, 3.2}, 0.5, wall};
  const Pit upper{plain.rim, 0.2, wall};
  const auto with_ledge = [&](double width) {
    const double inset = width + upper.depth / wall;
    const Pit lower{{0.6 + inset, 0.8 + inset, 3.6 - inset, 3.2 - inset}, 0.3, wall};
    return [=](double x, double y) { return upper(x, y) + lower(x, y); };
  };
  for (const Shape& shape :
       {Shape(plain), Shape(with_ledge(0.1)), Shape(with_ledge(0.2)), Shape(with_ledge(0.6))}) {
    const double truth = -scanned(shape, std::nullopt).z.sum() * cell_size * cell_size;
    const Measured found = change_by(shape, GetParam()).excavated;
    EXPECT_NEAR(found.value, truth, 3.0 * found.sd);
    EXPECT_NEAR(found.value, truth, 0.02 * truth);
  }
}

INSTANTIATE_TEST_SUITE_P(Falls, PitInShadow, testing::Values(0.7, 0.9, 1.2));

/// The change by a pit of which one far sensor hides a share.
struct HalfSeenPit {
  double unseen_share;
  bool is_warned;
};

HalfSeenPit half_seen_pit(double fall_of_rays) {
  const Pit pit{{1.0, 1.2, 3.0, 2.8}, 0.5, std::tan(70.0 * degree)};
  const VolumeChange change = change_by(pit, fall_of_rays);
  const auto hole = std::find_if(change.zones.begin(), change.zones.end(),
                                 [](const ChangeZone& zone) { return zone.kind == ZoneKind::dig; });
  if (hole == change.zones.end()) return {nan, false};
  return {hole->unknown_share,
          std::any_of(change.warnings.begin(), change.warnings.end(), [](const Warning& warning) {
            return warning.code == WarningCode::zone_partly_unseen;
          })};
}

TEST(ShadowFilling, KeepsTrustInAHoleUpToThirtyFivePercentInShadow) {
  const HalfSeenPit below = half_seen_pit(0.60);
  EXPECT_GT(below.unseen_share, ChangeOptions{}.max_unknown_share);
  EXPECT_LT(below.unseen_share, 0.33);
  EXPECT_FALSE(below.is_warned);
  const HalfSeenPit above = half_seen_pit(0.45);
  EXPECT_GT(above.unseen_share, 0.37);
  EXPECT_LT(above.unseen_share, ChangeOptions{}.refused_unknown_share);
  EXPECT_TRUE(above.is_warned);
}

}  // namespace
}  // namespace excavplan
