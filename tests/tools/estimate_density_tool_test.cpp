// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <sstream>

#include <Eigen/Geometry>

#include <excavplan/clouds/cloud.hpp>

#include "base/angles.hpp"
#include "support/report_page.hpp"
#include "support/tool_answers.hpp"

/// @file
/// estimate-density, from two scans to the density and its trustworthiness.

namespace excavplan::test {
namespace {

#ifdef EXCAVPLAN_PAPER
constexpr bool has_paper = true;
#else
constexpr bool has_paper = false;
#endif

TEST_F(BadInput, MethodPaperWithoutPclNamesThePackage) {
  if (has_paper) GTEST_SKIP() << "built with PCL";
  for (const Words& words : {Words{"--method", "paper"}, Words{"--compare-methods"}}) {
    refused(2, "libpcl-dev", "estimate-density", quickstart(folder) + words);
  }
}

TEST_F(Tools, EstimateDensityGivesTheKeysOfTheContract) {
  const json result = answer("estimate-density", quickstart(folder));
  expect_keys(result, "number", volume_keys);
  expect_keys(result, "number",
              {"bulking_factor", "bulking_factor_sd", "density_percent", "density_raw_percent",
               "density_sd_percent", "density_interval_percent/0", "density_interval_percent/1"});
  expect_keys(result, "string", {"law"});
  expect_keys(result, "boolean", {"trustworthy"});
  EXPECT_EQ(result["density_interval_percent"].size(), 2U);
  EXPECT_DOUBLE_EQ(number(result, "/volume/before_m3"), number(result, "/volume/excavated_m3"));
  EXPECT_NEAR(number(result, "/volume/after_m3"),
              number(result, "/volume/spilled_m3") + number(result, "/volume/dumped_m3"), 1e-12);
}

void expect_truth_found(const json& estimate, double truth) {
  const double low = number(estimate, "/density_interval_percent/0");
  const double high = number(estimate, "/density_interval_percent/1");
  std::cout << "  truth " << truth << " %, estimate " << estimate.at("density_percent") << " %, in "
            << low << " .. " << high << " %, k " << estimate.at("bulking_factor")
            << (estimate.at("trustworthy") == true ? "" : ", not trustworthy") << '\n';
  EXPECT_NEAR(number(estimate, "/density_percent"), truth, 5.0);
  EXPECT_LE(low, truth);
  EXPECT_GE(high, truth);
}

TEST_F(Tools, QuickstartScansGiveTheDensity) {
  const json truth = json::parse(content_of(shipped("quickstart/truth.json")));
  const json estimate = answer("estimate-density", quickstart(folder) + Words{"--strict"});
  expect_truth_found(estimate, number(truth, "/density_percent"));
  EXPECT_EQ(warning_codes(estimate), Words{"soil_assumed"});
  const json loam =
      answer("estimate-density", quickstart(folder) + Words{"--strict", "--soil", "loam"});
  EXPECT_EQ(loam["warnings"], json::array());
  EXPECT_EQ(loam["density_percent"], estimate["density_percent"]);
}

TEST_F(BadInput, TheDensityIsCompactionToo) {
  const Words scans = quickstart(folder);
  const json found =
      answer("estimate-density", scans + Words{"--soil", "loam", "--proctor", "1.84t/m3"});
  const double e = 1.3 - 0.01 * number(found, "/density_percent") * (1.3 - 0.415);
  EXPECT_NEAR(number(found, "/compaction_percent"), 100.0 * 2680.0 / (1.0 + e) / 1840.0, 0.3);
  EXPECT_LT(number(found["compaction_interval_percent"], "/0"),
            number(found, "/compaction_percent"));
  EXPECT_FALSE(answer("estimate-density", scans).contains("compaction_percent"));
  refused(2, "--proctor needs --soil", "estimate-density", scans + Words{"--proctor", "1840"});
  refused(2, "Proctor density [kg/m3] is 18.4", "estimate-density",
          scans + Words{"--soil", "loam", "--proctor", "18.4"});
}

TEST_F(Tools, TheSoilIsAssumedToldOrUnknown) {
  const json assumed = answer("estimate-density", quickstart(folder));
  EXPECT_EQ(assumed["soil"], "loam");
  EXPECT_EQ(assumed["soil_assumed"], true);
  expect_keys(assumed, "number",
              {"density_sd_given_law_percent", "any_soil/density_percent",
               "any_soil/density_sd_percent", "any_soil/density_interval_percent/1"});
  EXPECT_LT(number(assumed, "/density_sd_given_law_percent"),
            0.8 * number(assumed, "/density_sd_percent"));
  ASSERT_EQ(assumed["soils"].size(), 4U);
  const auto in_soil = [&](const std::string& name) {
    for (const json& soil : assumed["soils"]) {
      if (soil["name"] == name) return soil;
    }
    return json();
  };
  for (const char* name : {"sand", "clay", "gravel"}) {
    const json told = answer("estimate-density", quickstart(folder) + Words{"--soil", name});
    EXPECT_EQ(told["soil"], name);
    EXPECT_EQ(told["soil_assumed"], false);
    EXPECT_EQ(told["law"], std::string("zx120-") + name);
    EXPECT_EQ(told["density_percent"], in_soil(name)["density_percent"]);
    EXPECT_EQ(told["density_sd_percent"], in_soil(name)["density_sd_percent"]);
  }
  const json unknown = answer("estimate-density", quickstart(folder) + Words{"--soil", "unknown"});
  EXPECT_TRUE(unknown["soil"].is_null());
  EXPECT_TRUE(unknown["law_soil"].is_null());
  EXPECT_EQ(unknown["density_percent"], assumed["any_soil"]["density_percent"]);
  EXPECT_EQ(unknown["density_sd_percent"], assumed["any_soil"]["density_sd_percent"]);
  EXPECT_GT(number(unknown, "/density_sd_percent"), 10.0);
  EXPECT_EQ(unknown["trustworthy"], true);
}

TEST_F(Tools, AWeighedPayloadChecksTheSoil) {
  const json truth = json::parse(content_of(shipped("quickstart/truth.json")));
  const std::string mass = std::to_string(number(truth, "/payload_mass_kg"));
  const Words weighed = quickstart(folder) + Words{"--payload-mass", mass + ",2.5"};
  const json loam = answer("estimate-density", weighed + Words{"--soil", "loam", "--moisture",
                                                               "0.12,0.005", "--strict"});
  EXPECT_NEAR(number(loam, "/payload/bulk_density_kg_m3"), 1542.0,
              3.0 * number(loam, "/payload/bulk_density_sd_kg_m3"));
  EXPECT_EQ(number(loam, "/payload/mass_sd_kg"), 2.5);
  EXPECT_NEAR(number(loam, "/density_percent"), 40.0, 2.0 * number(loam, "/density_sd_percent"));
  EXPECT_LT(number(loam, "/density_sd_percent"), number(loam, "/payload/law_density_sd_percent"));
  const json sand = answer("estimate-density", weighed + Words{"--soil", "sand", "--strict"}, 4);
  EXPECT_TRUE(warns(sand, "payload_disagrees")) << sand["warnings"];
  EXPECT_TRUE(answer("estimate-density", quickstart(folder))["payload"].is_null());
}

TEST_F(Tools, AWeighedPayloadInUnknownSoilIsCheckedToo) {
  const Words unknown = quickstart(folder) + Words{"--soil", "unknown"};
  const json right = answer("estimate-density", unknown + Words{"--payload-mass", "257,2.6"});
  EXPECT_EQ(right["trustworthy"], true) << right["warnings"];
  EXPECT_EQ(number(right, "/payload/mass_kg"), 257.0);
  EXPECT_NEAR(number(right, "/payload/bulk_density_kg_m3"), 1542.0, 60.0);
  for (const json& soil : right["soils"]) {
    expect_keys(soil, "number", {"payload/bulk_density_kg_m3", "payload/disagreement_sds"});
  }
  EXPECT_NEAR(number(right["readings"][0], "/density_percent"), number(right, "/density_percent"),
              1e-9);
  const json wrong =
      answer("estimate-density", unknown + Words{"--payload-mass", "400", "--strict"}, 4);
  EXPECT_TRUE(warns(wrong, "payload_disagrees")) << wrong["warnings"];
}

TEST_F(Tools, AHoleOfManyBucketsIsSaidAndTrusted) {
  json machine = json::parse(content_of(shipped("machines/zx120.json")));
  EXPECT_FALSE(warns(answer("estimate-density", quickstart(folder)), "many_buckets"));
  machine["bucket"]["width_outside_m"] = 0.07;
  machine["bucket"]["width_inside_m"] = 0.03;
  machine["bucket"].erase("teeth");
  const std::string narrow = folder.write("narrow.json", machine.dump());
  const json found = answer("estimate-density", quickstart(folder) + Words{"--machine", narrow});
  EXPECT_TRUE(warns(found, "many_buckets")) << found["warnings"];
  EXPECT_EQ(found["trustworthy"], true);
}

TEST_F(Tools, ALawOfAnotherMachineEndsTrust) {
  EXPECT_FALSE(warns(answer("estimate-density", quickstart(folder)), "law_of_other_machine"));
  json machine = json::parse(content_of(shipped("machines/zx120.json")));
  machine["name"] = "larger";
  const std::string larger = folder.write("larger.json", machine.dump());
  const json found = answer("estimate-density", quickstart(folder) + Words{"--machine", larger});
  EXPECT_TRUE(warns(found, "law_of_other_machine")) << found["warnings"];
  EXPECT_EQ(found["trustworthy"], false);
}

TEST_F(Tools, OneWarningNamesTheUnitOfAllClouds) {
  Words scans;
  for (const std::string& scan : quickstart(folder)) scans.push_back(in_millimetres(folder, scan));
  const Words found = warning_codes(answer("estimate-density", scans));
  EXPECT_EQ(std::count(found.begin(), found.end(), "units"), 1);
  const json in_cm = answer("estimate-density", scans + Words{"--unit", "cm"});
  EXPECT_TRUE(contains(in_cm["warnings"].dump(), "in mm: --unit mm")) << in_cm["warnings"];
  EXPECT_EQ(warning_codes(answer("estimate-density", scans + Words{"--unit", "mm"})),
            Words{"soil_assumed"});
}

TEST_F(Tools, APathThatWasNotDugEndsTrust) {
  const Words words = quickstart(folder) + Words{"--soil", "loam", "--dug-start", "6.05"};
  const json dug =
      answer("estimate-density", words + Words{"--dug-path", "45deg,0.35m,1.5m", "--strict"});
  EXPECT_FALSE(dug["fallback"].is_null());
  EXPECT_EQ(dug["law"], "zx120-loam-path");
  for (const char* path : {"45deg,0.6m,1.5m", "45deg,0.35m,2.4m"}) {
    const json other = answer("estimate-density", words + Words{"--dug-path", path, "--strict"}, 4);
    EXPECT_TRUE(warns(other, "dug_path_doubtful")) << path << other["warnings"];
    EXPECT_TRUE(other["fallback"].is_null());
  }
}

TEST_F(BadInput, LoadsOfTheJointsGiveASecondDensity) {
  const std::string log = folder.file("loads.csv");
  const json dug = answer("simulate-dig", {"--density", "40", "--start", "6.05", "--simulator",
                                           "section", "--history", log});
  const Words scans = quickstart(folder) + Words{"--soil", "loam"};
  const Words path = {"--dug-path", "45deg,0.35m,1.5m", "--dug-start", "6.05"};
  const json alone = answer("estimate-density", scans + path);
  const json both = answer("estimate-density", scans + path + Words{"--loads", log, "--strict"});
  EXPECT_TRUE(alone["density_by_loads"].is_null());
  const std::string loads = "/density_by_loads";
  EXPECT_NEAR(number(both, loads + "/work_kj"), number(dug, "/energy_kj"), 1.0);
  EXPECT_NEAR(number(both, loads + "/density_percent"), 40.0, 10.0);
  EXPECT_EQ(number(both, loads + "/scans_density_percent"), number(alone, "/density_percent"));
  EXPECT_LT(number(both, "/density_sd_percent"), number(alone, "/density_sd_percent"));
  EXPECT_LT(number(both, loads + "/weight"), 0.2);
  const std::string harder = folder.file("harder.csv");
  answer("simulate-dig",
         {"--density", "100", "--start", "6.05", "--path", "45deg,0.6m,2m", "--history", harder});
  refused(2, "--loads needs --dug-path and --dug-start", "estimate-density",
          scans + Words{"--loads", log});
  refused(2, "--loads needs the kind of the soil: --soil", "estimate-density",
          quickstart(folder) + path + Words{"--loads", log});
  refused(2, "--from: 100 s is outside", "estimate-density",
          scans + path + Words{"--loads", log, "--from", "100"});
  const std::string fuel = folder.file("fuel.csv");
  answer("simulate-dig", {"--density", "40", "--fuel-log", fuel});
  refused(3, "records fuel flow, expected the loads of the joints", "estimate-density",
          scans + path + Words{"--loads", fuel});
}

TEST_F(BadInput, ThePriorOfTheLastDigIsCombined) {
  const Words words = quickstart(folder) + Words{"--soil", "loam"};
  const std::string file = folder.file("prior.json");
  json alone = answer("estimate-density", words);
  folder.write("prior.json", alone.dump());
  refused(3, file + ": volume: is that of this dig; must be the result of a dig before it",
          "estimate-density", words + Words{"--prior", file});
  alone["volume"]["excavated_m3"] = 1.001 * number(alone, "/volume/excavated_m3");
  const auto with = [&](const json& prior, const Words& more = {}, int code = 0) {
    folder.write("prior.json", prior.dump());
    return answer("estimate-density", words + Words{"--prior", file} + more, code);
  };
  const json both = with(alone, {"--prior-drift", "0", "--strict"});
  const double own = number(alone, "/density_sd_given_law_percent");
  EXPECT_NEAR(number(both, "/prior/weight"), 0.5, 1e-6);
  EXPECT_NEAR(number(both, "/density_sd_given_law_percent"), own / std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(number(both, "/prior/combined_shared_sd_percent"),
              number(both, "/prior/shared_sd_percent"), 1e-6);
  EXPECT_EQ(number(both, "/prior/this_dig_density_sd_percent"),
            number(alone, "/density_sd_percent"));
  EXPECT_LT(number(with(alone), "/prior/weight"), 0.2);  // the usual drift
  json second = both;
  second["volume"] = alone["volume"];
  const json third = with(second, {"--prior-drift", "0"});  // a chain
  EXPECT_NEAR(number(third, "/density_sd_given_law_percent"), own / std::sqrt(3.0), 1e-6);

  json other = alone;
  other["density_percent"] = other["density_raw_percent"] = 80.0;
  const json apart = with(other, {"--strict"}, 4);
  EXPECT_TRUE(warns(apart, "prior_disagrees"));
  EXPECT_EQ(apart["density_percent"], alone["density_percent"]);
  json untrusted = other;
  untrusted["trustworthy"] = false;
  const json ignored = with(untrusted, {"--strict"});
  EXPECT_TRUE(warns(ignored, "prior_not_trustworthy"));
  EXPECT_TRUE(ignored["prior"].is_null());
  json away = alone;
  for (json& zone : away["zones"]) zone["extent_m"] = {20.0, 20.0, 21.0, 21.0};
  const json moved = with(away, {"--strict"}, 4);
  EXPECT_TRUE(warns(moved, "density_from_elsewhere"));
  EXPECT_EQ(moved["trustworthy"], false);

  const auto refuses = [&](json prior, const char* key, const json& value,
                           const std::string& reason) {
    prior[key] = value;
    folder.write("prior.json", prior.dump());
    refused(3, reason, "estimate-density", words + Words{"--prior", file});
  };
  json of_sand = alone;
  of_sand["law_soil"] = "sand";
  refuses(of_sand, "soil", "sand", "its density is of sand, this dig is in loam");
  refuses(alone, "law_soil", "sand", "law_soil: is sand, soil is loam; must be the same");
  refuses(alone, "law", "any soil", "its density is of any soil (--soil unknown), this dig");
  refuses(alone, "format", "excavplan-law", "format: is \"excavplan-law\", expected a result of");
  refuses(alone, "density_sd_percent", nullptr, "density_sd_percent: is null");
  json exact = alone;
  exact["density_sd_given_law_percent"] = 0.0;
  refuses(exact, "density_sd_percent", 0.0, "density_sd_percent: is 0, must be above 0");
  refused(3, "tool: is missing, expected a result of estimate-density --json", "estimate-density",
          words + Words{"--prior", shipped("quickstart/truth.json")});
  folder.write("prior.json", alone.dump());
  refused(3, "its density is of loam, this dig is in any soil (--soil unknown)", "estimate-density",
          quickstart(folder) + Words{"--soil", "unknown", "--prior", file});
  refuses(alone, "density_raw_percent", 500.0, "density_raw_percent");
  refuses(alone, "density_sd_given_law_percent", 50.0, "density_sd_given_law_percent");
  refuses(alone, "density_percent", nullptr, "density_percent");
  refused(2, "--prior-drift", "estimate-density",
          words + Words{"--prior", file, "--prior-drift=-1"});
}

TEST_F(Tools, AWeighedPayloadIsOfNoUseToTheMethodOfThePaper) {
  if (!has_paper) GTEST_SKIP() << "built without PCL";
  const Words words =
      quickstart(folder) + Words{"--payload-mass", "480", "--moisture", "0.1", "--soil", "loam"};
  EXPECT_FALSE(warns(answer("estimate-density", words), "options_ignored"));
  const Words paper = words + Words{"--method", "paper"};
  const json ignored = answer("estimate-density", paper);
  EXPECT_TRUE(ignored["payload"].is_null());
  ASSERT_TRUE(warns(ignored, "options_ignored")) << ignored["warnings"];
  EXPECT_TRUE(contains(ignored["warnings"].back()["message"], "--payload-mass, --moisture; "));
  EXPECT_FALSE(
      warns(answer("estimate-density", paper + Words{"--compare-methods"}), "options_ignored"));
}

TEST_F(Tools, OptionsOfAnEstimateAreOfNoUseToAPlannedSurvey) {
  const Words plan = {"--plan-survey", "height=2", "--law", "paper"};
  EXPECT_FALSE(warns(answer("estimate-density", plan), "options_ignored"));
  const json ignored =
      answer("estimate-density", plan + Words{"--cell", "0.1", "--level", "--moisture", "0.1"});
  ASSERT_TRUE(warns(ignored, "options_ignored"));
  EXPECT_EQ(ignored["warnings"].back()["message"],
            "without effect: --level, --cell, --moisture; a survey is planned by its keys alone");
}

TEST_F(Tools, SettingsOfTheOtherMethodAreReported) {
  const json usual =
      answer("estimate-density",
             quickstart(folder) + Words{"--paper-voxels", "cubes", "--paper-outliers", "none"});
  EXPECT_TRUE(warns(usual, "options_ignored")) << usual["warnings"];
  const Words cell = {"--cell", "1e-3"};
  const ProgramResult fine = run_program("estimate-density", quickstart(folder) + cell);
  EXPECT_EQ(fine.code, 2);
  EXPECT_TRUE(contains(fine.err, "m in cells (--cell) of 0.001 m needs about ")) << fine.err;
}

TEST_F(Tools, APathWithoutItsStartChoosesTheLaw) {
  const json usual = answer("estimate-density", quickstart(folder) + Words{"--soil", "loam"});
  const json path =
      answer("estimate-density",
             quickstart(folder) + Words{"--soil", "loam", "--dug-path", "45deg,0.35m,1.5m"});
  EXPECT_TRUE(path["fallback"].is_null());
  EXPECT_NEAR(number(path, "/density_percent"), number(usual, "/density_percent"), 0.2);
  EXPECT_LT(number(path, "/density_sd_percent"), 0.9 * number(usual, "/density_sd_percent"));
}

/// Of the scans of seed s: density 10 s - 5 %.
class ScansOfSeed : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Tools, ScansOfSeed, testing::Range(1, 11));

TEST_P(ScansOfSeed, GiveTheDensity) {
  const TemporaryFolder folder;
  const int density = 10 * GetParam() - 5;
  const ScanFiles scans = scan_pair(folder, density, GetParam());
  expect_truth_found(answer("estimate-density", {scans.before, scans.after}), density);
  const double solids = number(scans.truth, "/solids_before_kg");
  EXPECT_NEAR(number(scans.truth, "/solids_after_kg"), solids, 1e-9 * solids);
}

/// The points of a scan whose y is in a range, as XYZ text.
std::string part_of(const TemporaryFolder& folder, const std::string& scan, double low,
                    double high) {
  const std::string whole = folder.file("whole.xyz");
  answer("inspect-cloud", {scan, "--out", whole});
  std::istringstream lines(content_of(whole));
  std::string part;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    double x = 0.0;
    double y = 0.0;
    if (words >> x >> y && y > low && y < high) part += line + '\n';
  }
  return folder.write(fs::path(scan).stem().string() + std::to_string(low) + ".xyz", part);
}

TEST_F(Tools, SeparateScansOfDigAndDumpGiveTheSameAsTheWholeScene) {
  const ScanFiles scans = scan_pair(folder, 50, 3);
  const json whole = answer("estimate-density", {scans.before, scans.after});
  const json separate =
      answer("estimate-density",
             {part_of(folder, scans.before, -3.0, 2.0), part_of(folder, scans.after, -3.0, 2.0),
              "--dump-before", part_of(folder, scans.before, 2.0, 9.0), "--dump-after",
              part_of(folder, scans.after, 2.0, 9.0)});
  for (const char* name : {"excavated", "dumped"}) {
    const std::string volume = std::string("/volume/") + name;
    EXPECT_NEAR(number(separate, volume + "_m3"), number(whole, volume + "_m3"),
                3.0 * number(whole, volume + "_sd_m3"));
  }
  expect_truth_found(separate, 50.0);
}

TEST_F(Tools, MapsOfADumpAreaAreThoseOfItsScans) {
  const ScanFiles scans = scan_pair(folder, 50, 3);
  answer(
      "estimate-density",
      {part_of(folder, scans.before, -3.0, 2.0), part_of(folder, scans.after, -3.0, 2.0),
       "--dump-before", part_of(folder, scans.before, 2.0, 9.0), "--dump-after",
       part_of(folder, scans.after, 2.0, 9.0), "--map", "zones=" + folder.file("dig.asc"), "--map",
       "dump-zones=" + folder.file("dump.asc"), "--map", "dump=" + folder.file("dump.ply")});
  const std::string dig = content_of(folder.file("dig.asc"));
  const std::string dump = content_of(folder.file("dump.asc"));
  EXPECT_TRUE(contains(dig, " 1 1 1 "));
  EXPECT_FALSE(contains(dig, " 3 3 3 "));
  EXPECT_TRUE(contains(dump, " 3 3 3 "));
  EXPECT_FALSE(contains(dump, " 1 1 1 "));
  EXPECT_TRUE(contains(content_of(folder.file("dump.ply")).substr(0, 1000), "scalar_change_sd_m"));
}

TEST_F(Tools, PaperMethodGivesItsVolumesAndNoTrust) {
  if (!has_paper) GTEST_SKIP() << "built without PCL";
  const Words words = quickstart(folder) + Words{"--method", "paper"};
  const json truth = json::parse(content_of(shipped("quickstart/truth.json")));
  const json paper = answer("estimate-density", words);
  std::cout << "  paper's method: k " << paper.at("bulking_factor") << " of "
            << truth.at("bulking_factor") << ", density " << paper.at("density_percent") << " of "
            << truth.at("density_percent") << " %\n";
  EXPECT_EQ(paper.at("method"), "paper");
  const json cubes = answer("estimate-density", words + Words{"--paper-voxels", "cubes"});
  for (const char* volume : {"/volume/excavated_m3", "/volume/dumped_m3"}) {
    EXPECT_NEAR(number(paper, volume), number(truth, volume), 0.1 * number(truth, volume));
    // A face counts once for each cube it crosses: docs/methods.md#volumes.
    EXPECT_GT(number(cubes, volume), 1.5 * number(truth, volume));
  }
  expect_keys(paper, "null",
              {"volume/excavated_sd_m3", "bulking_factor_sd", "bulking_factor_sd_scans",
               "density_sd_given_law_percent"});
  EXPECT_TRUE(warns(paper, "volume_error_unknown")) << paper["warnings"];
  answer("estimate-density", words + Words{"--strict"}, 4);
}

TEST_F(Tools, OutlierRemovalOfThePaperMethodIsAnOption) {
  if (!has_paper) GTEST_SKIP() << "built without PCL";
  const Words words = quickstart(folder) + Words{"--method", "paper"};
  const auto hole = [&](const std::string& outliers) {
    return number(answer("estimate-density", words + Words{"--paper-outliers", outliers}),
                  "/volume/excavated_m3");
  };
  EXPECT_EQ(hole("50,1"), number(answer("estimate-density", words), "/volume/excavated_m3"));
  EXPECT_GT(hole("none"), hole("50,1"));
  EXPECT_NE(hole("8,0.5"), hole("50,1"));
}

TEST_F(BadInput, OutlierSettingsThatMakeNoSense) {
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {"50", "is neither NEIGHBOURS,DEVIATIONS nor none"},
           {"0.5,1", "'0.5' is not a number of neighbours, 1 to 10000"},
           {"50,0", "'0' is not above 0"}}) {
    refused(2, reason, "estimate-density", quickstart(folder) + Words{"--paper-outliers", text});
  }
}

