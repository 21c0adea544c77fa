// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/job_history.hpp>

#include <cmath>
#include <fstream>
#include <limits>
#include <regex>
#include <sstream>

#include "base/non_finite.hpp"
#include "job/trench_job.hpp"
#include "site/cell_codes.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

using Eigen::ArrayXXd;
using Eigen::ArrayXXi;

std::string log_of(const TrenchJob& job) { return content_of(job.path() + "/job-log.jsonl"); }

void expect_same_layer(const ArrayXXd& a, const ArrayXXd& b) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  EXPECT_TRUE((a == b || (a.isNaN() && b.isNaN())).all());
}

void expect_same(const JobHistory& a, const JobHistory& b) {
  ASSERT_EQ(a.events.size(), b.events.size());
  EXPECT_EQ(a.begin, b.begin);
  EXPECT_EQ(a.design_volume, b.design_volume);
  for (std::size_t i = 0; i <= a.events.size(); ++i) {
    expect_same_layer(a.ground(i).surface.z, b.ground(i).surface.z);
    expect_same_layer(a.ground(i).seen_at, b.ground(i).seen_at);
    if (i == a.events.size()) return;
    const JobEvent &one = a.events[i], &other = b.events[i];
    EXPECT_EQ(one.what, other.what);
    EXPECT_EQ(one.step, other.step);
    EXPECT_EQ(one.time, other.time);
    EXPECT_EQ(one.energy, other.energy);
    EXPECT_EQ(one.payload_mass, other.payload_mass);
    EXPECT_EQ(one.predicted.payload_interval, other.predicted.payload_interval);
    EXPECT_EQ(one.base.x, other.base.x);
    EXPECT_EQ(one.dump, other.dump);
    EXPECT_EQ(one.keeps_load, other.keeps_load);
    EXPECT_EQ(one.stalled, other.stalled);
    EXPECT_EQ(one.scanned, other.scanned);
    EXPECT_EQ(one.left_volume, other.left_volume);
    EXPECT_EQ(one.warnings.size(), other.warnings.size());
  }
}

TEST(CellCodes, NumbersComeBack) {
  ArrayXXi numbers(2, 5);
  numbers << 0, 0, -1, 300, 0, 0, unknown_height, std::numeric_limits<int>::max(),
      std::numeric_limits<int>::min(), 0;
  const auto same = [](const ArrayXXi& a, const ArrayXXi& b) { return (a == b).all(); };
  EXPECT_TRUE(same(*numbers_of(codes_of(numbers), 2, 5), numbers));
  const ArrayXXi heights = numbers.max(unknown_height).min(1000000000);
  EXPECT_TRUE(same(sums_of(steps_of(heights)), heights));
  const ArrayXXi none = ArrayXXi::Zero(40, 50);
  EXPECT_LT(codes_of(none).size(), 10U);
  EXPECT_TRUE(same(*numbers_of(codes_of(none), 40, 50), none));
  EXPECT_FALSE(numbers_of(codes_of(none), 40, 49));
  EXPECT_FALSE(numbers_of(codes_of(none), 40, 51));
  EXPECT_FALSE(numbers_of("not base64", 2, 5));
  EXPECT_FALSE(numbers_of("//////////8=", 1, 1));
}

TEST(JobHistory, HeightsAreKeptInMillimetresAndStepsAsWhatTheyChanged) {
  JobHistory start;
  start.before = flat_ground({0.0, 0.0, 1.0, 0.6}, 0.1, 0.25049);
  start.before.z(0, 0) = nan;
  start.target = start.before;
  start.seen_at = ArrayXXd::Constant(6, 10, nan);
  JobRecorder recorder(start);
  JobHistory::Ground after = recorder.now();
  after.surface.z(2, 3) = -0.1004;
  after.surface.z(4, 7) = nan;
  after.seen_at(2, 3) = 5.0;
  recorder.add({}, after);
  recorder.add({}, recorder.now());
  const JobHistory& history = recorder.history();
  EXPECT_EQ(history.before.z(1, 1), 0.25);
  const CellPatch& patch = history.events[0].surface;
  EXPECT_EQ(patch.row, 2);
  EXPECT_EQ(patch.col, 3);
  EXPECT_EQ(patch.z.rows(), 3);
  EXPECT_EQ(patch.z.cols(), 5);
  EXPECT_EQ(history.ground(1).surface.z(2, 3), -0.1);
  EXPECT_TRUE(std::isnan(history.ground(2).surface.z(4, 7)));
  EXPECT_EQ(history.events[1].surface.z.size(), 0);
  EXPECT_EQ(history.events[1].seen_at.z.size(), 0);
  recorder.cut(0);
  expect_same_layer(recorder.now().surface.z, history.before.z);
  after.surface = flat_ground({0.0, 0.0, 1.0, 0.7}, 0.1);
  EXPECT_NE(error_of([&] { recorder.add({}, after); }).find("another grid"), std::string::npos);
}

/// The site grows when a scan from another place sees farther; design and ground are compared cell
/// by cell.
TEST(JobHistory, TheGroundStaysOnTheCellsOfTheFirstScan) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  const HeightMap first = job.ground().bank;
  do of.make_step(job);
  while (!of.report.scan);
  EXPECT_TRUE(same_grid(job.ground().bank, first));
  EXPECT_TRUE(same_grid(job.history().target, first));
  const HeightMap cells = load_ground(of.path() + "/job-first-ground.tif").terrain.bank;
  EXPECT_TRUE(same_grid(cells, first));
}

