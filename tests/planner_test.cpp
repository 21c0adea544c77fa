// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/planner.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <excavplan/data_files.hpp>
#include <excavplan/planning/calibration.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

namespace excavplan {
namespace {

class Planner : public testing::Test {
 protected:
  HeightMapSimulator simulator(double density) const { return {machine_, soil_, density}; }

  static DigSearchOptions small_search(unsigned threads = 0) {
    DigSearchOptions options;
    options.genetic.population = 20;
    options.genetic.generations = 6;
    options.threads = threads;
    return options;
  }

  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind soil_ = load_soil(find_data_file("soils/loam.json"));
  const Terrain level_ = level_planning_ground(machine_);
};

TEST_F(Planner, EvaluatesThePapersFixedPath) {
  const auto outcome = evaluate_dig(machine_, simulator(40.0), level_, paper_fixed_path());
  const PlannedDig& dig = std::get<PlannedDig>(outcome);
  EXPECT_NEAR(dig.payload_volume, 0.38, 0.03);
  EXPECT_NEAR(dig.efficiency(), dig.payload_mass / dig.energy, 1e-15);
  EXPECT_GT(dig.duration,
            3.0);  // a dig takes 4-8 s (Caterpillar Performance Handbook, cycle times)
  EXPECT_LT(dig.duration, 8.0);
}

TEST_F(Planner, PlannedPathBeatsThePapersFixedPath) {
  for (const double density : {10.0, 40.0, 80.0}) {
    const auto fixed = evaluate_dig(machine_, simulator(density), level_, paper_fixed_path());
    const auto found = search_dig(machine_, simulator(density), level_, small_search());
    ASSERT_TRUE(found);
    EXPECT_GT(found->dig.efficiency(), std::get<PlannedDig>(fixed).efficiency()) << density;
  }
}

TEST_F(Planner, SameSeedSameBytesForAnyNumberOfThreads) {
  const auto one = search_dig(machine_, simulator(60.0), level_, small_search(1));
  for (const unsigned threads : {2U, 8U}) {
    const auto many = search_dig(machine_, simulator(60.0), level_, small_search(threads));
    EXPECT_EQ(one->dig.parameters.penetration_angle, many->dig.parameters.penetration_angle);
    EXPECT_EQ(one->dig.parameters.penetration_length, many->dig.parameters.penetration_length);
    EXPECT_EQ(one->dig.parameters.drag_length, many->dig.parameters.drag_length);
    EXPECT_EQ(one->dig.energy, many->dig.energy);
    EXPECT_EQ(one->evaluations, many->evaluations);
  }
}

TEST_F(Planner, AKnownGoodPathIsNeverLost) {
  const auto good = search_dig(machine_, simulator(80.0), level_, small_search());
  DigSearchOptions options = small_search();
  options.seed = 99;
  options.genetic.generations = 1;
  options.polish_evaluations = 0;
  options.known_good = good->dig.parameters;
  const auto again = search_dig(machine_, simulator(80.0), level_, options);
  EXPECT_GE(again->dig.efficiency(), good->dig.efficiency());
}

TEST_F(Planner, PolishNeverMakesItWorse) {
  DigSearchOptions plain = small_search();
  plain.polish_evaluations = 0;
  const auto before = search_dig(machine_, simulator(50.0), level_, plain);
  const auto after = search_dig(machine_, simulator(50.0), level_, small_search());
  EXPECT_GE(after->dig.efficiency(), before->dig.efficiency());
  EXPECT_GT(after->evaluations, before->evaluations);
}

TEST_F(Planner, DigsOnASlopeAndInAPit) {
  Terrain slope = level_;
  for (Eigen::Index col = 0; col < slope.bank.z.cols(); ++col) {
    slope.bank.z.col(col) += 0.1 * (slope.bank.x(col) - 5.0);
  }
  EXPECT_TRUE(std::holds_alternative<PlannedDig>(
      evaluate_dig(machine_, simulator(40.0), slope, paper_fixed_path())));

  const auto path = make_dig_path(machine_, paper_fixed_path(), 6.0, [](double) { return 0.0; });
  const Terrain pit = simulator(40.0).dig(level_, std::get<DigPath>(path)).after(level_);
  EXPECT_TRUE(std::holds_alternative<PlannedDig>(
      evaluate_dig(machine_, simulator(40.0), pit, paper_fixed_path())));
}

TEST_F(Planner, UnknownGroundUnderTheBucketIsAReason) {
  Terrain holed = level_;
  const auto col = static_cast<Eigen::Index>((5.0 - holed.bank.origin.x()) / holed.bank.cell);
  holed.bank.z.block(holed.bank.z.rows() / 2, col, 3, 3) = std::nan("");
  const auto outcome = evaluate_dig(machine_, simulator(40.0), holed, paper_fixed_path(), 6.05);
  const DigFailure& failure = std::get<DigFailure>(outcome);
  EXPECT_EQ(std::get<Infeasible>(failure).reason, Infeasible::Reason::unknown_ground);
  EXPECT_EQ(describe(failure), "the path runs over ground that is unknown or off the map");
}

TEST_F(Planner, NoGroundAtAllIsNoPlan) {
  Terrain unknown = level_;
  unknown.bank.z.setConstant(std::nan(""));
  DigSearchOptions options = small_search();
  options.genetic.generations = 2;
  EXPECT_FALSE(search_dig(machine_, simulator(40.0), unknown, options));
}

TEST_F(Planner, AStallIsAReason) {
  Machine weak = machine_;
  for (JointLimits& limits : weak.limits) limits.torque = 15e3;
  const HeightMapSimulator hard(weak, soil_, 100.0);
  const auto outcome = evaluate_dig(weak, hard, level_, paper_fixed_path());
  const std::string text = describe(std::get<DigFailure>(outcome));
  EXPECT_NE(text.find("stalls in the phase"), std::string::npos) << text;
}

/// A user's own simulator: lifts what the three numbers say, at a price of its own.
class HandMade : public SoilSimulator {
 public:
  DigResult dig(const Terrain&, const DigPath& path, const DigOptions&) const override {
    DigResult result;
    result.payload_mass = 100.0;
    result.energy.total = 1000.0 + std::pow(path.parameters.drag_length - 1.0, 2) * 1e4;
    return result;
  }
};

TEST_F(Planner, PlansWithAnySimulator) {
  const auto found = search_dig(machine_, HandMade(), level_, small_search());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->dig.parameters.drag_length, 1.0, 0.05);
}

TEST(BoomPlaneProfile, IsTheSurfaceInTheBoomPlane) {
  HeightMap map = flat_ground({0, -1, 4, 1}, 0.1);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      map.z(row, col) = 0.3 * map.x(col) + 0.2 * map.y(row);
    }
  }
  const GroundProfile profile = boom_plane_profile(map);
  EXPECT_NEAR(profile(2.0), 0.6, 1e-12);
  EXPECT_TRUE(std::isnan(profile(9.0)));
}