TEST_F(Tools, AKnownPathCorrectsTheBulkingFactorForFallback) {
  const ScanFiles scans = scan_pair(folder, 90, 2);
  const double start = number(scans.truth, "/path/start_x_m");
  const Words words = {scans.before, scans.after};
  const json without = answer("estimate-density", words);
  const json with = answer("estimate-density", words + Words{"--dug-path", "45deg,0.35m,1.5m",
                                                             "--dug-start", std::to_string(start)});
  EXPECT_TRUE(without["fallback"].is_null());
  EXPECT_TRUE(without["bulking_factor_corrected"].is_null());
  EXPECT_GT(number(without, "/density_without_fallback_percent"),
            number(without, "/density_raw_percent") + 1.0);
  EXPECT_NEAR(number(with, "/fallback/fraction"), number(scans.truth, "/fallback_fraction"), 0.02);
  EXPECT_NEAR(number(with, "/fallback/cut_m3"), 0.326, 0.01);
  const double k = number(with, "/bulking_factor_corrected");
  EXPECT_EQ(number(with, "/bulking_factor"), number(without, "/bulking_factor"));
  EXPECT_LT(k, number(with, "/bulking_factor"));
  EXPECT_NEAR(k, number(scans.truth, "/bulking_factor_true"),
              2.0 * number(with, "/bulking_factor_corrected_sd"));
  EXPECT_NEAR(number(with, "/density_percent"), 90.0, 5.0);
}

