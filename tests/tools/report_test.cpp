// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include <excavplan/base/data_files.hpp>
#include <excavplan/sensing/scene.hpp>

#include "drawing/plot.hpp"
#include "report/dig_report.hpp"
#include "report/report_figures.hpp"
#include "support/report_page.hpp"

/// @file
/// The page of --report as text; report_page.py opens it in a browser.

namespace excavplan::tools {
namespace {

using nlohmann::json;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

ReportedRun plain_run() {
  ReportedRun run;
  run.tool = "simulate-dig";
  run.version = "1.2.3";
  run.json = R"({"tool": "simulate-dig", "density_percent": 41.515, "density_sd_percent": 3.1})";
  run.lines = {"density 41.5"};
  run.settings = {{"--density", "40", true}, {"--soil", "loam", false}};
  return run;
}

HeightMap bumpy(double width, double height, double cell) {
  HeightMap map = flat_ground({0.0, 0.0, width, height}, cell);
  for (Eigen::Index i = 0; i < map.z.size(); ++i)
    map.z(i) = 0.4 * std::sin(0.37 * static_cast<double>(i));
  return map;
}

Report survey_page(const HeightMap& before, const HeightMap& after) {
  Report report;
  report.title = "Survey";
  report.headline = {"density_percent", "not.there"};
  report.plot = "<?xml?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>";
  report.scene.areas = {{{{"before", before}, {"after", after}}}};
  return report;
}

/// What the page says besides the scripts that are shipped, the last two.
std::string own_text(const std::string& page) {
  std::string text = page;
  for (int i = 0; i < 2; ++i) {
    const std::size_t start = text.rfind("<script nonce=");
    text.erase(start, text.find("</script>", start) + 9 - start);
  }
  return text;
}

TEST(ReportPage, LoadsNothing) {
  const std::string page = html_page(survey_page(bumpy(1, 1, 0.1), bumpy(1, 1, 0.1)), plain_run());
  EXPECT_TRUE(contains(page, "default-src 'none'"));
  const std::string text = own_text(page);
  EXPECT_TRUE(contains(text, "href=\"data:,\""));
  for (const char* foreign : {"src=\"", "href=\"http", "href=\"/", "@import", "url(", "<iframe",
                              "<object", "<embed", "<img", "fetch("}) {
    EXPECT_FALSE(contains(text, foreign)) << foreign;
  }
}

TEST(ReportPage, OneWithoutGroundIsShortAndSaysOnlyWhatWasGiven) {
  Report report;
  report.title = "Estimate";
  report.plot = "<svg></svg>";
  report.plot_always = true;
  ReportedRun run = plain_run();
  run.json = R"({"digs": 9, "digs_interval": [7, 12], "spread_percent": {"digs": {"density": 8.25,
    "played_jobs": 10}, "time_min": {"density": 4, "played_jobs": 11}}})";
  report.headline = {"digs"};
  const std::string page = html_page(report, run);
  EXPECT_LT(page.size(), 60000U);
  EXPECT_TRUE(contains(page, "95 % interval 7 .. 12"));
  EXPECT_TRUE(contains(page, "<code>--density</code>"));
  EXPECT_FALSE(contains(page, "<code>--soil</code>"));
  EXPECT_TRUE(contains(page, "<h3>Spread [%]</h3>"));
  EXPECT_TRUE(contains(page, "data-key=\"spread_percent.time_min.played_jobs\""));
  run.settings.clear();
  run.lines.clear();
  const std::string bare = html_page(report, run);
  EXPECT_FALSE(contains(bare, "id=\"settings\""));
  EXPECT_FALSE(contains(bare, "id=\"printed\""));
}

