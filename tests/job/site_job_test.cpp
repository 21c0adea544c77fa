// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/site_job.hpp>

#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include <excavplan/job/job_motion.hpp>

#include "base/non_finite.hpp"
#include "ground/grid_cells.hpp"
#include "job/job_record.hpp"
#include "job/trench_job.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

void expect_same(const JobStep& a, const JobStep& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.what, b.what);
  EXPECT_EQ(a.lane, b.lane);
  EXPECT_EQ(a.dump, b.dump);
  ASSERT_EQ(a.path.poses.size(), b.path.poses.size());
  for (std::size_t i = 0; i < a.path.poses.size(); ++i) {
    ASSERT_EQ(a.path.poses[i].joints, b.path.poses[i].joints);
  }
}

/// Begins a job and does its first steps: to its first dig, at least.
struct BegunJob {
  explicit BegunJob(int steps = 2) {
    for (int i = 0; i < steps; ++i) of.make_step(job);
  }
  const ShortTrench site{};
  TrenchJob of{site};
  SiteJob job = of.begin();
};

TEST(SiteJob, TheStepStaysUntilItIsDone) {
  BegunJob begun;
  const JobStep step = begun.job.next();
  EXPECT_EQ(step.what, JobAction::dig);
  EXPECT_GT(step.predicted.payload_mass, 0.0);
  const std::string record = begun.of.record();
  expect_same(begun.job.next(), step);
  for (const long long other : {step.id - 1, step.id + 1, 0LL}) begun.job.done(other, {});
  EXPECT_EQ(begun.of.record(), record);
  expect_same(begun.job.next(), step);
}

TEST(SiteJob, ResumedAfterEachStepItGoesOnWithTheSameBytes) {
  const ShortTrench site;
  TrenchJob one{site}, other{site};
  SiteJob through = one.begin();
  other.begin();
  for (int i = 0; i < 9; ++i) {
    {
      SiteJob resumed = other.resume();
      expect_same(resumed.next(), through.next());
    }
    SiteJob resumed = other.resume();
    one.make_step(through);
    other.make_step(resumed);
    ASSERT_EQ(one.record(), other.record()) << i;
  }
  EXPECT_GE(through.progress().scans, 1);
}

/// As if the process was killed when the site had taken the scan in, and the job was not written.
TEST(SiteJob, AScanWhoseJobWasNotWrittenIsTakenBack) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  std::string before;
  long long id = 0;
  do {
    id = job.next().id;
    before = of.record();
    of.make_step(job);
  } while (!of.report.scan);
  const std::string after = of.record();
  job = SiteJob(std::move(job));
  { SiteJob ended = std::move(job); }
  std::ofstream(of.path() + "/job.json", std::ios::binary) << before;
  SiteJob again = of.resume();
  EXPECT_EQ(again.next().id, id);
  again.done(id, of.report);
  EXPECT_EQ(of.record(), after);
}

TEST(SiteJob, TheLastChangeIsTakenBack) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  EXPECT_NE(error_of([&] { job.undo(); }).find("no step to take back"), std::string::npos);
  do {
    (void)job.next();
    const std::string before = of.record();
    const double left = job.progress().left_volume;
    const JobStep step = of.make_step(job);
    job.undo();
    EXPECT_EQ(of.record(), before);
    EXPECT_EQ(job.progress().left_volume, left);
    expect_same(job.next(), step);
    EXPECT_NE(error_of([&] { job.undo(); }), "no error");
    job.done(step.id, of.report);
  } while (!of.report.scan);
}

TEST(SiteJob, AScanOfNoStepChangesThePlan) {
  BegunJob begun;
  const JobStep step = begun.job.next();
  begun.job.look(begun.of.truth.scan(), begun.of.truth.time() + 1.0);
  EXPECT_EQ(begun.job.progress().scans, 1);
  EXPECT_GT(begun.job.next().id, step.id);
  begun.job.undo();
  expect_same(begun.job.next(), step);
}

TEST(SiteJob, AScanThatIsRefusedChangesNothing) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  do {
    of.make_step(job);
  } while (!of.report.scan);
  const StepReport twice = of.report;
  const JobStep step = job.next();
  ASSERT_TRUE(step.digs());
  const std::string record = of.record();
  const double left = job.progress().left_volume;
  EXPECT_NE(error_of([&] { job.done(step.id, twice); }).find("already"), std::string::npos);
  EXPECT_NE(error_of([&] { job.look(*twice.scan, twice.time); }), "no error");
  EXPECT_EQ(of.record(), record);
  EXPECT_EQ(job.progress().left_volume, left);
  expect_same(job.next(), step);
  of.make_step(job);
  EXPECT_GT(job.next().id, step.id);
}

