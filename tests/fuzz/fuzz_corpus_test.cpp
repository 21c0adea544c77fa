// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <gtest/gtest.h>

#include "base/json.hpp"
#include "fuzz/file_readers.hpp"
#include "fuzz/fuzz_target.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using test::FuzzTarget;

/// The inputs of the fuzz targets, those that once found something among them.
class Corpus : public testing::TestWithParam<FuzzTarget> {};

TEST_P(Corpus, HoldsNothingThatBreaks) {
  const std::filesystem::path folder(EXCAVPLAN_FUZZ_CORPUS "/" + GetParam().name);
  int inputs = 0;
  for (const auto& input : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(input.path());
    EXPECT_NO_THROW(GetParam().run(test::content_of_file(input.path())));
    ++inputs;
  }
  EXPECT_GT(inputs, 0);
}

// A fuzzer that starts from files of an earlier version finds none of the present one:
// write-corpus.
TEST(CorpusOfReaders, ValidFilesAreRead) {
  const test::TemporaryFolder folder;
  for (const auto& readers : {test::file_readers(), test::design_readers(), test::job_readers()}) {
    for (const test::FileReader& reader : readers) {
      const std::filesystem::path inputs(EXCAVPLAN_FUZZ_CORPUS "/" + reader.name);
      for (const auto& input : std::filesystem::directory_iterator(inputs)) {
        const std::string name = input.path().filename();
        if (name.rfind("valid-", 0) != 0) continue;
        const std::string bytes = test::content_of_file(input.path());
        const std::string path = folder.write("file", reader.sealed ? sealed(bytes) : bytes);
        EXPECT_NO_THROW(reader.read(path)) << reader.name << '/' << name;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(test::fuzz_targets()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace excavplan