TEST(ReportPage, RunsNoScriptOfItsTexts) {
  const std::string evil =
      "</script><script>alert(1)</script><img src=x onerror=alert(1)>\"'&{{title}}\x1b\xff";
  Report report = survey_page(bumpy(1, 1, 0.1), bumpy(1, 1, 0.1));
  report.title = evil;
  report.note = evil;
  report.scene.areas[0].states[0].name = evil;
  ReportedRun run = plain_run();
  run.tool = evil;
  run.json = nlohmann::ordered_json({{"soil", "</pre></script><script>alert(1)</script>"},
                                     {"<img src=x>", 1.0},
                                     {"zones", {{{"<img src=x>", "<img src=y>"}}}}})
                 .dump(2);
  run.lines = {evil};
  run.warnings = {{WarningCode::units, evil}};
  run.settings = {{evil, evil, true}};
  const std::string text = own_text(html_page(report, run));
  for (const char* markup : {"<script>", "<img", "\x1b", "\xff", "</pre></script>"}) {
    EXPECT_FALSE(contains(text, markup)) << markup;
  }
  EXPECT_EQ(test::drawn_on(text)["areas"][0]["states"][0]["name"].get<std::string>().substr(0, 9),
            "</script>");
}

Report job_page(const std::string& text) {
  JobHistory start;
  start.before = flat_ground({0.0, 0.0, 8.0, 6.0}, 0.1);
  start.target = flat_ground({0.0, 0.0, 8.0, 6.0}, 0.1, -0.3);
  start.seen_at = start.before.z;
  start.design.start = BasePose{2.0, 3.0, 0.0, 0.0};
  start.design.keep_out = {{text, {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}}}};
  start.design.obstacles = {{text, {{5.0, 1.0}, {6.0, 1.0}, {6.0, 2.0}}, 1.0}};
  JobRecorder recorder(start);
  JobEvent event;
  event.what = JobAction::dig;
  event.reason = text;
  event.warnings = {{WarningCode::units, text}};
  JobHistory::Ground after = recorder.now();
  after.surface.z(30, 40) = -0.2;
  recorder.add(event, after);
  Report report;
  report.title = text;
  report.state = text;
  report.note = text;
  report.job = ReportJob{recorder.history(), load_machine(find_data_file("machines/zx120.json"))};
  return report;
}

TEST(ReportPage, OfAJobLoadsNothingAndRunsNoScriptOfItsTexts) {
  const std::string text = own_text(
      html_page(job_page("</script><img src=x onerror=alert(1)>{{data}}\x1b\xff"), plain_run()));
  for (const char* foreign : {"<img", "\x1b", "\xff", "src=\"", "href=\"http", "@import", "url("}) {
    EXPECT_FALSE(contains(text, foreign)) << foreign;
  }
  const json drawn = test::drawn_on(text);
  EXPECT_EQ(drawn["design"]["keep_out"][0]["kind"].get<std::string>().substr(0, 9), "</script>");
  EXPECT_EQ(drawn["events"].size(), 1U);
  EXPECT_EQ(drawn["events"][0]["ground"]["rows"], 1);
  EXPECT_TRUE(drawn["events"][0]["seen"].is_null());
}

TEST(ReportPage, ShowsValueErrorIntervalAndUnit) {
  const std::string tables = figure_tables(nlohmann::ordered_json::parse(R"({
      "tool": "t", "version": "1", "warnings": [],
      "density_percent": 41.51522, "density_sd_percent": 3.1026, "density_interval_percent": [35.43, 47.6],
      "volume": {"excavated_m3": 0.26754585, "excavated_sd_m3": 0.0020655},
      "energy": {"by_phase_kj": {"drag": 12.2133}}, "angle_rad": 0.7854, "blocks": null,
      "soils": [{"name": "loam", "weight": 0.31, "density_percent": 41.5, "density_sd_percent": 3.1,
                 "payload": {"bulk_density_kg_per_m3": 1500.0}}]})"));
  for (const char* part :
       {"<td data-key=\"density_percent\" data-value=\"41.51522\" data-sd=\"3.1026\" "
        "class=\"value\">41.5 ± 3.1</td>"
        "<td>%</td><td>35.4 .. 47.6</td>",
        ">0.2675 ± 0.0021</td><td>m³</td>", "By phase, drag", ">12.2</td><td>kJ</td>",
        "rad (45.0°)",
        "<td data-label=\"weight\" data-key=\"soils.0.weight\" data-value=\"0.31\" "
        "class=\"number\">0.310</td>",
        "Loam: payload", "kg/m³", "density [%]"}) {
    EXPECT_TRUE(contains(tables, part)) << part << '\n' << tables;
  }
  EXPECT_FALSE(contains(tables, "blocks"));
  EXPECT_FALSE(contains(tables, "density sd"));
}

