// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/ground/ascii_grid.hpp>

#include "support/plain_site_folder.hpp"
#include "support/tool_answers.hpp"

namespace excavplan::test {
namespace {

using nlohmann::json;

/// The lines of a log without what the clock says.
std::vector<json> lines_of(const std::string& file) {
  std::istringstream text(content_of(file));
  std::vector<json> lines;
  for (std::string line; std::getline(text, line);) {
    lines.push_back(json::parse(line));
    lines.back().erase("plan_s");
  }
  return lines;
}

TEST(SimulateSite, APolicyPlaysAJobWithLogAndGround) {
  const PlainSiteFolder folder;
  folder.read();
  const std::string log = folder.path() + "/log.jsonl", ground = folder.path() + "/after.asc";
  const auto play = [&] {
    return answer("simulate-site",
                  {folder.path(), "--planner", "operator", "--log", log, "--ground-after", ground});
  };
  const json found = play();
  for (const char* key : {"finished", "rms_m", "p95_m", "overdig_percent", "spill_percent", "digs",
                          "moves", "stalls", "energy_kj_per_design_m3", "time_min", "planning_s"}) {
    EXPECT_TRUE(found.contains(key)) << key;
  }
  const std::vector<json> first = lines_of(log);
  int digs = 0;
  double time = 0.0;
  for (const json& line : first) {
    digs += line["type"] == "dig" ? 1 : 0;
    time += line.value("time_s", 0.0);
  }
  EXPECT_EQ(found["digs"], digs);
  EXPECT_NEAR(found["time_min"].get<double>(), time / 60.0, 1e-6);
  EXPECT_EQ(first.back()["type"], "end");
  const HeightMap after = read_ascii_grid(ground);
  EXPECT_EQ(after.cell_size, 0.025);
  EXPECT_LT(height_at(after, 4.0, 0.0), -0.2);
  const std::string bytes = content_of(ground);
  play();
  EXPECT_EQ(lines_of(log), first);
  EXPECT_EQ(content_of(ground), bytes);
}

TEST(SimulateSite, TheBoundIsBelowTheReference) {
  const PlainSiteFolder folder;
  folder.read();
  const json found = answer("simulate-site", {folder.path(), "--bound"});
  EXPECT_GT(found["reference_kj_per_design_m3"], found["bound_kj_per_design_m3"]);
  EXPECT_NEAR(found["design_cut_m3"].get<double>(), 1.6, 1e-6);
}

}  // namespace
}  // namespace excavplan::test
