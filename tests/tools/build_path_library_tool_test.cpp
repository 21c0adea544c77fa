// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/tool_answers.hpp"

/// @file
/// build-path-library: its answer, and the same file for any threads and after an interrupt.

namespace excavplan::test {
namespace {

TEST_F(Tools, BuildPathLibraryGivesTheKeysOfTheContract) {
  const json result =
      answer("build-path-library",
             Words{"--densities", "20,60", "--out", folder.file("l.json")} + small_library);
  expect_keys(result, "number", {"wall_time_s"});
  EXPECT_GT(result.at("evaluations").get<int>(), 0);
  ASSERT_EQ(result.at("entries").size(), 2U);
  for (const json& entry : result["entries"]) {
    expect_keys(entry, "number", path_keys + cost_keys + Words{"density_percent"});
  }
}

TEST_F(Tools, ALibraryHoldsItsGoal) {
  const Words words =
      Words{"--densities", "20", "--out", folder.file("l.json"), "--swing", "2"} + small_library;
  const json cycle = answer("build-path-library", words);
  EXPECT_EQ(cycle.at("goal"), "cycle");
  EXPECT_EQ(cycle.at("goal_parameters").at("swing_rad"), 2.0);
  const Words plan = {"--density", "20", "--library", folder.file("l.json")};
  EXPECT_EQ(answer("plan-path", plan + Words{"--swing", "2"}).at("path"),
            cycle.at("entries").at(0).at("path"));
  EXPECT_EQ(run_program("plan-path", plan).code, 2);
  EXPECT_EQ(run_program("plan-path", plan + Words{"--goal", "energy"}).code, 2);
}

TEST_F(Tools, LibraryIsTheSameForAnyNumberOfThreads) {
  const std::string file = folder.file("library.json");
  const auto library = [&](const char* threads, const char* seed) {
    return answer("build-path-library", Words{"--densities", "20,60", "--threads", threads,
                                              "--seed", seed, "--out", file} +
                                            small_library)
        .at("entries");
  };
  const json entries = library("1", "5");
  const std::string bytes = content_of(file);
  EXPECT_EQ(json::parse(bytes).at("entries"), entries);
  for (const char* threads : {"2", "8"}) {
    library(threads, "5");
    EXPECT_EQ(content_of(file), bytes) << threads;
  }
  EXPECT_NE(library("1", "6"), entries);
}

TEST_F(Tools, InterruptedLibraryIsResumedToTheSameBytes) {
  const auto words = [&](const std::string& file) {
    return Words{"--densities", "0:5:100", "--out", folder.file(file)} + small_library;
  };
  const ProgramResult stopped = interrupted("build-path-library", words("resumed"), " densities, ");
  EXPECT_EQ(stopped.code, 75) << stopped.err;
  EXPECT_FALSE(fs::exists(folder.file("resumed")));

  const json resumed = answer("build-path-library", words("resumed") + Words{"--resume"});
  EXPECT_EQ(resumed.at("entries").size(), 21U);
  answer("build-path-library", words("at once"));
  EXPECT_EQ(content_of(folder.file("resumed")), content_of(folder.file("at once")));
}

}  // namespace
}  // namespace excavplan::test
