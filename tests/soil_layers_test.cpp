// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/soil_layers.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <excavplan/random.hpp>

namespace excavplan {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

SlopeLimits loose_soil(double repose) {
  return {std::tan(repose), std::tan(repose), std::numeric_limits<double>::infinity(), 1.0};
}

CellBlock whole(const Terrain& terrain) {
  return {0, terrain.loose.rows(), 0, terrain.loose.cols()};
}

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
  EXPECT_TRUE(slump(terrain, whole(terrain), loose_soil(repose), 100000).empty());
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

TEST(Slump, KeepsEveryGrain) {
  Random random(3);
  Terrain terrain = undisturbed(flat_ground({0, 0, 2, 2}, 0.05));
  for (Eigen::Index i = 0; i < terrain.loose.size(); ++i) {
    terrain.bank.z.data()[i] = 0.3 * random.uniform();
    terrain.loose.data()[i] = random.uniform() < 0.1 ? random.uniform() : 0.0;
  }
  const double before = terrain.loose.sum();
  slump(terrain, whole(terrain), loose_soil(35 * degree), 100000);
  EXPECT_NEAR(terrain.loose.sum(), before, 1e-12 * before * 3600);
  EXPECT_GE(terrain.loose.minCoeff(), 0.0);
}

TEST(Slump, DryWallCavesInToItsFrictionAngleAndCohesiveWallStands) {
  const auto wall = [](double critical_height) {
    Terrain terrain = undisturbed(flat_ground({0, 0, 4, 2}, 0.05));
    terrain.bank.z.leftCols(40) += 0.5;
    slump(terrain, whole(terrain),
          {std::tan(35 * degree), std::tan(35 * degree), critical_height, 1.2}, 100000);
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
  // What broke off swelled by 1.2: solids are conserved.
  const double broken = 40 * 40 * 0.5 - caved.bank.z.sum();
  EXPECT_GT(broken, 0.0);
  EXPECT_NEAR(caved.loose.sum(), 1.2 * broken, 1e-9);
}

TEST(Slump, UnknownCellsAreWalls) {
  Terrain terrain = undisturbed(flat_ground({0, 0, 1, 1}, 0.05));
  terrain.bank.z.col(10).setConstant(std::nan(""));
  terrain.loose.col(9).setConstant(1.0);
  slump(terrain, whole(terrain), loose_soil(30 * degree), 100000);
  EXPECT_NEAR(terrain.loose.leftCols(10).sum(), 20.0, 1e-9);
  EXPECT_EQ(terrain.loose.rightCols(10).sum(), 0.0);
}

TEST(Pour, HeapHoldsItsVolumeOnAnyGround) {
  Terrain terrain = undisturbed(flat_ground({0, 0, 6, 6}, 0.05));
  for (Eigen::Index col = 0; col < terrain.bank.z.cols(); ++col) {
    terrain.bank.z.col(col) += 0.2 * terrain.bank.x(col);
  }
  pour(terrain, {3.0, 3.0}, 0.4, std::tan(35 * degree));
  EXPECT_NEAR(terrain.loose.sum() * 0.05 * 0.05, 0.4, 1e-12);
  pour(terrain, {3.3, 3.0}, 0.4, std::tan(35 * degree));
  EXPECT_NEAR(terrain.loose.sum() * 0.05 * 0.05, 0.8, 1e-12);
}

}  // namespace
}  // namespace excavplan
