// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/tool_answers.hpp"

/// @file
/// inspect-cloud: what is in a scan, and scans written in other formats.

namespace excavplan::test {
namespace {

TEST_F(Tools, InspectCloudGivesTheKeysOfTheContract) {
  const std::string file = folder.write("three.xyz", "0 0 0\n2 0 1\nnan nan nan\n1 3 2\n");
  const json result = answer("inspect-cloud", {file});
  EXPECT_EQ(result.at("points"), 4);
  EXPECT_EQ(result.at("width"), 4);
  EXPECT_EQ(result.at("height"), 1);
  EXPECT_EQ(result.at("finite_points"), 3);
  EXPECT_EQ(result.at("centroid_m"), json({1.0, 1.0, 1.0}));
  EXPECT_EQ(result.at("min_m"), json({0.0, 0.0, 0.0}));
  EXPECT_EQ(result.at("max_m"), json({2.0, 3.0, 2.0}));
}

TEST_F(Tools, CloudsKeepTheirPointsInEveryFormat) {
  std::string last = shipped("quickstart/before.pcd");
  const json original = answer("inspect-cloud", {last});
  for (const char* name : {"a.ply", "b.xyz", "c.pcd", "d.asc"}) {
    const std::string next = folder.file(name);
    answer("inspect-cloud", {last, "--out", next});
    last = next;
  }
  const json copy = answer("inspect-cloud", {last});
  for (const char* key : {"finite_points", "centroid_m", "min_m", "max_m"}) {
    EXPECT_EQ(copy.at(key), original.at(key)) << key;
  }
}

TEST_F(RealScans, AreRead) {
  for (const auto& [file, points] :
       std::vector<std::pair<std::string, int>>{{"site-terrain/terrain.pcd", 56758},
                                                {"dig-pair-livox/before.pcd", 100645},
                                                {"dig-pair-livox/after.pcd", 87900}}) {
    const json cloud = answer("inspect-cloud", {shared(file)});
    EXPECT_EQ(cloud.at("points"), points) << file;
    EXPECT_EQ(cloud.at("finite_points"), points) << file;
  }
  const json site = answer("inspect-cloud", {terrain});
  EXPECT_NEAR(number(site, "/min_m/2"), -3.7, 0.05);
  EXPECT_NEAR(number(site, "/max_m/2"), 8.1, 0.05);
}

}  // namespace
}  // namespace excavplan::test
