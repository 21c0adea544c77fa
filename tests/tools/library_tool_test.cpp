// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>

#include <sys/file.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <nlohmann/json.hpp>

#include "base/random.hpp"

#include "support/run_program.hpp"

/// @file
/// build-path-library as jobs of a cluster use it: killed, resumed, several in one folder, under
/// mpirun.

namespace excavplan::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

Words operator+(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

const Words grid = {"--densities", "10,20,35,70", "--cell", "0.1",         "--points",
                    "8",           "--polish",    "8",      "--inherited", "8"};

ProgramResult build(const Words& words) { return run_program("build-path-library", words); }

/// A run that is killed after a while, unless it has ended.
void killed(const Words& words, std::chrono::microseconds after) {
  const pid_t child = started("build-path-library", words, [] {});
  std::this_thread::sleep_for(after);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

class LibraryTool : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(build(grid + Words{"--out", folder_.file("whole.json")}).code, 0);
    whole_ = content_of(folder_.file("whole.json"));
  }
  const TemporaryFolder folder_;
  const std::string out_ = folder_.file("library.json");
  std::string whole_;
};

TEST_F(LibraryTool, LeavesNothingButTheLibrary) {
  for (const auto& file : fs::directory_iterator(fs::path(out_).parent_path())) {
    EXPECT_EQ(file.path().filename(), "whole.json");
  }
}

TEST_F(LibraryTool, SeveralRunsShareAFolder) {
  const std::string cells = folder_.file("cells");
  std::vector<pid_t> runs;
  for (int i = 0; i < 3; ++i) {
    const std::string out = folder_.file("shared" + std::to_string(i) + ".json");
    runs.push_back(started("build-path-library",
                           grid + Words{"--cells", cells, "--out", out, "--quiet"}, [] {}));
  }
  for (const pid_t run : runs) {
    int status = -1;
    ::waitpid(run, &status, 0);
    EXPECT_EQ(status, 0);
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(content_of(folder_.file("shared" + std::to_string(i) + ".json")), whole_);
  }
  EXPECT_FALSE(fs::is_empty(cells)) << "its files are kept";
}

TEST_F(LibraryTool, UsesOnlyEntriesOfTheSameSearch) {
  const std::string cells = folder_.file("cells");
  const Words other = {"--seed", "2", "--cells", cells, "--out", folder_.file("other.json")};
  EXPECT_EQ(build(grid + other).code, 0);
  const auto others = std::distance(fs::directory_iterator(cells), fs::directory_iterator());
  const ProgramResult own = build(grid + Words{"--cells", cells, "--out", out_});
  EXPECT_EQ(own.code, 0);
  EXPECT_EQ(own.err,
            cells + ": " + std::to_string(others) + " entries of other options are not used\n");
  EXPECT_EQ(content_of(out_), whole_);
  EXPECT_EQ(build(grid + other).err, own.err) << "as many are of this search";
  EXPECT_NE(content_of(folder_.file("other.json")), whole_);
}

TEST_F(LibraryTool, LibrariesThatCannotBeToldApartAreRefused) {
  auto soil =
      nlohmann::json::parse(content_of(std::string(EXCAVPLAN_DATA_SOURCE) + "/soils/loam.json"));
  const std::string mine = folder_.write("mine.json", soil.dump());
  const ProgramResult alike = build(grid + Words{"--soil", "loam," + mine, "--out", out_});
  EXPECT_EQ(alike.code, 2);
  EXPECT_NE(alike.err.find("two of the soils are named 'loam'"), std::string::npos) << alike.err;
  soil["name"] = "loam of site a/b";
  folder_.write("mine.json", soil.dump());
  const std::string libraries = folder_.file("libraries");
  const ProgramResult odd = build(grid + Words{"--soil", "sand," + mine, "--out", libraries});
  EXPECT_EQ(odd.code, 0) << odd.err;
  EXPECT_TRUE(fs::exists(libraries + "/zx120-loam_of_site_a_b-cycle.json"));
}

TEST_F(LibraryTool, WhereItWritesIsCheckedBeforeTheSearch) {
  const std::string file = folder_.write("file", "mine");
  const ProgramResult several = build(grid + Words{"--soil", "loam,sand", "--out", file});
  EXPECT_EQ(several.code, 3);
  EXPECT_NE(several.err.find("is a file, several libraries need a folder"), std::string::npos);
  const std::string folder = folder_.file("folder");
  fs::create_directory(folder);
  const ProgramResult one = build(grid + Words{"--out", folder});
  EXPECT_EQ(one.code, 3);
  EXPECT_NE(one.err.find("is a folder, the library needs a file"), std::string::npos) << one.err;
  EXPECT_EQ(content_of(file), "mine");
}

