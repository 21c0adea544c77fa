// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/section_simulator.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "simulation/section_bucket.hpp"
#include "simulation/section_resistance.hpp"
#include "simulation/soil_section.hpp"
#include "support/errors.hpp"
#include "support/machine_file.hpp"
#include "support/soil_simulator_contract.hpp"

namespace excavplan {
namespace {

SoilKind shipped_soil(const std::string& name) {
  return load_soil(find_data_file("soils/" + name + ".json"));
}

SimulatorCase section_of(const std::string& soil) {
  return {soil, [soil](const Machine& machine, double density) {
            return std::make_unique<SectionSimulator>(machine, shipped_soil(soil), density);
          }};
}

INSTANTIATE_TEST_SUITE_P(Section, SoilSimulatorContract,
                         testing::Values(section_of("loam"), section_of("sand")),
                         [](const auto& tested) { return tested.param.name; });

class Section : public testing::Test {
 protected:
  DigPath path_on(const Terrain& ground, const DigParameters& parameters = paper_fixed_path(),
                  double step = 0.025) const {
    DigPathOptions options;
    options.step = step;
    return std::get<DigPath>(make_dig_path_anywhere(machine_, parameters,
                                                    boom_plane_profile(ground.surface()), options));
  }

  /// The paper's path and nine drawn ones that the machine can drive.
  std::vector<DigPath> ten_paths(const Terrain& ground) const {
    std::vector<DigPath> paths = {path_on(ground)};
    Random random(5);
    while (paths.size() < 10) {
      DigParameters parameters;
      for (const DigParameterInfo& info : dig_parameter_table()) {
        parameters.*info.field = random.uniform(info.lower, info.upper);
      }
      auto path =
          make_dig_path_anywhere(machine_, parameters, boom_plane_profile(ground.surface()));
      if (std::holds_alternative<DigPath>(path)) paths.push_back(std::get<DigPath>(path));
    }
    return paths;
  }

  Terrain slope(double gradient) const {
    Terrain ground = level_planning_ground(machine_);
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      ground.bank.z.col(col) = gradient * (ground.bank.x(col) - 5.0);
    }
    return ground;
  }

  const Machine machine_ = test::zx120_held_down();
};

// ---- Oracles ------------------------------------------------------------------------------------

TEST_F(Section, CutsTheAreaUnderTheTipsLine) {
  // Trapezoids between the poses, off the grid and at any cell, against the level ground.
  for (const double cell : {0.1, 0.05, 0.033}) {
    const Terrain ground = level_planning_ground(machine_, cell);
    const DigPath path = path_on(ground);
    double area = 0.0;
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
      const BucketPose& p = path.poses[i - 1].bucket;
      const BucketPose& q = path.poses[i].bucket;
      if (path.poses[i].phase == DigPhase::lift || (p.z > 0.0 && q.z > 0.0)) continue;
      const double run = p.x - q.x;
      if (p.z <= 0.0 && q.z <= 0.0) {
        area -= 0.5 * (p.z + q.z) * run;
      } else {
        const double below = std::min(p.z, q.z);
        area += 0.5 * below * below / std::abs(p.z - q.z) * run;
      }
    }
    const SectionSimulator simulator(machine_, shipped_soil("loam"), 0.0);
    const DigResult result = simulator.dig(ground, path);
    const double volume = area * machine_.bucket.width_outside;
    EXPECT_NEAR(result.soil.bank_cut, volume, 1e-9 * volume);
    const double lowered = (ground.bank.z - result.after(ground).bank.z).sum() *
                           ground.bank.cell_size * ground.bank.cell_size;
    EXPECT_NEAR(lowered, volume, 1e-9 * volume);
  }
}

TEST_F(Section, BucketIsRatedAsTheStandardDoes) {
  const double level = -pi;  // the mouth is level within 2.5 deg
  EXPECT_NEAR(clipped_capacity(machine_, level, 0.0, {1.0, 1.0}), heaped_capacity(machine_),
              0.01 * heaped_capacity(machine_));
  EXPECT_DOUBLE_EQ(clipped_capacity(machine_, 0.0, 0.0, {0.7, 0.7}), 0.0);  // mouth down
}

