// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/sensing/depth_camera.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include <algorithm>

#include <Eigen/LU>

#include "earth/slump.hpp"
#include "simulation/section_bucket.hpp"
#include "simulation/swath.hpp"
#include "soil/earthmoving.hpp"
#include "support/cases.hpp"
#include "support/machine_file.hpp"

namespace excavplan::test {
namespace {

constexpr double pi = 3.14159265358979323846;

CuttingWedge any_wedge(Random& random) {
  CuttingWedge wedge;
  wedge.rake = random.uniform(0.3, 1.6);
  wedge.friction = random.uniform(0.1, 0.7);
  wedge.tool_friction = wedge.friction * random.uniform(0.0, 1.0);
  wedge.slope = random.uniform(-0.1, 0.3);
  return wedge;
}

/// McKyes' factors from the balance of forces on the wedge, by sines alone: weight W, cohesion on
/// the plane, adhesion on the face, reaction R at phi to the plane's normal, force P at delta to
/// that of the face. A level surface.
TEST(SimulationProperties, EarthmovingFactorsBalanceTheWedge) {
  for_cases([](Random& random) {
    CuttingWedge wedge = any_wedge(random);
    wedge.slope = 0.0;
    const double beta = random.uniform(0.2, 0.9);
    const auto n = earthmoving_factors(wedge, beta);
    if (!n || n->D < 0.05) return;
    const double gamma = random.uniform(1e4, 2e4), c = random.uniform(0.0, 2e4);
    const double ca = random.uniform(0.0, 1e4), q = random.uniform(0.0, 1e4);
    const double t = random.uniform(0.1, 1.0);
    const double reach = t * (1.0 / std::tan(wedge.rake) + 1.0 / std::tan(beta));
    const double weight = 0.5 * gamma * t * reach + q * reach;
    const double plane = c * t / std::sin(beta), face = ca * t / std::sin(wedge.rake);
    // Unknown P and R: across and up.
    const double at_p = wedge.rake + wedge.tool_friction, at_r = beta + wedge.friction;
    Eigen::Matrix2d forces;
    forces << std::sin(at_p), -std::sin(at_r), std::cos(at_p), std::cos(at_r);
    const Eigen::Vector2d right(plane * std::cos(beta) - face * std::cos(wedge.rake),
                                weight + plane * std::sin(beta) + face * std::sin(wedge.rake));
    const double force = forces.inverse().row(0).dot(right);
    const double factors = gamma * t * t * n->gamma + c * t * n->c + q * t * n->q + ca * t * n->ca;
    EXPECT_NEAR(factors / force, 1.0, 1e-9);
  });
}

/// McKyes and Ali 1977: the crescents beside a blade of this width over depth widen the surface on
/// which a surcharge lies by 1 + s / w, the weight by 1 + 2 s / (3 w); none beside an infinite one.
TEST(SimulationProperties, CrescentsWidenWhatIsMoved) {
  for_cases([](Random& random) {
    CuttingWedge wedge = any_wedge(random);
    wedge.slope = 0.0;
    const double beta = random.uniform(0.3, 0.8), width = random.uniform(0.3, 5.0);
    if (wedge.rake + wedge.tool_friction + beta + wedge.friction > 3.0) return;
    const EarthmovingFactors wide = crescent_factors(wedge, beta, 1e12);
    const EarthmovingFactors narrow = crescent_factors(wedge, beta, width);
    const double cot_rake = 1.0 / std::tan(wedge.rake), cot_beta = 1.0 / std::tan(beta);
    const double reach = cot_rake + cot_beta;  // r / t; s^2 = r^2 - (t cot rake)^2
    const double side = std::sqrt(reach * reach - cot_rake * cot_rake) / width;
    EXPECT_NEAR(narrow.q / wide.q, 1.0 + side, 1e-9);
    EXPECT_NEAR(narrow.c / wide.c, 1.0 + side, 1e-9);
    EXPECT_NEAR(narrow.gamma / wide.gamma, 1.0 + 2.0 / 3.0 * side, 1e-9);
    EXPECT_NEAR(wide.gamma / wide.q, 0.5, 1e-9);
  });
}

/// Points lie within the range of the camera along its ray, however far above the ground it is and
/// whatever stands on it.
TEST(SimulationProperties, CamerasSeeAsFarAsTheirRange) {
  std::size_t points = 0;
  for_cases(
      [&](Random& random) {
        HeightMap ground = flat_ground({-3.0, -3.0, 3.0, 3.0}, 0.25);
        ground.z.block(2, 2, 3, 3).setConstant(random.uniform(0.5, 2.0));
        DepthCamera camera;
        camera.position = {0.3, 0.0, random.uniform(3.0, 6.0)};
        camera.width = 16;
        camera.height = 12;
        camera.noise = camera.dropouts = 0.0;
        camera.max_range = random.uniform(2.0, 7.0);
        const auto seen = scan_surface(ground, camera, 1);
        points += seen.size();
        const Eigen::Vector3d axis = (camera.target - camera.position).normalized();
        for (const Eigen::Vector3d& point : seen) {
          EXPECT_LE((point - camera.position).dot(axis), camera.max_range + 1e-9);
        }
        if (camera.max_range > 1.6 * camera.position.z()) {
          EXPECT_GT(seen.size(), 100U);
        }
      },
      300);
  EXPECT_GT(points, static_cast<std::size_t>(many));
}

TEST(SimulationProperties, CriticalFailureAnglesAreTheWeakest) {
  for_cases(
      [](Random& random) {
        const CuttingWedge wedge = any_wedge(random);
        const auto critical = critical_failure_angle(wedge);
        if (!critical) return;
        const double least = earthmoving_factors(wedge, *critical)->gamma;
        for (int i = 0; i < 10; ++i) {
          const double beta = random.uniform(0.05, 1.5);
          const auto other = earthmoving_factors(wedge, beta);
          if (other && beta + wedge.friction + wedge.rake + wedge.tool_friction < pi - 0.01) {
            EXPECT_GE(other->gamma, least * (1.0 - 1e-9));
          }
        }
      },
      1000);
}

/// A heap of loose soil as a pile of cells, some unknown.
Terrain any_ground(Random& random) {
  HeightMap map;
  map.cell_size = 0.1;
  map.z.resize(8, 8);
  for (double& z : map.z.reshaped()) z = random.uniform(-0.3, 0.3);
  Terrain terrain = undisturbed(map);
  for (double& loose : terrain.loose.reshaped()) {
    loose = std::max(0.0, random.uniform(-0.3, 0.5));
  }
  if (random.uniform() < 0.3) terrain.bank.z(2, 5) = std::nan("");
  return terrain;
}

struct States {
  SoilKind kind = loam();
  SoilState bank = bank_state(kind, 60.0);
  SoilState loose = loose_state(kind);
};

const States& states() {
  static const States of_loam;
  return of_loam;
}

/// Dry mass over a cell's area, of known cells [kg].
double mass(const Terrain& terrain) {
  const Eigen::ArrayXXd known = terrain.bank.z.isNaN().select(
      Eigen::ArrayXXd::Zero(8, 8),
      terrain.bank.z * states().bank.dry_density + terrain.loose * states().loose.dry_density);
  return known.sum() * 0.01;
}

TEST(SimulationProperties, SlidingSoilKeepsItsSolidsAndComesToRest) {
  for_cases(
      [](Random& random) {
        Terrain terrain = any_ground(random);
        const double before = mass(terrain);
        const bool hole = std::isnan(terrain.bank.z(2, 5));
        const CellBlock whole = {0, 8, 0, 8};
        const SlopeLimits limits = {random.uniform(0.4, 0.9), true};
        GroundWindow window(terrain, {states().kind, states().bank, states().loose}, whole);
        EXPECT_TRUE(slump(window, whole, limits, 100000).empty());
        apply(TerrainPatch(window.patch()), terrain);
        EXPECT_NEAR(mass(terrain), before, 1e-9 * std::abs(before) + 1e-9);
        EXPECT_EQ(std::isnan(terrain.bank.z(2, 5)), hole);
        EXPECT_GE(terrain.loose.minCoeff(), 0.0);
        const Eigen::ArrayXXd top = terrain.surface().z;
        for (Eigen::Index row = 0; row < 8; ++row) {
          for (Eigen::Index col = 1; col < 8; ++col) {
            const double fall = top(row, col - 1) - top(row, col);
            if (fall > 0.0 && terrain.loose(row, col - 1) > 1e-9) {
              // on a flank the fall is a mean over both sides, 0.85 of the lower side's at least
              EXPECT_LE(0.85 * fall / 0.1, limits.loose_slope * (1.0 + limits.slack) + 1e-6);
            }
          }
        }
      },
      2000);
}

TEST(SimulationProperties, PouredHeapsHoldTheirVolume) {
  for_cases(
      [](Random& random) {
        Terrain terrain = undisturbed(flat_ground({0.0, 0.0, 3.0, 3.0}, 0.1));
        const double volume = random.uniform(0.01, 0.2);
        GroundWindow window(terrain, {states().kind, states().bank, states().loose}, {});
        const Eigen::Vector2d at = drawn_vector(random, 2, 1.2, 1.8);
        pour(window, at, volume, random.uniform(0.5, 0.9));
        apply(window.patch(), terrain);
        EXPECT_NEAR(terrain.loose.sum() * 0.01, volume, 1e-12);
      },
      2000);
}

TEST(SimulationProperties, ABucketCoversItsWidthOfAnyRows) {
  for_cases([](Random& random) {
    const double cell = random.uniform(0.02, 0.3);
    HeightMap map = flat_ground({0.0, -1.5, 2.0 * cell, 1.5}, cell);
    map.origin.y() = random.uniform(-1.5 - 0.4 * cell, -1.5);
    const double width = random.uniform(0.3, 1.4);
    const Swath swath(map, width);
    double sum = 0.0, moment = 0.0;
    for (Eigen::Index i = 0; i < swath.rows(); ++i) {
      EXPECT_TRUE(swath.cover(i) >= 0.0 && swath.cover(i) <= 1.0 + 1e-12);
      sum += swath.cover(i);
      moment += swath.cover(i) * map.y(swath.first_row() + i);
    }
    EXPECT_NEAR(sum * cell, width, 1e-9);
    EXPECT_LE(std::abs(moment / sum), 0.5 * cell);
  });
}

/// Steeper faces and heaps hold more, and no bucket holds more than the machine file says it can.
TEST(SimulationProperties, BucketsHoldMoreOfSteeperSoil) {
  for_cases([](Random& random) {
    const double phi3 = random.uniform(-3.2, 0.5);
    const double support = random.uniform(0.0, 0.8);
    const HoldingSlopes slopes = {random.uniform(0.3, 1.5), random.uniform(0.2, 0.9)};
    const double held = bucket_capacity(zx120(), phi3, support, slopes);
    EXPECT_GE(held, 0.0);
    EXPECT_GE(bucket_capacity(zx120(), phi3, support, {1.1 * slopes.face, slopes.heap}),
              held - 1e-12);
    EXPECT_GE(bucket_capacity(zx120(), phi3, support + 0.05, slopes), held - 1e-12);
  });
}

/// The side plates all under ground: area and centre of the profile by Gauss' formula.
TEST(SimulationProperties, BuriedBucketsHaveTheirWholeSides) {
  const std::vector<Eigen::Vector2d>& profile = zx120().bucket.profile;
  double area = 0.0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Eigen::Vector2d& a = profile[i];
    const Eigen::Vector2d& b = profile[(i + 1) % profile.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  for_cases([&](Random& random) {
    BucketSection bucket(zx120().bucket);
    bucket.turn_to(random.uniform(-3.2, 0.5));
    const Below ground = {random.uniform(5.0, 9.0), random.uniform(-0.5, 0.5)};
    EXPECT_NEAR(bucket.buried(ground).area, area, 1e-12);
    const double level = random.uniform(-1.0, 1.0);
    const double below = bucket.buried({level, ground.slope}).area;
    EXPECT_TRUE(below >= 0.0 && below <= area + 1e-12);
    EXPECT_GE(bucket.buried({level + 0.01, ground.slope}).area, below - 1e-12);
  });
}

TEST(SimulationProperties, HigherFacesStandLessSteep) {
  for_cases([](Random& random) {
    const SoilState soil = bank_state(loam(), random.uniform(0.0, 100.0));
    const double least = random.uniform(0.2, 0.6);
    const double height = random.uniform(0.01, 5.0);
    const double angle = stable_slope(soil, height, least);
    EXPECT_TRUE(angle >= least && angle <= 80.0 * pi / 180.0 + 1e-12);
    EXPECT_LE(stable_slope(soil, 1.1 * height, least), angle + 1e-12);
    if (angle <= least + 1e-9 || angle >= 79.9 * pi / 180.0) return;
    // Culmann 1875
    const double phi = soil.friction_angle;
    const double stands = 4.0 * soil.cohesion / soil.unit_weight * std::sin(angle) * std::cos(phi) /
                          (1.0 - std::cos(angle - phi));
    EXPECT_NEAR(stands / height, 1.0, 1e-6);
  });
}

/// Soil that a dig cuts is in the bucket, beside the cut or back in it; a dig of stronger soil
/// costs more.
TEST(SimulationProperties, DigsConserveSolidsAndEnergyOnlyGrows) {
  const Terrain ground = level_planning_ground(zx120(), 0.2);
  int dug = 0;
  for_cases(
      [&](Random& random) {
        DigParameters parameters;
        parameters.penetration_angle = random.uniform(0.4, 1.2);
        parameters.penetration_length = random.uniform(0.1, 0.6);
        parameters.drag_length = random.uniform(0.5, 2.0);
        DigPathOptions coarse;
        coarse.step = 0.1;
        const auto path = make_dig_path(
            zx120(), parameters, random.uniform(5.5, 6.5), [](double) { return 0.0; }, coarse);
        if (!std::holds_alternative<DigPath>(path)) return;
        ++dug;
        const HeightMapSimulator simulator(zx120(), loam(), random.uniform(0.0, 100.0));
        const DigResult dig = simulator.dig(ground, std::get<DigPath>(path));
        EXPECT_NEAR(dig.soil.solids_after / dig.soil.solids_before, 1.0, 1e-9);
        const double swell =
            (1.0 + simulator.loose().void_ratio) / (1.0 + simulator.bank().void_ratio);
        EXPECT_NEAR(dig.soil.bank_cut * swell,
                    dig.soil.payload + dig.soil.spilled + dig.soil.fallen_back, 1e-6);
        EXPECT_NEAR(dig.payload_mass, dig.payload_volume * simulator.loose().bulk_density, 1e-9);
        const EnergyLedger& energy = dig.energy;
        EXPECT_TRUE(0.0 < energy.edge && energy.edge <= energy.soil * (1.0 + 1e-9));
        EXPECT_NEAR(energy.soil + energy.payload + energy.links, energy.total,
                    1e-9 * energy.total + 1e-9);
        double phases = 0.0, joints = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_TRUE(energy.by_phase[i] >= 0.0 && energy.by_joint[i] >= 0.0);
          phases += energy.by_phase[i];
          joints += energy.by_joint[i];
        }
        EXPECT_NEAR(phases, energy.total, 1e-9 * energy.total + 1e-9);
        EXPECT_NEAR(joints, energy.total, 1e-9 * energy.total + 1e-9);
      },
      500);
  EXPECT_GT(dug, 100);
}

}  // namespace
}  // namespace excavplan::test