/// A dig in hard soil that falls as blocks, scanned from five places.
class HardSoilThatBreaks : public testing::TestWithParam<int> {
 protected:
  // That of plan-path --density 90; the paper's fixed path would lift the machine.
  const std::string angle = "0.44034809077453074";
  const std::string lengths = "0.4279762549991743,1.33426244953194";
  const std::string start = "4.734375000000003";

  json rehearsal(const Words& more, json& truth) const {
    const TemporaryFolder folder;
    const Words scans = {folder.file("b.pcd"), folder.file("a.pcd")};
    const Words cameras = {"5.2,0.9,2.6,4.9,0,0", "3.6,-0.9,2.6,3.9,0,0", "5.5,3.1,2.4,5.5,4,0",
                           "4.7,4.5,2.4,5.5,4,0", "6.3,4.5,2.4,5.5,4,0"};
    const std::string path = angle + "," + lengths;
    Words words = {"--density", "90",      "--path",
                   path,        "--start", start,
                   "--blocks",  "--seed",  std::to_string(GetParam()),
                   "--before",  scans[0],  "--after",
                   scans[1]};
    for (const std::string& camera : cameras) words = words + Words{"--camera", camera};
    truth = answer("simulate-dig", words + more);
    EXPECT_EQ(truth["stalled"], false);
    return answer("estimate-density",
                  scans + Words{"--cell", "0.04", "--dug-path", path, "--dug-start", start});
  }
};