TEST(JobHistory, OfAJobThatWasResumedAfterEachStepIsThatOfOneThatWasNot) {
  const ShortTrench site;
  TrenchJob one{site}, other{site};
  SiteJob through = one.begin();
  other.begin();
  for (int i = 0; i < 9; ++i) {
    SiteJob resumed = other.resume();
    one.make_step(through);
    other.make_step(resumed);
    ASSERT_EQ(log_of(one), log_of(other)) << i;
  }
  const SiteJob resumed = other.resume();
  expect_same(resumed.history(), through.history());
  const JobHistory& history = through.history();
  ASSERT_EQ(history.events.size(), 9U);
  const ArrayXXd off = history.ground(9).surface.z - through.ground().surface().z;
  EXPECT_LE(off.isNaN().select(0.0, off).abs().maxCoeff(), 0.0005 + 1e-12);
  EXPECT_EQ(history.events.back().left_volume, through.progress().left_volume);
  EXPECT_EQ(history.design_volume, through.progress().design_volume);
  double time = history.begin;
  for (const JobEvent& event : history.events) time += event.time;
  EXPECT_NEAR(time, one.truth.time(), 1e-3);
}

/// As if the process was killed at any place between two steps.
TEST(JobHistory, IsNeverAheadOfTheRecord) {
  const ShortTrench site;
  TrenchJob of{site};
  std::string before, log_before;
  StepReport report;
  long long id = 0;
  {
    SiteJob job = of.begin();
    for (int i = 0; i < 4; ++i) {
      id = job.next().id;
      before = of.record();
      log_before = log_of(of);
      of.make_step(job);
    }
  }
  const std::string log = log_of(of);
  const auto set = [&](const char* name, const std::string& text) {
    std::ofstream(of.path() + name, std::ios::binary) << text;
  };
  const std::string record = of.record();
  for (const std::size_t written : {log_before.size(), log_before.size() + 40, log.size()}) {
    set("/job.json", before);
    set("/job-log.jsonl", log.substr(0, written));
    SiteJob again = of.resume();
    EXPECT_EQ(log_of(of), log_before);
    EXPECT_EQ(again.history().events.size(), 3U);
    again.done(id, of.report);
    EXPECT_EQ(log_of(of), log);
    EXPECT_EQ(of.record(), record);
  }
}

TEST(JobHistory, TheLastEventIsTakenBack) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  for (int i = 0; i < 2; ++i) of.make_step(job);
  const std::string log = log_of(of);
  of.make_step(job);
  job.undo();
  EXPECT_EQ(log_of(of), log);
  EXPECT_EQ(job.history().events.size(), 2U);
  job.look(of.truth.scan(), of.truth.time() + 1.0);
  const JobEvent& look = job.history().events.back();
  EXPECT_EQ(look.what, JobAction::scan);
  EXPECT_EQ(look.step, 0);
  EXPECT_GT(look.seen_at.z.size(), 0);
  job.undo();
  EXPECT_EQ(log_of(of), log);
}

TEST(JobHistory, LinesHaveTheKeysOfALog) {
  const ShortTrench site;
  TrenchJob of{site};
  SiteJob job = of.begin();
  for (int i = 0; i < 2; ++i) of.make_step(job);
  std::istringstream text(log_of(of));
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0]["type"], "begin");
  EXPECT_EQ(lines[1]["type"], "move");
  const nlohmann::json& dig = lines[2];
  EXPECT_EQ(dig["type"], "dig");
  EXPECT_EQ(dig["payload_kg"], *of.report.payload_mass);
  EXPECT_EQ(dig["energy_j"], *of.report.joint_work);
  EXPECT_EQ(dig["pass"], "bulk");
  EXPECT_EQ(dig["stall"], of.report.stalled);
  EXPECT_TRUE(dig["base"].contains("heading_rad"));
  EXPECT_EQ(dig["predicted"]["payload_kg_interval"].size(), 2U);
}

TEST(JobHistory, ADamagedLineIsNamedAndAJobWithoutALogGoesOn) {
  const ShortTrench site;
  TrenchJob of{site};
  Eigen::Index rows = 0;
  {
    SiteJob job = of.begin();
    for (int i = 0; i < 2; ++i) of.make_step(job);
    rows = job.history().before.z.rows();
  }
  const std::string path = of.path() + "/job-log.jsonl";
  const std::string log = log_of(of);
  const auto error_with = [&](const char* part, const std::string& instead) {
    std::ofstream(path, std::ios::binary) << std::regex_replace(log, std::regex(part), instead);
    return error_of([&] { of.resume(); }, ErrorKind::bad_file);
  };
  EXPECT_NE(error_with(R"("move")", R"("fly")").find("line 2: type"), std::string::npos);
  const std::string last_row = R"("ground":{"row":)" + std::to_string(rows - 1);
  const std::string beyond = error_with(R"("ground":\{"row":\d+)", last_row);
  EXPECT_NE(beyond.find("rows"), std::string::npos) << beyond;
  std::filesystem::remove(path);
  {
    SiteJob job = of.resume();
    EXPECT_EQ(job.history().events.size(), 0U);
    of.make_step(job);
    EXPECT_EQ(job.history().events.size(), 1U);
  }
  EXPECT_EQ(of.resume().history().events.size(), 1U);
}

}  // namespace
}  // namespace excavplan::test