TEST_F(LibraryTool, WhatCannotBeWrittenIsFoundBeforeTheSearch) {
  fs::create_directory(folder_.file("libraries"));
  const std::string sand = folder_.file("libraries/zx120-sand-cycle.json");
  for (const std::string& link : {out_, sand}) fs::create_symlink("/nowhere/library.json", link);
  for (const Words& words : {Words{"--out", out_}, Words{"--out", folder_.file("none/l.json")},
                             Words{"--soil", "loam,sand", "--out", out_},
                             Words{"--soil", "loam,sand", "--out", folder_.file("libraries")}}) {
    const ProgramResult result = build(grid + words);
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_FALSE(fs::exists(words.back() + ".cells")) << "it was searched";
  }
}

TEST_F(LibraryTool, ASecondRunWithTheSameOutIsRefusedAndDisturbsNothing) {
  const std::string cells = out_ + ".cells";
  fs::create_directory(cells);
  const std::string entry = folder_.write("library.json.cells/a.entry.json", "of the first run");
  const int lock = ::open(folder_.write("library.json.cells/in-use", "").c_str(), O_RDWR);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  const ProgramResult second = build(grid + Words{"--out", out_});
  EXPECT_EQ(second.code, 3);
  EXPECT_NE(second.err.find(cells + ": another run with the same --out uses it"),
            std::string::npos);
  EXPECT_EQ(content_of(entry), "of the first run");
  ::close(lock);
  EXPECT_EQ(build(grid + Words{"--out", out_}).code, 0);
  EXPECT_EQ(content_of(out_), whole_);
  EXPECT_FALSE(fs::exists(cells));
}

TEST_F(LibraryTool, ErrorsNameTheOption) {
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--slopes", "0,90deg"}, "--slopes [rad] must rise inside -1 .. 1"},
      {{"--densities", "20,10"}, "--densities [%] must rise inside 0 .. 100"},
      {{"--cell", "5"}, "--cell: the cell size is 5 m, must be in 0.005 .. 1 m"},
      {{"--points", "0"}, "--points is 0, must be in 1 .. 1000000"},
      {{"--points", "1000001"}, "--points is 1000001, must be in 1 .. 1000000"},
      {{"--polish", "-1"}, "--polish is -1, must be in 0 .. 1000000"},
      {{"--inherited", "-1", "--densities", "40,50"}, "--inherited is -1, must be in 0 .. 1000000"},
      {{"--method", "paper", "--population", "0"}, "--population must be >= 2"},
      {{"--method", "paper", "--generations", "-1"}, "--generations must be >= 1"}};
  for (const auto& [words, message] : cases) {
    const ProgramResult result = build(words + Words{"--threads", "1", "--out", out_});
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.err.find("build-path-library: " + message), 0U) << result.err;
  }
}

TEST_F(LibraryTool, LeavesFilesOfOthersAlone) {
  const std::string cells = out_ + ".cells";
  fs::create_directory(cells);
  for (const char* name : {"notes.txt", "notes.json"}) {
    folder_.write(std::string("library.json.cells/") + name, "not an entry");
  }
  EXPECT_EQ(build(grid + Words{"--out", out_}).code, 0);
  EXPECT_EQ(content_of(out_), whole_);
  std::size_t files = 0;
  for (const auto& file : fs::directory_iterator(cells)) {
    EXPECT_EQ(content_of(file.path()), "not an entry");
    ++files;
  }
  EXPECT_EQ(files, 2U);
}

TEST_F(LibraryTool, SeedsTooLargeForTheFileAndOptionsWithoutEffectAreReported) {
  const ProgramResult seed = build(grid + Words{"--seed", "18446744073709551615", "--out", out_});
  EXPECT_EQ(seed.code, 2);
  EXPECT_NE(seed.err.find("must be at most 9007199254740992"), std::string::npos) << seed.err;
  const ProgramResult population = build(grid + Words{"--population", "6", "--out", out_});
  EXPECT_EQ(population.code, 0);
  EXPECT_NE(population.err.find("without effect: --population"), std::string::npos);
  EXPECT_EQ(content_of(out_), whole_);
}