TEST_F(Section, CapacityIsTheVolumeUnderTheSlopes) {
  // Counts small cubes instead of clipping.
  const HoldingSlopes slopes = {2.0, 0.7};
  const auto& profile = machine_.bucket.profile;
  for (const double phi3 : {-1.2, -1.7, -2.2, -2.7, -3.1}) {  // the mouth faces ahead, then up
    std::vector<Eigen::Vector2d> corners;
    for (const Eigen::Vector2d& corner : profile) {
      corners.push_back(Eigen::Rotation2Dd(phi3) * (corner - profile.front()));
    }
    const Eigen::Vector2d top = corners.back();
    const double half = 0.5 * machine_.bucket.width_inside;
    const double step = 0.01;
    const auto inside = [&](const Eigen::Vector2d& p) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2d a = corners[(i + 1) % corners.size()] - corners[i];
        const Eigen::Vector2d b = p - corners[i];
        if (a.x() * b.y() - a.y() * b.x() < 0.0) return false;
      }
      return true;
    };
    double volume = 0.0;
    for (double x = -1.3 + 0.5 * step; x < 1.3; x += step) {
      for (double z = -1.3 + 0.5 * step; z < 1.6; z += step) {
        if (z > slopes.face * x) continue;
        const double mouth = top.y() / top.x() * x;
        if (inside({x, z})) {
          volume += 2.0 * half * step * step;
        } else if (x > 0.0 && x < top.x() && z > mouth &&
                   z < top.y() + slopes.heap * (top.x() - x)) {
          volume += 2.0 * std::max(0.0, half - (z - mouth) / slopes.heap) * step * step;
        }
      }
    }
    EXPECT_NEAR(clipped_capacity(machine_, phi3, 0.0, slopes), volume, 0.01 * volume + 5e-4)
        << "phi3 " << phi3;
  }
}

TEST_F(Section, WindrowsStandAtTheAngleOfRepose) {
  // The paper's path with a longer drag overfills the bucket.
  DigParameters parameters = paper_fixed_path();
  parameters.drag_length = 2.0;
  const Terrain ground = level_planning_ground(machine_, 0.025);
  const SoilKind soil = shipped_soil("loam");
  const DigResult result =
      SectionSimulator(machine_, soil, 70.0).dig(ground, path_on(ground, parameters));
  ASSERT_FALSE(result.stall);
  ASSERT_GT(result.soil.spilled, 0.05);
  const Terrain dug = result.after(ground);
  const HeightMap after = dug.surface();
  const Eigen::Index middle = after.z.rows() / 2;
  double steepest = 0.0;
  for (Eigen::Index col = 0; col < after.z.cols(); ++col) {
    for (Eigen::Index row = 1; row < middle; ++row) {
      if (dug.bank.z(row, col) < 0.0) continue;  // the wall of the cut
      steepest =
          std::max(steepest, std::abs(after.z(row, col) - after.z(row - 1, col)) / after.cell_size);
    }
  }
  EXPECT_NEAR(std::atan(steepest), soil.angle_of_repose, 0.02);
}

TEST_F(Section, SandWallsBreakBackAndLoamWallsStand) {
  const Terrain ground = level_planning_ground(machine_);
  const auto widest = [&](const std::string& soil) {
    const DigResult result = SectionSimulator(machine_, shipped_soil(soil), 60.0)
                                 .dig(ground, path_on(ground, {0.86, 0.76, 1.46}));  // 0.6 m deep
    const Terrain after = result.after(ground);
    Eigen::Index rows = 0;
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      rows = std::max(rows, (after.bank.z.col(col) < -1e-6).count());
    }
    return static_cast<double>(rows) * ground.bank.cell_size;
  };
  EXPECT_NEAR(widest("loam"), machine_.bucket.width_outside, 1e-9);
  EXPECT_GT(widest("sand"), machine_.bucket.width_outside + 0.1);
}

