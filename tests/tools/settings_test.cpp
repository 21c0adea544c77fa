// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/settings_file.hpp"

#include <gtest/gtest.h>

#include "inputs/plots.hpp"
#include "inputs/simulator_inputs.hpp"
#include "support/errors.hpp"
#include "support/tool_answers.hpp"

namespace excavplan::tools {
namespace {

using test::error_of;

class SettingsText : public ::testing::Test {
 protected:
  SettingsText() {
    arguments.positional("SCAN", scan, "");
    arguments.flag("search", search, "");
    arguments.text("soil", "NAME", soil, "");
    arguments.text("range", "FROM,TO", range, "");
    arguments.option("camera", cameras, "");
    arguments.output("trajectory", trajectory, "");
    arguments.folder("output", output, "");
    declare_plots(arguments, plots, {{"section", ""}});
    declare_simulator(arguments, simulator);
  }
  std::vector<std::string> texts(const std::string& toml, const std::string& name) const {
    for (const auto& option :
         parse_settings("site.toml", toml, "plan-path", arguments.entries()).options) {
      if (arguments.entries()[option.entry].name == name) return option.texts;
    }
    return {"not stated"};
  }
  std::string refusal(const std::string& toml) const {
    return error_of([&] { parse_settings("site.toml", toml, "plan-path", arguments.entries()); },
                    ErrorKind::bad_file);
  }

  Arguments arguments;
  std::string scan, soil, range;
  bool search = false;
  std::vector<CameraPlace> cameras;
  SimulatorInputs simulator;
  std::optional<std::string> trajectory, output;
  Plots plots;
};

using Texts = std::vector<std::string>;

TEST_F(SettingsText, ValuesReadAsOnTheCommandLine) {
  EXPECT_EQ(texts("soil = 'sand'", "soil"), Texts{"sand"});
  EXPECT_EQ(texts("soil = 3", "soil"), Texts{"3"});
  EXPECT_EQ(texts("soil = 0.05", "soil"), Texts{"0.05"});
  EXPECT_EQ(texts("range = [0.4, 0.9]", "range"), Texts{"0.4,0.9"});
  EXPECT_EQ(texts("range = ['30deg', '60deg']", "range"), Texts{"30deg,60deg"});
  EXPECT_EQ(texts("camera = [[1,2,3,4,5,6], '0,0,2,5,0,0']", "camera"),
            (Texts{"1,2,3,4,5,6", "0,0,2,5,0,0"}));
  EXPECT_EQ(texts("search = true", "search").size(), 1U);
  EXPECT_EQ(texts("search = false", "search"), Texts{});
}

TEST_F(SettingsText, TheTableOfTheToolWins) {
  const std::string both = "soil = 'sand'\n[plan-path]\nsoil = 'clay'\n[simulate-dig]\nnoise = 1\n";
  EXPECT_EQ(texts(both, "soil"), Texts{"clay"});
}

TEST_F(SettingsText, WhatIsOfOtherToolsIsLeftOut) {
  const auto stated = parse_settings("site.toml", "noise = 1\n[simulate-dig]\nnoise = 1",
                                     "plan-path", arguments.entries());
  EXPECT_EQ(stated.left_out, (Texts{"noise", "[simulate-dig]"}));
  EXPECT_TRUE(stated.options.empty());
}

TEST_F(SettingsText, WhatIsWrongIsNamedWithItsPlace) {
  EXPECT_EQ(refusal("\n[plan-path]\nsoyl = 'x'"),
            "site.toml: line 3, column 8: 'soyl' is no option of plan-path, did you mean 'soil'?");
  EXPECT_EQ(refusal("[plan-path]\nSCAN = 'x'"),
            "site.toml: line 2, column 8: 'SCAN' is no option of plan-path");
  EXPECT_EQ(refusal("plan-path = 1"),
            "site.toml: line 1, column 13: 'plan-path' must be a table, [plan-path]");
  EXPECT_EQ(refusal("search = 1"), "site.toml: line 1, column 10: 'search' must be true or false");
  EXPECT_EQ(refusal("soil = true"), "site.toml: line 1, column 8: 'soil' needs a value, NAME");
  EXPECT_EQ(refusal("help = true"),
            "site.toml: line 1, column 8: --help is of the command line alone");
  EXPECT_EQ(refusal("soil = 1979-05-27"),
            "site.toml: line 1, column 8: must be a text, a number, true, false or a list of texts "
            "or numbers");
  EXPECT_EQ(refusal("soil = \"a\\u0007\"").rfind("site.toml: line 1, column 8: a text is", 0), 0U);
  EXPECT_EQ(refusal("soil = 'x").rfind("site.toml: line 1, column 10: Error while parsing", 0), 0U);
  EXPECT_EQ(refusal("[\007plan-path]").rfind("site.toml: line 1, column 2: Error while", 0), 0U);
  EXPECT_EQ(refusal("soil = '\xff'"), "site.toml: byte 8 is no UTF-8 text");
  EXPECT_EQ(refusal("a" + std::string(2000, '.')),
            "site.toml: line 1: 2001 bytes, at most 1000 are allowed");
  EXPECT_EQ(refusal("\n[plan-pth]"),
            "site.toml: line 2, column 1: '[plan-pth]' is the name of no tool, did you mean "
            "'plan-path'?");
}

TEST_F(SettingsText, NothingInItRunsCode) {
  EXPECT_EQ(texts("simulator = 'section'", "simulator"), Texts{"section"});
  EXPECT_EQ(refusal("simulator = './evil.so'"),
            "site.toml: line 1, column 13: --simulator: './evil.so' in a file, expected height-map "
            "or section; a shared library is named on the command line alone");
  EXPECT_EQ(
      refusal("[plan-path]\nsimulator-command = 'touch x'"),
      "site.toml: line 2, column 21: --simulator-command is of the command line alone: a file "
      "names no program to run");
}

// Nor does it replace files of who runs it.
TEST_F(SettingsText, NothingInItWrites) {
  for (const std::string name : {"trajectory", "output", "plot"}) {
    EXPECT_EQ(refusal("[plan-path]\n" + name + " = '../.bashrc'"),
              "site.toml: line 2, column " + std::to_string(name.size() + 4) + ": --" + name +
                  " is of the command line alone: a file names nothing to write");
  }
}

}  // namespace
}  // namespace excavplan::tools

