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

TEST_F(SiteTool, LooksFromSeveralPlacesAreOneScan) {
  const std::string scan = folder.file("look");
  answer("simulate-dig", {"--density", "55", "--setup", "cab-lidar", "--each-look", "--before",
                          scan + "-a.pcd", "--after", scan + "-b.pcd", "--base=-1,0"});
  const auto looks = [&](const std::string& name, const std::string& option) {
    return Words{option, name + "-2.pcd", option, name + "-3.pcd"};
  };
  const Words pair = {scan + "-a.pcd", scan + "-b.pcd", "--soil", "loam"};
  const json whole = answer("estimate-density", pair + looks(scan + "-a", "--before-also") +
                                                    looks(scan + "-b", "--after-also"));
  const auto has_code = [](const json& result, const std::string& code) {
    for (const json& warning : result.at("warnings")) {
      if (warning.at("code") == code) return true;
    }
    return false;
  };
  EXPECT_TRUE(whole.at("trustworthy")) << whole.at("warnings");
  EXPECT_FALSE(has_code(whole, "sensor_place_inferred"));
  EXPECT_NEAR(whole.at("density_percent"), 55.0, 12.0);
  EXPECT_TRUE(contains(content_of(scan + "-a.pcd").substr(0, 300), "VIEWPOINT -0.4 0.7 4.2"));
  const auto refused = [&](const Words& words, const std::string& text) {
    const ProgramResult result = run_program("estimate-density", pair + words);
    EXPECT_EQ(result.code, 2);
    EXPECT_TRUE(contains(result.err, text)) << result.err;
  };
  refused({"--after-also", scan + "-b.pcd"}, "-b.pcd is given twice");
  refused({"--after-also", scan + "-b-2.pcd", "--sensor-origin", "1,1,4"},
          "--after-also excludes --sensor-origin");
  const ProgramResult ply =
      run_program("simulate-dig", {"--density", "55", "--each-look", "--after", scan + ".ply"});
  EXPECT_EQ(ply.code, 2);
  EXPECT_TRUE(contains(ply.err, "must end in .pcd")) << ply.err;
  const ProgramResult alone =
      run_program("estimate-density", Words{scan + "-b.pcd", "--site", site(), "--soil", "loam"} +
                                          looks(scan + "-a", "--before-also"));
  EXPECT_EQ(alone.code, 2);
  EXPECT_TRUE(contains(alone.err, "--before-also needs BEFORE")) << alone.err;
}

TEST_F(SiteTool, WhereTheBucketWasEmptiedIsToldOfADig) {
  const std::string one = dig(1);
  const Words words = {one + "b.xyz", "--site", site(), "--soil", "loam"};
  answer("estimate-density", {one + "a.xyz", "--site", site(), "--soil", "loam"});
  const ProgramResult untold = run_program("estimate-density", words + Words{"--dump-at", "3,3"});
  EXPECT_EQ(untold.code, 2);
  EXPECT_TRUE(contains(untold.err, "--dump-at needs --dug")) << untold.err;
  const Words look = words + Words{"--dug", one + ".json", "--no-update"};
  const json told = answer("estimate-density", look);
  const ProgramResult elsewhere =
      run_program("estimate-density", look + Words{"--dump-at", "3,-3", "--json"});
  ASSERT_EQ(elsewhere.code, 0) << elsewhere.err;
  const auto rose = [](const json& result) {
    return result.at("volume").at("spilled_m3").get<double>() +
           result.at("volume").at("dumped_m3").get<double>();
  };
  EXPECT_GT(rose(told) - rose(json::parse(elsewhere.out)), 0.1);
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