TEST_F(Section, HardlyDependsOnCellAndStep) {
  // Both a path that fills the bucket and one that overfills it twice.
  for (const DigParameters& parameters : {paper_fixed_path(), DigParameters{0.86, 0.76, 1.46}}) {
    const SectionSimulator simulator(machine_, shipped_soil("loam"), 40.0);
    const Terrain ground = level_planning_ground(machine_);
    const DigResult coarse = simulator.dig(ground, path_on(ground, parameters));
    const Terrain fine_ground = level_planning_ground(machine_, 0.0125);
    const DigResult fine = simulator.dig(fine_ground, path_on(fine_ground, parameters));
    EXPECT_NEAR(coarse.payload_volume, fine.payload_volume, 0.005 * fine.payload_volume);
    EXPECT_NEAR(coarse.energy.total, fine.energy.total, 0.01 * fine.energy.total);
    const double all = fine.soil.spilled + fine.soil.fallen_back;
    EXPECT_NEAR(coarse.soil.fallen_back, fine.soil.fallen_back, 0.03 * all + 0.001);

    const DigResult small = simulator.dig(ground, path_on(ground, parameters, 0.0125));
    EXPECT_NEAR(small.payload_volume, coarse.payload_volume, 0.01 * coarse.payload_volume);
    EXPECT_NEAR(small.energy.total, coarse.energy.total, 0.01 * coarse.energy.total);
  }
}

TEST_F(Section, TeethPenetrateAsTheirConeIndexSays) {
  // With teeth and without, driven equally deep, friction is the same: what is left is the cone
  // index on teeth that grow over their length, or on the whole lip.
  const SoilKind soil = shipped_soil("loam");
  const SoilState state = bank_state(soil, 20.0);
  Machine plain = machine_;
  plain.bucket.teeth.reset();
  const Bucket& bucket = machine_.bucket;
  const Teeth& teeth = *bucket.teeth;
  const double tan_delta = std::tan(state.tool_friction_angle);
  const double flanks = (1.0 + tan_delta / std::tan(0.5 * teeth.angle)) /
                        (1.0 + tan_delta / std::tan(15.0 * pi / 180.0));
  DigOptions options;
  options.history = true;
  for (const double gradient : {-0.2, 0.0, 0.2}) {
    const Terrain ground = slope(gradient);
    const DigPath path = path_on(ground);
    const DigResult with = SectionSimulator(machine_, soil, 20.0).dig(ground, path, options);
    const DigResult without = SectionSimulator(plain, soil, 20.0).dig(ground, path, options);
    const auto place = [&](std::size_t i) {
      return Eigen::Vector2d(path.poses[i].bucket.x, path.poses[i].bucket.z);
    };
    for (std::size_t i = 0; with.history[i].phase == DigPhase::penetrate; ++i) {
      const Eigen::Vector2d tip = 0.5 * (place(i) + place(i + 1));
      const double depth = gradient * (tip.x() - 5.0) - tip.y();
      const double driven = (tip - place(0)).norm();
      // No higher than the tip is deep.
      const double lip = std::min(depth, bucket.edge_thickness) * bucket.width_outside;
      const double area = teeth.count * teeth.width * std::min(depth, teeth.thickness) * flanks *
                          std::min(1.0, driven / teeth.length);
      const double expected = cone_index(soil, state, depth) * (area - lip);
      const Eigen::Vector2d more = with.history[i].soil - without.history[i].soil;
      const double sign = more.x() > 0.0 ? 1.0 : -1.0;
      EXPECT_NEAR(sign * more.norm(), expected, 1e-3 * std::abs(expected))
          << "gradient " << gradient << ", driven " << driven;
    }
  }
}

