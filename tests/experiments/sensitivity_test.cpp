// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/experiments/sensitivity.hpp>

#include <set>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/dig_ground.hpp>

namespace excavplan {
namespace {

class Sensitivity : public testing::Test {
 protected:
  DigModel reference() const {
    DigModel model;
    model.machine = machine_;
    model.soil = loam_;
    model.simulator = default_simulator();
    model.search.objective = DigObjective::Goal::energy;
    return model;
  }
  std::vector<AssumptionResult> run(const std::vector<Assumption>& assumptions,
                                    unsigned threads = 0) const {
    SensitivityOptions options;
    options.densities_percent = {40.0};
    options.digs = 60;
    options.threads = threads;
    return run_sensitivity(reference(), assumptions, options);
  }

  const Machine machine_ = load_machine(shipped_or_file("machines", "zx120"));
  const SoilKind loam_ = load_soil(shipped_or_file("soils", "loam"));
};

TEST_F(Sensitivity, AnAssumptionThatChangesNothingLosesNothing) {
  const auto rows = run({{"none", "", [](DigModel&) {}}});
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].factor, "reference");
  for (const AssumptionResult& row : rows) {
    EXPECT_GE(row.regret_percent, 0.0);
    EXPECT_LT(row.regret_percent, 1.0);
    EXPECT_NEAR(row.worth, DigObjective().worth(*row.really), 1e-9 * row.worth);
  }
}

TEST_F(Sensitivity, RegretIsWhatThePathLosesInTheReference) {
  const auto rows =
      run({{"drag", "none", [](DigModel& m) { m.search.bounds.upper.drag_length = 0.5; }},
           {"teeth", "none", [](DigModel& m) { m.machine.bucket.teeth.reset(); }}});
  for (std::size_t i : {1U, 2U}) {
    const Terrain level = level_planning_ground(machine_);
    const auto simulator = default_simulator().make(machine_, loam_, 40.0);
    const auto again = evaluate_dig(machine_, *simulator, level, rows[i].best->parameters,
                                    rows[i].really->start_x);
    const double there = std::get<PlannedDig>(again).efficiency();
    EXPECT_NEAR(rows[i].really->efficiency(), there, 1e-12);
    EXPECT_NEAR(rows[i].regret_percent, 100.0 * (1.0 - there / rows[0].really->efficiency()), 0.5);
  }
  EXPECT_GT(rows[1].regret_percent, 2.0);
  EXPECT_LE(rows[1].best->parameters.drag_length, 0.5);
  EXPECT_GT(rows[2].worth, 1.02 * rows[0].worth) << "teeth cost work";
}

/// A floor level with the cut is forbidden in the reference.
TEST_F(Sensitivity, APathThatBreaksARuleOfTheReferenceIsMovedOrRefused) {
  const auto rows =
      run({{"floor", "0 deg", [](DigModel& m) { m.search.rules.min_heel_clearance = 0.0; }}});
  EXPECT_GT(rows[1].worth, 1.005 * rows[0].worth);
  if (rows[1].really) {
    EXPECT_NE(rows[1].really->start_x, rows[1].best->start_x);
  } else {
    EXPECT_NE(rows[1].failure.find("heel"), std::string::npos) << rows[1].failure;
  }
}

TEST_F(Sensitivity, WhereNoDigCanBeDoneItSaysWhy) {
  const auto rows = run({{"drag", "8 m", [](DigModel& m) {
                            m.search.bounds.lower.drag_length = 8.0;
                            m.search.bounds.upper.drag_length = 9.0;
                          }}});
  EXPECT_FALSE(rows[1].best || rows[1].really);
  EXPECT_NE(rows[1].failure, "");
  EXPECT_TRUE(rows[0].best);
}

TEST_F(Sensitivity, EveryAssumptionOfOursChangesTheModel) {
  std::set<std::string> names;
  for (const Assumption& assumption : our_assumptions()) {
    EXPECT_TRUE(names.insert(assumption.factor + assumption.level).second) << assumption.factor;
    DigModel model = reference();
    assumption.change(model);
    const DigModel usual = reference();
    const auto numbers = [](const DigModel& m) {
      return fingerprint(m.machine) + fingerprint(m.soil) + m.simulator.word +
             std::to_string(m.search.rules.min_heel_clearance) +
             std::to_string(m.search.bounds.lower.drag_length) +
             std::to_string(static_cast<int>(m.search.start_rule.kind));
    };
    EXPECT_NE(numbers(model), numbers(usual)) << assumption.factor << ", " << assumption.level;
    EXPECT_NO_THROW(require_machine(model.machine)) << assumption.factor << assumption.level;
    EXPECT_NO_THROW(require_soil(model.soil)) << assumption.factor << assumption.level;
  }
}

TEST_F(Sensitivity, DoesNotDependOnTheThreads) {
  const std::vector<Assumption> assumptions = {
      {"teeth", "none", [](DigModel& m) { m.machine.bucket.teeth.reset(); }}};
  const auto one = run(assumptions, 1), two = run(assumptions, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(one[i].worth, two[i].worth);
    EXPECT_EQ(one[i].regret_percent, two[i].regret_percent);
  }
}

}  // namespace
}  // namespace excavplan