INSTANTIATE_TEST_SUITE_P(Tools, HardSoilThatBreaks, testing::Range(1, 5));

TEST_P(HardSoilThatBreaks, ReadsMoreThanAHundredPercentUntilItsVoidsAreTakenOff) {
  json truth;
  const json estimate = rehearsal({}, truth);
  const double k = number(estimate, "/bulking_factor");
  std::cout << "  k " << k << " (true " << truth["bulking_factor_true"] << "), corrected "
            << estimate["bulking_factor_corrected"] << ", voids " << estimate["blocks"]["voids_m3"]
            << " of " << truth["blocks"]["voids_m3"] << " m3, density "
            << estimate["density_interval_percent"] << " %\n";
  EXPECT_GT(161.57 * k - 152.87, 120.0);  // the paper's line
  EXPECT_EQ(estimate["blocks"]["found"], true);
  EXPECT_TRUE(warns(estimate, "blocks"));
  EXPECT_EQ(estimate["trustworthy"], false);
  EXPECT_NEAR(number(estimate, "/bulking_factor_corrected"), number(truth, "/bulking_factor_true"),
              1.96 * number(estimate, "/bulking_factor_corrected_sd"));
  EXPECT_LE(number(estimate, "/density_interval_percent/0"), 90.0);
}

// The correction takes the soil of the blocks for as loose as dumped soil is.
TEST_P(HardSoilThatBreaks, UndisturbedBlocksReadTooLowAndAreNotTrusted) {
  json truth;
  const json estimate = rehearsal({"--block-swell", "0"}, truth);
  EXPECT_EQ(estimate["blocks"]["found"], true);
  EXPECT_EQ(estimate["trustworthy"], false);
  EXPECT_LT(number(estimate, "/density_percent"), 80.0);
}

