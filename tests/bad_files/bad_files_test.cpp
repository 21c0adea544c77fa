// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "bad_files/run_bad_files.hpp"

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

TEST_P(BadFiles, CutOrWithAFlippedBitAreNoticedOrReadAsTheyAre) {
  const BadFileTally tally = test::run_sweeps(GetParam(), 41);
  EXPECT_EQ(tally.wrong(), 0) << test::report_of({tally});
}

TEST_P(BadFiles, AreMany) {
  const bool is_cloud = GetParam().name == "pcd" || GetParam().name == "ply";
  EXPECT_GE(test::bad_files(GetParam().name).size(), is_cloud ? 100U : 40U);
}

INSTANTIATE_TEST_SUITE_P(Files, BadFiles, testing::ValuesIn(readers()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace excavplan