TEST_F(Section, BluntLipsMeetThePassivePressureOnAFlatEdge) {
  // Two lips dragged level through the same ground differ by the limit pressure on a flat front in
  // soil with friction (Sokolovski 1960): as deep as it is thick, under the soil above it.
  const SoilKind soil = shipped_soil("clay");
  const SoilState state = bank_state(soil, 40.0);
  const double phi = state.friction_angle;
  const double delta = state.tool_friction_angle;
  const double root = std::sqrt(std::pow(std::sin(phi), 2) - std::pow(std::sin(delta), 2));
  const double ratio =
      std::cos(delta) * (std::cos(delta) + root) / (1.0 - std::sin(phi)) *
      std::exp((delta + std::asin(std::sin(delta) / std::sin(phi))) * std::tan(phi));
  constexpr double depth = 0.15;
  const auto on_lip = [&](double thickness) {
    const double active = std::pow(std::tan(0.25 * pi - 0.5 * phi), 2);
    const double pressure =
        state.cohesion / std::tan(phi) + state.unit_weight * (0.5 * thickness + active * depth);
    return ratio * pressure * thickness * machine_.bucket.width_outside;
  };
  const auto drag = [&](double thickness) {
    Machine machine = machine_;
    machine.bucket.edge_thickness = thickness;
    for (JointLimits& limits : machine.limits) limits.torque = 1e9;
    DigPath path;
    for (int i = 0; i <= 2; ++i) {
      DigPose pose;
      pose.phase = DigPhase::drag;
      pose.bucket = {6.2 - 0.025 * i, -depth, 0.05};
      pose.joints = std::get<JointAngles>(inverse_kinematics(machine, pose.bucket));
      path.poses.push_back(pose);
    }
    DigOptions options;
    options.history = true;
    const Terrain ground = level_planning_ground(machine_);
    return SectionSimulator(machine, soil, 40.0).dig(ground, path, options).history[0].soil.x();
  };
  EXPECT_NEAR(drag(0.05) - drag(0.02), on_lip(0.05) - on_lip(0.02), 0.01 * on_lip(0.05));
}

TEST_F(Section, HeelStandsOnTheGroundLikeAFooting) {
  // The tip hovers above level ground, the heel is pressed into it: no other force is there.
  Machine machine = machine_;
  for (JointLimits& limits : machine.limits) limits.torque = 1e9;
  DigPath path;
  for (int i = 0; i < 6; ++i) {
    DigPose pose;
    pose.bucket = {5.5 - 0.02 * i, 0.01, -0.1};
    pose.joints = std::get<JointAngles>(inverse_kinematics(machine_, pose.bucket));
    path.poses.push_back(pose);
  }
  const SoilKind soil = shipped_soil("loam");
  const SoilState state = bank_state(soil, 40.0);
  DigOptions options;
  options.history = true;
  const Terrain ground = level_planning_ground(machine_);
  const DigResult result = SectionSimulator(machine, soil, 40.0).dig(ground, path, options);
  ASSERT_EQ(result.history.size(), 5U);

  // Summed over small pieces of floor and back.
  const double phi = state.friction_angle;
  const double n_q = std::exp(pi * std::tan(phi)) * std::pow(std::tan(0.25 * pi + 0.5 * phi), 2);
  const auto& profile = machine_.bucket.profile;
  const double width = (profile[1] - profile[0]).norm();
  const Eigen::Rotation2Dd turn(-0.1 - pi + machine_.beta());
  Eigen::Vector2d force = Eigen::Vector2d::Zero();
  for (int side = 0; side < 2; ++side) {
    const auto corner = [&](int i) -> Eigen::Vector2d {
      return turn * (profile[static_cast<std::size_t>(i)] - profile[0]);
    };
    const Eigen::Vector2d along = corner(side + 1) - corner(side);
    for (int i = 0; i < 1000; ++i) {
      const double sunk = -(0.01 + corner(side).y() + (i + 0.5) / 1000.0 * along.y());
      if (sunk <= 0.0) continue;
      const double capacity =
          state.cohesion * (n_q - 1.0) / std::tan(phi) +
          state.unit_weight * (sunk * n_q + width * (n_q + 1.0) * std::tan(phi));
      const double pressed = std::min(1.0, sunk / (0.1 * width)) * capacity * along.norm() /
                             1000.0 * machine_.bucket.width_outside;
      const Eigen::Vector2d inward = Eigen::Vector2d(-along.y(), along.x()).normalized();
      force += pressed * (inward + Eigen::Vector2d(std::tan(state.tool_friction_angle), 0.0));
    }
  }
  EXPECT_GT(force.y(), 1000.0);
  for (const ForceSample& sample : result.history) {
    EXPECT_NEAR((sample.soil - force).norm(), 0.0, 0.01 * force.norm());
  }
}

