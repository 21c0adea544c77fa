// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/trial_history.hpp>

#include <excavplan/trial/plain_planners.hpp>

#include "ground/window.hpp"
#include "support/errors.hpp"
#include "support/plain_site_folder.hpp"

namespace excavplan::test {
namespace {

TEST(TrialRecorder, ItsLastGroundIsThatOfTheTrial) {
  PlainSiteFolder folder;
  folder.site["design"]["length_m"] = 2.0;
  const HiddenSite site = folder.read(truth_cell);
  const auto planner = plain_planner(plain_policies()[0], site.known, site.first_scan, zx120());
  TrialRecorder recorder(site);
  TrialOptions options;
  double time = 0.0, energy = 0.0;
  std::size_t steps = 0;
  Eigen::ArrayXXd seen;
  options.each = [&](const TrialStep& at) {
    recorder.add(at);
    ++steps;
    time += at.done.time;
    energy += at.done.energy;
    seen = at.site->seen_at();
  };
  const JobTrial trial = run_trial(site, zx120(), *planner, options);
  const JobHistory& history = recorder.history();
  ASSERT_EQ(history.events.size(), steps);
  const JobHistory::Ground last = history.ground(steps);
  const HeightMap after = coarser(trial.after.surface(), 2);
  ASSERT_TRUE(same_grid(last.surface, after));
  EXPECT_LE((last.surface.z - after.z).abs().maxCoeff(), 0.0005 + 1e-12);
  EXPECT_TRUE((last.seen_at.isNaN() == middle_cells(seen, 2).isNaN()).all());
  EXPECT_EQ(history.events.back().left_volume, trial.score.left);
  EXPECT_EQ(history.design_volume, trial.score.design_cut);
  double told_time = 0.0, told_energy = 0.0;
  for (const JobEvent& event : history.events) {
    told_time += event.time;
    told_energy += event.energy.value_or(0.0);
  }
  EXPECT_DOUBLE_EQ(told_time, trial.time);
  EXPECT_DOUBLE_EQ(told_energy, trial.energy);
  EXPECT_NE(error_of([&] { recorder.add({}); }).find("has no ground"), std::string::npos);
}

}  // namespace
}  // namespace excavplan::test
