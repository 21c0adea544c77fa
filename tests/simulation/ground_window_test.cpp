// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "earth/slump.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>
#include "base/angles.hpp"
#include "base/random.hpp"

#include "support/errors.hpp"

namespace excavplan {
namespace {

CellBlock whole(const Terrain& terrain) {
  return {0, terrain.loose.rows(), 0, terrain.loose.cols()};
}

/// Soil with one bank and one loose state; slides with the given tangents.
struct Ground {
  Ground() {
    kind.specific_gravity = 2.7;
    kind.void_ratio_max = 1.4;
    kind.void_ratio_min = 0.4;
    kind.void_ratio_loose = 1.4;
    kind.friction_loosest = 35 * degree;
    kind.angle_of_repose = 35 * degree;
    kind.cone_index_reference = 1e5;
    kind.cone_index_reference_density = 1500.0;
    bank = bank_state(kind, 80.0);  // void ratio 0.6: swells by 1.5
    loose = loose_state(kind);
  }

  void slump(Terrain& terrain, double repose, bool bank_stands = true) const {
    GroundWindow window(terrain, {kind, bank, loose}, whole(terrain));
    const SlopeLimits limits = {std::tan(repose), bank_stands};
    EXPECT_TRUE(excavplan::slump(window, whole(terrain), limits, 100000).empty());
    apply(window.patch(), terrain);
  }

  void pour(Terrain& terrain, const Eigen::Vector2d& at, double volume) const {
    GroundWindow window(terrain, {kind, bank, loose}, {});
    excavplan::pour(window, at, volume, std::tan(35 * degree));
    apply(window.patch(), terrain);
  }

