// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/watch/job_view.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "job/trench_job.hpp"
#include "support/errors.hpp"
#include "watch/settled.hpp"

namespace excavplan::test {
namespace {

void expect_same(const JobHistory& a, const JobHistory& b) {
  ASSERT_EQ(a.events.size(), b.events.size());
  EXPECT_EQ(a.begin, b.begin);
  EXPECT_EQ(a.design_volume, b.design_volume);
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].step, b.events[i].step);
    EXPECT_EQ(a.events[i].what, b.events[i].what);
    EXPECT_EQ(a.events[i].left_volume, b.events[i].left_volume);
  }
  const auto same = [](const Eigen::ArrayXXd& one, const Eigen::ArrayXXd& other) {
    return ((one == other) || (one.isNaN() && other.isNaN())).all();
  };
  const JobHistory::Ground now = a.ground(a.events.size()), other = b.ground(b.events.size());
  EXPECT_TRUE(same(now.surface.z, other.surface.z));
  EXPECT_TRUE(same(now.seen_at, other.seen_at));
  EXPECT_TRUE(same(a.target.z, b.target.z));
}

void expect_same(const JobProgress& a, const JobProgress& b) {
  EXPECT_EQ(a.left_volume, b.left_volume);
  for (const auto part : {&JobProgress::rms, &JobProgress::p95})
    EXPECT_TRUE(a.*part == b.*part || (std::isnan(a.*part) && std::isnan(b.*part)));
  EXPECT_EQ(a.seen, b.seen);
  EXPECT_EQ(a.digs, b.digs);
  EXPECT_EQ(a.moves, b.moves);
  EXPECT_EQ(a.scans, b.scans);
  EXPECT_EQ(a.design_volume, b.design_volume);
}

TEST(JobView, FollowsAJobThatAnotherHolds) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  JobView view(of.path(), of.settings);
  EXPECT_FALSE(view.refresh());
  EXPECT_FALSE(view.present());
  expect_same(view.history(), job.history());
  const double sd = view.belief().payload.sd;
  for (int i = 0; i < 8; ++i) {
    const JobStep step = job.next();
    EXPECT_TRUE(view.refresh()) << "a step is planned";
    ASSERT_TRUE(view.present());
    EXPECT_EQ(view.present()->id, step.id);
    EXPECT_EQ(view.present()->path.start_x, step.path.start_x);
    of.make_step(job);
    EXPECT_TRUE(view.refresh()) << "and done";
    EXPECT_FALSE(view.present());
    EXPECT_FALSE(view.refresh());
    expect_same(view.history(), job.history());
    expect_same(view.progress(), job.progress());
  }
  EXPECT_GE(view.progress().scans, 1);
  EXPECT_LT(view.belief().payload.sd, sd) << "payloads were learnt from";
  EXPECT_EQ(view.rewritten(), 0);
  expect_same(JobView(of.path(), of.settings).history(), job.history());
}

TEST(JobView, ReadsAgainWhatChangedWhileItRead) {
  const Error two_states(ErrorKind::bad_file, "job: of two states");
  int state = 1, readings = 0;
  read_settled([&] { return state; },
               [&](int) {
                 if (++readings == 3) return;
                 ++state;
                 throw two_states;
               });
  EXPECT_EQ(readings, 3);
  const auto damaged = [&](int) {
    ++readings;
    throw two_states;
  };
  EXPECT_THROW(read_settled([] { return 1; }, damaged), Error);
  EXPECT_EQ(readings, 4) << "of files that stay as they are once";
  EXPECT_THROW(read_settled([&] { return ++state; }, damaged), Error);
}

TEST(JobView, SeesThatStepsAreTakenBack) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  for (int i = 0; i < 3; ++i) of.make_step(job);
  JobView view(of.path(), of.settings);
  job.undo();
  EXPECT_TRUE(view.refresh());
  EXPECT_EQ(view.rewritten(), 1);
  expect_same(view.history(), job.history());
  of.make_step(job);
  EXPECT_TRUE(view.refresh());
  EXPECT_EQ(view.rewritten(), 1);
  job.undo();
  job.done(job.next().id, {});  // in the place of the one before, between two looks
  EXPECT_TRUE(view.refresh());
  EXPECT_EQ(view.rewritten(), 2);
  expect_same(view.history(), job.history());
}

TEST(JobView, ALineThatIsNotWholeIsNotThereYet) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  of.make_step(job);
  JobView view(of.path(), of.settings);
  const std::string log = of.path() + "/job-log.jsonl";
  std::ofstream(log, std::ios::app) << "{\"type\": \"mo";
  job.next();
  EXPECT_TRUE(view.refresh());
  EXPECT_EQ(view.history().events.size(), 1U);
  std::ofstream(log, std::ios::app) << "ve\"}\n";
  of.make_step(job);  // over it
  EXPECT_TRUE(view.refresh());
  expect_same(view.history(), job.history());
  std::filesystem::remove(log);
  job.next();
  EXPECT_TRUE(view.refresh());
  EXPECT_TRUE(view.history().events.empty());
}

TEST(JobView, SaysWhatIsNotThereOrDamaged) {
  const TemporaryFolder empty;
  const auto bad = ErrorKind::bad_file;
  const ShortTrench site;
  TrenchJob of{site};
  const std::string none = error_of([&] { JobView(empty.file("none"), of.settings); }, bad);
  EXPECT_TRUE(contains(none, "holds no job")) << none;
  SiteJob job = of.begin();
  of.make_step(job);
  JobView view(of.path(), of.settings);
  std::ofstream(of.path() + "/job.json", std::ios::app) << "x";
  EXPECT_TRUE(contains(error_of([&] { view.refresh(); }, bad), "job.json"));
  EXPECT_EQ(view.history().events.size(), 1U);
  job.next();
  of.make_step(job);  // writes it whole
  EXPECT_TRUE(view.refresh());
  expect_same(view.history(), job.history());
}

}  // namespace
}  // namespace excavplan::test
