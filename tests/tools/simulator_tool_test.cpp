// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// --simulator FILE.so and --simulator-command of the tools that have them.

#include <fcntl.h>

#include <csignal>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "support/tool_answers.hpp"

namespace excavplan {
namespace {

using test::answer;
using test::contains;
using test::json;
using test::operator+;
using test::run_program;
using test::TemporaryFolder;
using test::Words;

const std::string plugin = EXCAVPLAN_PLUGINS "/libcutting_resistance.so";
const std::string program = "python3 '" EXCAVPLAN_EXAMPLES "/simulator_command/fee_wedge.py'";
std::string odd(const std::string& how) {
  return "python3 '" EXCAVPLAN_TEST_SUPPORT "/odd_simulator.py' " + how;
}

TEST(SimulatorTool, LibraryAndProgramDig) {
  const Words dig = {"--density", "40", "--cell", "0.1"};
  const json built_in = answer("simulate-dig", dig);
  for (const Words& words : {Words{"--simulator", plugin}, Words{"--simulator-command", program}}) {
    const json result = answer("simulate-dig", dig + words);
    EXPECT_GT(result.at("payload_mass_kg"), 50.0);
    EXPECT_NE(result.at("payload_mass_kg"), built_in.at("payload_mass_kg"));
  }
}

TEST(SimulatorTool, PlansAndLibrariesNameIt) {
  const TemporaryFolder folder;
  const json plan = answer("plan-path", {"--density", "40", "--search", "--evaluations", "15",
                                         "--cell", "0.1", "--simulator-command", program});
  EXPECT_EQ(plan.at("simulator"), "fee wedge 1 (program)");
  EXPECT_EQ(plan.at("source"), "search");
  const std::string file = folder.file("library.json");
  const Words build = {"--densities", "40",     "--points", "6",     "--polish",
                       "4",           "--cell", "0.1",      "--out", file};
  answer("build-path-library", build + Words{"--simulator", plugin});
  const std::string name = json::parse(test::content_of(file)).at("simulator");
  EXPECT_TRUE(contains(name, "cutting resistance 1 (library ")) << name;
  const auto refused = run_program("plan-path", {"--density", "40", "--library", file});
  EXPECT_NE(refused.code, 0);
  EXPECT_TRUE(contains(refused.err, name)) << refused.err;
  EXPECT_EQ(answer("plan-path", {"--density", "40", "--library", file, "--simulator", plugin})
                .at("evaluations"),
            0);
}

TEST(SimulatorTool, SaysWhatIsWrong) {
  const auto said = [](const Words& words, int code) {
    const auto result = run_program("simulate-dig", Words{"--density", "40"} + words);
    EXPECT_EQ(result.code, code) << result.err;
    return result.err;
  };
  EXPECT_TRUE(
      contains(said({"--simulator", "magic"}, 2), "'magic' is none of height-map, section"));
  EXPECT_TRUE(contains(said({"--simulator", "./none.so"}, 3), "./none.so: cannot be opened"));
  EXPECT_TRUE(contains(said({"--simulator", "section", "--simulator-command", program}, 2),
                       "--simulator-command excludes --simulator"));
  EXPECT_TRUE(contains(said({"--simulator-command", program, "--simulator-timeout", "0"}, 2),
                       "--simulator-timeout"));
  EXPECT_TRUE(contains(said({"--simulator-timeout", "5"}, 0), "there is no --simulator-command"));
  const std::string exits = said({"--simulator-command", odd("exit")}, 3);
  EXPECT_FALSE(contains(exits, "--help")) << exits;
  said({"--simulator-command", "false"}, 3);
  said({"--simulator", EXCAVPLAN_PLUGINS "/libodd_fails.so"}, 3);
  EXPECT_TRUE(contains(exits, "simulator: out of?[31m licences\n")) << exits;
  EXPECT_TRUE(contains(exits, "simulator 'odd 1 (program)': it ended, with exit code 3")) << exits;
}

TEST(SimulatorTool, ALibraryThatEndsTheToolIsNoSuccess) {
  const auto result = run_program(
      "simulate-dig", {"--density", "40", "--simulator", EXCAVPLAN_PLUGINS "/libodd_ends.so"});
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.err, "the program was ended by code that is no part of excavplan\n");
}

TEST(SimulatorTool, ShowsWhatTheProgramWritesOnStandardError) {
  const Words words = {"--density", "40", "--cell", "0.1", "--simulator-command", odd("none")};
  EXPECT_EQ(run_program("simulate-dig", words).err, "simulator: step?[2J one\n");
  EXPECT_EQ(run_program("simulate-dig", words + Words{"--quiet"}).err, "");
}

bool runs(int process) {
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string number, name, state;
  return (stat >> number >> name >> state) && state != "Z";
}

TEST(SimulatorTool, AnInterruptEndsTheProgramAndItsChildren) {
  for (const std::string tool : {"simulate-dig", "plan-path"}) {
    const TemporaryFolder folder;
    const std::string file = folder.file("processes");
    Words words = {"--density", "40", "--simulator-command", odd("family " + file)};
    if (tool == "plan-path") words.push_back("--search");
    const pid_t child = test::started(tool, words, [] {
      ::dup2(::open("/dev/null", O_RDWR), STDOUT_FILENO);
      ::dup2(::open("/dev/null", O_RDWR), STDERR_FILENO);
    });
    int own = 0;
    int grandchild = 0;
    for (int i = 0; i < 3000 && grandchild == 0; ++i) {
      ::usleep(10000);
      std::ifstream(file) >> own >> grandchild;
    }
    ASSERT_GT(grandchild, 0) << tool;
    EXPECT_TRUE(runs(own));
    ::kill(child, SIGINT);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(test::exit_code(status), 128 + SIGINT) << tool;
    for (int i = 0; i < 500 && (runs(own) || runs(grandchild)); ++i) ::usleep(10000);
    EXPECT_FALSE(runs(own)) << tool;
    EXPECT_FALSE(runs(grandchild)) << tool;
  }
}

}  // namespace
}  // namespace excavplan
