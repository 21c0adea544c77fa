// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>

#include "support/depth_png.hpp"
#include "support/svg_figure.hpp"
#include "support/tool_answers.hpp"

/// @file
/// What all tools have in common: options, streams, exit codes, refusals and figures.

namespace excavplan::test {
namespace {

struct Contract {
  std::string tool;
  Words options;  // beside those that all have
  std::string misspelt;
  std::string meant;
  std::function<Words(const TemporaryFolder&)> run;  // arguments of a run that works
};

void PrintTo(const Contract& contract, std::ostream* out) { *out << contract.tool; }

const std::vector<Contract>& contracts() {
  static const std::vector<Contract> list = {
      {"estimate-density",
       {"--dump-before", "--dump-after", "--dig-area", "--dump-area", "--before-frame",
        "--after-frame", "--before-pose", "--after-pose", "--frame", "--level", "--sensor-origin",
        "--method", "--cell", "--law", "--plot", "--strict"},
       "--dig-aera",
       "--dig-area",
       quickstart},
      {"calibrate-density",
       {"--samples", "--soil", "--machine", "--simulator"},
       "--sample",
       "--samples",
       [](const TemporaryFolder&) {
         return Words{"--densities", "0:25:100"};
       }},
      {"simulate-dig",
       {"--density", "--path", "--start", "--terrain", "--dump-at", "--cell", "--seed", "--noise",
        "--before", "--after", "--history", "--plot", "--report", "--soil", "--machine",
        "--simulator"},
       "--sede",
       "--seed",
       [](const TemporaryFolder&) {
         return Words{"--density", "40"};
       }},
      {"plan-path",
       {"--density", "--density-from", "--library", "--search", "--terrain", "--seed",
        "--trajectory", "--plot", "--soil", "--machine"},
       "--denisty",
       "--density",
       [](const TemporaryFolder&) {
         return Words{"--density", "40"};
       }},
      {"build-path-library",
       {"--densities", "--slopes", "--soil", "--machine", "--simulator", "--method", "--population",
        "--generations", "--seed", "--threads", "--cells", "--resume", "--out"},
       "--thread",
       "--threads",
       [](const TemporaryFolder& folder) {
         return Words{"--densities", "20", "--out", folder.file("library.json")} + small_library;
       }},
      {"run-experiment",
       {"--path", "--soil", "--machine", "--simulator", "--seed"},
       "--densitis",
       "--densities",
       [](const TemporaryFolder&) {
         return Words{"--densities", "40"};
       }},
      {"measure-efficiency",
       {"--volume", "--dump-before", "--dump-after", "--second-volume"},
       "--volum",
       "--volume",
       [](const TemporaryFolder& folder) {
         return Words{folder.write("log.csv", "time_s,fuel_flow_ml_per_s\n0,2\n5,2\n"), "--volume",
                      "0.4"};
       }},
      {"depth-to-cloud", {"--intrinsics", "--pose", "--out"}, "--pos", "--pose", depth_run},
      {"inspect-cloud", {"--out"}, "--uot", "--out", [](const TemporaryFolder&) {
         return Words{shipped("quickstart/before.pcd")};
       }}};
  return list;
}

class EveryTool : public testing::TestWithParam<Contract> {
 protected:
  void SetUp() override {
    if (GetParam().tool == "depth-to-cloud" &&
        !fs::exists(std::string(EXCAVPLAN_BIN) + "/depth-to-cloud")) {
      GTEST_SKIP() << "built without EXCAVPLAN_SURVEY";
    }
  }