/// Of other ground.
Scan wavy(Scan scan, double height) {
  auto cloud = std::make_shared<Cloud>(*scan.clouds.front());
  for (Eigen::Vector3d& point : cloud->points)
    point.z() += height * std::sin(1.5 * point.x()) * std::cos(1.5 * point.y());
  scan.clouds = {cloud};
  return scan;
}

TEST(SiteJob, DoesNotDigOnWhileScansAreNotTaken) {
  BegunJob begun(3);
  SiteJob& job = begun.job;
  ASSERT_EQ(job.next().what, JobAction::dig);
  const double time = begun.of.truth.time();
  job.look(wavy(begun.of.truth.scan(), 1.0), time + 1.0);
  EXPECT_EQ(job.next().what, JobAction::scan);
  { const SiteJob ended = std::move(begun.job); }
  begun.job = begun.of.resume();
  EXPECT_EQ(job.next().what, JobAction::scan);
  job.look(wavy(begun.of.truth.scan(), 1.1), time + 2.0);
  EXPECT_EQ(job.next().what, JobAction::scan);
  job.look(wavy(begun.of.truth.scan(), 1.2), time + 3.0);
  EXPECT_EQ(job.next().what, JobAction::stop);
  EXPECT_NE(job.next().reason.find("do not fit"), std::string::npos);
  job.look(begun.of.truth.scan(), time + 4.0);
  EXPECT_EQ(job.next().what, JobAction::dig);
}

TEST(SiteJob, AScanThatWasNotTakenIsTakenBack) {
  BegunJob begun(3);
  const Scan scan = wavy(begun.of.truth.scan(), 1.0);
  const double left = begun.job.progress().left_volume;
  begun.job.look(scan, begun.of.truth.time() + 1.0);
  const auto& warnings = begun.job.scan_warnings();
  ASSERT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const Warning& each) {
    return each.code == WarningCode::scan_not_taken;
  }));
  { const SiteJob ended = std::move(begun.job); }
  begun.job = begun.of.resume();
  begun.job.undo();
  EXPECT_EQ(begun.job.progress().left_volume, left);
}

TEST(SiteJob, AMoveThatWasAskedForOutlastsAScan) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  const JobStep move = job.next();
  ASSERT_EQ(move.what, JobAction::move);
  job.look(of.truth.scan(), trial_begin + 1.0);
  expect_same(job.next(), move);
}

TEST(SiteJob, AFolderHoldsOneJob) {
  const ShortTrench site;
  TrenchJob of{site};
  of.begin();
  EXPECT_NE(error_of([&] { of.begin(); }).find("holds a job already"), std::string::npos);
  of.settings.design.start.reset();
  EXPECT_NE(error_of([&] { of.resume(); }).find("start is not told"), std::string::npos);
}

TEST(SiteJob, AFolderInWhichNoneCouldBeginTakesAnother) {
  const ShortTrench site;
  TrenchJob of{site};
  const DesignSurface design = of.settings.surface;
  for (Eigen::Vector3d& point : std::get<Tin>(of.settings.surface.shape).points) point.z() += 5.0;
  EXPECT_NE(error_of([&] { of.begin(); }).find("covers no cell of the ground"), std::string::npos);
  of.settings.surface = design;
  EXPECT_EQ(of.begin().next().what, JobAction::move);
}