TEST_F(Section, NothingPressesUnderTheHeelOfAPlannedDig) {
  // Driving in along a line, the force is along that line, whatever the floor rests on.
  const Terrain ground = level_planning_ground(machine_);
  const DigPath path = path_on(ground);
  DigOptions options;
  options.history = true;
  const DigResult result =
      SectionSimulator(machine_, shipped_soil("loam"), 40.0).dig(ground, path, options);
  const double angle = path.parameters.penetration_angle;
  for (const ForceSample& sample : result.history) {
    if (sample.phase != DigPhase::penetrate) break;
    const double across = sample.soil.x() * std::sin(angle) - sample.soil.y() * std::cos(angle);
    EXPECT_NEAR(across, 0.0, 1e-6 * sample.soil.norm());
  }
}

TEST_F(Section, PackedSoilIsAnEasierFaceThanAFlatFloor) {
  // A level drag with the floor at 3 deg: once the heel has passed, only what has packed into the
  // corner and what lies ahead change. A lip of 25 deg is steep enough to be easier than any packed
  // soil; then the pile ahead adds.
  const Terrain ground = level_planning_ground(machine_);
  const auto last_over_first = [&](double edge_angle) {
    Machine machine = machine_;
    machine.bucket.edge_angle = edge_angle;
    for (JointLimits& limits : machine.limits)
      limits.torque = 1e9;  // the heel starts in the ground
    DigPath path;
    for (int i = 0; i <= 60; ++i) {
      DigPose pose;
      pose.phase = DigPhase::drag;
      pose.bucket = {6.2 - 0.025 * i, -0.15, 0.05};
      pose.joints = std::get<JointAngles>(inverse_kinematics(machine, pose.bucket));
      path.poses.push_back(pose);
    }
    DigOptions options;
    options.history = true;
    const DigResult result =
        SectionSimulator(machine, shipped_soil("clay"), 20.0).dig(ground, path, options);
    return result.history.at(59).soil.x() / result.history.at(45).soil.x();
  };
  EXPECT_LT(last_over_first(0.1), 0.99);
  EXPECT_GT(last_over_first(machine_.bucket.edge_angle), 1.0);
}

TEST_F(Section, EqualVoidRatiosAreThatDensity) {
  const SoilKind soil = shipped_soil("loam");
  Terrain ground = level_planning_ground(machine_);
  const DigPath path = path_on(ground);
  const DigResult told = SectionSimulator(machine_, soil, 45.0).dig(ground, path);
  ground.bank_void_ratio = Eigen::ArrayXXd::Constant(ground.loose.rows(), ground.loose.cols(),
                                                     bank_state(soil, 45.0).void_ratio);
  const DigResult held = SectionSimulator(machine_, soil, 10.0).dig(ground, path);
  EXPECT_NEAR(held.payload_mass, told.payload_mass, 1e-5 * told.payload_mass);
  EXPECT_NEAR(held.energy.total, told.energy.total, 1e-3 * told.energy.total);
}

