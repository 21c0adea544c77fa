// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>

#include "bad_files/bad_file.hpp"
#include "bad_files/run_bad_files.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using test::BadFileTally;
using test::FileReader;

/// Every format but texts of the command line.
std::vector<FileReader> readers() {
  std::vector<FileReader> readers = test::file_readers();
  readers.erase(std::remove_if(readers.begin(), readers.end(),
                               [](const FileReader& reader) { return reader.name == "option"; }),
                readers.end());
  return readers;
}

class BadFiles : public testing::TestWithParam<FileReader> {};

// Every third; scripts/check.d/45-bad-files reads all of them.
TEST_P(BadFiles, AreRefusedOrReadAsTheyAre) {
  const BadFileTally tally = test::run_bad_files(GetParam(), 3);
  EXPECT_EQ(tally.wrong(), 0) << test::report_of({tally});
  EXPECT_GT(tally.refused, 5);
}

// Of short ones every byte, where the last numbers are a part that counts.
TEST_P(BadFiles, CutOrWithAFlippedBitAreNoticedOrReadAsTheyAre) {
  const bool is_short = test::valid_files(GetParam().name).front().size() <= 150;
  const BadFileTally tally = test::run_sweeps(GetParam(), is_short ? 1 : 41);
  EXPECT_EQ(tally.wrong(), 0) << test::report_of({tally});
}

TEST_P(BadFiles, AreMany) {
  const bool is_cloud = GetParam().name == "pcd" || GetParam().name == "ply";
  EXPECT_GE(test::bad_files(GetParam().name).size(), is_cloud ? 100U : 40U);
}

TEST(ValidJobFiles, AreRead) {
  const test::TemporaryFolder folder;
  for (const FileReader& reader : test::job_readers()) {
    for (const std::string& bytes : test::valid_job_files(reader.name)) {
      EXPECT_NO_THROW(reader.read(folder.write(reader.name, bytes))) << reader.name;
    }
  }
}

// Its reader puts grids beside a file.
TEST(BadPlainGround, WithoutANameLeavesNothingWhereTheProgramRuns) {
  namespace fs = std::filesystem;
  const test::TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.file(""));
  EXPECT_THROW(test::reader_of("plain_ground").read(""), Error);
  EXPECT_TRUE(fs::is_empty(folder.file("")));
  fs::current_path(before);
}

INSTANTIATE_TEST_SUITE_P(Files, BadFiles, testing::ValuesIn(readers()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace excavplan