TEST(SiteJob, AReportThatCannotBeOfTheStepIsRefused) {
  BegunJob begun(0);
  const auto refusal = [&](const auto& change) {
    StepReport report;
    change(report);
    const std::string before = begun.of.record();
    const std::string text = error_of([&] { begun.job.done(begun.job.next().id, report); });
    EXPECT_EQ(begun.of.record(), before) << text;
    return text;
  };
  ASSERT_EQ(begun.job.next().what, JobAction::move);
  EXPECT_EQ(refusal([](StepReport& each) { each.payload_mass = 310.0; }),
            "payload mass of step 1, move [kg] is 310, must be 0 or left out, as nothing is dug in "
            "it");
  EXPECT_EQ(refusal([](StepReport& each) { each.stalled = true; }),
            "step 1 is a move and cannot have stalled: only a dig can");
  for (const double bad : {nan, 1e13, -1e13}) {
    for (double BasePose::*part : {&BasePose::x, &BasePose::y, &BasePose::z}) {
      const std::string text = refusal([&](StepReport& each) {
        each.base = BasePose();
        (*each.base).*part = bad;
      });
      EXPECT_EQ(text.rfind("base of step 1, move [m] is ", 0), 0U) << text;
    }
    const std::string turned = refusal([&](StepReport& each) {
      each.base = BasePose{0.0, 0.0, 0.0, bad};
    });
    EXPECT_EQ(turned.rfind("heading of step 1, move [rad] is ", 0), 0U) << turned;
  }
  begun.of.make_step(begun.job);
  ASSERT_EQ(begun.job.next().what, JobAction::dig);
  for (const double bad : {nan, -1.0, 1e13}) {
    EXPECT_NE(refusal([&](StepReport& each) { each.payload_mass = bad; }), "no error") << bad;
    EXPECT_NE(refusal([&](StepReport& each) { each.joint_work = bad; }), "no error") << bad;
  }
  EXPECT_EQ(refusal([&](StepReport& each) { each.payload_mass = nan; }),
            "payload mass of step 2, dig [kg] is nan, must be in 0 .. 1000000");
  EXPECT_EQ(refusal([&](StepReport& each) { each.time = nan; }),
            "time of step 2, dig [s] is nan, must be in -100000000000 .. 100000000000");
  EXPECT_NE(refusal([&](StepReport& each) { each.time = 1e12; }), "no error");
}

TEST(SiteJob, ARecordThatCannotBeOfTheDesignIsRefused) {
  BegunJob begun(1);
  ASSERT_EQ(begun.job.next().what, JobAction::dig);
  const std::string folder = begun.of.path();
  { const SiteJob ended = std::move(begun.job); }
  const JobRecord record = load_record(folder);
  const auto refusal = [&](const auto& change) {
    JobRecord other = record;
    change(other);
    save_record(folder, other);
    return error_of([&] { begun.of.resume(); });
  };
  const std::string text = ": its job is of another design, truck or machine";
  EXPECT_NE(refusal([](JobRecord& each) { each.station = 40; }).find(text), std::string::npos);
  EXPECT_NE(refusal([](JobRecord& each) { each.planned.reset(); }).find(text), std::string::npos);
  EXPECT_NE(refusal([](JobRecord& each) { each.present->truck = 1; }).find(text),
            std::string::npos);
  EXPECT_EQ(refusal([](JobRecord&) {}), "no error");
}

TEST(SiteJob, AJobWhoseSiteIsGoneIsRefused) {
  BegunJob begun(0);
  const std::string folder = begun.of.path();
  { const SiteJob ended = std::move(begun.job); }
  std::filesystem::remove(folder + "/site.json");
  EXPECT_EQ(error_of([&] { begun.of.resume(); }, ErrorKind::bad_file),
            folder +
                ": its site has taken in 0 scans, its job 1: files of it are missing, or of "
                "another job");
}

TEST(SiteJob, AJobWithTheMostThatIsBelievedCanBeReadAgain) {
  BegunJob begun(1);
  const JobStep dig = begun.job.next();
  ASSERT_EQ(dig.what, JobAction::dig);
  StepReport report;
  report.payload_mass = 2.9 * 2200.0 * heaped_capacity(begun.of.settings.site.machine);
  report.joint_work = 19.0 * dig.predicted.energy;
  report.base = BasePose{dig.base.x, dig.base.y + 9.9, 1e9, 1e3};
  begun.job.done(dig.id, report);
  { const SiteJob ended = std::move(begun.job); }
  begun.job = begun.of.resume();
  EXPECT_EQ(begun.job.progress().payload_mass, report.payload_mass);
}

TEST(SiteJob, ANumberInAnotherUnitIsRefusedAndNothingIsLearntOfIt) {
  BegunJob begun(1);
  const JobStep dig = begun.job.next();
  const std::string before = begun.of.record();
  const auto refusal = [&](const StepReport& report) {
    const std::string text = error_of([&] { begun.job.done(dig.id, report); });
    EXPECT_EQ(begun.of.record(), before);
    return text;
  };
  StepReport report;
  report.payload_mass = 310e3;  // g
  EXPECT_NE(refusal(report).find("three buckets hold: is it in kg?"), std::string::npos);
  report.payload_mass.reset();
  for (const double factor : {1e3, 1e-3}) {
    report.joint_work = factor * dig.predicted.energy;
    EXPECT_NE(refusal(report).find("kJ are foretold: is it in kJ?"), std::string::npos) << factor;
  }
  report.joint_work.reset();
  report.base = BasePose{dig.base.x + 100.0, dig.base.y, 0.0, 0.0};
  EXPECT_NE(refusal(report).find("its distance from where the step has it [m] is 100"),
            std::string::npos);
}