TEST_F(Section, SoilSwellsFromTheCellItComesFrom) {
  // Adjacent dense and loose rows, on rough ground: the bucket holds what the cells lost, each at
  // its own ratio.
  const SoilKind soil = shipped_soil("loam");
  Terrain ground = rough_ground(machine_, 8);
  ground.bank_void_ratio = ground.loose_void_ratio = ground.loose;
  for (Eigen::Index row = 0; row < ground.loose.rows(); ++row) {
    ground.bank_void_ratio.row(row) = row % 2 == 0 ? 0.5 : 1.2;
    ground.loose_void_ratio.row(row) = row % 3 == 0 ? 0.6 : 1.28;
  }
  const DigResult result =
      SectionSimulator(machine_, soil, 40.0).dig(ground, path_on(ground, {0.7, 0.25, 0.8}));
  const Terrain after = result.after(ground);
  const double loose = 1.0 + soil.void_ratio_loose;
  const double swollen = ((ground.bank.z - after.bank.z) / (1.0 + ground.bank_void_ratio) +
                          ground.loose / (1.0 + ground.loose_void_ratio) -
                          after.loose / (1.0 + after.loose_void_ratio))
                             .sum() *
                         loose * ground.bank.cell_size * ground.bank.cell_size;
  EXPECT_GT(result.payload_volume, 0.05);
  EXPECT_NEAR(result.payload_volume, swollen, 1e-9 * swollen);
}

// ---- The ground of the section ------------------------------------------------------------------

/// A bucket of 0.8 m on cells of 5 cm.
class SectionGround : public testing::Test {
 protected:
  SoilSection section_on(const Terrain& ground) const {
    return {ground, {kind_, bank_, loose_}, width_, {1.0, 3.0, 0.0}};
  }
  static Terrain after(const Terrain& before, SoilSection& section) {
    Terrain terrain = before;
    apply(section.ground().patch(), terrain);
    return terrain;
  }

  const double width_ = 0.8;
  const SoilKind kind_ = shipped_soil("loam");
  const SoilState bank_ = bank_state(kind_, 40.0);
  const SoilState loose_ = loose_state(kind_);
  const Terrain level_ = undisturbed(flat_ground({0.0, -2.0, 4.0, 2.0}, 0.05));
};

/// A lip that climbs by more than the ground shears soil off besides pushing it: less is pushed,
/// none where it rises upright (docs/methods.md#simulation).
TEST_F(SectionGround, TheWedgeThatIsPushedEndsAsTheLipRisesUpright) {
  const SectionModel model(test::zx120_held_down(), kind_, 40.0);
  const SoilSection section = section_on(level_);
  BucketSection bucket(model.machine.bucket);
  bucket.turn_to(0.5);
  const auto length = [&](double climb) {
    Cutting cut;
    cut.tip = {2.0, -0.2, 0.3};
    cut.motion = {-std::cos(climb), std::sin(climb)};
    cut.ground = section.ahead(2.0);
    cut.bank = section.bank_of(cut.ground.void_ratio);
    cut.loose = section.loose_of(cut.ground.loose_void_ratio);
    return section_resistance(model, section, cut, bucket, DigPhase::drag).wedge_length;
  };
  EXPECT_GT(length(0.0), 0.2);
  EXPECT_LT(length(89.0 * degree), 0.1 * length(0.0));
  EXPECT_NEAR(length(90.0 * degree), 0.0, 1e-12);
}

// docs/methods.md#simulation: a heap of mean height h > b s over the width b is a triangle. One of
// area A whose sides fall by s is sqrt(A s) high. Within 2 mm: sum over cells of 5 cm.
TEST_F(SectionGround, AHeapHigherThanItsWidthAllowsFallsFromACrest) {
  const double slope = std::tan(kind_.angle_of_repose);
  SoilSection section = section_on(level_);
  section.settle(2.0, {SoilSection::Side::both, 2.025, slope}, 1.2);
  const Eigen::Index col = section.column_at(2.025);
  const double area = width_ * section.column(col).settled;
  ASSERT_GT(area, 1.2 * width_ * width_ * slope);
  write_back(section, slope);
  const Terrain dug = after(level_, section);
  const double crest = std::sqrt(area * slope);
  for (Eigen::Index row = 0; row < dug.loose.rows(); ++row) {
    const double height = crest - slope * std::abs(level_.bank.y(row));
    EXPECT_NEAR(dug.loose(row, col), std::max(0.0, height), 2e-3) << level_.bank.y(row);
  }
}