TEST_F(Tools, BothMethodsAreShownWhenAsked) {
  if (!has_paper) GTEST_SKIP() << "built without PCL";
  const Words words = quickstart(folder) + Words{"--compare-methods"};
  const json both = answer("estimate-density", words);
  const json surface = answer("estimate-density", quickstart(folder));
  const json paper = answer("estimate-density", quickstart(folder) + Words{"--method", "paper"});
  EXPECT_EQ(both["method"], "surface");
  EXPECT_EQ(both["volume"], surface["volume"]);
  EXPECT_EQ(both["methods"]["surface"]["density_percent"], surface["density_percent"]);
  EXPECT_EQ(both["methods"]["paper"]["volume"], paper["volume"]);
}

TEST_F(Tools, ASurveyIsPlannedWithoutScans) {
  const json near = answer("estimate-density", {"--plan-survey", "height=2,offset=1"});
  const std::string poor =
      run_program("estimate-density", {"--plan-survey", "sensor=lidar,height=2.5,offset=3"}).out;
  EXPECT_TRUE(contains(poor, "frames   is not enough alone")) << poor;
  const json far = answer("estimate-density", {"--plan-survey", "height=4,offset=2,target=1"});
  EXPECT_LT(number(near, "/density_sd_percent"), 0.4 * number(far, "/density_sd_percent"));
  EXPECT_NEAR(number(near, "/range_m"), std::sqrt(5.0), 0.05);
  EXPECT_LT(number(far, "/needs/range_at_most_m"), number(far, "/range_m"));
  double shares = 0.0;
  for (const auto& share : near["variance_shares"]) shares += share.get<double>();
  EXPECT_NEAR(shares, 1.0, 1e-9);
}

