// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/dig_along.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "support/errors.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using test::error_of;
using test::loam;
using test::zx120;

DigPath path_from(double start_x) {
  return std::get<DigPath>(
      make_dig_path(zx120(), paper_fixed_path(), start_x, [](double) { return 0.0; }));
}

/// Ground of a site that looks alike from all sides of the origin: its relief is of rings.
Terrain ringed_site() {
  HeightMap surface = flat_ground({-9.0, -9.0, 9.0, 9.0}, 0.05);
  for (Eigen::Index col = 0; col < surface.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < surface.z.rows(); ++row) {
      surface.z(row, col) = 0.05 * std::sin(2.0 * std::hypot(surface.x(col), surface.y(row)));
    }
  }
  return undisturbed(surface);
}

double solids(const Terrain& site, const SoilVoids& voids) {
  const double area = site.bank.cell_size * site.bank.cell_size;
  return voids.grain_density * area *
         ((site.bank.z + 5.0) / (1.0 + voids.bank) + site.loose / (1.0 + voids.loose)).sum();
}

TEST(DigAlong, PayloadAndEnergyAreThoseOfEveryHeading) {
  const HeightMapSimulator simulator(zx120(), loam(), 50.0);
  const SoilVoids voids = soil_voids(loam(), 50.0);
  const Terrain site = ringed_site();
  const DigPath path = path_from(6.0);
  const DigResult straight = dig_along(simulator, zx120(), site, {{}, voids, path});
  ASSERT_GT(straight.payload_mass, 200.0);
  for (int i = 0; i < 24; ++i) {
    const DigLine line = {{0.0, 0.0}, 0.0, 2.0 * pi * i / 24.0};
    const DigResult dig = dig_along(simulator, zx120(), site, {line, voids, path});
    EXPECT_NEAR(dig.payload_mass, straight.payload_mass, 0.02 * straight.payload_mass) << i;
    EXPECT_NEAR(dig.energy.total, straight.energy.total, 0.02 * straight.energy.total) << i;
    EXPECT_NEAR(dig.soil.solids_after, dig.soil.solids_before, 1e-9 * dig.soil.solids_before) << i;
    const Terrain after = dig.after(site);
    const double carried = dig.payload_volume / (1.0 + voids.loose) * voids.grain_density;
    EXPECT_NEAR(solids(after, voids) + carried, solids(site, voids), 1e-9 * solids(site, voids));
  }
}

TEST(DigAlong, AlongTheGridIsTheSimulatorsOwnDig) {
  const HeightMapSimulator simulator(zx120(), loam(), 50.0);
  const Terrain level = level_planning_ground(zx120());
  const DigPath path = path_from(6.0);
  const DigResult own = simulator.dig(level, path);
  const GroundAlong seen(level, {}, level.bank.extent(), level.bank.cell_size);
  DigResult along = simulator.dig(seen.terrain(), path);
  seen.enter(level, soil_voids(loam(), 50.0), along);
  EXPECT_NEAR(along.payload_mass, own.payload_mass, 1e-9 * own.payload_mass);
  EXPECT_EQ(along.energy.total, own.energy.total);
  const Terrain a = own.after(level);
  const Terrain b = along.after(level);
  EXPECT_LT((a.bank.z - b.bank.z).abs().maxCoeff(), 1e-9);
  EXPECT_LT((a.loose - b.loose).abs().maxCoeff(), 1e-9);
}