TEST_F(SectionGround, RowsOfAnyHeightAreCutToOneLevel) {
  Random random(11);
  Terrain ground = level_;
  for (Eigen::Index i = 0; i < ground.bank.z.size(); ++i) {
    ground.bank.z.data()[i] = random.uniform(-0.01, 0.01);
  }
  SoilSection section = section_on(ground);
  section.cut({3.0, -0.004}, {1.0, -0.004});
  const Terrain dug = after(ground, section);
  const Swath& swath = section.swath();
  int untouched = 0;
  for (Eigen::Index col = section.column_at(1.01); col <= section.column_at(2.99); ++col) {
    const auto before = ground.bank.z.block(swath.first_row(), col, swath.rows(), 1);
    const auto bank = dug.bank.z.block(swath.first_row(), col, swath.rows(), 1);
    const double level = bank.maxCoeff();
    EXPECT_LT((bank - before.min(level)).abs().maxCoeff(), 1e-12) << ground.bank.x(col);
    EXPECT_NEAR(bank.mean(), std::min(before.mean(), -0.004), 1e-12) << ground.bank.x(col);
    untouched += static_cast<int>((bank == before).count());
  }
  EXPECT_GT(untouched, 0);
}

// ---- Against the built-in simulator -------------------------------------------------------------

struct CrossCheck {
  std::string name;
  std::string soil;
  double gradient = 0.0;
  double payload = 0.1;  ///< how far the two may part
  double work = 0.06;    ///< the same, of energy and work on the soil
  bool teeth = true;
};

class SectionAgainstMap : public Section, public testing::WithParamInterface<CrossCheck> {
 protected:
  /// Work of the tip against the soil's force [J]: unlike the ledger's share of the soil, it does
  /// not hang on which joint just lifts and which lowers.
  static double work_on_soil(const DigResult& result, const DigPath& path) {
    double work = 0.0;
    for (std::size_t i = 0; i < result.history.size(); ++i) {
      const BucketPose& p = path.poses[i].bucket;
      const BucketPose& q = path.poses[i + 1].bucket;
      work -= result.history[i].soil.dot(Eigen::Vector2d(q.x - p.x, q.z - p.z));
    }
    return work;
  }
};

TEST_P(SectionAgainstMap, AgreesOverDensitiesAndPaths) {
  // What they share is the physics of docs/methods.md; cutting, bucket, piles and forces are each
  // written twice. They part where soil leaves the pile ahead: around its corners, and over its
  // sides, it has a closed form in the section and cells on the map.
  const Terrain ground = slope(GetParam().gradient);
  const SoilKind soil = shipped_soil(GetParam().soil);
  Machine machine = machine_;
  if (!GetParam().teeth) machine.bucket.teeth.reset();
  const std::vector<DigPath> paths = ten_paths(ground);
  int parted = 0;
  int compared = 0;
  for (double density = 0.0; density <= 100.0; density += 20.0) {
    const SectionSimulator section(machine, soil, density);
    const HeightMapSimulator map(machine, soil, density);
    for (const DigPath& path : paths) {
      SCOPED_TRACE(std::to_string(density) + " %, path " +
                   std::to_string(path.parameters.penetration_angle) + ", " +
                   std::to_string(path.parameters.penetration_length) + ", " +
                   std::to_string(path.parameters.drag_length));
      DigOptions options;
      options.history = true;
      const DigResult a = section.dig(ground, path, options);
      const DigResult b = map.dig(ground, path, options);
      if (a.stall.has_value() != b.stall.has_value()) ++parted;
      if (a.stall || b.stall) continue;
      EXPECT_NEAR(a.soil.bank_cut, b.soil.bank_cut, 1e-6 * b.soil.bank_cut);
      EXPECT_NEAR(a.payload_mass, b.payload_mass, GetParam().payload * b.payload_mass);
      EXPECT_NEAR(a.energy.total, b.energy.total, GetParam().work * b.energy.total);
      const double work = work_on_soil(b, path);
      EXPECT_NEAR(work_on_soil(a, path), work, GetParam().work * work);
      ++compared;
    }
  }
  EXPECT_GE(compared, 12);
  EXPECT_LE(parted, 6);  // of 60: a joint at its limit in one, just below in the other
}

