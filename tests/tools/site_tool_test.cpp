// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "support/tool_answers.hpp"

/// @file
/// --site of estimate-density and plan-path: digs in a row that are remembered.

namespace excavplan::test {
namespace {

/// Digs of simulate-dig in a row, each with a scan before and after it and its result.
class SiteTool : public Tools {
 protected:
  std::string dig(int number) {
    const std::string name = folder.file(std::to_string(number));
    Words words = {"--density", "55",           "--before",     name + "a.xyz",
                   "--after",   name + "b.xyz", "--ground-out", name + ".tif"};
    if (number > 1)
      words = words + Words{"--ground", folder.file(std::to_string(number - 1) + ".tif")};
    folder.write(std::to_string(number) + ".json", answer("simulate-dig", words).dump());
    return name;
  }
  std::string site() const { return folder.file("pit"); }
};

TEST_F(SiteTool, DigsInARowAreRemembered) {
  const std::string one = dig(1);
  const json begun =
      answer("estimate-density", {one + "a.xyz", "--site", site(), "--soil", "loam"});
  EXPECT_EQ(begun.at("site").at("updates"), 1);
  EXPECT_EQ(begun.at("density_percent"), nullptr);
  EXPECT_TRUE(begun.at("site").at("density_percent").is_null());
  const json first = answer("estimate-density", {one + "b.xyz", "--site", site(), "--soil", "loam",
                                                 "--dug", one + ".json"});
  expect_keys(first, "number",
              {"density_percent", "bulking_factor", "volume/excavated_m3", "site/digs",
               "site/density_percent", "site/density_sd_percent"});
  EXPECT_EQ(first.at("site").at("digs"), 1);
  EXPECT_NEAR(first.at("site").at("density_percent"), 55.0, 15.0);
  const std::string two = dig(2);
  const json second = answer("estimate-density", {two + "b.xyz", "--site", site(), "--soil", "loam",
                                                  "--dug", two + ".json"});
  EXPECT_EQ(second.at("site").at("updates"), 3);
  const json plan = answer("plan-path", {"--site", site()});
  expect_keys(plan, "number", path_keys + cost_keys + Words{"density_percent", "site/digs"});
  EXPECT_EQ(plan.at("density_percent"), plan.at("site").at("density_percent"));
}

TEST_F(SiteTool, UndoLookAndShow) {
  const std::string one = dig(1);
  const Words words = {one + "b.xyz", "--site", site(), "--soil", "loam"};
  answer("estimate-density", Words{one + "a.xyz"} + words);
  EXPECT_EQ(answer("estimate-density", {"--site", site()}).at("site").at("digs"), 1);
  const ProgramResult twice = run_program("estimate-density", words);
  EXPECT_EQ(twice.code, 2);
  EXPECT_TRUE(contains(twice.err, "this scan is in the site already")) << twice.err;
  EXPECT_EQ(answer("estimate-density", {"--site", site(), "--undo"}).at("site").at("updates"), 0);
  answer("estimate-density", Words{one + "a.xyz"} + Words{"--site", site(), "--soil", "loam"});
  const json looked = answer("estimate-density", words + Words{"--no-update"});
  EXPECT_EQ(looked.at("site").at("digs"), 1);
  EXPECT_EQ(answer("estimate-density", {"--site", site()}).at("site").at("updates"), 1);
}

TEST_F(SiteTool, WhatDoesNotGoTogetherIsRefused) {
  const std::string one = dig(1);
  const auto refused = [](const std::string& tool, const Words& words, const std::string& why) {
    const ProgramResult result = run_program(tool, words);
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, why)) << result.err;
  };
  answer("estimate-density", {one + "a.xyz", one + "b.xyz", "--site", site(), "--soil", "loam"});
  refused("plan-path", {"--site", site(), "--density", "40"}, "exclude --site");
  refused("plan-path", {"--site", site(), "--soil", "clay"}, "the site is of soil 'loam'");
  refused("estimate-density", {one + "a.xyz", "--site", site(), "--soil", "clay"},
          "the site is of soil 'loam'");
  refused("estimate-density", {one + "a.xyz", "--site", site(), "--soil", "unknown"},
          "a site is of one soil");
  refused("estimate-density", {one + "a.xyz", "--site", site(), "--method", "paper"},
          "--site excludes");
  refused("estimate-density", {"--site", site(), "--undo", one + "a.xyz"}, "--undo takes no scans");
  refused("estimate-density", {one + "a.xyz", "--site", site(), "--base", "1,2"}, "X,Y,HEADING");
  refused("estimate-density", {one + "a.xyz", "--site", site(), "--base", "1,2,90"}, "a turn");
  EXPECT_EQ(run_program("plan-path", {"--site", folder.file("nowhere")}).code, 3);
}

}  // namespace
}  // namespace excavplan::test
