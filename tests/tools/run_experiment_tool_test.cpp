// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <regex>
#include <sstream>
#include <string>

#include <excavplan/soil/density_fit.hpp>

#include "support/report_page.hpp"
#include "support/svg_figure.hpp"
#include "support/tool_answers.hpp"

/// @file
/// run-experiment: fixed path against planned path.

namespace excavplan::test {
namespace {

TEST_F(Tools, RunExperimentGivesTheKeysOfTheContract) {
  const json result = answer("run-experiment", {"--densities", "40"});
  ASSERT_EQ(result.at("conditions").size(), 1U);
  const json& condition = result["conditions"][0];
  expect_keys(condition, "string", {"name"});
  expect_keys(condition, "number",
              {"density_percent", "bulking_factor", "density_estimated_percent", "gain_percent"});
  for (const char* dig : {"fixed", "planned"}) {
    expect_keys(condition.at(dig), "number", path_keys + cost_keys);
  }
}

TEST_F(Tools, AConditionIsNamedOnce) {
  const auto text = [](const std::string& density) {
    return run_program("run-experiment", {"--densities", density}).out;
  };
  EXPECT_EQ(text("40").rfind("density 40.0 %, k ", 0), 0U);
  EXPECT_EQ(text("paper").rfind("soft: density 10.0 %, k ", 0), 0U);
}

TEST_F(Tools, ExperimentPlansForThePapersGoalUnlessToldOtherwise) {
  const Words soft = {"--densities", "10"};
  const json energy = answer("run-experiment", soft);
  EXPECT_EQ(energy.at("goal"), "energy");
  const json cycle = answer("run-experiment", soft + Words{"--goal", "cycle"});
  EXPECT_EQ(cycle.at("goal"), "cycle");
  EXPECT_GT(number(cycle, "/conditions/0/planned/fill_fraction"), 0.79);
  EXPECT_NEAR(number(cycle, "/conditions/0/gain_percent"),
              100.0 * (number(cycle, "/conditions/0/planned/cycle/efficiency_kg_per_kj") /
                           number(cycle, "/conditions/0/fixed/cycle/efficiency_kg_per_kj") -
                       1.0),
              1e-9);
}

TEST_F(Tools, ExperimentSaysWhereItsLawIsOfAnotherSoilOrMachine) {
  const Words sand = {"--densities", "40", "--soil", "sand"};
  const json own = answer("run-experiment", sand);
  EXPECT_FALSE(warns(own, "law_of_other_soil") || warns(own, "law_of_other_machine"));
  const json other = answer("run-experiment", sand + Words{"--law", "zx120-clay"});
  EXPECT_TRUE(warns(other, "law_of_other_soil")) << other["warnings"];
  EXPECT_FALSE(warns(other, "law_of_other_machine"));
}

TEST_F(Tools, ADensityThatStallsEndsNoOther) {
  const json found = answer("run-experiment", {"--soil", "gravel", "--densities", "20,90"});
  EXPECT_TRUE(warns(found, "condition_failed")) << found["warnings"];
  EXPECT_GT(number(found, "/conditions/0/gain_percent"), 0.0);
  EXPECT_TRUE(contains(found["conditions"][1].at("failure"), "stalls"));
  EXPECT_EQ(run_program("run-experiment", {"--soil", "gravel", "--densities", "90"}).code, 2);
}

TEST_F(Tools, ExperimentHasTheContentOfThePapersFigures) {
  const json found = answer("run-experiment", {"--densities", "40"});
  const json& regression = found.at("regression");
  ASSERT_EQ(regression.at("samples").size(), 21U);
  EXPECT_NEAR(number(regression, "/paper_line/a_percent"), 161.57, 1e-9);
  std::vector<BulkingSample> samples;
  for (const json& sample : regression["samples"]) {
    samples.push_back({sample.at("bulking_factor"), sample.at("density_percent")});
  }
  EXPECT_NEAR(fit_line(samples).a, number(regression, "/line/a_percent"), 1e-9);
  for (const char* dig : {"fixed", "planned"}) {
    const json& of = found["conditions"][0][dig];
    double lowest = 0.0;
    for (const json& tip : of.at("tip_path_m")) lowest = std::min(lowest, tip[1].get<double>());
    EXPECT_NEAR(number(of, "/depth_m"), -lowest, 1e-12) << dig;
    EXPECT_GT(number(of, "/section_m2"), 0.1) << dig;
  }
}

TEST_F(Tools, AStudyWritesItsRunsAndItsTable) {
  const std::string out = folder.file("study");
  const Words words = {"--study", out, "--study-runs", "0.001", "--seed", "3", "--soil", "sand"};
  const json found = answer("run-experiment", words);
  const std::string runs = content_of(out + "/runs.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(runs.begin(), runs.end(), '\n')),
            found.at("study").size() + 1);
  EXPECT_EQ(json::parse(content_of(out + "/study.json"))["study"], found["study"]);
  std::istringstream rows(std::regex_replace(runs, std::regex("\"[^\"]*\""), ""));
  for (std::string row; std::getline(rows, row);) {
    EXPECT_EQ(std::count(row.begin(), row.end(), ','), 19) << row;
  }
  EXPECT_TRUE(contains(content_of(out + "/study.md"), "| slope | +10.0 deg | 1 |"));
  expect_figure(out + "/study.svg", {"slope, +10.0 deg", "gain of the planned dig [%]"});
  EXPECT_TRUE(warns(found, "options_ignored"));
}

TEST_F(Tools, ReportOfAnExperimentShowsBothDigsOfEachCondition) {
  const std::string file = folder.file("report.html");
  const json result = answer("run-experiment", {"--densities", "10,40", "--report", file});
  const std::string page = content_of(file);
  EXPECT_TRUE(contains(page, ">10</text>") && contains(page, "tip, planned path"));
  EXPECT_TRUE(contains(page, "[kg/kJ]</text>"));
  const json scene = drawn_on(page);
  ASSERT_EQ(scene["digs"].size(), 4U);
  EXPECT_EQ(scene["digs"][3]["name"], "40.0 %, fixed path");
  EXPECT_NEAR(number(scene, "/digs/2/start_x_m"),
              number(result, "/conditions/1/planned/path/start_x_m"), 1e-6);
  const json& energy = scene["digs"][2]["loads"]["energy_kj"];
  EXPECT_NEAR(energy.back().get<double>(), number(result, "/conditions/1/planned/energy_kj"), 0.01);
}

TEST_F(Tools, ExperimentSplitsItsGainIntoPathAndStart) {
  const json result = answer("run-experiment", {"--search", "--densities", "10"});
  const json condition = result.at("conditions").at(0);
  EXPECT_EQ(condition.at("start_rule"), "least work of the links' own weight");
  EXPECT_NEAR((1.0 + number(condition, "/gain_path_percent") / 100.0) *
                  (1.0 + number(condition, "/gain_start_percent") / 100.0),
              1.0 + number(condition, "/gain_percent") / 100.0, 1e-9);
  EXPECT_GT(number(condition, "/gain_path_percent"), 10.0);
  EXPECT_GT(number(condition, "/gain_start_percent"), 5.0);
}

TEST_F(Tools, PlannedPathBeatsTheFixedOneInEverySoil) {
  const json result = answer("run-experiment", {});
  ASSERT_EQ(result.at("conditions").size(), 3U);
  const std::vector<std::pair<std::string, double>> expected = {
      {"soft", 10.0}, {"medium", 40.0}, {"hard", 80.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    const json& condition = result["conditions"][i];
    EXPECT_EQ(condition.at("name"), expected[i].first);
    EXPECT_EQ(condition.at("density_percent"), expected[i].second);
    const double fixed = number(condition, "/fixed/efficiency_kg_per_kj");
    const double planned = number(condition, "/planned/efficiency_kg_per_kj");
    const double gain = number(condition, "/gain_percent");
    std::cout << "  " << expected[i].first << ": " << fixed << " to " << planned << " kg/kJ, gain "
              << gain << " %\n";
    EXPECT_GT(gain, 0.0);
    EXPECT_NEAR(gain, 100.0 * (planned / fixed - 1.0), 1e-9);
    EXPECT_EQ(condition.at("machine_held_down"), expected[i].first == "hard");
    EXPECT_NEAR(number(condition, "/fixed/path/penetration_angle_rad"), std::atan(1.0), 1e-12);
    EXPECT_NEAR(number(condition, "/fixed/path/penetration_length_m"), 0.35, 1e-12);
    EXPECT_NEAR(number(condition, "/fixed/path/drag_length_m"), 1.5, 1e-12);
  }
}

/// A gain by the dig's efficiency can cost payload and the cycle: both stand beside it.
TEST_F(Tools, ExperimentShowsWhatAGainCosts) {
  const Words words = {"--densities", "10", "--goal", "energy"};
  const json condition = answer("run-experiment", words).at("conditions").at(0);
  const auto gain = [&](const std::string& of) {
    return 100.0 * (number(condition, "/planned/" + of) / number(condition, "/fixed/" + of) - 1.0);
  };
  EXPECT_NEAR(number(condition, "/payload_gain_percent"), gain("payload_mass_kg"), 1e-9);
  EXPECT_NEAR(number(condition, "/cycle_gain_percent"), gain("cycle/efficiency_kg_per_kj"), 1e-9);
  const std::string text = run_program("run-experiment", words).out;
  const std::size_t at = text.find("; payload ");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_NE(text.find(number(condition, "/payload_gain_percent") < 0.0 ? "kg (-" : "kg (+", at),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("over the whole cycle", at), std::string::npos) << text;
}

TEST_F(Tools, RunExperimentDigsInTheSimulatorAsked) {
  const Words words = {"--densities", "40"};
  const json usual = answer("run-experiment", words).at("conditions").at(0);
  const json section =
      answer("run-experiment", words + Words{"--simulator", "section"}).at("conditions").at(0);
  EXPECT_NE(section.at("fixed").at("energy_kj"), usual.at("fixed").at("energy_kj"));
  EXPECT_GT(number(section, "/gain_percent"), 0.0);
}

TEST_F(Tools, ExperimentSearchesByThePapersAlgorithmAsSet) {
  const Words words = {"--densities", "40",           "--search", "--method",
                       "paper",       "--population", "8",        "--generations",
                       "3",           "--crossover",  "0.7",      "--mutation",
                       "0.2",         "--tournament", "2",        "--elites",
                       "2",           "--drag-range", "1m,2m"};
  const json found = answer("run-experiment", words);
  EXPECT_EQ(found.at("warnings"), json::array());
  json search = found.at("search");
  EXPECT_EQ(search["ranges"]["drag_length_m"], json({1.0, 2.0}));
  search.erase("ranges");
  EXPECT_EQ(search, json({{"method", "paper"},
                          {"population", 8},
                          {"generations", 3},
                          {"crossover", 0.7},
                          {"mutation", 0.2},
                          {"tournament", 2},
                          {"elites", 2},
                          {"seed", 1}}));
  EXPECT_EQ(found["conditions"][0]["start_rule"], "least work of the links' own weight");
  const double drag = number(found, "/conditions/0/planned/path/drag_length_m");
  EXPECT_TRUE(drag >= 1.0 && drag <= 2.0) << drag;
  EXPECT_TRUE(warns(answer("run-experiment", {"--densities", "40", "--method", "paper"}),
                    "options_ignored"));
}

TEST_F(Tools, FieldExperimentComparesVolumePerFuel) {
  const Words words = {"--preset", "field", "--digs", "1"};
  const json found = answer("run-experiment", words);
  ASSERT_EQ(found.at("soils").size(), 2U);
  EXPECT_EQ(found["soils"][0]["name"], "soft");
  EXPECT_EQ(found["soils"][1]["name"], "hard");
  EXPECT_NEAR(number(found, "/paper/gain_percent"), 27.7, 1e-12);
  const json& run = found["soils"][0]["runs"][0];
  EXPECT_NEAR(number(run, "/fixed/path/drag_length_m"), 2.487, 1e-12);
  for (const char* dig : {"fixed", "planned", "planned_equal_payload"}) {
    const json& of = run.at(dig);
    expect_keys(of, "number", path_keys + cost_keys);
    EXPECT_NEAR(number(of, "/efficiency_m3_per_ml"),
                number(of, "/payload_volume_m3") / number(of, "/fuel_ml"), 1e-12);
    EXPECT_NEAR(number(of, "/fuel_ml"), number(of, "/fuel_idle_ml") + number(of, "/fuel_work_ml"),
                1e-12);
  }
  EXPECT_TRUE(found["soils"][0]["gain_percent"]["interval_95"].is_null());
  EXPECT_TRUE(warns(found, "machine_held_down") && warns(found, "density_not_trustworthy"));
  const json other =
      answer("run-experiment",
             words + Words{"--path", "45deg,0.35,1.5", "--densities", "20", "--method", "paper"});
  EXPECT_NEAR(number(other, "/soils/0/runs/0/fixed/path/drag_length_m"), 1.5, 1e-12);
  EXPECT_EQ(other["soils"][0]["name"], "20.0 %");
  EXPECT_TRUE(warns(other, "options_ignored"));
}

TEST_F(BadInput, SettingsOfExperimentsAreRefusedByTheNamesOfOptions) {
  const Words paper = {"--densities", "40", "--search", "--method", "paper", "--population", "8"};
  refused(2, "--elites must be in 0 .. population - 1 = 7, got 8", "run-experiment",
          paper + Words{"--elites", "8"});
  refused(2, "--tournament must be >= 1, got 0", "run-experiment",
          paper + Words{"--tournament", "0"});
  refused(2, "--crossover must be in 0 .. 1, got 1.5", "run-experiment",
          paper + Words{"--crossover", "1.5"});
  refused(2, "--digs is 0, must be in 1 .. 10000", "run-experiment",
          {"--preset", "field", "--digs", "0"});
}

TEST_F(BadInput, ExperimentsThatExcludeEachOtherAreRefused) {
  const std::string out = folder.file("study");
  refused(2, "--study and --sensitivity are two experiments: give one", "run-experiment",
          {"--sensitivity", "--study", out});
  refused(2, "--study and --preset field are two experiments: give one", "run-experiment",
          {"--preset", "field", "--study", out});
  refused(2, "--sensitivity and --preset field are two experiments: give one", "run-experiment",
          {"--preset", "field", "--sensitivity"});
}

TEST_F(BadInput, FilesThatAnExperimentDoesNotWriteAreRefused) {
  for (const Words& of : {Words{"--sensitivity"}, Words{"--preset", "field"}}) {
    refused(2, "--report would not be written: only the experiment of section 3 has a page",
            "run-experiment", of + Words{"--report", folder.file("page.html")});
    refused(2, "--plot: no figure 'efficiency': only the experiment of section 3 has it",
            "run-experiment", of + Words{"--plot", "efficiency=" + plot});
  }
  refused(2, "--report would not be written: a study has its own conditions", "run-experiment",
          {"--study", folder.file("study"), "--report", folder.file("page.html")});
}

TEST_F(BadInput, AStudyReplacesNoFileThatIsUsed) {
  const std::string out = folder.file("study");
  fs::create_directory(out);
  const std::string machine = out + "/study.json";
  fs::copy_file(shipped("machines/zx120.json"), machine);
  refused(2, "--machine and --study name the same file, " + machine, "run-experiment",
          {"--study", out, "--machine", machine});
  refused(2, "--study and --plot name the same file, " + out + "/study.svg", "run-experiment",
          {"--study", out, "--plot", "study=" + out + "/study.svg"});
  refused(2, "--study-runs: 0 must be above 0 and at most 10000", "run-experiment",
          {"--study", folder.file("none"), "--study-runs", "0"});
}

TEST_F(Tools, SensitivityTellsWhatEachAssumptionIsWorth) {
  const Words words = {"--sensitivity", "--densities",   "10", "--law",
                       "paper",         "--evaluations", "40"};
  const json found = answer("run-experiment", words);
  EXPECT_TRUE(warns(found, "options_ignored"));
  const json& rows = found.at("sensitivity");
  EXPECT_EQ(rows[0]["factor"], "reference");
  EXPECT_EQ(found["evaluations"], 40);
  EXPECT_GT(rows.size(), 20U);
  double most = 0.0;
  for (const json& row : rows) {
    if (row.at("regret_percent").is_null()) {
      EXPECT_NE(row.at("failure"), "");
      continue;
    }
    EXPECT_GE(row["regret_percent"].get<double>(), 0.0);
    most = std::max(most, row["regret_percent"].get<double>());
  }
  EXPECT_GT(most, 3.0);
}

TEST_F(Tools, ExperimentAlongThePathOfTheFieldTestHasALawForIt) {
  const json result =
      answer("run-experiment", {"--path", "1.023,0.496,2.487", "--densities", "10,40,80"});
  for (const json& condition : result["conditions"]) {
    EXPECT_NEAR(number(condition, "/density_estimated_percent"),
                number(condition, "/density_percent"), 0.2);
  }
}

}  // namespace
}  // namespace excavplan::test