// The paper's regression (section 3.1): d = 161.57 k - 152.87, R2 = 0.9811; curvature of the exact
// law alone gives 0.983 (docs/methods.md#density-law).
TEST(Calibration, SimulatorFreedOfFallbackGivesThePapersLine) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const DensityCalibration calibration = calibrate_density(machine, loam);
  EXPECT_EQ(calibration.samples.size(), 21U);
  EXPECT_NEAR(calibration.line.a, 161.57, 0.05 * 161.57);
  EXPECT_NEAR(calibration.line.b, -152.87, 0.05 * 152.87);
  EXPECT_GT(calibration.line.r2, 0.975);
  EXPECT_LT(calibration.line.r2, 0.990);
  EXPECT_GE(calibration.closed_form.r2, 0.999);
  EXPECT_GE(calibration.closed_form_as_measured->r2, 0.999);
  for (const auto& sample : calibration.samples) {
    EXPECT_NEAR(sample.bulking_factor, sample.bulking_factor_true, 1e-3);
    EXPECT_GE(sample.bulking_factor_measured, sample.bulking_factor_true - 1e-3);
  }
}

TEST(Calibration, TheShippedLawIsWhatTheSimulatorGives) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const DensityCalibration calibration = calibrate_density(machine, loam);
  const DensityLaw law = load_density_law(find_data_file("laws/zx120-loam.json"));
  for (const auto& sample : calibration.samples) {
    EXPECT_NEAR(
        density_of_bulking(law.form, sample.bulking_factor_measured),
        density_of_bulking(*calibration.closed_form_as_measured, sample.bulking_factor_measured),
        0.01);
  }
}

}  // namespace
}  // namespace excavplan