// Registration multiplies the variance of the datum by 2.5 (docs/methods.md#survey-planning).
TEST_F(Tools, ASurveyIsPlannedWithRegistrationIfTheSensorMoves) {
  const auto datum_sd = [](const std::string& survey) {
    return number(answer("estimate-density", {"--plan-survey", survey}), "/datum_sd_m");
  };
  const double stands = datum_sd("height=2,moved=no");
  EXPECT_NEAR(datum_sd("height=2,moved=yes"), std::sqrt(2.5) * stands, 1e-6 * stands);
  EXPECT_EQ(datum_sd("height=2"), stands);
}

TEST_F(Tools, WithoutDumpedSoilThereAreVolumesButNoDensity) {
  const json result = answer("estimate-density", quickstart(folder) + Words{"--area", "0,-3,12,2"});
  expect_keys(result, "number", volume_keys);
  expect_keys(result, "null",
              {"bulking_factor", "bulking_factor_sd", "density_percent", "density_raw_percent",
               "density_sd_percent", "density_interval_percent"});
  EXPECT_TRUE(warns(result, "no_dumped_soil")) << result["warnings"];
  EXPECT_EQ(result["trustworthy"], false);
  EXPECT_GT(number(result, "/volume/excavated_m3"), 0.25);
}

TEST_F(Tools, StrictRefusesADensityThatShouldNotBeTrusted) {
  // The law of a soil that hardly swells: ordinary bulking lies far beyond its 100 %.
  const std::string law = folder.file("stiff.json");
  const std::string digs = folder.write(
      "stiff.csv", "bulking_factor,density_percent\n1.00,40\n1.02,60\n1.04,80\n1.06,100\n");
  answer("calibrate-density", {"--samples", digs, "--out", law});
  const Words words = quickstart(folder) + Words{"--law", law};
  const json lenient = answer("estimate-density", words);
  EXPECT_EQ(lenient.at("trustworthy"), false);
  EXPECT_FALSE(lenient.at("warnings").empty());
  EXPECT_EQ(number(lenient, "/density_percent"), 100.0);
  EXPECT_GT(number(lenient, "/density_raw_percent"), 100.0);
  EXPECT_EQ(answer("estimate-density", words + Words{"--strict"}, 4), lenient);
  EXPECT_EQ(
      answer("estimate-density", quickstart(folder) + Words{"--area", "0,-3,12,2", "--strict"}, 4)
          .at("trustworthy"),
      false);
}

TEST_F(Tools, ALawFittedToSamplesIsUsed) {
  std::string samples = "bulking_factor,density_percent\n";
  for (const char* row : {"1.0,10\n", "1.1,20\n", "1.3,40\n", "1.6,70\n"}) samples += row;
  const std::string law = folder.file("law.json");
  const json fit =
      answer("calibrate-density", {"--samples", folder.write("digs.csv", samples), "--out", law});
  EXPECT_NEAR(number(fit, "/line/a"), 100.0, 1e-9);
  EXPECT_NEAR(number(fit, "/line/b"), -90.0, 1e-9);
  EXPECT_NEAR(number(fit, "/line/r2"), 1.0, 1e-12);
  const json estimate = answer("estimate-density", quickstart(folder) + Words{"--law", law});
  EXPECT_EQ(estimate.at("law"), "samples");
  EXPECT_NEAR(number(estimate, "/density_percent"),
              100.0 * number(estimate, "/bulking_factor") - 90.0, 1e-3);
}

TEST_F(BadInput, IncompleteOptionsAreRefused) {
  const std::string tool = "estimate-density";
  refused(2, "AFTER is missing", tool, {scan});
  refused(2, "BEFORE is missing", tool, {});
  refused(2, "--dug-path: drag, after 2.725 m: ", tool,
          {scan, later_scan, "--dug-path", "45deg,0.35m,9m", "--dug-start", "6"});
  refused(3, "holds fewer than 100 finite points inside --area", tool,
          {scan, later_scan, "--area", "100,100,101,101"});
  refused(2, "--dug-start needs --dug-path", tool, {scan, later_scan, "--dug-start", "6"});
  refused(2, "--law is for sand, --soil is clay", tool,
          {scan, later_scan, "--law", "zx120-sand", "--soil", "clay"});
  refused(2, "--soil unknown takes the laws of all shipped soils", tool,
          {scan, later_scan, "--law", "paper", "--soil", "unknown"});
  refused(2, "--payload-mass: must be above 0", tool, {scan, later_scan, "--payload-mass", "0"});
  refused(2, "--payload-mass: '1,2,3' is not VALUE,SD", tool,
          {scan, later_scan, "--payload-mass", "1,2,3"});
  refused(2, "--moisture: must be in 0 .. 2 (12 % is 0.12)", tool,
          {scan, later_scan, "--payload-mass", "480", "--moisture", "12"});
  refused(2, "--moisture needs --payload-mass", tool, {scan, later_scan, "--moisture", "0.1"});
  refused(2, "takes no scans", tool, {scan, later_scan, "--plan-survey", "height=2"});
  refused(2,
          "--plan-survey: 'hight' is not one of sensor, height, offset, volume, depth, area, k, "
          "frames, moved, target\nSee",
          tool, {"--plan-survey", "hight=2"});
  refused(2, "frames is 1.5, must be a whole number", tool, {"--plan-survey", "frames=1.5"});
  refused(2, "'height' must be KEY=VALUE", tool, {"--plan-survey", "height"});
  refused(2, "--plan-survey: 'k' is given more than once", tool, {"--plan-survey", "k=1.2,k=1.3"});
  refused(2, "bulking factor is 120, must be in 0.9 .. 3", tool, {"--plan-survey", "k=120"});
}

TEST_F(BadInput, SwappedScansAreRefused) {
  refused(3, "before and after are probably swapped", "estimate-density",
          {later_scan, scan, "--plot", plot});
}

