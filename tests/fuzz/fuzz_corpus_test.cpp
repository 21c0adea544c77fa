// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <gtest/gtest.h>

#include "fuzz/file_readers.hpp"
#include "fuzz/fuzz_target.hpp"

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

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(test::fuzz_targets()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace excavplan