namespace excavplan::test {
namespace {

TEST(Settings, FillWhatTheCommandLineDoesNotGive) {
  const TemporaryFolder folder;
  const std::string file = folder.write(
      "site.toml", "soil = \"sand\"\nnoise = 1\n[plan-path]\ndensity = 40\ngoal = \"energy\"\n");
  json by_file = answer("plan-path", {"--config", file});
  json by_words = answer("plan-path", {"--soil", "sand", "--density", "40", "--goal", "energy"});
  by_file.erase("wall_time_s");
  by_words.erase("wall_time_s");
  EXPECT_EQ(by_file, by_words);
  EXPECT_EQ(answer("plan-path", {"--config", file, "--density", "70"}).at("density_percent"), 70.0);
  const ProgramResult shown = run_program("plan-path", {"--config", file});
  EXPECT_EQ(shown.err.rfind(
                "settings from " + file + ": --soil, --density, --goal; left out: noise\n", 0),
            0U)
      << shown.err;
}

TEST(Settings, ComeFromStandardInputToo) {
  const TemporaryFolder folder;
  const std::string file = folder.write("site.toml", "[plan-path]\ndensity = 40\n");
  const ProgramResult result = run_program("plan-path", {"--config", "-", "--json"}, file);
  EXPECT_EQ(result.code, 0) << result.err;
}

TEST(Settings, TheCommandLineWinsOverWhatExcludesIt) {
  const TemporaryFolder folder;
  const std::string file = folder.write("site.toml", "density = 40\n");
  const std::string result = folder.write("result.json", R"({"density_percent": 70})");
  const ProgramResult run = run_program("plan-path", {"--config", file, "--density-from", result});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err.rfind("settings from " + file +
                              ": nothing; left out: --density (--density-from is given)\n",
                          0),
            0U)
      << run.err;
}

TEST(Settings, ManyUnknownKeysAreCut) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "k" + std::to_string(i) + " = 1\n";
  const std::string file = folder.write("site.toml", text);
  const ProgramResult run = run_program("plan-path", {"--config", file, "--density", "40"});
  EXPECT_TRUE(contains(run.err, " and 980 more\n")) << run.err;
}

TEST(Settings, ValuesThatAreRefusedAreNamedWithTheirPlace) {
  const TemporaryFolder folder;
  const std::string file = folder.file("site.toml");
  const auto said = [&](const std::string& text) {
    folder.write("site.toml", text);
    const ProgramResult run = run_program("plan-path", {"--config", file});
    EXPECT_EQ(run.code, 3) << run.err;
    return run.err;
  };
  const std::string start = "plan-path: " + file + ": line ";
  EXPECT_EQ(said("density = nan").rfind(start + "1, column 11: --density: 'nan'", 0), 0U);
  EXPECT_EQ(
      said("[plan-path]\ndensity = [1, 2]").rfind(start + "2, column 11: --density: '1,2'", 0), 0U);
  EXPECT_EQ(said("density = 40\nseed = 1.5").rfind(start + "2, column 8: --seed: '1.5'", 0), 0U);
  EXPECT_TRUE(contains(said("density = 400"), start + "1, column 11: --density: 400 % is outside"));
}

TEST(Settings, AreCheckedAsTheCommandLineIs) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("site.toml", "[plan-path]\ndensity = 40\nsoil = \"snad\"\n");
  EXPECT_NE(run_program("plan-path", {"--config", file}).code, 0);
  EXPECT_EQ(run_program("plan-path", {"--config", folder.file("none.toml")}).code, 3);
}

}  // namespace
}  // namespace excavplan::test
