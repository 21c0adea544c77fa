// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/experiments/experiment.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include <excavplan/base/data_files.hpp>

#include "support/errors.hpp"

namespace excavplan {
namespace {

class ExperimentTest : public testing::Test {
 protected:
  ExperimentResult run(const ExperimentOptions& options, double density = 40.0) const {
    return run_experiment(machine_, soil_, law_, density, options);
  }
  ExperimentOptions looked_up() const {
    ExperimentOptions options;
    options.plan.library =
        std::make_shared<PathLibrary>(shipped_library(machine_, soil_, DigObjective::Goal::energy));
    return options;
  }

  const Machine machine_ = load_machine(shipped_or_file("machines", "zx120"));
  const SoilKind soil_ = load_soil(shipped_or_file("soils", "loam"));
  const DensityLaw law_ = load_density_law(shipped_or_file("laws", "zx120-loam"));
};

TEST_F(ExperimentTest, PlansForTheDensityThatTheFixedDigShows) {
  const ExperimentOptions options = looked_up();
  const ExperimentResult result = run(options);
  EXPECT_EQ(result.density_percent, 40.0);
  EXPECT_NEAR(result.estimate.percent, 40.0, 0.5);
  EXPECT_EQ(result.estimate.percent,
            relative_density(law_, {result.volumes.bulking_factor, 0.0}).percent);
  EXPECT_EQ(to_vector(result.fixed.parameters), to_vector(paper_fixed_path()));
  const PlannedDig plan = look_up(*options.plan.library, result.estimate.percent);
  EXPECT_EQ(to_vector(result.planned.parameters), to_vector(plan.parameters));
  EXPECT_EQ(result.planned.start_x, plan.start_x);
}

TEST_F(ExperimentTest, KeepsThePathsThatItDug) {
  const ExperimentResult result = run(looked_up());
  EXPECT_EQ(result.fixed_path.start_x, result.fixed.start_x);
  EXPECT_EQ(result.planned_path.start_x, result.planned.start_x);
  EXPECT_EQ(to_vector(result.planned_path.parameters), to_vector(result.planned.parameters));
}

TEST_F(ExperimentTest, PlansForWhatASurveySays) {
  ExperimentOptions options = looked_up();
  options.survey = [&](const DigScene& scene) {
    EXPECT_GT(scene.volumes.dumped, 0.0);
    RelativeDensity wrong;
    wrong.percent = 90.0;
    return wrong;
  };
  const ExperimentResult result = run(options);
  EXPECT_EQ(result.estimate.percent, 90.0);
  EXPECT_EQ(to_vector(result.planned.parameters),
            to_vector(look_up(*options.plan.library, 90.0).parameters));
}

TEST_F(ExperimentTest, DigsAnotherSoilThanItPlansFor) {
  ExperimentOptions options = looked_up();
  options.dug_soil = load_soil(shipped_or_file("soils", "sand"));
  const ExperimentResult sand = run(options);
  const ExperimentResult loam = run(looked_up());
  EXPECT_NE(sand.fixed.energy, loam.fixed.energy);
  EXPECT_LT(sand.estimate.percent, loam.estimate.percent);  // sand swells less
}

TEST_F(ExperimentTest, ASecondDigOnTheGroundThatTheFirstLeftFindsAPit) {
  ExperimentOptions options = looked_up();
  options.second = SecondGround::left;
  const ExperimentResult left = run(options);
  const ExperimentResult fresh = run(looked_up());
  EXPECT_EQ(left.fixed.energy, fresh.fixed.energy);
  EXPECT_NE(left.planned.energy, fresh.planned.energy);
}

TEST_F(ExperimentTest, DigsOnTheGroundGivenAndPlansOnThatSeen) {
  ExperimentOptions options = looked_up();
  Terrain slope = undisturbed(flat_ground(scene_extent(machine_, default_dump_point()), 0.05));
  for (Eigen::Index col = 0; col < slope.bank.z.cols(); ++col) {
    slope.bank.z.col(col) += 0.1 * std::max(0.0, slope.bank.x(col) - machine_.track_front);
  }
  options.ground = slope;
  int looks = 0;
  options.seen = [&](const Terrain& ground) {
    ++looks;
    EXPECT_EQ(ground.bank.z(3, 90), slope.bank.z(3, 90));
    return ground;
  };
  EXPECT_GT(run(options).fixed_path.ground_z, 0.1);
  EXPECT_EQ(looks, 1);
}

TEST_F(ExperimentTest, SplitsTheGainIntoPathAndStart) {
  const ExperimentResult result = run(looked_up());
  ASSERT_TRUE(result.fixed_moved);
  EXPECT_EQ(to_vector(result.fixed_moved->parameters), to_vector(paper_fixed_path()));
  EXPECT_NE(result.fixed_moved->start_x, result.fixed.start_x);
  EXPECT_EQ(result.start_rule.kind, StartRule::Kind::least_work);
  EXPECT_GT(result.gain_percent(), 0.0);
  EXPECT_NEAR(
      (1.0 + result.path_gain_percent() / 100.0) * (1.0 + result.start_gain_percent() / 100.0),
      1.0 + result.gain_percent() / 100.0, 1e-12);
}

TEST_F(ExperimentTest, DigsAndSearchesInTheSimulatorGiven) {
  ExperimentOptions options;
  options.plan.method = PlanMethod::search;
  options.plan.simulator = simulator_of_word("section");
  options.plan.search.stop.evaluations = 20;
  const ExperimentResult section = run(options);
  EXPECT_NE(section.volumes.bulking_factor, run(looked_up()).volumes.bulking_factor);
  const auto simulator = options.plan.simulator.make(machine_, soil_, 40.0);
  const auto again = evaluate_dig(machine_, *simulator, level_planning_ground(machine_),
                                  section.planned.parameters, StartRule(section.planned.start_x));
  EXPECT_EQ(std::get<PlannedDig>(again).payload_mass, section.planned.payload_mass);
}

TEST_F(ExperimentTest, RefusesAFixedPathThatCannotBeDug) {
  ExperimentOptions options = looked_up();
  options.fixed_path.penetration_length = 9.0;
  EXPECT_NE(test::error_of([&] { run(options); }).find("penetrate, after "), std::string::npos);
}

}  // namespace
}  // namespace excavplan