TEST(ReportPage, AddsAPlotForAPhoneWithNamesOfItsOwn) {
  Report report =
      survey_page(flat_ground({0.0, 0.0, 1.0, 1.0}, 0.1), flat_ground({0.0, 0.0, 1.0, 1.0}, 0.1));
  Panel panel("", "x", "y");
  panel.line({{0.0, 0.0}, {1.0, 1.0}}, {});
  set_plot(report, {"t", {{panel}}});
  const std::string page = html_page(report, plain_run());
  for (const char* name : {"\"clip0\"", "\"narrow-clip0\"", "url(#narrow-clip0)"}) {
    const std::size_t at = page.find(name);
    ASSERT_NE(at, std::string::npos) << name;
    EXPECT_EQ(page.find(name, at + 1), std::string::npos) << name << " is there twice";
  }
}

TEST(ReportPage, CallsShortKeysByPlainNames) {
  const auto result = nlohmann::ordered_json::parse(R"({"p95_m": 0.08, "overdig_percent": 4.1})");
  EXPECT_TRUE(contains(headline_tiles(result, {"p95_m"}), "<dt>95 % of errors are below</dt>"));
  EXPECT_TRUE(contains(figure_tables(result), ">Dug too deep</th>"));
}

TEST(ReportPage, HeadlineIsOfWhatThereIs) {
  const auto result = nlohmann::ordered_json::parse(
      R"({"cycle": {"energy_kj": 196.7}, "payload_mass_kg": 522.6, "payload_mass_sd_kg": 5.8, "path": null})");
  const std::string tiles =
      headline_tiles(result, {"payload_mass_kg", "cycle.energy_kj", "path.start_x_m", "none"});
  EXPECT_TRUE(contains(tiles, "522.6</span><span class=\"sd\"> ± 5.8</span>"));
  EXPECT_TRUE(contains(tiles, "Cycle energy"));
  EXPECT_EQ(tiles.find("<dt>", tiles.find("Cycle energy")), std::string::npos);

  const auto list =
      nlohmann::ordered_json::parse(R"({"conditions": [{"name": "soft", "gain_percent": 41.7}]})");
  EXPECT_TRUE(contains(headline_tiles(list, {"conditions.0.gain_percent"}), ">Gain, soft<"));
  EXPECT_EQ(headline_tiles(list, {"conditions.1.gain_percent"}), "");
}

TEST(ReportPage, SaysWhetherToTrustAndWhy) {
  const Report report = survey_page(bumpy(1, 1, 0.1), bumpy(1, 1, 0.1));
  ReportedRun run = plain_run();
  EXPECT_TRUE(contains(html_page(report, run), "Done.</strong> No warnings."));
  run.judged = true;
  run.warnings = {{WarningCode::two_surfaces, "two surfaces"}};
  EXPECT_TRUE(contains(html_page(report, run), "Trustworthy.</strong> 1 warning, below."));
  run.trustworthy = false;
  const std::string page = html_page(report, run);
  EXPECT_TRUE(contains(page, "Do not trust this result."));
  EXPECT_TRUE(contains(page, "<code>two_surfaces</code> two surfaces"));
}

TEST(ReportPage, OfAMapOfSixByThreeMetresIsSmall) {
  const HeightMap map = bumpy(6, 3, 0.05);
  const std::string page = html_page(survey_page(map, map), plain_run());
  RecordProperty("bytes", std::to_string(page.size()));
  EXPECT_LT(page.size(), 3000000U);
  EXPECT_LT(page.size() - own_text(page).size(), 800000U) << "scripts";
  EXPECT_EQ(page, html_page(survey_page(map, map), plain_run()));
}

std::vector<std::uint8_t> bytes_of(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(word >> bits & 255U));
  }
  return bytes;
}