TEST_F(BadInput, ScansThatDoNotOverlapAreRefused) {
  const std::string far = folder.write("far.txt", "1 0 0 100\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  refused(3, "do not overlap", "estimate-density",
          {scan, later_scan, "--after-frame", far, "--plot", plot});
}

/// So many points on level ground of 10 m x 10 m, each in a place of its own.
std::string scattered(int points, unsigned seed) {
  std::mt19937 random(seed);
  const auto place = [&] { return std::to_string(1e-3 * static_cast<double>(random() % 10000)); };
  std::string cloud;
  for (int i = 0; i < points; ++i) cloud += place() + " " + place() + " 0\n";
  return cloud;
}

TEST_F(BadInput, ScansTooSparseForTheirCellsAreNamed) {
  const std::string before = folder.write("before.xyz", scattered(400, 1));
  const std::string after = folder.write("after.xyz", scattered(400, 2));
  const std::string names = before + ", " + after + ": ";
  const std::string shared = "the maps before and after share ";
  refused(3, names, "estimate-density", {before, after});
  refused(3, names + shared, "estimate-density", {before, after, "--no-register", "--cell", "5cm"});
  const std::string log = folder.write("log.csv", "time_s,power_w\n0,1\n1,1\n");
  refused(3, names + shared, "measure-efficiency",
          {log, "--dump-before", before, "--dump-after", after, "--cell", "1cm"});
}

TEST_F(BadInput, FramesThatAreNotRigidAreRefused) {
  const std::string skew = folder.write("skew.txt", "1 0 0 0\n0 2 0 0\n0 0 1 0\n0 0 0 1\n");
  refused(3, "skew.txt: ", "estimate-density", {scan, later_scan, "--before-frame", skew});
  refused(3, "letter.txt: ", "estimate-density", {scan, later_scan, "--before-frame", letter});
}

/// Both quick-start scans as a camera sees them from 6 m above (-3, 2), looking down by 40 degrees
/// from level, and the inverse of what brought them there.
class ScansOfACamera : public BadInput {
 protected:
  ScansOfACamera() {
    const double down = 40.0 * pi / 180.0;
    Eigen::Matrix4d site_from_camera = Eigen::Matrix4d::Identity();
    site_from_camera.topLeftCorner<3, 3>() << 0.0, -std::sin(down), std::cos(down), -1.0, 0.0, 0.0,
        0.0, -std::cos(down), -std::sin(down);
    site_from_camera.topRightCorner<3, 1>() << -3.0, 2.0, 6.0;
    write_frame(folder.file("pose.txt"), site_from_camera);
    write_frame(folder.file("inverse.txt"), site_from_camera.inverse());
    answer("inspect-cloud", {scan, "--frame", folder.file("inverse.txt"), "--out", before});
    answer("inspect-cloud", {later_scan, "--frame", folder.file("inverse.txt"), "--out", after});
    const Eigen::Quaterniond turn(Eigen::Matrix3d(site_from_camera.topLeftCorner<3, 3>()));
    std::ostringstream numbers;
    numbers.precision(17);
    numbers << "-3,2,6," << turn.x() << ',' << turn.y() << ',' << turn.z() << ',' << turn.w();
    pose = numbers.str();
  }
  void expect_density_of_site_frame(const json& result) const {
    const json site = answer("estimate-density", {scan, later_scan});
    const double sd = number(site, "/density_sd_percent");
    EXPECT_NEAR(number(result, "/density_percent"), number(site, "/density_percent"), 0.25 * sd);
    EXPECT_EQ(result.at("trustworthy"), site.at("trustworthy"));
    EXPECT_FALSE(warns(result, "frame"));
  }

  const std::string before = folder.file("camera-before.pcd");
  const std::string after = folder.file("camera-after.pcd");
  std::string pose;
};

TEST_F(ScansOfACamera, LevelFindsTheirFrame) {
  const json result = answer("estimate-density", {before, after, "--level"});
  expect_density_of_site_frame(result);
  EXPECT_EQ(result.at("/pose/method"_json_pointer), "level");
  EXPECT_NEAR(number(result, "/pose/height_m"), 6.0, 0.05);
  EXPECT_NEAR(number(result, "/pose/tilt_rad"), 50.0 * pi / 180.0, 0.01);
}

TEST_F(ScansOfACamera, PosesAreAsGoodAsFrames) {
  const json result =
      answer("estimate-density", {before, after, "--before-pose", pose, "--after-pose", pose});
  expect_density_of_site_frame(result);
  EXPECT_EQ(result.at("pose"), nullptr);
  const json framed =
      answer("estimate-density", {before, after, "--frame", folder.file("pose.txt")});
  EXPECT_NEAR(number(framed, "/volume/excavated_m3"), number(result, "/volume/excavated_m3"), 1e-6);
  const json numbers = answer("estimate-density", {before, after, "--frame", pose});
  EXPECT_NEAR(number(numbers, "/volume/excavated_m3"), number(result, "/volume/excavated_m3"),
              1e-9);
}

TEST_F(ScansOfACamera, FramesExcludeEachOther) {
  const std::string file = folder.file("pose.txt");
  const auto refuse = [&](const std::string& reason, const Words& more) {
    Words words = {before, after};
    words.insert(words.end(), more.begin(), more.end());
    refused(2, reason, "estimate-density", words);
  };
  refuse("--level excludes --frame", {"--level", "--frame", "camera"});
  refuse("--level excludes --before-pose", {"--level", "--before-pose", pose});
  refuse("--frame excludes --after-frame", {"--frame", "lidar", "--after-frame", file});
  refuse("--before-frame excludes --before-pose", {"--before-pose", pose, "--before-frame", file});
  refuse("--before-pose: '1,2' is not a pose", {"--before-pose", "1,2"});
  refuse("the quaternion's norm is 2, must be 1", {"--after-pose", "0,0,0,0,0,0,2"});
}

TEST_F(ScansOfACamera, AFrameThatIsNamedIsNotSuspected) {
  // Ground at 5 m that lies ahead of the origin along z, as all that a camera sees.
  const std::string raised = folder.write("up.txt", "1 0 0 -6\n0 1 0 0\n0 0 1 12\n0 0 0 1\n");
  const std::string low = folder.file("low.pcd");
  const std::string high = folder.file("high.pcd");
  answer("inspect-cloud", {scan, "--frame", raised, "--out", low});
  answer("inspect-cloud", {later_scan, "--frame", raised, "--out", high});
  EXPECT_TRUE(warns(answer("estimate-density", {low, high}), "frame"));
  expect_density_of_site_frame(answer("estimate-density", {low, high, "--frame", "lidar"}));
}