/// As if a process was killed in the second of two scans: of the ground before the first nothing is
/// left.
TEST(SiteJob, WhatCannotBeTakenBackAnyMoreIsNot) {
  BegunJob begun;
  const auto look = [&](double later) {
    begun.job.look(begun.of.truth.scan(), begun.of.truth.time() + later);
  };
  look(1.0);
  const std::string record = begun.of.record();
  const std::string earlier = content_of(begun.of.path() + "/job-before.json");
  look(2.0);
  { const SiteJob ended = std::move(begun.job); }
  std::ofstream(begun.of.path() + "/job.json", std::ios::binary) << record;
  std::ofstream(begun.of.path() + "/job-before.json", std::ios::binary) << earlier;
  begun.job = begun.of.resume();
  EXPECT_NE(error_of([&] { begun.job.undo(); }).find("no step to take back"), std::string::npos);
  EXPECT_EQ(begun.of.record(), record);
  { const SiteJob ended = std::move(begun.job); }
  begun.job = begun.of.resume();
  EXPECT_EQ(begun.job.progress().scans, 1);
}

TEST(SiteJob, TheScansOfItsSiteAreItsOwn) {
  const BegunJob begun;
  EXPECT_NE(error_of([&] { Site(begun.of.path(), begun.of.settings.site, SiteAccess::write); },
                     ErrorKind::bad_file)
                .find("holds a job"),
            std::string::npos);
  EXPECT_EQ(Site(begun.of.path(), begun.of.settings.site).updates(), 1);
}

/// As if a process was killed between the first scan and the record of its job.
TEST(SiteJob, BeginsOnAScanThatItsSiteHolds) {
  const ShortTrench site;
  TrenchJob of{site};
  { const SiteJob begun = of.begin(); }
  std::filesystem::remove(of.path() + "/job.json");
  const SiteJob again = of.begin();
  EXPECT_EQ(Site(of.path(), of.settings.site).updates(), 1);
  EXPECT_GT(again.progress().left_volume, 0.0);
}

TEST(SiteJob, ADesignThatLeavesTheScanIsNeverFinished) {
  const ShortTrench site;
  TrenchJob of{site};
  EXPECT_TRUE(of.begin().design_warnings().empty());
  TrenchJob longer{site};
  longer.settings.design.words->length += 10.0;
  longer.settings.surface =
      design_of_words(*longer.settings.design.words, longer.hidden.ground.bank);
  const SiteJob job = longer.begin();
  const auto warnings = job.design_warnings();
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings.front().code, WarningCode::design_beyond_scan);
  EXPECT_TRUE(warnings.front().ends_trust);
  EXPECT_LT(job.progress().seen, 0.9);
}

TEST(SiteJob, WhereTheMachineStandsIsTakenOfAnyStep) {
  BegunJob begun(1);
  const JobStep dig = begun.job.next();
  ASSERT_EQ(dig.what, JobAction::dig);
  StepReport report;
  report.base = dig.base;
  report.base->x -= 0.1;  // it slid
  begun.job.done(dig.id, report);
  EXPECT_EQ(begun.job.next().base.x, dig.base.x - 0.1);
}

/// No file that is written then grows beyond so many bytes, as on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

/// Makes a change with ever more room, until it can be written; before that all is as it was.
void expect_whole(const TrenchJob& of, SiteJob& job, const std::function<void()>& change) {
  const std::string record = of.record();
  const std::optional<JobStep> step = job.present();
  const double left = job.progress().left_volume;
  const std::size_t events = job.history().events.size();
  int failures = 0;
  for (rlim_t room = 0; room < 1U << 24U; room = 4 * room + 1000, ++failures) {
    const std::string problem = [&] {
      const FullDisk full(room);
      return error_of(change, ErrorKind::bad_file);
    }();
    if (problem == "no error") break;
    EXPECT_NE(problem.find("cannot be written"), std::string::npos) << problem;
    ASSERT_EQ(of.record(), record) << room;
    ASSERT_EQ(job.progress().left_volume, left) << room;
    ASSERT_EQ(job.history().events.size(), events) << room;
    ASSERT_EQ(job.present().has_value(), step.has_value()) << room;
    if (step) expect_same(*job.present(), *step);
  }
  EXPECT_GE(failures, 2);
}