  const std::string& tool = GetParam().tool;
  TemporaryFolder folder;
};

INSTANTIATE_TEST_SUITE_P(Tools, EveryTool, testing::ValuesIn(contracts()),
                         [](const auto& parameter) {
                           std::string name = parameter.param.tool;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(EveryTool, HelpNamesEveryOptionAndShowsExamples) {
  const ProgramResult help = run_program(tool, {"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_EQ(help.err, "");
  for (const std::string& option :
       GetParam().options + Words{"--json", "--quiet", "--version", "--help"}) {
    EXPECT_TRUE(contains(help.out, option + " ")) << option;
  }
  EXPECT_TRUE(contains(help.out, "Usage: " + tool));
  EXPECT_TRUE(contains(help.out, "Exit codes:"));
  const std::size_t examples = help.out.find("\nExamples:\n");
  ASSERT_NE(examples, std::string::npos);
  EXPECT_TRUE(contains(help.out.substr(examples), "  " + tool + " "));
}

TEST_P(EveryTool, PrintsItsVersion) {
  const ProgramResult version = run_program(tool, {"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind(tool + " (excavplan) ", 0), 0U) << version.out;
  EXPECT_EQ(version.err, "");
}

TEST_P(EveryTool, RefusesAMisspeltOptionAndSuggestsOne) {
  const ProgramResult refusal = run_program(tool, {GetParam().misspelt, "40"});
  EXPECT_EQ(refusal.code, 2);
  EXPECT_EQ(refusal.out, "");
  EXPECT_TRUE(contains(refusal.err, "unknown option " + GetParam().misspelt + ", did you mean " +
                                        GetParam().meant + "?"))
      << refusal.err;
}

TEST_P(EveryTool, JsonIsOneObjectOnStandardOutput) {
  const json object = answer(tool, GetParam().run(folder));
  expect_keys(object, "string", {"tool", "version"});
  expect_keys(object, "array", {"warnings"});
  EXPECT_EQ(object["tool"], tool);
  for (const json& warning : object["warnings"]) {
    expect_keys(warning, "string", {"code", "message"});
  }
}

TEST_P(EveryTool, QuietLeavesOnlyTheJson) {
  const Words words = GetParam().run(folder) + Words{"--quiet"};
  const ProgramResult quiet = run_program(tool, words);
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
  const ProgramResult with_json = run_program(tool, words + Words{"--json"});
  EXPECT_EQ(with_json.err, "");
  EXPECT_TRUE(json::parse(with_json.out, nullptr, false).is_object()) << with_json.out;
}

TEST_F(BadInput, FilesThatAreNoCloudsAreRefused) {
  const std::string missing = folder.file("none.pcd");
  for (const auto& [file, reason] : std::vector<std::pair<std::string, std::string>>{
           {missing, "none.pcd: cannot be opened"},
           {letter, "letter.txt: line 1: found 'Dear reader,'"},
           {folder.file(""), "is not a regular file"},
           {folder.write("empty.pcd", ""), "empty.pcd: "},
           {folder.write("cut.pcd", content_of(scan).substr(0, 5000)), "cut.pcd: "}}) {
    refused(3, reason, "estimate-density", {file, later_scan, "--plot", plot});
    refused(3, reason, "estimate-density", {scan, file, "--plot", plot});
    refused(3, reason, "inspect-cloud", {file, "--out", folder.file("out.ply")});
    refused(3, reason, "plan-path", {"--density", "40", "--terrain", file, "--plot", plot});
    refused(3, reason, "simulate-dig", {"--density", "40", "--terrain", file, "--plot", plot});
  }
}

TEST_F(BadInput, ValuesOutOfRangeAreRefused) {
  refused(2, "--density: 140 % is outside 0 .. 100", "plan-path", {"--density", "140"});
  refused(2, "--density-sd: -3 must be at least 0", "plan-path",
          {"--density", "40", "--density-sd=-3"});
  refused(2, "140 %, must be in 0 .. 100 %", "simulate-dig", {"--density", "140", "--plot", plot});
  refused(2, "0 .. 100", "build-path-library", {"--densities", "140", "--out", plot});
  refused(2, "0 .. 100", "run-experiment", {"--densities", "140"});
  refused(2, "--density: 'dense'", "plan-path", {"--density", "dense"});
  refused(2, "cell is 0 m", "estimate-density", {scan, later_scan, "--cell", "0"});
  refused(2, "cell size is 0 m", "simulate-dig", {"--density", "40", "--cell", "0"});
  refused(2, "--area: ", "estimate-density", {scan, later_scan, "--area", "1,2,3"});
}

TEST_F(BadInput, UnitsOfAnotherQuantityAreRefused) {
  refused(2, "--cell: '5deg' is an angle, expected a length", "simulate-dig",
          {"--density", "40", "--cell", "5deg"});
  refused(2, "--cell: '5deg' is an angle", "estimate-density",
          {scan, later_scan, "--cell", "5deg", "--plot", plot});
}

TEST_F(BadInput, NamesThatAreNotShippedAreRefused) {
  for (const char* tool : {"simulate-dig", "plan-path"}) {
    refused(2, "'mud' is neither a file nor one of the soils", tool,
            {"--density", "40", "--soil", "mud"});
    refused(2, "'zx999' is neither a file nor one of the machines", tool,
            {"--density", "40", "--machine", "zx999"});
  }
  refused(2, "neither a file nor one of the laws", "estimate-density",
          {scan, later_scan, "--law", "none"});
  refused(3, "letter.txt: not valid JSON", "estimate-density", {scan, later_scan, "--law", letter});
}

TEST_F(BadInput, NamesThatAreLoopsOrTooLongAreRefused) {
  const std::string loop = folder.file("loop");
  fs::create_symlink("loop", loop);
  const std::string letters(300, 'a');
  refused(3, loop + ": cannot be opened: Too many levels of symbolic links", "simulate-dig",
          {"--density", "40", "--soil", loop});
  refused(2, letters + "' is neither a file nor one of the machines", "plan-path",
          {"--density", "40", "--machine", letters});
  refused(3, loop + ": Too many levels of symbolic links", "build-path-library",
          {"--out", folder.file("library.json"), "--cells", loop});
}

TEST_F(BadInput, FilesOfOtherFormatsAreNotWritten) {
  const std::string png = folder.file("plot.png");
  refused(2, "must end in .svg", "estimate-density", {scan, later_scan, "--plot", png});
  refused(2, "must end in .svg", "simulate-dig", {"--density", "40", "--plot", png});
  refused(2, "must end in .svg", "plan-path", {"--density", "40", "--plot", png});
  refused(2, "must end in .pcd, .ply", "inspect-cloud", {scan, "--out", png});
  refused(2, "must end in .pcd, .ply", "simulate-dig",
          {"--density", "40", "--before", folder.file("b.pcd"), "--after", png});
  refused(3, "there is no folder", "plan-path",
          {"--density", "40", "--trajectory", folder.file("none/dig.csv")});
  refused(3, "there is no folder", "simulate-dig",
          {"--density", "40", "--history", folder.file("none/dig.csv")});
  refused(3, "/dev/full: cannot be written: No space left on device", "calibrate-density",
          {"--densities", "20", "--out", "/dev/full"});
}

TEST_F(BadInput, SurplusAndRepeatedArgumentsAreRefused) {
  refused(2, "unexpected argument 'b.pcd'", "inspect-cloud", {scan, "b.pcd"});
  refused(2, "--density is given more than once", "plan-path",
          {"--density", "40", "--density", "50"});
  refused(2, "AFTER is missing", "estimate-density", {scan});
}

TEST(XmlFault, IsFound) {
  EXPECT_EQ(xml_fault("<?xml?><!-- < --><a b=\"1\"><c/>&amp;</a>"), "");
  EXPECT_NE(xml_fault("<a><b></a>"), "");
  EXPECT_NE(xml_fault("<a>"), "");
  EXPECT_NE(xml_fault("<a b=\"1></a>"), "");
  EXPECT_NE(xml_fault("<a>sand & loam, more or less</a>"), "");
}

TEST_F(Tools, FiguresAreWellFormedAndShowTheirLabels) {
  const std::string file = folder.file("figure.svg");
  answer("estimate-density", quickstart(folder) + Words{"--plot", file});
  expect_figure(file, {"hole", "heap"});
  answer("simulate-dig", {"--density", "40", "--plot", file});
  expect_figure(file, {"loam at 40.0 %", "penetrate", "drag", "scoop"});
  answer("plan-path", {"--density", "80", "--plot", file});
  expect_figure(file, {"loam at 80.0 %", "penetrate", "drag", "scoop"});
}

}  // namespace
}  // namespace excavplan::test
