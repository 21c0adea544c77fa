// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <ostream>
#include <tuple>

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
        "--method", "--cell", "--law", "--plot", "--map", "--report", "--strict"},
       "--dig-aera",
       "--dig-area",
       quickstart},
      {"calibrate-density",
       {"--samples", "--soil", "--machine", "--simulator"},
       "--sample",
       "--samples",
       [](const TemporaryFolder&) {
         return Words{"--densities", "0:25:100", "--draws", "0"};
       }},
      {"simulate-dig",
       {"--density", "--path", "--start", "--terrain", "--dump-at", "--cell", "--seed", "--noise",
        "--before", "--after", "--history", "--plot", "--map", "--report", "--soil", "--machine",
        "--simulator"},
       "--sede",
       "--seed",
       [](const TemporaryFolder&) {
         return Words{"--density", "40"};
       }},
      {"plan-path",
       {"--density", "--density-from", "--library", "--search", "--terrain", "--seed",
        "--trajectory", "--plot", "--map", "--report", "--soil", "--machine"},
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
      {"machine-kit",
       {"--output", "--soil", "--goal", "--densities", "--slopes", "--draws", "--plot"},
       "--outptu",
       "--output",
       [](const TemporaryFolder& folder) {
         return Words{"zx120",    "--output", folder.file("kit"),
                      "--soil",   "loam",     "--densities",
                      "0,50,100", "--slopes", "0",
                      "--draws",  "0"};
       }},
      {"run-experiment",
       {"--path", "--soil", "--machine", "--simulator", "--seed", "--report"},
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
       GetParam().options + Words{"--json", "--quiet", "--config", "--version", "--help"}) {
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

/// Runs a tool whose standard output, or whatever `prepare` changes, is not as usual.
ProgramResult run_prepared(const std::string& tool, const Words& words,
                           const std::function<void()>& prepare) {
  const TemporaryFolder folder;
  const std::string err = folder.file("err");
  const pid_t child = started(tool, words, [&] {
    ::dup2(::open("/dev/null", O_RDWR), STDIN_FILENO);
    ::dup2(STDIN_FILENO, STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    prepare();
  });
  int status = 0;
  ::waitpid(child, &status, 0);
  return {exit_code(status), "", content_of(err)};
}

TEST_P(EveryTool, SaysThatItsOutputCannotBeWritten) {
  const auto full = [] { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); };
  const auto closed = [] { ::close(STDOUT_FILENO); };
  const std::string reason = tool + ": standard output: cannot be written: ";
  for (const Words& words : {Words{"--help"}, Words{"--version"}, GetParam().run(folder)}) {
    const ProgramResult on_full = run_prepared(tool, words, full);
    EXPECT_EQ(on_full.code, 3) << words[0];
    EXPECT_EQ(on_full.err.substr(on_full.err.rfind(tool)), reason + "No space left on device\n");
  }
  const ProgramResult on_closed = run_prepared(tool, {"--help"}, closed);
  EXPECT_EQ(on_closed.code, 3);
  EXPECT_EQ(on_closed.err, reason + "Bad file descriptor\n");
}

TEST_P(EveryTool, EndsQuietlyWhereNobodyReadsItsOutput) {
  const ProgramResult result = run_prepared(tool, GetParam().run(folder) + Words{"--json"}, [] {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) ::_exit(126);
    ::dup2(pipe[1], STDOUT_FILENO);
    ::close(pipe[0]);
  });
  EXPECT_EQ(result.code, 128 + SIGPIPE) << result.err;
}

TEST_P(EveryTool, NamesWhatItMissesInARemovedFolder) {
  for (const Words& words : {Words{"x.csv"}, Words{"--density", "40", "--machine", "x.json"},
                             Words{"--out", "x.json"}, Words{"a.xyz", "b.xyz"}}) {
    const TemporaryFolder gone;
    const ProgramResult result = run_prepared(tool, words, [&] {
      if (::chdir(gone.file("").c_str()) != 0 || ::rmdir(gone.file("").c_str()) != 0) ::_exit(126);
    });
    EXPECT_TRUE(result.code == 2 || result.code == 3) << words[0] << result.code << result.err;
    EXPECT_EQ(result.err.rfind(tool + ": ", 0), 0U) << result.err;
  }
}

TEST_P(EveryTool, ALimitOnFileSizesIsAnErrorOfTheWrite) {
  if (!contains(run_program(tool, {"--help"}).out, "--out FILE")) GTEST_SKIP() << "no --out";
  const std::string out = folder.write("out.xyz", "old");
  Words words = GetParam().run(folder);
  if (tool == "build-path-library" || tool == "depth-to-cloud") {
    words.back() = out;
    if (tool == "build-path-library")
      words = Words{"--densities", "20", "--out", out} + small_library;
  } else {
    words = words + Words{"--out", out};
  }
  const ProgramResult result = run_prepared(tool, words, [] {
    const rlimit most = {500, 500};
    ::setrlimit(RLIMIT_FSIZE, &most);
  });
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_TRUE(contains(result.err, "cannot be written: File too large")) << result.err;
  EXPECT_EQ(content_of(out), "old");
  for (const auto& entry : fs::recursive_directory_iterator(folder.file(""))) {
    EXPECT_FALSE(contains(entry.path(), ".part-")) << entry.path();
  }
}

/// A user's own files that are open meanwhile remain, whatever their names.
TEST_P(EveryTool, ATermEndsItWhileItWaits) {
  fs::create_directory(folder.file("run.part-3"));
  const std::string errors = folder.write("survey.part-host-1-abcdefgh", "");
  const std::string log = folder.write("run.part-3/survey.part-2.log", "");
  std::array<int, 2> silent{};
  ASSERT_EQ(::pipe(silent.data()), 0);
  ASSERT_EQ(::write(silent[1], "x", 1), 1);
  const pid_t child = started(tool, {"--soil", "-", "-"}, [&] {
    ::dup2(silent[0], STDIN_FILENO);
    ::close(silent[1]);
    ::dup2(::open(errors.c_str(), O_WRONLY | O_CLOEXEC), STDERR_FILENO);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    ::open(log.c_str(), O_WRONLY | O_APPEND);
  });
  int status = 0;
  bool is_over = false;
  for (int unread = 1; unread > 0 && !is_over;) {  // then it waits for more
    is_over = ::waitpid(child, &status, WNOHANG) == child;
    ASSERT_EQ(::ioctl(silent[0], FIONREAD, &unread), 0);
  }
  if (is_over) {
    EXPECT_EQ(exit_code(status), 2);  // it has no --soil
  } else {
    ::kill(child, SIGTERM);
    ::waitpid(child, &status, 0);
    EXPECT_EQ(exit_code(status), 128 + SIGTERM);
  }
  for (const std::string& file : {errors, log}) EXPECT_TRUE(fs::exists(file)) << file;
  for (const int end : silent) ::close(end);
}

TEST_F(BadInput, NumbersAboveACeilingAreRefused) {
  const std::string log = folder.write("log.csv", "time_s,fuel_flow_ml_per_s\n0,2\n5,2\n");
  const std::string out = folder.file("out.json");
  const Words search = {"--density", "40", "--search"};
  refused(2, "--population must be <= 1000000, got 2147483647", "plan-path",
          search + Words{"--method", "paper", "--population", "2147483647"});
  refused(2, "--evaluations is 2147483647, must be in 0 .. 1000000", "plan-path",
          search + Words{"--evaluations", "2147483647"});
  refused(2, "--generations x generation_size must be <= 1000000, got 25769803764", "plan-path",
          search + Words{"--generations", "2147483647"});
  refused(2, "--population must be <= 1000000", "build-path-library",
          {"--method", "paper", "--population", "2147483647", "--out", out});
  refused(2, "--points is 2147483647, must be in 1 .. 1000000", "build-path-library",
          {"--points", "2147483647", "--out", out});
  refused(2, "--machine x --soil x --slopes x --densities is 505101, must be at most 100000",
          "build-path-library",
          {"--densities", "0:0.02:100", "--slopes", "0:0.01:1", "--out", out});
  for (const char* tool : {"plan-path", "run-experiment"}) {
    refused(2, "--threads: 1025 must be at most 1024", tool, {"--threads", "1025"});
  }
  refused(2, "--threads: 4294967297 must be at most 1024", "build-path-library",
          {"--threads", "4294967297", "--out", out});
  refused(2, "--draws is 2147483647, must be in 0 .. 100000", "calibrate-density",
          {"--draws", "2147483647", "--out", out});
  const std::string cell = "--cell: the cell size is 0.001 m, must be in 0.005 .. 1 m";
  refused(2, cell, "calibrate-density", {"--cell", "1e-3", "--out", out});
  refused(2, cell, "run-experiment", {"--cell", "1e-3"});
  refused(2, cell, "plan-path", {"--density", "40", "--cell", "1e-3"});
  refused(2, cell, "simulate-dig", {"--density", "40", "--cell", "1e-3"});
  refused(2, "in cells (--cell) of 0.05 m holds ", "simulate-dig",
          {"--density", "40", "--dump-at", "1000,1000"});
  refused(2, "in cells (--cell) of 0.001 m needs about ", "measure-efficiency",
          {log, "--dump-before", scan, "--dump-after", later_scan, "--cell", "1e-3"});
}

TEST_F(BadInput, OneFileForTwoThingsIsRefused) {
  const std::string out = folder.write("out.svg", "old");
  const std::string other = folder.file("./out.svg");
  const std::string link = folder.file("link.svg");
  fs::create_symlink("out.svg", link);
  for (const std::string& name : {out, other, link}) {
    refused(2, "--plot and --report name the same file, " + out, "simulate-dig",
            {"--density", "40", "--plot", out, "--report", name});
  }
  const std::string nowhere = folder.file("nowhere.svg");
  fs::create_symlink("none.svg", nowhere);
  refused(2, "--plot and --report name the same file, " + nowhere, "simulate-dig",
          {"--density", "40", "--plot", nowhere, "--report", folder.file("none.svg")});
  const std::string copy = folder.write("scan.pcd", content_of(scan));
  refused(2, "FILE and --out name the same file, " + copy, "inspect-cloud", {copy, "--out", copy});
  refused(2, "--before and --after name the same file", "simulate-dig",
          {"--density", "40", "--before", copy, "--after", copy});
  refused(2, "--library and --checkpoint name the same file", "plan-path",
          {"--density", "40", "--search", "--library", copy, "--checkpoint", copy});
  const std::string soil = folder.write("digs.json.soil3", "mine");
  fs::create_symlink("digs.json.soil3", folder.file("other.soil1"));
  const Words uncertain = {"--density", "40", "--density-sd", "8", "--search", "--checkpoint"};
  for (const char* name : {"digs.json", "other"}) {
    const std::string part = name + std::string(name[0] == 'd' ? ".soil3" : ".soil1");
    const std::string same = "name the same file, " + folder.file(part);
    refused(2, "--checkpoint and --trajectory " + same, "plan-path",
            uncertain + Words{folder.file(name), "--trajectory", soil});
    refused(2, "--library and --checkpoint " + same, "plan-path",
            uncertain + Words{folder.file(name), "--library", soil});
    refused(3, folder.file(part) + ": is no checkpoint of a search", "plan-path",
            uncertain + Words{folder.file(name)});
  }
  EXPECT_EQ(content_of(soil), "mine");
  refused(2, "--out: standard output is no file to write", "calibrate-density", {"--out", "-"});
  EXPECT_EQ(content_of(out), "old");
  EXPECT_EQ(content_of(copy), content_of(scan));
}

TEST_F(BadInput, AMissingFolderIsFoundBeforeTheWork) {
  const std::string none = folder.file("none");
  const Words no_machine = {"--machine", none + ".json"};
  for (const auto& [tool, words, file] : std::vector<std::tuple<std::string, Words, std::string>>{
           {"estimate-density", {none, none, "--plot"}, "/x.svg"},
           {"estimate-density", {none, none, "--report"}, "/x.html"},
           {"calibrate-density", no_machine + Words{"--out"}, "/x.json"},
           {"simulate-dig", no_machine + Words{"--density", "40", "--history"}, "/x.csv"},
           {"plan-path", no_machine + Words{"--density", "40", "--trajectory"}, "/x.csv"},
           {"run-experiment", no_machine + Words{"--plot"}, "/x.svg"},
           {"run-experiment", no_machine + Words{"--report"}, "/x.html"},
           {"run-experiment", no_machine + Words{"--study", none, "--plot"}, "/x.svg"},
           {"measure-efficiency", {none, "--volume", "1", "--plot"}, "/x.svg"},
           {"inspect-cloud", {none, "--out"}, "/x.xyz"}}) {
    refused(3, none + file + ": there is no folder " + none, tool, words + Words{none + file});
  }
}

TEST_F(Tools, PipesAndDevicesMayBeSharedByOutputs) {
  EXPECT_EQ(run_program("simulate-dig",
                        {"--density", "40", "--history", "/dev/null", "--report", "/dev/null"})
                .code,
            0);
}

TEST_F(Tools, AStackTooSmallIsNoCrash) {
  const TemporaryFolder outputs;
  const std::string err = outputs.file("err");
  const pid_t child = started("estimate-density", quickstart(folder), [&] {
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    rlimit limit{};
    ::getrlimit(RLIMIT_STACK, &limit);
    limit.rlim_cur = 160 * 1024;
    ::setrlimit(RLIMIT_STACK, &limit);
  });
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(exit_code(status), 1);
  EXPECT_EQ(content_of(err),
            "estimate-density: not enough memory for a stack of 1 MiB (ulimit -s or -v)\n");
}

TEST_F(Tools, AnOutputNamedStandardOutputComesBeforeTheAnswer) {
  const std::string file = folder.file("dig.csv");
  const Words plan = {"--density", "40", "--json", "--trajectory"};
  ASSERT_EQ(run_program("plan-path", plan + Words{file}).code, 0);
  const std::string trajectory = content_of(file);
  const ProgramResult both = run_program("plan-path", plan + Words{"/dev/stdout"});
  EXPECT_EQ(both.code, 0) << both.err;
  EXPECT_EQ(both.out.substr(0, trajectory.size()), trajectory);
  EXPECT_EQ(json::parse(both.out.substr(trajectory.size())).at("tool"), "plan-path");
}

TEST_F(Tools, AnOutputThatReplacesTheFileOfStandardOutputIsRefused) {
  const std::string file = folder.write("dig.csv", "old\n");
  fs::create_symlink("dig.csv", folder.file("link.csv"));
  for (const std::string& name : {file, folder.file("link.csv")}) {
    const pid_t child = started("plan-path", {"--density", "40", "--trajectory", name}, [&] {
      ::dup2(::open(file.c_str(), O_WRONLY | O_APPEND), STDOUT_FILENO);
      ::dup2(STDOUT_FILENO, STDERR_FILENO);
    });
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(exit_code(status), 2);
    EXPECT_EQ(content_of(file), "old\nplan-path: --trajectory names the file of standard output, " +
                                    name + "; /dev/stdout adds to it\nSee plan-path --help\n");
    folder.write("dig.csv", "old\n");
  }
}

TEST_F(Tools, AnEmptyFolderOfTemporaryFilesIsAsGoodAsNone) {
  const std::string tool = EXCAVPLAN_BIN "/inspect-cloud --quiet - <";
  EXPECT_EQ(std::system(("TMPDIR= " + tool + shipped("quickstart/before.pcd")).c_str()), 0);
}

TEST_F(BadInput, StandardInputIsATransformButNoDatabase) {
  const std::string frame = folder.write("frame.txt", "1 0 0 5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const Words words = {scan, "--json", "--frame"};
  const ProgramResult piped = run_program("inspect-cloud", words + Words{"-"}, frame);
  EXPECT_EQ(piped.code, 0) << piped.err;
  EXPECT_EQ(piped.out, run_program("inspect-cloud", words + Words{frame}).out);
  const std::string database = folder.write("run.db3", std::string("SQLite format 3\0...", 19));
  const ProgramResult refused = run_program("inspect-cloud", {"-"}, database);
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(refused.err,
            "inspect-cloud: standard input: found an SQLite recording (.db3), expected another "
            "format: give this one as a file\n");
}

TEST_F(BadInput, APipeAmongTheEntriesOfALibraryIsRefused) {
  const std::string cells = folder.file("cells");
  const Words words =
      Words{"--densities", "20", "--out", folder.file("library.json"), "--cells", cells} +
      small_library;
  ASSERT_EQ(run_program("build-path-library", words).code, 0);
  const fs::path entry = fs::directory_iterator(cells)->path();
  fs::remove(entry);
  ASSERT_EQ(::mkfifo(entry.c_str(), 0600), 0);
  refused(3, entry.string() + ": is not a regular file", "build-path-library", words);
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
  refused(2, "--density-sd: -3 % is outside 0 .. 1000", "plan-path",
          {"--density", "40", "--density-sd=-3"});
  refused(2, "140 %, must be in 0 .. 100 %", "simulate-dig", {"--density", "140", "--plot", plot});
  refused(2, "0 .. 100", "build-path-library", {"--densities", "140", "--out", plot});
  refused(2, "0 .. 100", "run-experiment", {"--densities", "140"});
  refused(2, "--density: 'dense'", "plan-path", {"--density", "dense"});
  refused(2, "--cell is 0, must be above 0 m and finite", "estimate-density",
          {scan, later_scan, "--cell", "0"});
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

TEST_F(Tools, TheShellOffersTheWordsOfAnOption) {
  const std::string completion = EXCAVPLAN_BIN "/../completion/excavplan.bash";
  if (!fs::exists(completion) || std::system("bash -c : 2>/dev/null") != 0) GTEST_SKIP();
  const std::string script = folder.write("offer.bash", "source " + completion + R"(
compopt() { :; }
for option in --soil --machine --goal --map --plot --simulator --density; do
  COMP_WORDS=(plan-path $option "") COMP_CWORD=2
  _excavplan ")" EXCAVPLAN_BIN R"(/plan-path"
  echo "${COMPREPLY[*]}"
done)");
  const std::string offered = folder.file("offered");
  ASSERT_EQ(std::system(("bash " + script + " > " + offered).c_str()), 0);
  EXPECT_EQ(content_of(offered),
            "loam sand clay gravel\n"
            "zx120 zx200 generic-20t generic-mini\n"
            "cycle energy time priced:\n"
            "all= before= after= change= footprint= path=\n"
            "\n"
            "height-map section\n"
            "\n");
}

TEST_F(BadInput, FilesOfOtherFormatsAreNotWritten) {
  const std::string png = folder.file("plot.png");
  const std::string gif = folder.file("plot.gif");
  refused(2, "must end in .svg", "estimate-density", {scan, later_scan, "--plot", gif});
  refused(2, "must end in .svg", "simulate-dig", {"--density", "40", "--plot", gif});
  refused(2, "must end in .svg", "plan-path", {"--density", "40", "--plot", gif});
  refused(2, "--trajectory: '" + png + "' must end in .csv or .json", "plan-path",
          {"--density", "40", "--trajectory", png});
  refused(2, "--trajectory: '.json' is an ending without a name before it", "plan-path",
          {"--density", "40", "--trajectory", ".json"});
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
  expect_figure(file, {"hole", "heap", "height after − before [cm]"});
  answer("simulate-dig", {"--density", "40", "--plot", file});
  expect_figure(file, {"loam at 40.0 %", "penetrate", "drag", "scoop"});
  answer("plan-path", {"--density", "80", "--plot", file});
  expect_figure(file, {"loam at 80.0 %", "penetrate", "drag", "scoop"});
}

}  // namespace
}  // namespace excavplan::test