TEST_F(LibraryTool, KilledAtRandomMomentsItResumesToTheSameBytes) {
  Random random(5);
  for (int i = 0; i < 8; ++i) {
    const auto after = std::chrono::microseconds(random.index(80000));
    killed(grid + Words{"--out", out_, "--resume", "--quiet"}, after);
  }
  const ProgramResult result = build(grid + Words{"--out", out_, "--resume"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(content_of(out_), whole_);
  EXPECT_FALSE(fs::exists(out_ + ".cells"));
}

TEST_F(LibraryTool, AnInterruptKeepsTheEntriesForResume) {
  const Words large = {"--densities", "0:2:100", "--out", out_};
  EXPECT_EQ(interrupted("build-path-library", large, " densities, ").code, 75);
  EXPECT_TRUE(fs::exists(out_ + ".cells"));
  EXPECT_FALSE(fs::exists(out_));
  EXPECT_EQ(build(grid + Words{"--out", out_}).code, 0);  // starts again
  EXPECT_EQ(content_of(out_), whole_);
  EXPECT_FALSE(fs::exists(out_ + ".cells"));
}

TEST_F(LibraryTool, SeveralSoilsMakeAFolderOfLibraries) {
  const std::string libraries = folder_.file("libraries");
  const ProgramResult result =
      build(Words{"--densities", "20", "--soil", "loam,sand", "--slopes=-5deg,0", "--cell", "0.1",
                  "--points", "8", "--polish", "8", "--out", libraries, "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json.at("libraries").size(), 2U);
  EXPECT_EQ(json["libraries"][1].at("file"), libraries + "/zx120-sand-cycle.json");
  const ProgramResult plan = run_program(
      "plan-path",
      {"--density", "20", "--soil", "sand", "--library", libraries + "/zx120-sand-cycle.json"});
  EXPECT_EQ(plan.code, 0) << plan.err;
  const ProgramResult wrong = run_program(
      "plan-path", {"--density", "20", "--library", libraries + "/zx120-sand-cycle.json"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("its soil is sand, not loam"), std::string::npos) << wrong.err;
}

TEST_F(LibraryTool, WithoutOutItIsRefused) {
  const ProgramResult result = build({});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("--out is missing"), std::string::npos) << result.err;
}

TEST_F(LibraryTool, AnotherSimulatorMakesAnotherLibrary) {
  ASSERT_EQ(build(grid + Words{"--simulator", "section", "--out", out_}).code, 0);
  EXPECT_NE(content_of(out_), whole_);
  EXPECT_EQ(build(grid + Words{"--simulator", "magic", "--out", out_}).code, 2);
}

#ifdef EXCAVPLAN_MPIRUN
/// Runs mpirun with these words. @return its exit code
int run_ranks(const std::string& words, const std::string& said) {
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  ::setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
  ::setenv("ASAN_OPTIONS", "detect_leaks=0",
           0);  // Open MPI leaks; read by sanitized programs alone
  const std::string command = EXCAVPLAN_MPIRUN + (" " + words) + " > " + said + " 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
#endif

TEST_F(LibraryTool, SameBytesForOneToFourRanks) {
#ifndef EXCAVPLAN_MPIRUN
  GTEST_SKIP() << "no mpirun, or built without MPI";
#else
  for (const int ranks : {1, 2, 4}) {
    std::string words =
        "-n " + std::to_string(ranks) + " " + EXCAVPLAN_BIN + "/build-path-library --out " + out_;
    for (const std::string& word : grid) words += " " + word;
    ASSERT_EQ(run_ranks(words, folder_.file("said")), 0) << content_of(folder_.file("said"));
    EXPECT_EQ(content_of(out_), whole_) << ranks;
    const std::string said = content_of(folder_.file("said"));
    EXPECT_EQ(said.find(out_), said.rfind(out_)) << said;  // one rank prints
    fs::remove(out_);
    EXPECT_EQ(run_ranks(words + " --json", folder_.file("said")), 0)
        << content_of(folder_.file("said"));
    fs::remove(out_);
  }
#endif
}

TEST_F(LibraryTool, OneOfTheRanksThatFailPrintsTheReason) {
#ifndef EXCAVPLAN_MPIRUN
  GTEST_SKIP() << "no mpirun, or built without MPI";
#else
  const auto ranks = [&](int count, const std::string& machine) {
    return "-n " + std::to_string(count) + " " + EXCAVPLAN_BIN + "/build-path-library --out " +
           out_ + " --machine " + machine;
  };
  const std::string reason =
      "build-path-library: 'nowhere' is neither a file nor one of the machines";
  const auto times = [](const std::string& text, const std::string& part) {
    int count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  };
  for (const int others : {1, 3}) {
    EXPECT_EQ(run_ranks(ranks(1, "zx120") + " : " + ranks(others, "nowhere"), folder_.file("said")),
              2);
    const std::string said = "\n" + content_of(folder_.file("said"));
    EXPECT_EQ(times(said, reason), 1) << said;
    // mpirun's message on the end of a rank may come before that of the rank.
    int speakers = 0;
    for (int rank = 1; rank <= others; ++rank) {
      speakers += times(said, "\nrank " + std::to_string(rank) + ": " + reason);
    }
    EXPECT_EQ(speakers, 1) << said;
  }
  EXPECT_EQ(run_ranks(ranks(3, "nowhere"), folder_.file("said")), 2);
  const std::string said = content_of(folder_.file("said"));
  EXPECT_EQ(times(said, reason), 1) << said;
  const std::string program = std::string(EXCAVPLAN_BIN) + "/build-path-library --densities 20 ";
  EXPECT_EQ(run_ranks("-n 1 " + program + "--out " + out_ + " : -n 1 " + program +
                          "--seed 2 --out " + out_,
                      folder_.file("said")),
            2);
  EXPECT_EQ(times(content_of(folder_.file("said")), "give all of them the same options"), 1);
#endif
}

}  // namespace
}  // namespace excavplan::test
