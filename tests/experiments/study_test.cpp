// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/experiments/study.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

class Study : public testing::Test {
 protected:
  StudyResult run(const StudySetting& setting, int runs, unsigned threads = 0) const {
    StudyOptions options;
    options.threads = threads;
    options.draws = 12;
    return run_study(machine_, {{"factor", "level", setting, runs}}, options).front();
  }
  static std::string numbers(const StudyResult& result) {
    std::string text;
    for (const StudyRun& run : result.runs) {
      for (const double value : {run.density_percent, run.estimate_percent, run.energy.gain,
                                 run.equal.gain, run.cycle.gain, run.cycle.payload}) {
        text += std::to_string(value) + " ";
      }
    }
    return text + std::to_string(result.energy.gain.interval[0]);
  }

  const Machine machine_ = load_machine(shipped_or_file("machines", "zx120"));
  const SoilKind loam_ = load_soil(shipped_or_file("soils", "loam"));
};

// ---- Statistics ---------------------------------------------------------------------------------

TEST_F(Study, BootstrapIntervalsHoldTheMeanAsOftenAsTheySay) {
  constexpr int samples = 300, size = 40;
  int held = 0;
  double width = 0.0;
  for (std::uint64_t i = 0; i < samples; ++i) {
    Random random(i);
    std::vector<double> values;
    for (int k = 0; k < size; ++k) values.push_back(10.0 + 2.0 * random.normal());
    const StudyMean mean = bootstrap_mean(values, 1);
    held += mean.interval[0] <= 10.0 && mean.interval[1] >= 10.0;
    width += (mean.interval[1] - mean.interval[0]) / samples;
  }
  EXPECT_GT(held, 0.90 * samples);
  EXPECT_LT(held, 0.985 * samples);
  EXPECT_NEAR(width, 2.0 * 1.96 * 2.0 / std::sqrt(size), 0.06);
}

TEST_F(Study, AMeanOfNothingIsNotANumber) {
  EXPECT_TRUE(std::isnan(bootstrap_mean({}, 1).mean));
  EXPECT_EQ(bootstrap_mean({3.0}, 1).interval[1], 3.0);
}

// ---- Conditions ---------------------------------------------------------------------------------

TEST_F(Study, ThePathSizedToTheBucketSweepsWhatTheBucketHolds) {
  const DigParameters path = path_sized_to_bucket(machine_, loam_);
  const double depth = path.penetration_length * std::sin(path.penetration_angle);
  double section = 0.0;  // by slices
  constexpr double slice = 1e-4;
  const double wedge = path.penetration_length * std::cos(path.penetration_angle);
  for (double x = 0.5 * slice; x < wedge + path.drag_length; x += slice) {
    section += slice * std::min(depth, x * std::tan(path.penetration_angle));
  }
  EXPECT_NEAR(section * machine_.bucket.width_outside * bulking_of_density(loam_, 50.0),
              heaped_capacity(machine_), 1e-3);
  EXPECT_EQ(path.penetration_angle, paper_fixed_path().penetration_angle);
}

TEST_F(Study, TheDefaultVariesOneFactorAtATimeWithEnoughRuns) {
  const std::vector<StudyCondition> all = default_study(machine_);
  std::set<std::string> factors, names;
  for (const StudyCondition& condition : all) {
    factors.insert(condition.factor);
    EXPECT_TRUE(names.insert(condition.factor + condition.level).second) << condition.level;
    EXPECT_GE(condition.runs, 30) << condition.level;
  }
  for (const char* factor : {"density", "slope", "rough ground", "soil", "sensor", "law", "plan",
                             "second dig", "digs in a row", "baseline", "engine that digs"}) {
    EXPECT_EQ(factors.count(factor), 1U) << factor;
  }
}

// ---- Runs ---------------------------------------------------------------------------------------

TEST_F(Study, ItIsTheSameForAnyThreadsAndRunsArePaired) {
  const StudyResult one = run({}, 2, 1);
  EXPECT_EQ(numbers(one), numbers(run({}, 2, 4)));
  StudySetting sand;
  sand.soil = "sand";
  const StudyResult other = run(sand, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(one.runs[i].density_percent, other.runs[i].density_percent);
    EXPECT_NE(one.runs[i].density_percent, one.runs[1 - i].density_percent);
  }
}

TEST_F(Study, TheOwnLawTellsTheDensityOfItsOwnSoil) {
  StudySetting own;
  own.law = StudyLaw::own_engine;
  own.drawn_soil = false;
  const double rms = run(own, 2).rms;
  EXPECT_LT(rms, 0.5);
  StudySetting other = own;
  other.law = StudyLaw::other_engine;
  EXPECT_GT(run(other, 2).rms, rms);
}

TEST_F(Study, GainsAtEqualPayloadLiftNoLess) {
  StudySetting medium;
  medium.density_percent = 40.0;
  const StudyResult result = run(medium, 2);
  for (const StudyRun& each : result.runs) {
    EXPECT_EQ(each.failure, "");
    EXPECT_GT(each.energy.gain, each.equal.gain);
    EXPECT_GT(each.equal.payload, 0.97);
    EXPECT_GT(each.cycle.payload, 0.97);
    EXPECT_GT(each.equal.gain, 0.0);
    EXPECT_GT(each.cycle.gain, 0.0);
  }
}

