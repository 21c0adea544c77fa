// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/experiments/field_experiment.hpp>

#include <algorithm>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>

#include "support/errors.hpp"

namespace excavplan {
namespace {

class FieldExperimentTest : public testing::Test {
 protected:
  FieldOptions options(int digs, unsigned threads = 0) const {
    FieldOptions options;
    options.experiment.plan.library =
        std::make_shared<PathLibrary>(shipped_library(machine_, loam_, DigObjective::Goal::energy));
    options.fuel = fuel_;
    options.digs = digs;
    options.threads = threads;
    return options;
  }
  FieldResult run(double density, const FieldOptions& options) const {
    return run_field_experiment(machine_, loam_, law_, {density}, options).front();
  }

  const Machine machine_ = load_machine(shipped_or_file("machines", "zx120"));
  const SoilKind loam_ = load_soil(shipped_or_file("soils", "loam"));
  const DensityLaw law_ = load_density_law(shipped_or_file("laws", "zx120-loam"));
  const FuelModel fuel_ = load_fuel_model(shipped_or_file("engines", "zx120"));
};

TEST_F(FieldExperimentTest, FuelIsIdlingAndWork) {
  PlannedDig dig;
  dig.duration = 5.0;
  dig.energy = 40e3;
  dig.payload_volume = 0.4;
  const FuelledDig fuelled_dig = fuelled(dig, fuel_);
  const double per_joule = (21.2 - 2.8) / 3.6 / (70900.0 * 0.5);  // [mL/J], the engine's file
  EXPECT_NEAR(fuelled_dig.idle_fuel, 2.8 / 3.6 * 5.0, 1e-9);
  EXPECT_NEAR(fuelled_dig.work_fuel, per_joule * 40e3, 1e-9);
  EXPECT_NEAR(fuelled_dig.efficiency(), 0.4 / fuelled_dig.fuel(), 1e-12);
}

/// Section 4: a reasonable density, and a similar volume for less fuel.
TEST_F(FieldExperimentTest, SoftSoilIsTrustedAndDugForLessFuel) {
  const FieldResult soft = run(10.0, options(3));
  EXPECT_EQ(soft.failed + soft.held_down, 0);
  EXPECT_GE(soft.trusted, 2);
  for (const FieldRun& run : soft.runs) {
    EXPECT_EQ(to_vector(run.fixed.dig.parameters), to_vector(paper_field_path()));
    EXPECT_NEAR(run.density_raw, 10.0, 8.0);
    EXPECT_LT(run.equal.fuel(), run.fixed.fuel());
  }
  EXPECT_GE(soft.equal_volume_ratio.mean, 0.99);
  EXPECT_LT(soft.equal_volume_ratio.mean, 1.1);
  EXPECT_GT(soft.equal_gain.mean, 10.0);
  EXPECT_LT(soft.equal_gain.mean, 60.0);
  EXPECT_GT(soft.energy_gain.mean, soft.equal_energy_gain.mean);
}

/// Section 4.2: above 100 %, as the soil lies in blocks with voids between them.
TEST_F(FieldExperimentTest, HardSoilInBlocksIsNotTrusted) {
  const FieldResult hard = run(80.0, options(2));
  EXPECT_EQ(hard.failed, 0);
  EXPECT_EQ(hard.trusted, 0);
  for (const FieldRun& run : hard.runs) {
    EXPECT_GT(run.density_raw, 100.0);
    EXPECT_TRUE(std::any_of(run.warnings.begin(), run.warnings.end(), [](const Warning& warning) {
      return warning.code == WarningCode::blocks;
    }));
  }
  EXPECT_EQ(hard.held_down, 2);
}

TEST_F(FieldExperimentTest, RepeatsItselfForAnyNumberOfThreadsAndNotForAnotherSeed) {
  FieldOptions settings = options(2, 1);
  const FieldResult one = run(10.0, settings);
  settings.threads = 2;
  EXPECT_EQ(run(10.0, settings).gain.mean, one.gain.mean);
  EXPECT_NE(one.runs[0].density_raw, one.runs[1].density_raw);
  settings.seed = 2;
  settings.digs = 1;
  EXPECT_NE(run(10.0, settings).runs[0].density_raw, one.runs[0].density_raw);
}

TEST_F(FieldExperimentTest, ARunThatCannotBeDugSaysWhy) {
  FieldOptions settings = options(1);
  settings.experiment.fixed_path.drag_length = 9.0;
  const FieldResult result = run(10.0, settings);
  EXPECT_EQ(result.failed, 1);
  EXPECT_NE(result.runs[0].failure, "");
  settings.digs = 0;
  EXPECT_EQ(test::error_of([&] { run(10.0, settings); }).rfind("field experiment: digs", 0), 0U);
}

}  // namespace
}  // namespace excavplan