TEST_F(ScansOfACamera, OneScanMayBeStandardInput) {
  const ProgramResult piped = run_program("estimate-density", {"-", later_scan, "--json"}, scan);
  ASSERT_EQ(piped.code, 0) << piped.err;
  expect_density_of_site_frame(json::parse(piped.out));
  const ProgramResult twice = run_program("estimate-density", {"-", "-"}, scan);
  EXPECT_EQ(twice.code, 2);
  EXPECT_TRUE(contains(twice.err, "only one input can be -")) << twice.err;
}

/// The quick-start scan after with points all over boom, arm and bucket of the zx120 above the
/// hole: boom pin at (0.14, 1.424), 4.6, 2.519 and 1.23 m of links, swung by `swing`.
std::string with_machine(const TemporaryFolder& folder, const std::string& scan, double swing,
                         const Eigen::Vector3d& joints) {
  answer("inspect-cloud", {scan, "--out", folder.file("plain.xyz")});
  std::ostringstream rows;
  rows << content_of(folder.file("plain.xyz"));
  Eigen::Vector2d pin(0.14, 1.424);
  double angle = 0.0;
  const double lengths[] = {4.6, 2.519, 1.23};
  for (Eigen::Index link = 0; link < 3; ++link) {
    angle -= joints[link];
    const Eigen::Vector2d end =
        pin + lengths[link] * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    for (double along = 0.0; along <= 1.0; along += 0.02) {
      for (double side = -0.3; side <= 0.3; side += 0.05) {
        const Eigen::Vector2d p = pin + along * (end - pin);
        rows << std::cos(swing) * p.x() - std::sin(swing) * side << ' '
             << std::sin(swing) * p.x() + std::cos(swing) * side << ' ' << p.y() << '\n';
      }
    }
    pin = end;
  }
  return folder.write("machine.xyz", rows.str());
}

TEST_F(BadInput, TheMachineIsCutOutOfAScan) {
  const json clean = answer("estimate-density", {scan, later_scan});
  const std::string seen = with_machine(folder, later_scan, 0.1, {-0.5, 1.2, 0.9});
  const json disturbed = answer("estimate-density", {scan, seen});
  const json cut =
      answer("estimate-density", {scan, seen, "--after-machine-pose", "0.1,-0.5,1.2,0.9"});
  const double sd = number(clean, "/density_sd_percent");
  EXPECT_NEAR(number(cut, "/density_percent"), number(clean, "/density_percent"), 0.25 * sd);
  EXPECT_EQ(warning_codes(cut), warning_codes(clean));
  EXPECT_NE(warning_codes(disturbed), warning_codes(clean));
  refused(2, "--level excludes --machine-pose", "estimate-density",
          {scan, seen, "--level", "--machine-pose", "0,0,1,1"});
  refused(2, "--machine-pose excludes --before-machine-pose", "estimate-density",
          {scan, seen, "--machine-pose", "0,0,1,1", "--before-machine-pose", "0,0,1,1"});
  refused(2, "--machine-pose: '0,1' is not a posture SWING,BOOM,ARM,BUCKET", "estimate-density",
          {scan, seen, "--machine-pose", "0,1"});
}

/// A wheel loader's bite. No truth is known; others found with the frames that came with the scans
/// (CloudCompare) 2.61 m3 removed and 1.47 added, and after registration on the walls and the
/// ground around 2.80 .. 2.96 and 0.36 .. 0.38.
class WheelLoadersBite : public RealScans {
 protected:
  static json volumes(const Words& options) {
    const std::string pair = shared("dig-pair-livox/");
    Words words = {
        pair + "before.pcd", pair + "after.pcd",       "--before-frame", pair + "before_frame.txt",
        "--after-frame",     pair + "after_frame.txt", "--area",         "-1,-1,10,12"};
    words.insert(words.end(), options.begin(), options.end());
    return answer("estimate-density", words);
  }
  static double added(const json& result) {
    return number(result, "/volume/spilled_m3") + number(result, "/volume/dumped_m3");
  }
};

TEST_F(WheelLoadersBite, HasTheVolumesOthersFoundAfterRegistrationWhateverTheCell) {
  for (const char* const cell : {"0.1", "0.15", "0.2"}) {
    SCOPED_TRACE(cell);
    const json result = volumes({"--cell", cell});
    const double removed = number(result, "/volume/excavated_m3");
    std::cout << "  removed " << removed << ", added " << added(result) << " m3\n";
    EXPECT_NEAR(removed, 2.9, 0.25);
    EXPECT_NEAR(added(result), 0.37, 0.12);
    EXPECT_EQ(result.at("/registration/dig/lateral_is_significant"_json_pointer), true);
    EXPECT_TRUE(warns(result, "no_dumped_soil")) << result["warnings"];
    expect_keys(result, "null", {"bulking_factor", "density_percent"});
  }
}

TEST_F(WheelLoadersBite, HasAboutTheVolumesOfADifferenceOfRastersAsTheScansLie) {
  const json result = volumes({"--cell", "0.2", "--no-register"});
  EXPECT_NEAR(number(result, "/volume/excavated_m3"), 2.61, 0.4);
  EXPECT_NEAR(added(result), 1.47, 0.5);
  EXPECT_EQ(result.at("registration"), nullptr);
}

TEST_F(Tools, ReportOfAnEstimateShowsTheGroundWithItsZones) {
  const std::string file = folder.file("report.html");
  const json result = answer("estimate-density", quickstart(folder) + Words{"--report", file});
  const std::string page = content_of(file);
  EXPECT_TRUE(contains(page, "<figure class=\"plot\"><div class=\"spacious\"><svg"));
  EXPECT_TRUE(contains(page, "<div class=\"narrow\"><svg"));
  const json scene = drawn_on(page);
  ASSERT_EQ(scene["zones"].size(), result["zones"].size());
  EXPECT_EQ(scene["zones"][0]["kind"], result["zones"][0]["kind"]);
  const json& area = scene["areas"][0];
  EXPECT_EQ(area["cell_m"], result["cell_m"]);
  ASSERT_EQ(area["states"].size(), 2U);
  EXPECT_NE(area["states"][0]["codes"], area["states"][1]["codes"]);
}

}  // namespace
}  // namespace excavplan::test