TEST(ReportScene, KeepsHeights) {
  HeightMap map = bumpy(1.1, 0.7, 0.1);
  map.z += 812.0;
  map.z(3, 2) = std::numeric_limits<double>::quiet_NaN();
  ReportScene scene;
  scene.areas = {{{{"before", map}}}};
  const json area = to_json(scene)["areas"][0];
  const json state = area["states"][0];
  const auto bytes = bytes_of(state["codes"]);
  ASSERT_EQ(bytes.size(), 2U * 7U * 11U);
  for (Eigen::Index row = 0; row < 7; ++row) {
    for (Eigen::Index col = 0; col < 11; ++col) {
      const auto at = static_cast<std::size_t>(2 * (row * 11 + col));
      const int code = bytes[at] | bytes[at + 1] << 8;
      if (row == 3 && col == 2) {
        EXPECT_EQ(code, 65535);
        continue;
      }
      EXPECT_NEAR(state["base_m"].get<double>() + code * state["step_m"].get<double>(),
                  map.z(row, col), 0.00006);
    }
  }
}

TEST(ReportScene, CoarsensWhatIsTooLargeToDraw) {
  ReportScene scene;
  scene.areas = {{{{"before", flat_ground({0, 0, 100, 60}, 0.1, 2.0)}}}};
  scene.areas[0].zone = Eigen::ArrayXXi::Constant(600, 1000, -1);
  scene.areas[0].zone.topRows(300) = 0;
  const json area = to_json(scene)["areas"][0];
  EXPECT_EQ(area["rows"], 300);
  EXPECT_EQ(area["cols"], 500);
  EXPECT_NEAR(area["cell_m"].get<double>(), 0.2, 1e-12);
  EXPECT_NEAR(area["states"][0]["base_m"].get<double>(), 2.0, 1e-12);
  const auto zones = bytes_of(area["zone"]);
  EXPECT_EQ(zones.front(), 0);
  EXPECT_EQ(zones.back(), 255);
}

TEST(ReportScene, NothingKnownIsNoError) {
  HeightMap map = flat_ground({0, 0, 1, 1}, 0.1);
  map.z.setConstant(std::numeric_limits<double>::quiet_NaN());
  ReportScene scene;
  scene.areas = {{{{"before", map}}}};
  EXPECT_EQ(to_json(scene)["areas"][0]["states"][0]["base_m"], 0.0);
}

DigScene dig(const char* soil, double density) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  SceneOptions options;
  options.history = true;
  const Terrain ground = undisturbed(flat_ground(scene_extent(machine, options.dump_at), 0.05));
  return run_scene(machine, load_soil(find_data_file(std::string("soils/") + soil + ".json")),
                   density, ground, options);
}

TEST(ReportScene, EnergyOfTheChartIsThatOfTheResult) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const DigScene scene = dig("loam", 40.0);
  const Report report = scene_report(machine, scene);
  const json played = to_json(report.scene)["digs"][0];
  EXPECT_NEAR(played["loads"]["energy_kj"].back().get<double>(), scene.dig.energy.total / 1000.0,
              1e-5);
  EXPECT_NEAR(played["loads"]["energy_time_s"].back().get<double>(), scene.duration, 0.02);
  EXPECT_NEAR(played["loads"]["fill_m3"].back().get<double>(), scene.dig.payload_volume, 1e-3);
}

TEST(ReportScene, AStalledDigEndsWhereItStalled) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const DigScene scene = dig("gravel", 100.0);
  ASSERT_TRUE(scene.dig.stall.has_value());
  const ReportDig played = played_dig("dig", machine, scene.path, scene.dig);
  EXPECT_LT(played.trajectory.duration(), 0.8 * time_dig_path(machine, scene.path).duration());
  EXPECT_LT(played.history.size(), played.path.poses.size());
  EXPECT_EQ(played.path.poses.size(), scene.dig.torques.size() + 1);
  EXPECT_TRUE(contains(html_page(scene_report(machine, scene), plain_run()), "The dig stalled."));
}

}  // namespace
}  // namespace excavplan::tools