  SoilKind kind;
  SoilState bank;
  SoilState loose;
};

/// Half a cubic metre as a column of 20 cm radius that collapses.
Terrain collapsed_column(double cell, double repose) {
  Terrain terrain = undisturbed(flat_ground({-2.5, -2.5, 2.5, 2.5}, cell));
  int cells = 0;
  const auto inside = [&](Eigen::Index row, Eigen::Index col) {
    return std::hypot(terrain.bank.x(col), terrain.bank.y(row)) < 0.2;
  };
  for (int pass = 0; pass < 2; ++pass) {
    for (Eigen::Index col = 0; col < terrain.loose.cols(); ++col) {
      for (Eigen::Index row = 0; row < terrain.loose.rows(); ++row) {
        if (!inside(row, col)) continue;
        if (pass == 0) ++cells;
        if (pass == 1) terrain.loose(row, col) = 0.5 / (cells * cell * cell);
      }
    }
  }
  Ground().slump(terrain, repose);
  return terrain;
}

double flank_angle(const HeightMap& heap, double direction, double inner, double outer) {
  const auto at = [&](double r) {
    return height_at(heap, r * std::cos(direction), r * std::sin(direction));
  };
  return std::atan((at(inner) - at(outer)) / (outer - inner));
}

TEST(Slump, HeapStandsAtItsReposeInEveryDirection) {
  for (const double cell : {0.1, 0.05, 0.025}) {
    for (const double repose : {25.0, 30.0, 35.0, 40.0, 45.0}) {
      const Terrain terrain = collapsed_column(cell, repose * degree);
      const double radius = std::cbrt(3.0 * 0.5 / (3.14159265 * std::tan(repose * degree)));
      for (int i = 0; i < 36; ++i) {
        const double angle =
            flank_angle(terrain.surface(), 10.0 * degree * i, 0.25 * radius, 0.75 * radius);
        EXPECT_NEAR(angle / degree, repose, 1.0) << cell << " m, " << 10 * i << " deg";
      }
    }
  }
}

// Passes on larger cells carry soil far: as many are needed on small cells as on large ones, not
// the square of the cells across the heap.
TEST(Slump, SmallCellsNeedFewMorePasses) {
  const Ground ground;
  for (const double cell : {0.1, 0.05, 0.025, 0.0125}) {
    Terrain terrain = undisturbed(flat_ground({-1.5, -1.5, 1.5, 1.5}, cell));
    const Eigen::Index side = terrain.loose.rows();
    const auto half = static_cast<Eigen::Index>(std::lround(0.3 / cell));
    terrain.loose.block(side / 2 - half, side / 2 - half, 2 * half, 2 * half) += 0.6;
    GroundWindow window(terrain, {ground.kind, ground.bank, ground.loose}, whole(terrain));
    const SlopeLimits limits = {std::tan(35 * degree), true};
    EXPECT_TRUE(slump(window, whole(terrain), limits, 300).empty()) << cell;
  }
}

// On larger cells the edge of a cut is not seen where it is: what lies at rest beside it stays.
TEST(Slump, SoilAtRestBesideACutStays) {
  for (const Eigen::Index edge : {40, 41, 42, 43}) {
    Terrain terrain = undisturbed(flat_ground({0, 0, 2, 1}, 0.025));
    terrain.bank.z.rightCols(terrain.bank.z.cols() - edge) -= 0.5;
    for (Eigen::Index col = 0; col < edge; ++col) {
      terrain.loose.col(col) += 0.5 * 0.025 * static_cast<double>(edge - 1 - col);
    }
    const Terrain before = terrain;
    Ground().slump(terrain, 35 * degree);
    EXPECT_TRUE((terrain.loose == before.loose).all()) << edge;
  }
}

TEST(Slump, SymmetricSoilStaysSymmetric) {
  Terrain terrain = undisturbed(flat_ground({-2, -2, 2, 2}, 0.05));
  terrain.bank.z.block(32, 10, 16, 30) -= 0.4;
  terrain.loose.block(30, 40, 20, 4) += 0.8;
  Ground().slump(terrain, 35 * degree);
  const Eigen::ArrayXXd across = terrain.loose - terrain.loose.colwise().reverse();
  EXPECT_LT(across.abs().maxCoeff(), 0.02);
  EXPECT_LT(std::sqrt(across.square().mean()), 0.002);
}

TEST(Slump, KeepsEveryGrain) {
  Random random(3);
  Terrain terrain = undisturbed(flat_ground({0, 0, 2, 2}, 0.05));
  for (Eigen::Index i = 0; i < terrain.loose.size(); ++i) {
    terrain.bank.z.data()[i] = 0.3 * random.uniform();
    terrain.loose.data()[i] = random.uniform() < 0.1 ? random.uniform() : 0.0;
  }
  const double before = terrain.loose.sum();
  Ground().slump(terrain, 35 * degree);
  EXPECT_NEAR(terrain.loose.sum(), before, 1e-12 * before * 3600);
  EXPECT_GE(terrain.loose.minCoeff(), 0.0);
}

TEST(Slump, DryWallCavesInToItsFrictionAngleAndCohesiveWallStands) {
  const auto wall = [](double height) {
    Ground ground;
    ground.bank.cohesion = height * ground.bank.unit_weight / 4.0 /
                           std::tan(45 * degree + 0.5 * ground.bank.friction_angle);
    Terrain terrain = undisturbed(flat_ground({0, 0, 4, 2}, 0.05));
    terrain.bank.z.leftCols(40) += 0.5;
    ground.slump(terrain, 35 * degree, false);
    return terrain;
  };
  EXPECT_EQ(wall(0.6).bank.z.maxCoeff(), 0.5);
  EXPECT_EQ(wall(0.6).loose.sum(), 0.0);
  const Terrain caved = wall(0.0);
  // Over 20 cm; a single cell may fall a sixth steeper.
  const Eigen::ArrayXXd z = caved.surface().z;
  const double steepest = (z.leftCols(76) - z.rightCols(76)).maxCoeff() / (4 * 0.05);
  EXPECT_LT(steepest, std::tan(37 * degree));
  EXPECT_GT(steepest, std::tan(34 * degree));
  // What broke off swelled by 1.5: solids are conserved.
  const double broken = 40 * 40 * 0.5 - caved.bank.z.sum();
  EXPECT_GT(broken, 0.0);
  EXPECT_NEAR(caved.loose.sum(), 1.5 * broken, 1e-9);
}

// Without cohesion no length decides how steep soil stands.
TEST(Slump, ADryWallOfAnyHeightCavesInToItsFrictionAngle) {
  const Ground ground;
  for (const double cell : {0.05, 0.0125, 0.005}) {
    Terrain terrain = undisturbed(flat_ground({0, 0, 80 * cell, 10 * cell}, cell));
    terrain.bank.z.leftCols(40) += 10 * cell;
    ground.slump(terrain, 35 * degree, false);
    const Eigen::ArrayXXd z = terrain.surface().z;
    const double steepest = (z.leftCols(76) - z.rightCols(76)).maxCoeff() / (4 * cell);
    EXPECT_LT(steepest, std::tan(37 * degree)) << cell;  // a single cell may fall a sixth steeper
    EXPECT_GT(steepest, std::tan(34 * degree)) << cell;
  }
}

TEST(Slump, UnknownCellsAreWalls) {
  Terrain terrain = undisturbed(flat_ground({0, 0, 1, 1}, 0.05));
  terrain.bank.z.col(10).setConstant(std::nan(""));
  terrain.loose.col(9).setConstant(1.0);
  Ground().slump(terrain, 30 * degree);
  EXPECT_NEAR(terrain.loose.leftCols(10).sum(), 20.0, 1e-9);
  EXPECT_EQ(terrain.loose.rightCols(10).sum(), 0.0);
}

TEST(Slump, SoilThatMovesSwellsAndWhatStaysKeepsItsVoidRatio) {
  Terrain terrain = undisturbed(flat_ground({0, 0, 2, 2}, 0.05));
  terrain.loose_void_ratio = Eigen::ArrayXXd::Constant(40, 40, 0.5);
  terrain.loose.block(15, 15, 10, 10) += 0.8;
  terrain.loose.leftCols(2) += 0.1;  // lies still
  const auto solids = [](const Terrain& t) { return (t.loose / (1.0 + t.loose_void_ratio)).sum(); };
  const double before = solids(terrain);
  Ground().slump(terrain, 35 * degree);
  EXPECT_NEAR(solids(terrain), before, 1e-9 * before);
  EXPECT_EQ(terrain.loose_void_ratio(20, 0), 0.5);
  EXPECT_NEAR(terrain.loose_void_ratio(20, 12), 1.4, 1e-12);  // all that lies there has moved
  const double core = terrain.loose_void_ratio(20, 20);
  EXPECT_LT(core, 0.6);
}

TEST(Slump, UnevenBankFailsWhereItIsLoose) {
  Ground ground;
  ground.kind.cohesion_loosest = 100.0;
  ground.kind.cohesion_growth = 5.0;  // 100 Pa .. 15 kPa
  Terrain terrain = undisturbed(flat_ground({0, 0, 4, 2}, 0.05));
  terrain.bank.z.leftCols(40) += 0.5;
  terrain.bank_void_ratio = Eigen::ArrayXXd::Constant(40, 80, 1.4);
  terrain.bank_void_ratio.topRows(20).setConstant(0.4);
  const Terrain before = terrain;
  ground.slump(terrain, 35 * degree, false);
  EXPECT_TRUE((terrain.bank.z.topRows(19) == before.bank.z.topRows(19)).all());
  EXPECT_LT(terrain.bank.z(35, 39), 0.3);
}

// Digs and heaps at the rim of a window are the same as in the middle of one.
TEST(GroundWindow, GrowsWithWhatSlides) {
  Terrain small = undisturbed(flat_ground({0, 0, 6, 6}, 0.05));
  small.loose.block(55, 55, 10, 10) += 1.0;
  Terrain large = small;
  const Ground ground;
  const CellBlock column = {55, 65, 55, 65};
  const SlopeLimits limits = {std::tan(35 * degree), true};
  GroundWindow window(small, {ground.kind, ground.bank, ground.loose}, column);
  EXPECT_LT(window.cells().rows(), 40);
  slump(window, column, limits, 100000);
  apply(window.patch(), small);
  GroundWindow wide(large, {ground.kind, ground.bank, ground.loose}, whole(large));
  slump(wide, column, limits, 100000);
  apply(wide.patch(), large);
  EXPECT_TRUE((small.loose == large.loose).all());
  EXPECT_NEAR(small.loose.sum(), 100.0, 1e-9);
}

TEST(GroundWindow, RefusesLayersThatCannotBeWhereItLooks) {
  Terrain terrain = undisturbed(flat_ground({0, 0, 4, 4}, 0.05));
  terrain.loose(79, 79) = -1.0;  // far away: not read
  const Ground ground;
  const GroundSoil soil = {ground.kind, ground.bank, ground.loose};
  EXPECT_NO_THROW(GroundWindow(terrain, soil, {0, 10, 0, 10}));
  EXPECT_EQ(
      test::error_of([&] { GroundWindow(terrain, soil, whole(terrain)); }),
      "dig: the loose layer in the cell at x = 3.975 m, y = 3.975 m is -1, must be in 0 .. 1e+06");
  terrain.bank_void_ratio = Eigen::ArrayXXd::Constant(80, 80, 0.2);
  EXPECT_THROW(GroundWindow(terrain, soil, {0, 10, 0, 10}), Error);
}

TEST(Pour, HeapHoldsItsVolumeOnAnyGround) {
  Terrain terrain = undisturbed(flat_ground({0, 0, 6, 6}, 0.05));
  for (Eigen::Index col = 0; col < terrain.bank.z.cols(); ++col) {
    terrain.bank.z.col(col) += 0.2 * terrain.bank.x(col);
  }
  Ground().pour(terrain, {3.0, 3.0}, 0.4);
  EXPECT_NEAR(terrain.loose.sum() * 0.05 * 0.05, 0.4, 1e-12);
  Ground().pour(terrain, {3.3, 3.0}, 0.4);
  EXPECT_NEAR(terrain.loose.sum() * 0.05 * 0.05, 0.8, 1e-12);
}

}  // namespace
}  // namespace excavplan
