// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/job_trial.hpp>

#include <sstream>

#include <nlohmann/json.hpp>

#include <excavplan/trial/job_reference.hpp>
#include <excavplan/trial/plain_planners.hpp>

#include "support/errors.hpp"
#include "support/plain_site_folder.hpp"
#include "trial/trial_json.hpp"

namespace excavplan::test {
namespace {

struct SiteWithErrors : PlainSiteFolder {
  SiteWithErrors() {
    truth["tracking_height_sd_m"] = 0.012;
    truth["tracking_side_sd_m"] = 0.02;
    truth["payload_noise"] = 0.01;
    site["sensor"]["noise_sd_at_1m_m"] = 0.01;
  }
};

std::unique_ptr<JobPlanner> planner(const HiddenSite& site, std::size_t policy = 0) {
  return plain_planner(plain_policies()[policy], site.known, site.first_scan, zx120());
}

TEST(JobTrial, ThePlainPolicyDigsMostOfATrench) {
  const HiddenSite site = SiteWithErrors().read();
  const auto layers = planner(site);
  const JobTrial trial = run_trial(site, zx120(), *layers);
  EXPECT_TRUE(trial.stopped);
  EXPECT_EQ(trial.reason, "finished");
  EXPECT_LT(trial.score.left_percent(), 40.0);
  EXPECT_LT(trial.score.overdig_percent(), 15.0);
  EXPECT_GT(trial.digs, 5);
  EXPECT_GT(trial.finishing, 0);
  EXPECT_GE(trial.scans, 2);
  EXPECT_NEAR(trial.solids.cut, trial.solids.lying + trial.solids.hauled, 1e-9 * trial.solids.cut);
  EXPECT_GT(trial.energy_per_design(), 300e3);
}

TEST(JobTrial, SameSeedSameGround) {
  const HiddenSite site = SiteWithErrors().read();
  const auto run = [&](std::uint64_t seed) {
    TrialOptions options;
    options.truth.seed = seed;
    const auto layers = planner(site);
    return run_trial(site, zx120(), *layers, options);
  };
  const JobTrial first = run(1), second = run(1), other = run(2);
  EXPECT_TRUE((first.after.surface().z == second.after.surface().z).all());
  EXPECT_EQ(first.energy, second.energy);
  EXPECT_FALSE((first.after.surface().z == other.after.surface().z).all());
}

/// Two sites that differ in what is hidden alone look the same to a planner until it has dug.
TEST(JobTrial, APlannerCannotReachWhatIsHidden) {
  SiteWithErrors folder;
  const HiddenSite one = folder.read();
  folder.truth["strength_factor"] = 1.9;
  folder.truth["tracking_height_bias_m"] = 0.01;
  folder.density = [](double, double) { return 85.0; };
  const HiddenSite two = folder.read();
  for (std::size_t policy = 0; policy < plain_policies().size(); ++policy) {
    const JobStep a = planner(one, policy)->next(), b = planner(two, policy)->next();
    EXPECT_EQ(a.what, b.what);
    EXPECT_EQ(a.path.poses.size(), b.path.poses.size());
    for (std::size_t i = 0; i < a.path.poses.size(); ++i) {
      ASSERT_EQ(a.path.poses[i].joints, b.path.poses[i].joints);
    }
    EXPECT_EQ(a.dump, b.dump);
  }
}

TEST(JobTrial, APlannerThatNeverStopsIsStopped) {
  class Waits : public JobPlanner {
   public:
    JobStep next() override {
      JobStep step;
      step.what = what;
      return step;
    }
    void done(long long, const StepReport&) override {}
    JobAction what = JobAction::wait;
  };
  const HiddenSite site = PlainSiteFolder().read();
  Waits planner;
  EXPECT_EQ(run_trial(site, zx120(), planner).reason, "waits");
  planner.what = JobAction::scan;
  TrialOptions options;
  options.most_steps = 3;
  const JobTrial trial = run_trial(site, zx120(), planner, options);
  EXPECT_EQ(trial.reason, "too many steps");
  EXPECT_FALSE(trial.stopped);
  EXPECT_EQ(trial.scans, 3);
}

TEST(JobTrial, StepsThatAreNotTrustedAreDoneCountedAndLogged) {
  class Doubts : public JobPlanner {
   public:
    JobStep next() override {
      JobStep step;
      step.what = told++ < 3 ? JobAction::wait : JobAction::stop;
      step.trustworthy = told == 2;
      return step;
    }
    void done(long long, const StepReport&) override {}
    int told = 0;
  };
  Doubts planner;
  TrialOptions options;
  std::string log;
  options.each = [&](const TrialStep& step) { log += log_lines(step); };
  const JobTrial trial = run_trial(PlainSiteFolder().read(), zx120(), planner, options);
  EXPECT_EQ(trial.untrusted, 2);
  EXPECT_EQ(trial_json(trial)["untrusted_steps"], 2);
  EXPECT_EQ(nlohmann::json::parse(log_end(trial))["untrusted_steps"], 2);
  std::istringstream lines(log);
  for (const bool is_trusted : {false, true, false}) {
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(nlohmann::json::parse(line)["trustworthy"], is_trusted) << line;
  }
}

TEST(JobTrial, ADesignWithoutWordsHasNoPlainPolicy) {
  HiddenSite site = PlainSiteFolder().read();
  site.known.job.words.reset();
  EXPECT_NE(error_of([&] { planner(site); }).find("in words"), std::string::npos);
}

TEST(JobReference, DenserGroundCostsMoreAndTheBoundIsBelow) {
  PlainSiteFolder folder;
  FullDigOptions options;
  options.evaluations = 80;
  double last = 0.0;
  for (const double density : {20.0, 60.0}) {
    folder.density = [=](double, double) { return density; };
    const JobReference reference = job_reference(folder.read(), zx120(), options);
    EXPECT_NEAR(reference.density_percent, density, 1e-9);
    EXPECT_NEAR(reference.design_cut, 1.6, 1e-9);
    EXPECT_GT(reference.energy, last);
    EXPECT_LT(reference.bound, reference.energy);
    EXPECT_GE(reference.digs, 0.9 * reference.least_loads);
    last = reference.energy;
  }
}

TEST(JobReference, TheBoundLiftsTheWeightOfTheSoil) {
  HiddenSite site = PlainSiteFolder().read();
  FullDigOptions options;
  options.evaluations = 60;
  const double light = job_reference(site, zx120(), options).bound;
  site.soil.specific_gravity *= 1.5;
  site.soil.water_content /= 1.5;  // in the same pores
  const double heavy = job_reference(site, zx120(), options).bound;
  EXPECT_GT(heavy - light, 4000.0) << "750 kg/m^3 more, over 0.7 m";
}

TEST(JobReference, ThreadsDoNotMatter) {
  const HiddenSite site = PlainSiteFolder().read();
  FullDigOptions one, three;
  one.evaluations = three.evaluations = 60;
  one.threads = 1;
  three.threads = 3;
  EXPECT_EQ(job_reference(site, zx120(), one).energy, job_reference(site, zx120(), three).energy);
}

}  // namespace
}  // namespace excavplan::test