TEST_F(Study, AMachineThatIsHeldDownTellsTheGainInHardSoil) {
  StudySetting hard;
  hard.density_percent = 80.0;
  const StudyResult moved = run(hard, 1);
  EXPECT_EQ(moved.held_down, 1);
  EXPECT_TRUE(std::isnan(moved.energy.gain.mean));
  hard.held_down = true;
  const StudyResult held = run(hard, 1);
  EXPECT_EQ(held.runs[0].failure, "");
  EXPECT_EQ(held.held_down, 0);
  EXPECT_GT(held.energy.gain.mean, 0.0);
}

TEST_F(Study, APlanThatFailsKeepsTheEstimate) {
  StudySetting rising;  // in the second run the planned dig tips the machine
  rising.slope = 13.0 * pi / 180.0;
  rising.density_percent = 70.0;
  const StudyResult result = run(rising, 2);
  EXPECT_EQ(result.failed, 0);
  EXPECT_EQ(result.unplanned, 1);
  const StudyRun& second = result.runs[1];
  EXPECT_EQ(second.failure, "");
  EXPECT_NE(second.plan_failure.find("about its rear edge"), std::string::npos)
      << second.plan_failure;
  EXPECT_NEAR(second.estimate_percent, second.density_percent, 10.0);
  EXPECT_TRUE(std::isnan(second.energy.gain));
  EXPECT_EQ(result.energy.gain.values, 1);
}

TEST_F(Study, GainsAreComparedWithThoseOfTheSameRunsOfTheFirstCondition) {
  StudySetting soft, other;
  soft.density_percent = 20.0;
  other.law = StudyLaw::own_engine;
  StudyOptions options;
  options.draws = 12;
  const auto results = run_study(
      machine_,
      {{"reference", "", {}, 2, 2}, {"law", "own", other, 2, 2}, {"density", "20 %", soft, 1, 1}},
      options);
  EXPECT_EQ(results[0].energy.over_first.mean, 0.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    sum += results[1].runs[i].cycle.gain - results[0].runs[i].cycle.gain;
  }
  EXPECT_EQ(results[1].cycle.over_first.values, 2);
  EXPECT_DOUBLE_EQ(results[1].cycle.over_first.mean, 0.5 * sum);
  EXPECT_EQ(results[2].energy.over_first.values, 0);
  EXPECT_EQ(results[2].densities[0], 20.0);
}

TEST_F(Study, APlanThatIsNotAdaptedIsTheSameForEachDensity) {
  StudySetting soft;
  soft.plan = StudyPlan::not_adapted;
  soft.density_percent = 5.0;
  StudySetting adapted = soft;
  adapted.plan = StudyPlan::look_up;
  EXPECT_LT(run(soft, 1).energy.gain.mean, run(adapted, 1).energy.gain.mean);
}

TEST_F(Study, ARunThatFailsEndsNoOther) {
  StudySetting hard;
  hard.soil = "gravel";
  hard.density_percent = 95.0;
  const StudyResult result = run(hard, 2);
  EXPECT_EQ(result.failed, 2);
  EXPECT_NE(result.runs[0].failure, "");
  EXPECT_TRUE(std::isnan(result.energy.gain.mean));
}

TEST_F(Study, RunsThatAreNotComparedEstimateTheSame) {
  StudySetting setting;
  setting.density_percent = 40.0;
  setting.sensor = StudySensor::d435i;
  StudyOptions options;
  options.draws = 12;
  const StudyCondition both{"factor", "level", setting, 2, 2};
  StudyCondition one = both;
  one.compared = 1;
  const auto results = run_study(machine_, {both, one}, options);
  EXPECT_EQ(results[0].compared, 2);
  EXPECT_EQ(results[1].compared, 1);
  EXPECT_FALSE(results[1].runs[1].compared);
  EXPECT_EQ(results[0].rms, results[1].rms);
  EXPECT_EQ(results[0].runs[0].energy.gain, results[1].energy.gain.mean);
}

TEST_F(Study, ASurveyWithErrorsIsWorseThanOneWithout) {
  StudySetting none, poor;
  none.law = poor.law = StudyLaw::own_engine;
  none.drawn_soil = poor.drawn_soil = false;
  none.density_percent = poor.density_percent = 40.0;
  poor.sensor = StudySensor::poor;
  const StudyResult with = run(poor, 2);
  const StudyResult without = run(none, 2);
  EXPECT_EQ(with.failed, 0);
  EXPECT_GT(with.rms, without.rms);
  EXPECT_GT(with.runs[0].estimate_sd, without.runs[0].estimate_sd);
}

TEST_F(Study, DigsInARowGoOnWhereTheLastEnded) {
  StudySetting row;
  row.row = 3;
  row.density_percent = 40.0;
  const StudyResult result = run(row, 1);
  ASSERT_EQ(result.runs[0].failure, "");
  EXPECT_GT(result.runs[0].cycle.payload, 0.5);
  EXPECT_LT(result.runs[0].cycle.payload, 4.0);
}

TEST_F(Study, ItStopsWhenAskedTo) {
  StudyOptions options;
  options.draws = 0;
  options.progress = [](double, const std::string&) { return false; };
  EXPECT_TRUE(run_study(machine_, {{"factor", "level", {}, 30}}, options).empty());
}

TEST_F(Study, RefusesUnknownNames) {
  StudySetting setting;
  setting.soil = "peat";
  EXPECT_NE(test::error_of([&] { run(setting, 1); }).find("peat"), std::string::npos);
  setting = {};
  setting.digs = "vortex";
  EXPECT_NE(test::error_of([&] { run(setting, 1); }).find("vortex"), std::string::npos);
}

}  // namespace
}  // namespace excavplan
