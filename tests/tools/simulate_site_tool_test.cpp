// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/ground/ascii_grid.hpp>

#include "site/cell_codes.hpp"
#include "support/plain_site_folder.hpp"
#include "support/report_page.hpp"
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

/// Heights that a page draws after its last step [mm], row by row.
Eigen::ArrayXXi last_heights(const json& drawn) {
  const Eigen::Index rows = drawn["rows"], cols = drawn["cols"];
  Eigen::ArrayXXi z = sums_of(*numbers_of(drawn["before"].get<std::string>(), rows, cols));
  for (const json& event : drawn["events"]) {
    const json& block = event["ground"];
    if (block.is_null()) continue;
    const Eigen::Index height = block["rows"], width = block["cols"];
    z.block(block["row"], block["col"], height, width) +=
        *numbers_of(block["codes"].get<std::string>(), height, width);
  }
  return z;
}

TEST(SimulateSite, ThePagePlaysTheLogToTheGroundAfter) {
  PlainSiteFolder folder;
  folder.site["design"]["length_m"] = 2.0;
  folder.read();
  const std::string log = folder.path() + "/log.jsonl", ground = folder.path() + "/after.asc",
                    page = folder.path() + "/page.html";
  const json found = answer("simulate-site", {folder.path(), "--planner", "operator", "--log", log,
                                              "--ground-after", ground, "--report", page});
  const std::string text = content_of(page);
  EXPECT_EQ(json::parse(result_on(text)), found);
  const json drawn = drawn_on(text);
  double energy = 0.0, time = 0.0;
  std::size_t count = 0;
  for (const json& line : lines_of(log)) {
    if (line["type"] == "end") continue;
    const json& event = drawn["events"].at(count++);
    EXPECT_EQ(event["time_s"], line["time_s"]);
    if (line["type"] != "dig") continue;
    EXPECT_EQ(event["payload_kg"], line["payload_kg"]);
    EXPECT_EQ(event["energy_j"], line["energy_j"]);
    EXPECT_EQ(event["stall"], line["stall"]);
  }
  EXPECT_EQ(drawn["events"].size(), count);
  for (const json& event : drawn["events"]) {
    time += event["time_s"].get<double>();
    if (event["energy_j"].is_number()) energy += event["energy_j"].get<double>();
  }
  EXPECT_NEAR(energy / 1000.0, found["energy_kj"].get<double>(), 1e-6);
  EXPECT_NEAR(time / 60.0, found["time_min"].get<double>(), 1e-9);
  EXPECT_NEAR(
      100.0 * drawn["events"].back()["left_m3"].get<double>() / drawn["design_m3"].get<double>(),
      found["left_percent"].get<double>(), 1e-9);
  EXPECT_EQ(drawn["design_m3"], found["design_cut_m3"]);

  const HeightMap after = read_ascii_grid(ground);
  const Eigen::ArrayXXi heights = last_heights(drawn);
  const double cell = drawn["cell_m"], x0 = drawn["origin_m"][0], y0 = drawn["origin_m"][1];
  ASSERT_EQ(cell, 2.0 * after.cell_size);
  for (Eigen::Index row = 0; row < heights.rows(); ++row) {
    for (Eigen::Index col = 0; col < heights.cols(); ++col) {
      // Between four cells: their mean.
      const double x = x0 + cell * (static_cast<double>(col) + 0.5);
      const double y = y0 + cell * (static_cast<double>(row) + 0.5);
      ASSERT_NEAR(heights(row, col) / 1000.0, height_at(after, x, y), 0.00051) << x << ' ' << y;
    }
  }
}

/// In ground that has its shape already, so that it is soon over.
TEST(SimulateSite, AMachineWithoutALawOfItsOwnIsPlayed) {
  PlainSiteFolder folder;
  folder.height = [](double x, double y) {
    return x > 2.0 && x < 6.0 && std::abs(y) < 0.5 ? -0.4 : 0.0;
  };
  json machine = json::parse(content_of(EXCAVPLAN_DATA_SOURCE "/machines/zx120.json"));
  machine["name"] = "other";
  folder.site["machine"]["class"] = folder.path() + "/other.json";
  std::ofstream(folder.path() + "/other.json") << machine;
  folder.read();
  const json found = answer("simulate-site", {folder.path()});
  EXPECT_EQ(found["digs"], 0);
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