TEST(SiteJob, AChangeThatCannotBeWrittenIsNone) {
  BegunJob begun;
  SiteJob& job = begun.job;
  expect_whole(begun.of, job, [&] { (void)job.next(); });
  const JobStep dig = job.next();
  ASSERT_EQ(dig.what, JobAction::dig);
  begun.of.report = begun.of.truth.execute(dig).report;
  expect_whole(begun.of, job, [&] { job.done(dig.id, begun.of.report); });
  expect_whole(begun.of, job, [&] { job.undo(); });
}

TEST(SiteJob, AScanThatCannotBeWrittenIsNone) {
  BegunJob begun(1);
  SiteJob& job = begun.job;
  (void)job.next();
  const Scan scan = begun.of.truth.scan();
  const auto look = [&] { job.look(scan, begun.of.truth.time() + 1.0); };
  const std::string last_but_one = begun.of.path() + "/job-before.json";
  std::filesystem::remove(last_but_one);
  std::filesystem::create_directory(last_but_one);
  EXPECT_NE(error_of(look, ErrorKind::bad_file).find("cannot be written"), std::string::npos);
  std::filesystem::remove(last_but_one);
  EXPECT_EQ(job.progress().scans, 0);
  expect_whole(begun.of, job, look);
  EXPECT_EQ(job.progress().scans, 1);
}

TEST(SiteJob, WhatCouldNotBeWrittenIsNotTakenBack) {
  BegunJob begun;
  const JobStep dig = begun.job.next();
  {
    const FullDisk full(static_cast<rlim_t>(begun.of.record().size()));
    EXPECT_NE(error_of([&] { begun.job.done(dig.id, {}); }, ErrorKind::bad_file), "no error");
  }
  ASSERT_EQ(content_of(begun.of.path() + "/job-before.json"), begun.of.record());
  EXPECT_NE(error_of([&] { begun.job.undo(); }).find("no step to take back"), std::string::npos);
  expect_same(begun.job.next(), dig);
}

TEST(SiteJob, AJobThatCannotBeMendedIsRefused) {
  BegunJob begun;
  const JobStep dig = begun.job.next();
  const std::string log = begun.of.path() + "/job-log.jsonl", kept = content_of(log);
  std::filesystem::remove(log);
  std::filesystem::create_directory(log);
  const std::string record = begun.of.record();
  EXPECT_NE(error_of([&] { begun.job.done(dig.id, {}); }, ErrorKind::bad_file), "no error");
  const auto refused = [&](const std::function<void()>& change) {
    EXPECT_NE(error_of(change, ErrorKind::bad_file).find("cannot be restored"), std::string::npos);
  };
  refused([&] { (void)begun.job.next(); });
  refused([&] { (void)begun.job.present(); });
  refused([&] { begun.job.done(dig.id, {}); });
  refused([&] { begun.job.look(begun.of.truth.scan(), begun.of.truth.time()); });
  refused([&] { begun.job.undo(); });
  EXPECT_EQ(begun.of.record(), record);
  { const SiteJob ended = std::move(begun.job); }
  std::filesystem::remove(log);
  std::ofstream(log, std::ios::binary) << kept;
  begun.job = begun.of.resume();
  expect_same(begun.job.next(), dig);
}

TEST(SiteJob, APayloadOfNothingMayBeReportedOfAMove) {
  BegunJob begun(0);
  StepReport report;
  report.payload_mass = 0.0;
  begun.job.done(begun.job.next().id, report);
  EXPECT_EQ(begun.job.next().what, JobAction::dig);
}

/// Share of the floor of the usual trench, less its rim, that lies within so far of -0.4 m.
double share_within(const Terrain& ground, double tolerance) {
  const HeightMap surface = ground.surface();
  int count = 0, within = 0;
  for_each_cell(surface.z, [&](Cell at) {
    const double x = surface.x(at.col), y = surface.y(at.row);
    if (x < 2.1 || x > 5.9 || std::abs(y) > 0.4) return;
    ++count;
    if (std::abs(surface.z(at.row, at.col) + 0.4) <= tolerance) ++within;
  });
  return static_cast<double>(within) / count;
}