INSTANTIATE_TEST_SUITE_P(Grounds, SectionAgainstMap,
                         testing::Values(CrossCheck{"loam_level", "loam"},
                                         CrossCheck{"loam_plain_lip", "loam", 0.0, 0.1, 0.06,
                                                    false},
                                         CrossCheck{"loam_rising", "loam", -0.1, 0.1, 0.1},
                                         CrossCheck{"loam_falling", "loam", 0.1},
                                         CrossCheck{"sand_level", "sand", 0.0, 0.1, 0.08},
                                         CrossCheck{"clay_level", "clay"}),
                         [](const auto& tested) { return tested.param.name; });

// ---- Hostile ------------------------------------------------------------------------------------

TEST_F(Section, SoilKeepsToKnownCellsBesideTheCut) {
  Terrain ground = level_planning_ground(machine_);
  const Eigen::Index beside = ground.bank.z.rows() / 2 + 9;
  const DigPath path = path_on(ground, {0.86, 0.76, 1.46});
  ground.bank.z.row(beside).setConstant(std::nan(""));
  const DigResult result = SectionSimulator(machine_, shipped_soil("sand"), 40.0).dig(ground, path);
  const Terrain after = result.after(ground);
  EXPECT_EQ(after.bank.z.isNaN().count(), ground.bank.z.cols());
  EXPECT_EQ(after.loose.row(beside).sum(), 0.0);
  EXPECT_NEAR(result.soil.solids_after, result.soil.solids_before,
              1e-9 * result.soil.solids_before);
}

TEST_F(Section, SaysWhatIsWrongWithAPath) {
  const SectionSimulator simulator(machine_, shipped_soil("loam"), 40.0);
  const Terrain ground = level_planning_ground(machine_);
  const auto message = [&](const Terrain& terrain, const DigPath& path) {
    return test::error_of([&] { simulator.dig(terrain, path); });
  };
  const DigPath path = path_on(ground);
  EXPECT_EQ(message(ground, DigPath{}), "dig: a path has at least 2 poses, this one has 0");
  EXPECT_EQ(message(Terrain{}, path), "dig: the map is empty");
  DigPath far = path;
  far.poses.back().phase = far.poses[1].phase = DigPhase::penetrate;
  far.poses[1].bucket.x = 1e300;
  EXPECT_NE(message(ground, far).find("must lie on the map"), std::string::npos);
  far.poses[1].bucket.x = std::nan("");
  EXPECT_EQ(message(ground, far), "dig: x of a pose [m] is nan, must be finite");
  Terrain narrow = undisturbed(flat_ground({1.0, -0.2, 9.0, 0.2}, 0.05));
  EXPECT_EQ(message(narrow, path), "dig: the bucket, y = -0.35 .. 0.35 m, must lie on the map");
}

TEST_F(Section, RepeatedDigsAtOneSpotLoseNothing) {
  Terrain ground = rough_ground(machine_, 3);
  const SectionSimulator simulator(machine_, shipped_soil("loam"), 60.0);
  Random random(17);
  for (int i = 0; i < 300; ++i) {
    DigParameters parameters;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      parameters.*info.field = random.uniform(info.lower, info.upper);
    }
    const auto path =
        make_dig_path_anywhere(machine_, parameters, boom_plane_profile(ground.surface()));
    if (!std::holds_alternative<DigPath>(path)) continue;
    DigOptions options;
    options.dump_at = Eigen::Vector2d(random.uniform(3.0, 8.0), 0.0);
    const DigResult result = simulator.dig(ground, std::get<DigPath>(path), options);
    ASSERT_NEAR(result.soil.solids_after, result.soil.solids_before,
                1e-9 * result.soil.solids_before);
    apply(result.patch, ground);
    ASSERT_TRUE((ground.loose >= 0.0).all());
  }
}

}  // namespace
}  // namespace excavplan
