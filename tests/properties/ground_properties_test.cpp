// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/error.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/ground/resampling.hpp>
#include <excavplan/ground/terrain.hpp>

#include <algorithm>

#include <Eigen/Geometry>

#include "base/statistics.hpp"
#include "ground/hole_filling.hpp"
#include "support/cases.hpp"

namespace excavplan::test {
namespace {

using Eigen::ArrayXXd;

HeightMap any_map(Random& random, Eigen::Index rows, Eigen::Index cols) {
  HeightMap map;
  map.origin = drawn_vector(random, 2, -5.0, 5.0);
  map.cell_size = random.uniform(0.02, 0.5);
  map.z.resize(rows, cols);
  for (double& z : map.z.reshaped()) z = random.uniform(-1.0, 1.0);
  return map;
}

struct Plane {
  double constant, by_x, by_y;
  double at(double x, double y) const { return constant + by_x * x + by_y * y; }
};

Plane any_plane(Random& random) {
  const double constant = random.uniform(-2.0, 2.0);
  const double by_x = random.uniform(-1.0, 1.0);
  return {constant, by_x, random.uniform(-1.0, 1.0)};
}

void lay(const Plane& plane, HeightMap& map) {
  for_each_cell(map.z,
                [&](Cell at) { map.z(at.row, at.col) = plane.at(map.x(at.col), map.y(at.row)); });
}

TEST(GroundProperties, HeightsOfAPlaneAreThePlane) {
  for_cases([](Random& random) {
    HeightMap map = any_map(random, 5, 7);
    const Plane plane = any_plane(random);
    lay(plane, map);
    const double x = random.uniform(map.x(0), map.x(6));
    const double y = random.uniform(map.y(0), map.y(4));
    EXPECT_NEAR(height_at(map, x, y), plane.at(x, y), 1e-9);
    const Rectangle inside = {map.x(1), map.y(1), map.x(4), map.y(3)};
    const HeightMap finer = resampled(map, inside, 0.37 * map.cell_size, map.cell_size);
    for_each_cell(finer.z, [&](Cell at) {
      EXPECT_NEAR(finer.z(at.row, at.col), plane.at(finer.x(at.col), finer.y(at.row)), 1e-9);
    });
  });
}

TEST(GroundProperties, HeightsLieBetweenThoseAround) {
  for_cases([](Random& random) {
    const HeightMap map = any_map(random, 4, 4);
    const double x = random.uniform(map.extent().x_min, map.extent().x_max);
    const double y = random.uniform(map.extent().y_min, map.extent().y_max);
    const double z = height_at(map, x, y);
    EXPECT_TRUE(map.z.minCoeff() <= z && z <= map.z.maxCoeff());
    EXPECT_TRUE(std::isnan(height_at(map, map.extent().x_max + 1e-6, y)));
    EXPECT_TRUE(std::isnan(height_at(map, x, map.extent().y_min - 1e-6)));
  });
}

/// Within a millionth of a cell of the same place maps are on one grid, a thousandth off they are
/// not.
TEST(GroundProperties, GridsAreTheSameToABillionthOfACell) {
  for_cases([](Random& random) {
    const HeightMap map = any_map(random, 3, 3);
    HeightMap other = map;
    const auto axis = static_cast<Eigen::Index>(random.index(2));
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    other.origin(axis) += side * 1e-10 * map.cell_size;
    EXPECT_TRUE(same_grid(map, other));
    other.origin(axis) += side * random.uniform(1e-6, 0.5) * map.cell_size;
    EXPECT_FALSE(same_grid(map, other));
    EXPECT_FALSE(same_grid(other, map));
  });
}

Terrain terrain_of(const HeightMap& map) { return undisturbed(map); }

struct Change {
  HeightMap before;
  HeightMap after;
  Eigen::Vector2d dump_at = {0.0, 0.0};
  HeightMapVolumes volumes(double radius) const {
    return height_map_volumes(terrain_of(before), terrain_of(after), dump_at, radius);
  }
};

Change any_change(Random& random) {
  Change change;
  change.before = any_map(random, 6, 8);
  change.after = change.before;
  for (double& z : change.after.z.reshaped()) z += random.uniform(-0.5, 0.5);
  const Rectangle all = change.before.extent();
  const double x = random.uniform(all.x_min, all.x_max);
  change.dump_at = {x, random.uniform(all.y_min, all.y_max)};
  return change;
}

void expect_same(const HeightMapVolumes& a, const HeightMapVolumes& b) {
  EXPECT_NEAR(a.excavated, b.excavated, 1e-12);
  EXPECT_NEAR(a.spilled, b.spilled, 1e-12);
  EXPECT_NEAR(a.dumped, b.dumped, 1e-12);
}

TEST(GroundProperties, VolumesAddUpToTheChangeOfTheGround) {
  for_cases([](Random& random) {
    const Change change = any_change(random);
    const HeightMapVolumes volumes = change.volumes(random.uniform(0.0, 3.0));
    const double cell = change.before.cell_size;
    const double net = (change.after.z - change.before.z).sum() * cell * cell;
    EXPECT_NEAR(volumes.spilled + volumes.dumped - volumes.excavated, net, 1e-12);
    EXPECT_TRUE(volumes.excavated >= 0.0 && volumes.spilled >= 0.0 && volumes.dumped >= 0.0);
    if (volumes.excavated > 1e-6) {
      EXPECT_NEAR(volumes.bulking_factor * volumes.excavated, volumes.spilled + volumes.dumped,
                  1e-12);
    }
  });
}

/// The volumes of two halves of the ground add up to those of the whole.
TEST(GroundProperties, VolumesOfPartsAddUp) {
  for_cases([](Random& random) {
    const Change change = any_change(random);
    const double radius = random.uniform(0.0, 3.0);
    HeightMapVolumes sum;
    for (const Eigen::Index first : {0, 3}) {
      Change half = change;
      half.before.origin.y() = half.after.origin.y() =
          change.before.y(first) - 0.5 * change.before.cell_size;
      half.before.z = change.before.z.middleRows(first, 3);
      half.after.z = change.after.z.middleRows(first, 3);
      const HeightMapVolumes part = half.volumes(radius);
      sum.excavated += part.excavated;
      sum.spilled += part.spilled;
      sum.dumped += part.dumped;
    }
    // a cell at the edge of the heap's circle may fall on either side by rounding of its place
    EXPECT_NEAR(sum.excavated, change.volumes(radius).excavated, 1e-12);
    const HeightMapVolumes all = change.volumes(radius);
    EXPECT_NEAR(sum.spilled + sum.dumped, all.spilled + all.dumped, 1e-12);
  });
}

TEST(GroundProperties, VolumesDoNotDependOnPlaceDirectionOrDatum) {
  for_cases([](Random& random) {
    const Change change = any_change(random);
    const double radius = random.uniform(0.1, 3.0);
    const HeightMapVolumes volumes = change.volumes(radius);

    Change raised = change;
    const double up = random.uniform(-10.0, 10.0);
    raised.before.z += up;
    raised.after.z += up;
    expect_same(raised.volumes(radius), volumes);

    // along x turned round about the dump point, then rows and columns exchanged about it
    Change mirrored = change;
    mirrored.before.z = change.before.z.rowwise().reverse();
    mirrored.after.z = change.after.z.rowwise().reverse();
    mirrored.before.origin.x() = 2.0 * change.dump_at.x() - change.before.extent().x_max;
    mirrored.after.origin = mirrored.before.origin;
    expect_same(mirrored.volumes(radius), volumes);

    Change turned = change;
    turned.before.z = change.before.z.transpose();
    turned.after.z = change.after.z.transpose();
    turned.before.origin = change.dump_at + (change.before.origin - change.dump_at).reverse();
    turned.after.origin = turned.before.origin;
    expect_same(turned.volumes(radius), volumes);
  });
}

TEST(GroundProperties, BackFromAfterIsTheOppositeVolume) {
  for_cases([](Random& random) {
    Change change = any_change(random);
    const HeightMapVolumes there = change.volumes(2.0);
    std::swap(change.before, change.after);
    const HeightMapVolumes back = change.volumes(2.0);
    EXPECT_NEAR(back.excavated, there.spilled + there.dumped, 1e-12);
    EXPECT_NEAR(back.spilled + back.dumped, there.excavated, 1e-12);
  });
}

/// A membrane has no extremes of its own; a plane is its own membrane and its own thin plate.
TEST(GroundProperties, FilledHolesLieBetweenTheirRims) {
  for_cases([](Random& random) {
    HeightMap map = any_map(random, 6, 6);
    const bool is_plane = random.uniform() < 0.5;
    const Plane plane = any_plane(random);
    if (is_plane) lay(plane, map);
    const ArrayXXd whole = map.z;
    const Eigen::Index rows = drawn_int(random, 1, 3);
    const Eigen::Index cols = drawn_int(random, 1, 3);
    ArrayXXd holed = whole;
    holed.block(1, 1, rows, cols).setConstant(std::nan(""));
    const ArrayXXd rim = holed.topLeftCorner(rows + 2, cols + 2);
    ArrayXXd filled = holed;
    const Holes holes = fill_holes(filled);
    ASSERT_EQ(holes.cells.size(), 1U);
    EXPECT_EQ(holes.cells[0].size(), static_cast<std::size_t>(rows * cols));
    const double low = rim.isNaN().select(1e9, rim).minCoeff();
    const double high = rim.isNaN().select(-1e9, rim).maxCoeff();
    EXPECT_GE(filled.minCoeff(), std::min(low, whole.minCoeff()) - 1e-9);
    EXPECT_GE(filled.block(1, 1, rows, cols).minCoeff(), low - 1e-9);
    EXPECT_LE(filled.block(1, 1, rows, cols).maxCoeff(), high + 1e-9);
    if (!is_plane) return;
    EXPECT_LT((filled - whole).abs().maxCoeff(), 1e-9);
    ArrayXXd plate = holed;
    fill(plate, holes.cells[0], Filling::thin_plate);
    EXPECT_LT((plate - whole).abs().maxCoeff(), 1e-9);
  });
}

/// Squared slopes, or squared curvatures and a twentieth of squared slopes.
double energy_of(const ArrayXXd& z, Filling filling) {
  const Eigen::Index rows = z.rows(), cols = z.cols();
  const double slopes = (z.topRows(rows - 1) - z.bottomRows(rows - 1)).square().sum() +
                        (z.leftCols(cols - 1) - z.rightCols(cols - 1)).square().sum();
  if (filling == Filling::membrane) return slopes;
  const ArrayXXd by_row = z.topRows(rows - 1) - z.bottomRows(rows - 1);
  const ArrayXXd by_col = z.leftCols(cols - 1) - z.rightCols(cols - 1);
  const auto rises = [](const ArrayXXd& d) {
    return (d.topRows(d.rows() - 1) - d.bottomRows(d.rows() - 1)).square().sum();
  };
  return 0.05 * slopes + rises(by_row) + rises(by_col.transpose()) + 2.0 * rises(by_col);
}

TEST(GroundProperties, FillingsHaveTheLeastEnergy) {
  for_cases([](Random& random) {
    ArrayXXd z = any_map(random, 7, 7).z;
    std::vector<Cell> hole;
    const Eigen::Index rows = drawn_int(random, 1, 3), cols = drawn_int(random, 1, 3);
    for (Eigen::Index row = 2; row < 2 + rows; ++row) {
      for (Eigen::Index col = 2; col < 2 + cols; ++col) hole.push_back({row, col});
    }
    z.block(2, 2, rows, cols).setConstant(std::nan(""));
    const Filling filling = random.uniform() < 0.5 ? Filling::membrane : Filling::thin_plate;
    fill(z, hole, filling);
    const Cell at = hole[random.index(hole.size())];
    const auto energy = [&](double step) {
      ArrayXXd moved = z;
      moved(at.row, at.col) += step;
      return energy_of(moved, filling);
    };
    EXPECT_NEAR(energy(1e-3) - energy(-1e-3), 0.0, 1e-10);
  });
}

/// A small rigid motion: the correction takes the points of the scan after back, to the second
/// order of its angles.
TEST(GroundProperties, CorrectionsAreRigidAndTakeMotionsBack) {
  for_cases([](Random& random) {
    Alignment alignment;
    alignment.centre = drawn_vector(random, 3, -10.0, 10.0);
    alignment.motion.head<3>() = drawn_vector(random, 3, -0.1, 0.1);
    alignment.motion.tail<3>() = drawn_vector(random, 3, -0.01, 0.01);
    const Eigen::Matrix4d back = alignment.correction();
    const Eigen::Matrix3d turn = back.topLeftCorner<3, 3>();
    EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-12);
    const Eigen::Vector3d p = drawn_vector(random, 3, -10.0, 10.0);
    const Eigen::Vector3d arm = p - alignment.centre;
    const Eigen::Vector3d turns = alignment.motion.tail<3>();
    const Eigen::Vector3d moved = p + turns.cross(arm) + alignment.motion.head<3>();
    const Eigen::Vector3d found = (back * moved.homogeneous()).head<3>();
    const double angle = alignment.motion.tail<3>().norm();
    EXPECT_LT((found - p).norm(), 2.0 * angle * angle * (arm.norm() + 1.0) + angle * 0.2 + 1e-12);
  });
}

/// A plane that was shifted and raised comes back to itself, up to its border and beside unknown
/// cells, where the slope is known from one side alone.
TEST(GroundProperties, ShiftedPlanesAreTakenBack) {
  for_cases([](Random& random) {
    HeightMap map = any_map(random, 5, 5);
    const Plane plane = any_plane(random);
    lay(plane, map);
    Alignment alignment;
    alignment.motion.head<3>() = drawn_vector(random, 3, -0.01, 0.01);
    HeightMap moved = map;
    const Motion& by = alignment.motion;
    moved.z += by(2) - plane.by_x * by(0) - plane.by_y * by(1);
    const Cell hole = {2, 2};
    moved.z(hole.row, hole.col) = std::nan("");
    const HeightMap back = realigned(moved, alignment);
    for_each_cell(map.z, [&](Cell at) {
      if (at.row == hole.row && at.col == hole.col) return;
      EXPECT_NEAR(back.z(at.row, at.col), map.z(at.row, at.col), 1e-9);
    });
  });
}

TEST(GroundProperties, GrowthIsAcceptedUpToDetection) {
  const HeightMap ground = flat_ground({0.0, 0.0, 0.6, 0.6}, 0.05);
  for_cases(
      [&](Random& random) {
        ChangeOptions options;
        options.detection = random.uniform(0.5, 9.0);
        options.growth = options.detection;
        EXPECT_NO_THROW(measure_change(ground, ground, options));
        options.growth *= 1.0 + 1e-9;
        EXPECT_THROW(measure_change(ground, ground, options), Error);
      },
      200);
}

TEST(GroundProperties, MediansHaveHalfOfTheValuesOnEachSide) {
  for_cases([](Random& random) {
    std::vector<double> values(1 + random.index(12));
    for (double& value : values) value = std::round(random.uniform(-5.0, 5.0));
    const double middle = median(values);
    const auto below =
        std::count_if(values.begin(), values.end(), [&](double v) { return v < middle; });
    const auto above =
        std::count_if(values.begin(), values.end(), [&](double v) { return v > middle; });
    EXPECT_LE(2 * below, static_cast<std::ptrdiff_t>(values.size()));
    EXPECT_LE(2 * above, static_cast<std::ptrdiff_t>(values.size()));
    EXPECT_NE(std::find(values.begin(), values.end(), middle), values.end());
  });
}

}  // namespace
}  // namespace excavplan::test