/// True soil as believed, and no errors but those of cells, of what the sensor does not see, and of
/// half a millimetre in its ranges, so that no two scans are the same.
TEST(SiteJob, WithExactScansATrenchIsDugToItsDesign) {
  PlainSiteFolder site;
  site.site["sensor"]["noise_sd_at_1m_m"] = 0.0005;
  site.density = [](double, double) { return 50.0; };
  TrenchJob of{site, truth_cell};
  of.settings.density_percent = 50.0;
  SiteJob job = of.begin();
  JobStep step;
  int blocked = 0;
  for (int i = 0; i < 200; ++i) {
    step = job.next();
    if (step.what == JobAction::stop) break;
    const auto motion = motion_of(of.settings, job.ground(), step);
    if (const auto* stop = std::get_if<BlockedWay>(&motion)) {
      ++blocked;
      std::printf("%lld %s: %s\n", step.id, name(step.what), stop->message.c_str());
    }
    of.make_step(job);
  }
  const JobProgress done = job.progress();
  EXPECT_EQ(step.what, JobAction::stop);
  EXPECT_EQ(blocked, 0);
  const auto solids = of.truth.solids();
  EXPECT_LT(solids.held, 10.0) << "six litres are not worth a dump";
  EXPECT_NEAR(solids.cut, solids.lying + solids.held, 1e-9 * solids.cut);
  EXPECT_LT(done.left_volume, 0.15 * done.design_volume);
  EXPECT_GT(done.seen, 0.95);
  // There is no room beyond the far end, whose wall leans; what lies at its foot varies by 0.03
  // with the smallest change of the order of digs.
  EXPECT_GT(share_within(of.truth.ground(), 0.03), 0.88);
  EXPECT_GT(share_within(of.truth.ground(), 0.06), 0.93);
}

/// Reports the present step, a move, so far off where it was to go, along the trench and aside.
void arrive_off(SiteJob& job, double along, double aside = 0.0) {
  const JobStep move = job.next();
  ASSERT_EQ(move.what, JobAction::move);
  StepReport report;
  report.base = move.base;
  report.base->x += along;
  report.base->y += aside;
  job.done(move.id, report);
}

TEST(SiteJob, AMachineOffItsPlaceDigsFromWhereItStandsIfItCan) {
  BegunJob begun(0);
  const BasePose place = begun.job.next().base;
  arrive_off(begun.job, 0.0, 0.83);
  const JobStep step = begun.job.next();
  EXPECT_EQ(step.what, JobAction::dig);
  EXPECT_DOUBLE_EQ(step.base.y, place.y + 0.83);
}

TEST(SiteJob, AMachineThatCanDigNothingOffItsPlaceGoesThereOnceMore) {
  BegunJob begun(0);
  const BasePose place = begun.job.next().base;
  arrive_off(begun.job, 3.0);
  { const SiteJob ended = std::move(begun.job); }
  begun.job = begun.of.resume();
  EXPECT_EQ(begun.job.next().what, JobAction::move);
  EXPECT_NEAR(begun.job.next().base.x, place.x, 1e-9);
  arrive_off(begun.job, 0.0);
  EXPECT_EQ(begun.job.next().what, JobAction::dig);
  begun.job.undo();
  arrive_off(begun.job, 3.0);
  const JobStep step = begun.job.next();
  EXPECT_TRUE(step.what != JobAction::move || std::abs(step.base.x - place.x) > 1.0)
      << name(step.what) << ' ' << step.base.x;
}

TEST(SiteJob, AKeepOutIsNotCut) {
  ShortTrench site;
  const double depth = 0.15;
  site.site["keep_out"] = {{{"kind", "cable"},
                            {"polygon", {{3.0, -2.0}, {3.6, -2.0}, {3.6, 2.0}, {3.0, 2.0}}},
                            {"depth_m", depth}}};
  TrenchJob of{site};
  SiteJob job = of.begin();
  for (int i = 0; i < 12; ++i) {
    if (job.next().what == JobAction::stop) break;
    of.make_step(job);
  }
  EXPECT_GT(job.progress().digs, 4);
  const HeightMap& bank = of.truth.ground().bank;
  for (Eigen::Index row = 0; row < bank.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < bank.z.cols(); ++col) {
      if (bank.x(col) < 3.05 || bank.x(col) > 3.55) continue;
      ASSERT_GT(bank.z(row, col), -depth - 0.01) << bank.x(col) << ' ' << bank.y(row);
    }
  }
}

}  // namespace
}  // namespace excavplan::test