TEST(DigAlong, WallsStayWhereTheyAreWhenTheSameLineIsDugAgain) {
  const HeightMapSimulator simulator(zx120(), loam(), 60.0);
  const SoilVoids voids = soil_voids(loam(), 60.0);
  const DigLine line = {{0.3, -0.2}, 0.1, 0.4};
  Terrain site = undisturbed(flat_ground({-9.0, -9.0, 9.0, 9.0}, 0.05, 0.1));
  for (int i = 0; i < 6; ++i) {
    DigPathOptions options;
    options.floor = [](double) { return -0.3; };
    const GroundAlong seen(site, line, planning_extent(zx120()), 0.05);
    const auto path = make_dig_path(zx120(), {pi / 4.0, 1.0, 1.5}, 6.5,
                                    boom_plane_profile(seen.terrain()), options);
    site = dig_along(simulator, zx120(), site, {line, voids, std::get<DigPath>(path)}).after(site);
  }
  double beside = 0.0;
  double deepest = 1.0;
  for (Eigen::Index col = 0; col < site.bank.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < site.bank.z.rows(); ++row) {
      const Eigen::Vector2d offset =
          Eigen::Vector2d(site.bank.x(col), site.bank.y(row)) - line.origin;
      const double across = std::cos(0.4) * offset.y() - std::sin(0.4) * offset.x();
      const double lowered = 0.1 - site.bank.z(row, col);
      deepest = std::min(deepest, site.bank.z(row, col));
      if (std::abs(across) > 0.35) beside += lowered * 0.05 * 0.05;
    }
  }
  EXPECT_NEAR(deepest, 0.1 - 0.3, 1e-6);
  EXPECT_LT(beside, 0.02 * 6 * 0.7 * 0.3);
}

TEST(DigAlong, ALaneLiesBesideTheMachine) {
  const BasePose base = {2.0, 3.0, 0.5, pi / 2.0};
  const DigLine line = dig_line(base, 0.0, 0.25);
  EXPECT_LT((line.place(4.0, 0.0) - Eigen::Vector2d(1.75, 7.0)).norm(), 1e-12);
  EXPECT_EQ(line.z, 0.5);
  EXPECT_LT((dig_line(base, -pi / 2.0).place(4.0, 0.0) - Eigen::Vector2d(6.0, 3.0)).norm(), 1e-12);
}

TEST(DigAlong, HeapedSoilKeepsItsVolume) {
  Terrain site = undisturbed(flat_ground({-3.0, -3.0, 3.0, 3.0}, 0.05));
  heap_soil(site, loam(), 50.0, {0.4, -0.3}, 0.4);
  heap_soil(site, loam(), 50.0, {0.6, 0.1}, 0.3);
  EXPECT_NEAR(site.loose.sum() * 0.05 * 0.05, 0.7, 1e-9);
  EXPECT_EQ(site.bank.z.abs().maxCoeff(), 0.0);
  EXPECT_NE(error_of([&] {
              heap_soil(site, loam(), 50.0, {9.0, 0.0}, 0.1);
            }).find("dump point"),
            std::string::npos);
}

TEST(DigAlong, APatchOfOtherGroundIsRefused) {
  const Terrain site = ringed_site();
  const GroundAlong along(site, {}, {3.0, -1.0, 4.0, 1.0}, 0.05);
  const auto message = [&](const Terrain& of, TerrainPatch patch) {
    DigResult dig;
    dig.patch = std::move(patch);
    return error_of([&] { along.enter(of, soil_voids(loam(), 50.0), dig); });
  };
  TerrainPatch patch;
  EXPECT_EQ(message(site, patch), "ground along a line: the dig has no patch");
  patch.bank = patch.loose = Eigen::ArrayXXd::Zero(3, 3);
  EXPECT_EQ(message(site, patch), "no error");
  EXPECT_EQ(message({}, patch), "ground along a line: the map is empty");
  TerrainPatch outside = patch;
  outside.row = 100;
  EXPECT_EQ(message(site, outside),
            "patch: 3 x 3 cells from (100, 0) on, all layers alike, must lie on the terrain of "
            "40 x 20");
  TerrainPatch unlike = patch;
  unlike.loose.resize(1, 1);
  EXPECT_EQ(message(site, unlike),
            "patch: 3 x 3 cells from (0, 0) on, all layers alike, must lie on the terrain of "
            "40 x 20");
}

TEST(DigAlong, AHeapIsOfAVolumeThatCanBe) {
  Terrain site = undisturbed(flat_ground({0.0, 0.0, 2.0, 2.0}, 0.1));
  const auto message = [](Terrain& on, double volume) {
    return error_of([&] { heap_soil(on, loam(), 50.0, {1.0, 1.0}, volume); });
  };
  EXPECT_EQ(message(site, 1e300), "volume of a heap [m^3] is 1e+300, must be in 0 .. 1000000");
  site.loose.resize(1, 1);
  EXPECT_EQ(message(site, 0.1), "heap of soil: the loose layer must be as large as the map");
}

}  // namespace
}  // namespace excavplan
