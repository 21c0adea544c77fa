// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/tool.hpp"

#include "inputs/plots.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <excavplan/base/data_files.hpp>

#include "frame/stack.hpp"
#include "inputs/named_kinds.hpp"
#include "support/errors.hpp"

namespace excavplan::tools {
namespace {

using test::error_of;

TEST(Quantity, BareNumbersAreSi) {
  EXPECT_EQ(parse_quantity("--cell", "0.05", Quantity::length), 0.05);
  EXPECT_EQ(parse_quantity("--angle", "-1.5e-1", Quantity::angle), -0.15);
  EXPECT_EQ(parse_quantity("--start", "+3", Quantity::length), 3.0);
}

TEST(Quantity, DegreesWithoutTheirUnitAreTold) {
  for (const char* bare : {"45", "-40", "90", "6.3"}) {
    EXPECT_EQ(test::error_of([&] { parse_quantity("--swing", bare, Quantity::angle); }),
              "--swing: '" + std::string(bare) +
                  "' rad is more than a turn; degrees have their unit, as in 45deg");
  }
  EXPECT_EQ(parse_quantity("--swing", "6.28", Quantity::angle), 6.28);
  EXPECT_NEAR(parse_quantity("--swing", "400deg", Quantity::angle), 6.98, 0.01);
}

TEST(Quantity, UnitsAreConverted) {
  EXPECT_DOUBLE_EQ(parse_quantity("", "45deg", Quantity::angle), std::atan(1.0));
  EXPECT_DOUBLE_EQ(parse_quantity("", "5cm", Quantity::length), 0.05);
  EXPECT_DOUBLE_EQ(parse_quantity("", "50 mm", Quantity::length), 0.05);
  EXPECT_DOUBLE_EQ(parse_quantity("", "400L", Quantity::volume), 0.4);
  EXPECT_DOUBLE_EQ(parse_quantity("", "40%", Quantity::percent), 40.0);
  EXPECT_DOUBLE_EQ(parse_quantity("", "1.5min", Quantity::time), 90.0);
}

TEST(Quantity, JunkAndWrongKindsAreRefused) {
  EXPECT_EQ(error_of([] { parse_quantity("--cell", "5deg", Quantity::length); }),
            "--cell: '5deg' is an angle, expected a length such as 0.05, 5cm or 50mm");
  EXPECT_EQ(error_of([] { parse_quantity("--density", "4x", Quantity::percent); }),
            "--density: '4x' has the unknown unit 'x', expected a percentage such as 40 or 40%");
  for (const char* junk :
       {"", "x", "nan", "inf", "-", "+", "+-3", "1e999", "0,5", "5cm cm", "--3"}) {
    EXPECT_NE(error_of([&] { parse_quantity("--cell", junk, Quantity::length); }), "no error")
        << junk;
  }
}

TEST(DigPathText, TakesThreeQuantities) {
  const DigParameters path = parse_dig_path("--path", "45deg,35cm,1.5");
  EXPECT_DOUBLE_EQ(path.penetration_angle, std::atan(1.0));
  EXPECT_DOUBLE_EQ(path.penetration_length, 0.35);
  EXPECT_EQ(path.drag_length, 1.5);
  EXPECT_EQ(dig_path_argument(paper_fixed_path()), "45deg,0.35m,1.5m");
  EXPECT_EQ(dig_path_form().placeholder, "ANGLE,LENGTH,LENGTH");
  EXPECT_EQ(dig_path_form().units, "rad,m,m");
  EXPECT_EQ(dig_path_form().names, "penetration angle, penetration length, drag length");
  for (const char* bad : {"45deg,1m", "45deg,1m,1m,1m", "45deg,1m,1m,", "1m,1m,1m", ",,", ""}) {
    EXPECT_NE(error_of([&] { parse_dig_path("--path", bad); }), "no error") << bad;
  }
}

TEST(RectangleText, NeedsAnExtent) {
  const Rectangle area = parse_rectangle("--dig-area", "4,-1,7,100cm");
  EXPECT_EQ(area.x_min, 4.0);
  EXPECT_EQ(area.y_max, 1.0);
  EXPECT_EQ(error_of([] { parse_rectangle("--dig-area", "1,0,1,2"); }),
            "--dig-area: '1,0,1,2' is empty: XMIN must be below XMAX, YMIN below YMAX");
}

TEST(Readable, KeepsDigitsWithoutExponents) {
  EXPECT_EQ(readable(0.4512), "0.451");
  EXPECT_EQ(readable(12345.6), "12346");
  EXPECT_EQ(readable(0.0), "0.00");
  EXPECT_EQ(readable(std::numeric_limits<double>::quiet_NaN()), "unknown");
  EXPECT_EQ(readable(0.45123, 0.0123), "0.451 ± 0.012");
  EXPECT_EQ(readable(46.4, 7.3), "46.4 ± 7.3");
}

TEST(Readable, RoundingIsZeroWithoutASign) {
  EXPECT_EQ(readable(-4.3e-16), "0.00");
  EXPECT_EQ(readable(-0.0), "0.00");
  EXPECT_EQ(readable(-2e-9), "-0.00000000200");
  EXPECT_EQ(readable(-0.0004, 0.012), "0.000 ± 0.012");
  EXPECT_EQ(readable(0.4512, 1e-12), "0.451");
}

/// A tool that takes a bit of everything, run in this process.
struct Probe {
  int code = -1;
  std::string out;
  std::string err;
  std::string before;
  double cell_size = 0.05;
  std::optional<double> density;
  bool worked = false;
};

Probe run(std::vector<const char*> words, const Outcome& outcome = {}) {
  Probe result;
  Plots plots;
  std::string method = "surface";
  std::uint64_t seed = 1;
  words.insert(words.begin(), "probe");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  result.code = run_tool(
      static_cast<int>(words.size()), words.data(),
      {"probe", "Probes.", {{"probe a.pcd", "the example"}}, true, false},
      [&](Arguments& arguments) {
        arguments.positional("BEFORE", result.before, "a scan");
        arguments.option("density", result.density, Quantity::percent, "density of the ground");
        arguments.require("density");
        arguments.option("cell", result.cell_size, Quantity::length, "edge of a cell");
        arguments.option("seed", seed, "start of the random numbers");
        arguments.choice("method", method, {"surface", "paper"}, "how");
        declare_plots(arguments, plots,
                      {{"change", "the change"},
                       {"law", "the law", {[] { return false; }, "there is none"}}});
      },
      [&](Console& console) {
        result.worked = true;
        console.note("working");
        return outcome;
      });
  result.out = testing::internal::GetCapturedStdout();
  result.err = testing::internal::GetCapturedStderr();
  return result;
}

/// Lets this process have no more memory than it has.
void use_up_memory() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  ::setrlimit(RLIMIT_AS, &limit);
}

[[gnu::noinline]] void use_stack() {
  std::array<volatile char, stack_reserve - 16384> bytes;
  for (std::size_t i = bytes.size(); i > 0; i -= std::min<std::size_t>(i, 4096)) bytes[i - 1] = 0;
}

TEST(Stack, IsHeldForWhenMemoryIsUsedUp) {
  const auto later = [] {
    const bool held = hold_stack();
    use_up_memory();
    use_stack();
    ::_exit(held ? 0 : 1);
  };
  EXPECT_EXIT(later(), testing::ExitedWithCode(0), "");
}

TEST(Stack, ThatCannotBeHadIsNotHeld) {
  const auto without_memory = [] {
    use_up_memory();
    ::_exit(hold_stack() ? 0 : 1);
  };
  EXPECT_EXIT(without_memory(), testing::ExitedWithCode(1), "");
}

TEST(Tool, OptionsMayStandBeforeAndAfterPositionals) {
  for (const auto& words : {std::vector<const char*>{"--cell", "5mm", "a.pcd", "--density", "40"},
                            std::vector<const char*>{"a.pcd", "--density=40%", "--cell=0.005"}}) {
    const Probe probe = run(words);
    EXPECT_EQ(probe.code, 0) << probe.err;
    EXPECT_EQ(probe.before, "a.pcd");
    EXPECT_EQ(probe.cell_size, 0.005);
    EXPECT_EQ(probe.density, 40.0);
  }
}

TEST(Tool, WordsBehindTwoDashesAreNames) {
  for (const char* name : {"a.pcd", "--json", "--xyzzy", "-h", "--"}) {
    const Probe probe = run({"--density", "40", "--", name});
    EXPECT_EQ(probe.code, 0) << probe.err;
    EXPECT_EQ(probe.before, name);
    EXPECT_EQ(run({"a.pcd", "--density", "40", "--", name}).err,
              "probe: unexpected argument '" + std::string(name) + "'\nSee probe --help\n");
  }
  EXPECT_EQ(run({"a.pcd", "--density", "40", "--"}).code, 0);
  EXPECT_EQ(run({"--xyzzy", "--", "--json"}).err,
            "probe: unknown option --xyzzy\nSee probe --help\n");
}

TEST(Tool, MisspeltOptionIsReportedBeforeTheMissingOne) {
  for (const char* misspelt : {"--denisty", "--densty", "-density", "--dens", "--Density"}) {
    const Probe probe = run({"a.pcd", misspelt, "40"});
    EXPECT_EQ(probe.code, 2);
    EXPECT_EQ(probe.err, "probe: unknown option " + std::string(misspelt) +
                             ", did you mean --density?\nSee probe --help\n");
    EXPECT_FALSE(probe.worked);
  }
  EXPECT_EQ(run({"a.pcd", "--xyzzy"}).err, "probe: unknown option --xyzzy\nSee probe --help\n");
}

TEST(Tool, WrongUsageEndsWithTwoAndSaysWhy) {
  const std::vector<std::pair<std::vector<const char*>, std::string>> cases = {
      {{"a.pcd"}, "--density is missing: density of the ground [%]"},
      {{"--density", "4"}, "BEFORE is missing: a scan"},
      {{"a", "b", "--density", "4"}, "unexpected argument 'b'"},
      {{"a", "-", "--density", "4"}, "unexpected argument '-'"},
      {{"a", "---", "--density", "4"}, "unexpected argument '---'"},
      {{"a", "--density", "4", "--density", "5"}, "--density is given more than once"},
      {{"a", "--density", "--json"}, "--density needs a value, got --json"},
      {{"a", "--density", "4", "--seed", "-1"}, "--seed: '-1' is not a whole number, 0 or more"},
      {{"a", "--density", "4", "--seed", "99999999999999999999"},
       "--seed: 99999999999999999999 is too large"},
      {{"a", "--density", "4", "--method", "papr"},
       "--method: 'papr' is not one of surface, paper"},
      {{"a", "--density", "4", "--plot", "x.gif"},
       "--plot: 'x.gif' must end in .svg or .png or .pdf"},
      {{"a", "--density", "4", "--plot", "change=x"},
       "--plot: 'x' must end in .svg or .png or .pdf"},
      {{"a", "--density", "4", "--plot", "chnge=x.svg"},
       "--plot: there is no figure 'chnge', expected one of change, law"},
      {{"a", "--density", "4", "--plot", "law=x.svg"}, "--plot: no figure 'law': there is none"},
      {{"a", "--density", "4", "--plot", "change="}, "--plot: change= names no file"},
      {{"a", "--density", "4", "--plot", "change=-"},
       "--plot: standard output is no file to write, ./- is one of that name"},
      {{"a", "--density", "4", "--plot", "x.svg", "--plot", "change=./x.svg"},
       "--plot and --plot name the same file, x.svg"},
      {{"a", "--density", "4", "--plot", "x.svg", "--plot-size", "39mm"},
       "--plot-size: 39mm must be 40mm .. 500mm"},
      {{"a", "--density", "4", "--plot", "x.svg", "--plot-size", "85mm,501mm"},
       "--plot-size: 501mm must be 40mm .. 500mm"},
      {{"a", "--density", "4", "--plot", "x.svg", "--plot-size", "85"},
       "--plot-size: 85 m must be 40mm .. 500mm; 85mm is in millimetres"},
      {{"a", "--density", "4", "--plot", "x.svg", "--plot-size", "1,1,1"},
       "--plot-size: '1,1,1' must be a width, or width,height"}};
  for (const auto& [words, message] : cases) {
    const Probe probe = run(words);
    EXPECT_EQ(probe.code, 2);
    EXPECT_EQ(probe.err, "probe: " + message + "\nSee probe --help\n");
    EXPECT_EQ(probe.out, "");
  }
}

TEST(Tool, JsonIsOneObjectAndNanIsNull) {
  Outcome outcome;
  outcome.json = {{"bulking_factor", std::numeric_limits<double>::quiet_NaN()}, {"points", 3}};
  outcome.lines = {"for people"};
  outcome.warnings = {{WarningCode::no_dumped_soil, "no dumped soil is in the scans"}};
  const Probe probe = run({"a", "--density", "4", "--json"}, outcome);
  const auto json = nlohmann::ordered_json::parse(probe.out);
  EXPECT_TRUE(json.at("bulking_factor").is_null());
  EXPECT_EQ(json.at("points"), 3);
  EXPECT_EQ(json.at("tool"), "probe");
  EXPECT_EQ(json.at("warnings").at(0).at("code"), "no_dumped_soil");
  EXPECT_EQ(json.at("warnings").at(0).at("ends_trust"), false);
  EXPECT_EQ(probe.err,
            "working\nprobe: warning (no_dumped_soil): no dumped soil is in the scans\n");
}

TEST(Tool, PeopleGetLinesAndQuietNone) {
  Outcome outcome;
  outcome.lines = {"density 40 %"};
  EXPECT_EQ(run({"a", "--density", "4"}, outcome).out, "density 40 %\n");
  const Probe quiet = run({"a", "--density", "4", "--quiet"}, outcome);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST(Tool, OnlyStrictExitsWithFour) {
  Outcome outcome;
  outcome.trustworthy = false;
  EXPECT_EQ(run({"a", "--density", "4"}, outcome).code, 0);
  EXPECT_EQ(run({"a", "--density", "4", "--strict"}, outcome).code, 4);
  EXPECT_EQ(run({"a", "--density", "4", "--strict"}).code, 0);
  outcome.stopped_early = true;
  EXPECT_EQ(run({"a", "--density", "4"}, outcome).code, 75);
}

TEST(Tool, HelpAndVersionNeedNothingElse) {
  const Probe help = run({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* part : {"Usage: probe BEFORE [OPTIONS]", "--density PERCENT", "[%] (required)",
                           "--method surface|paper", "edge of a cell [m] (default: 0.05)",
                           "probe a.pcd", "--strict"}) {
    EXPECT_NE(help.out.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(run({"--version"}).out.rfind("probe (excavplan) ", 0), 0U);
}

TEST(Tool, ErrorsOfTheLibraryHaveTheirCodes) {
  const auto code_of = [](const std::function<void()>& fail) {
    const std::array<const char*, 1> words = {"probe"};
    testing::internal::CaptureStderr();
    const int code = run_tool(
        1, words.data(), {"probe", "Probes.", {}}, [](Arguments&) {},
        [&](Console&) -> Outcome {
          fail();
          return {};
        });
    testing::internal::GetCapturedStderr();
    return code;
  };
  EXPECT_EQ(code_of([] { throw Error(ErrorKind::bad_input, "cell must be > 0"); }), 2);
  EXPECT_EQ(code_of([] { throw Error(ErrorKind::bad_file, "a.pcd: no such file"); }), 3);
  EXPECT_EQ(code_of([] { throw std::logic_error("cannot be"); }), 1);
  EXPECT_EQ(code_of([] { throw std::filesystem::filesystem_error("", "/no/such", {}); }), 3);
}

TEST(Tool, WithoutMemoryItSaysSo) {
  const std::array<const char*, 1> words = {"probe"};
  testing::internal::CaptureStderr();
  struct None {};
  const int code = tool_main<None>(
      1, words.data(), {"probe", "Probes.", {}}, [](Arguments&, None&) {},
      [](const None&) -> Outcome { throw std::bad_alloc(); });
  EXPECT_EQ(code, 1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "probe: not enough memory\n");
}

TEST(Tool, WhatTwoPartsOfAWorkSayAlikeIsToldOnce) {
  Outcome outcome;
  const Warning alike(WarningCode::unseen_ground, "the ground at the tracks was not seen");
  outcome.warnings = {alike, {WarningCode::outliers, alike.message, false}, alike};
  const Probe probe = run({"a", "--density", "4", "--json"}, outcome);
  const auto json = nlohmann::ordered_json::parse(probe.out);
  ASSERT_EQ(json.at("warnings").size(), 2U);
  EXPECT_EQ(json.at("warnings").at(0).at("code"), "unseen_ground");
  EXPECT_EQ(json.at("warnings").at(1).at("code"), "outliers");
}

TEST(Tool, ForeignTextCannotSpeakToATerminal) {
  Outcome outcome;
  outcome.lines = {"topic \033]0;owned\007"};
  outcome.warnings = {{WarningCode::frame, "frame \033[2J\xc2\x9b and ä"}};
  const Probe probe = run({"a", "--density", "4"}, outcome);
  EXPECT_EQ(probe.out, "topic ?]0;owned?\nNOT TRUSTWORTHY: the warnings say why\n");
  EXPECT_EQ(probe.err, "working\nprobe: warning (frame, ends trust): frame ?[2J? and ä\n");
  const Probe refused = run({"a", "--density", "4\033[31m"});
  EXPECT_EQ(refused.err.find('\033'), std::string::npos) << refused.err;
}

TEST(Tool, PlacesThatCannotBeWrittenAreFoundBeforeTheWork) {
  const Probe probe = run({"a.pcd", "--density", "4", "--plot", "/nowhere/x.svg"});
  EXPECT_EQ(probe.code, 3);
  EXPECT_EQ(probe.err, "probe: /nowhere/x.svg: there is no folder /nowhere\n");
  EXPECT_FALSE(probe.worked);
}

TEST(Tool, ErrorsOfTheLibraryNameTheOption) {
  EXPECT_EQ(error_of([] {
              naming_options({{"the dump point", "--dump-at"}}, [] {
                throw Error(ErrorKind::bad_input, "the dump point 5,0 is in the pit");
              });
            }),
            "--dump-at 5,0 is in the pit");
}

TEST(ShippedFiles, AreFoundByNameAndFilesByPath) {
  EXPECT_EQ(soil_named("loam").name, "loam");
  EXPECT_EQ(shipped_or_file("soils", "./my.json"), "./my.json");
  EXPECT_EQ(error_of([] { shipped_or_file("soils", "lom"); }),
            "'lom' is neither a file nor one of the soils that excavplan ships: clay, gravel, "
            "loam, sand");
}

}  // namespace
}  // namespace excavplan::tools
