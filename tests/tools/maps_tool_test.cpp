// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/tool_answers.hpp"

/// @file
/// --map of the tools. What the files hold is looked at by map_programs.py and map_files_test.cpp.

namespace excavplan::test {
namespace {

TEST_F(Tools, MapWithoutNameHasAllLayers) {
  const std::string file = folder.file("dig.ply");
  answer("simulate-dig", {"--density", "40", "--map", file});
  const std::string head = content_of(file).substr(0, 1000);
  for (const std::string layer : {"height_before_m", "height_after_m", "change_m"}) {
    EXPECT_TRUE(contains(head, "property double scalar_" + layer + "\n")) << head;
  }
}

std::vector<double> cells_of_grid(const std::string& file) {
  std::istringstream text(content_of(file));
  std::string line, key;
  std::vector<double> cells;
  while (std::getline(text, line)) {
    if (std::isalpha(static_cast<unsigned char>(line[0])) != 0) continue;
    std::istringstream row(line);
    for (double cell; row >> cell;) cells.push_back(cell);
  }
  return cells;
}

TEST_F(Tools, GroundThatNoScanSawIsInNoZoneAndNotUnchanged) {
  const std::string zones = folder.file("zones.asc"), change = folder.file("change.asc");
  answer("estimate-density", {shipped("quickstart/before.pcd"), shipped("quickstart/after.pcd"),
                              "--map", "zones=" + zones, "--map", "change=" + change});
  const std::vector<double> kinds = cells_of_grid(zones), heights = cells_of_grid(change);
  ASSERT_EQ(kinds.size(), heights.size());
  ASSERT_FALSE(kinds.empty());
  constexpr double unknown = -9999.0;
  std::size_t unseen = 0;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (heights[i] == unknown && kinds[i] == unknown) ++unseen;
    EXPECT_NE(kinds[i], heights[i] == unknown ? 0.0 : unknown) << i;
  }
  EXPECT_GT(unseen, 0U);
}

TEST_F(Tools, WithoutADigThereIsTheGroundAlone) {
  const Words plan = {"--density", "40",
                      "--map",     "before=" + folder.file("before.asc"),
                      "--map",     "path=" + folder.file("dig.dxf")};
  const Words none = {"--search",      "--evaluations", "5",
                      "--angle-range", "1.4,1.4",       "--penetration-range",
                      "0.9,0.9",       "--drag-range",  "3,3"};
  EXPECT_FALSE(warns(answer("plan-path", plan + none), "map_not_written"));
  EXPECT_TRUE(fs::exists(folder.file("before.asc")));
  EXPECT_FALSE(fs::exists(folder.file("dig.dxf")));
  EXPECT_FALSE(warns(answer("plan-path", plan), "map_not_written"));
  EXPECT_TRUE(warns(answer("plan-path", plan + none), "map_not_written"));
}

TEST_F(BadInput, MapsAreRefusedBeforeTheWork) {
  const auto map = [&](const std::string& name) { return Words{"--density", "40", "--map", name}; };
  refused(2, "--map all: 'a.png' must end in .tif or .ply or .asc", "simulate-dig", map("a.png"));
  refused(2, "--map all: 'a.asc' would hold 3 layers, .asc holds one", "simulate-dig",
          map("a.asc"));
  refused(2, "--map path: 'a.asc' must end in .dxf or .ply", "plan-path", map("path=a.asc"));
  refused(2, "--map change: 'a.dxf' must end in .tif or .ply or .asc", "plan-path",
          map("change=a.dxf"));
  refused(2, "--map: there is no map 'chnge', expected one of all, before, after, change",
          "simulate-dig", map("chnge=a.ply"));
  refused(2, "--map: change= names no file", "simulate-dig", map("change="));
  refused(2, "--map: =a.tif has an empty name before its '='", "simulate-dig", map("=a.tif"));
  refused(2, "--map and --map name the same file", "simulate-dig",
          map("after=a.ply") + Words{"--map", "a.ply"});
  refused(2, "--map: no map 'dump-sd': the dump area has no scans of its own", "estimate-density",
          {scan, later_scan, "--map", "dump-sd=" + folder.file("a.asc")});
  refused(3, "there is no folder", "simulate-dig", map(folder.file("no/a.ply")));
  const std::string full = folder.file("full.ply");
  fs::create_symlink("/dev/full", full);
  refused(3, "cannot be written: No space left on device", "simulate-dig", map("before=" + full));
}

}  // namespace
}  // namespace excavplan::test
