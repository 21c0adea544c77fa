// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Simulators in programs of their own: what a sound one gives, and what becomes of others.

#include <chrono>
#include <csignal>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/planning/dig_search.hpp>
#include <excavplan/simulation/foreign_simulators.hpp>

#include "base/base64.hpp"
#include "base/child_process.hpp"
#include "support/foreign_digs.hpp"

namespace excavplan {
namespace {

using test::contains;
using test::dug;
using test::error_of;

const std::string example = "python3 '" EXCAVPLAN_EXAMPLES "/simulator_command/fee_wedge.py'";
std::string odd(const std::string& how) {
  return "python3 '" EXCAVPLAN_TEST_SUPPORT "/odd_simulator.py' " + how;
}
SimulatorKind program(const std::string& command, double timeout = 60.0) {
  return command_simulator({command, timeout});
}

TEST(CommandSimulator, DigsAndBalances) {
  const SimulatorKind kind = program(example);
  EXPECT_EQ(kind.name, "fee wedge 1 (program)");
  for (const double density : {10.0, 60.0}) {
    test::expect_sound_digs(*kind.make(test::zx120(), test::loam(), density));
  }
  EXPECT_GT(dug(kind, 80.0).energy.total, 1.5 * dug(kind, 10.0).energy.total);
}

TEST(CommandSimulator, TheExampleInDiscreteElementsDigs) {
  const SimulatorKind kind =
      program("python3 '" EXCAVPLAN_EXAMPLES "/simulator_command/disc_elements.py'", 600.0);
  const DigResult dig = dug(kind);
  EXPECT_GT(dig.payload_mass, 50.0);
  EXPECT_LT(dig.payload_mass, 600.0);
  EXPECT_GT(dig.energy.total, 1e3);
}

TEST(CommandSimulator, IsTheSameFromManyThreadsAndDensities) {
  const SimulatorKind kind = program(example);
  const auto soft = kind.make(test::zx120(), test::loam(), 20.0);
  const auto hard = kind.make(test::zx120(), test::loam(), 70.0);
  const double of_soft = dug(*soft).energy.total;
  const double of_hard = dug(*hard).energy.total;
  EXPECT_NE(of_soft, of_hard);
  std::vector<std::thread> threads;
  std::vector<double> energies(6);
  for (std::size_t i = 0; i < energies.size(); ++i) {
    threads.emplace_back([&, i] { energies[i] = dug(i % 2 == 0 ? *soft : *hard).energy.total; });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < energies.size(); ++i) {
    EXPECT_EQ(energies[i], i % 2 == 0 ? of_soft : of_hard);
  }
}

TEST(CommandSimulator, GetsNoMoreThanTheWindow) {
  const auto simulator = program(example).make(test::zx120(), test::loam(), 40.0);
  const Terrain near = level_planning_ground(test::zx120(), 0.1);
  Rectangle extent = near.bank.extent();
  extent.x_max += 30.0;
  Terrain far = undisturbed(flat_ground(extent, 0.1));
  far.bank.origin = near.bank.origin;
  EXPECT_EQ(dug(*simulator, near).payload_mass, dug(*simulator, far).payload_mass);
}

TEST(CommandSimulator, RefusesWhatItCannotDig) {
  const auto simulator = program(example).make(test::zx120(), test::loam(), 40.0);
  const Terrain ground = test::uneven_ground();
  const DigPath path = test::path_on(ground, paper_fixed_path());
  const auto said = [&](const Terrain& terrain) {
    return error_of([&] { simulator->dig(terrain, path); });
  };
  EXPECT_TRUE(contains(said(undisturbed(flat_ground({20, -2, 25, 2}, 0.1))), "leaves the map"));
  Terrain other = ground;
  other.bank.z.setConstant(std::nan(""));
  EXPECT_TRUE(contains(said(other), "crosses unknown ground"));
  other = ground;
  other.bank_void_ratio = other.loose;
  EXPECT_TRUE(contains(said(other), "void ratios of its own"));
}

TEST(CommandSimulator, AnEnergyDoesInPlaceOfLoads) {
  const DigResult dig = dug(program(odd("energy")));
  EXPECT_EQ(dig.energy.total, 60e3);
  EXPECT_EQ(dig.energy.by_phase[1], 40e3);
  EXPECT_TRUE(dig.torques.empty());
}

TEST(CommandSimulator, CommandsThatAreNone) {
  const auto said = [](const std::string& command) {
    const std::string text = error_of([&] { program(command, 5.0); });
    EXPECT_TRUE(contains(text, "simulator command " + command + ": ")) << text;
    return text;
  };
  EXPECT_TRUE(contains(said("no-such-program --x"), "cannot be started: No such file"));
  EXPECT_TRUE(contains(said(" "), "it names no program"));
  EXPECT_TRUE(contains(said("python3 'x"), "a quotation lacks its end"));
  EXPECT_TRUE(contains(said("false"), "it ended, with exit code 1"));
  EXPECT_TRUE(
      contains(said("sh -c 'read line; echo hello'"), "its answer: 'hello' is no JSON object"));
  EXPECT_TRUE(contains(said("cat"), "its answer: "));
  EXPECT_TRUE(contains(said(odd("protocol")), "protocol: is 2, this program speaks protocol 1"));
  EXPECT_TRUE(contains(said(odd("nameless")), "must have no comma"));
  EXPECT_TRUE(contains(error_of([] { program("sleep 60", 0.2); }), "no answer within 0.2 s"));
  EXPECT_TRUE(contains(error_of([] { program("cat", 0.0); }), "must be in 0.001 .. "));
}

struct Odd {
  const char* how;
  const char* text;
};
class OddProgram : public testing::TestWithParam<Odd> {};

TEST_P(OddProgram, IsRefusedByName) {
  const std::string text = error_of([] { dug(program(odd(GetParam().how), 20.0)); });
  EXPECT_TRUE(contains(text, "simulator 'odd 1 (program)': ")) << text;
  EXPECT_TRUE(contains(text, GetParam().text)) << text;
}

INSTANTIATE_TEST_SUITE_P(
    All, OddProgram,
    testing::Values(
        Odd{"wrong-number", "its payload [kg] is -1"},
        Odd{"text-number", "payload_kg: is \"many\", expected a number"},
        Odd{"heavy", "its balance of dry mass is off"}, Odd{"overfull", "times the 562"},
        Odd{"no-load", "neither loads nor an energy"}, Odd{"few-loads", "it gives 2 loads for"},
        Odd{"odd-loads", "loads: has 7 numbers, must be 4 a step"},
        Odd{"other-id", "id: is 77, expected that of the question, 1"},
        Odd{"other-type", "expected 'dug' or 'error'"},
        Odd{"unknown-key", "payload_t: is not a key"},
        Odd{"short-ground", "bank_m: is not the base64 of"},
        Odd{"no-base64", "bank_m: is not the base64 of"},
        Odd{"nan-ground", "its ground has a bank of nan m"}, Odd{"risen", "a bank must not rise"},
        Odd{"cheap", "with 1 J, less than"}, Odd{"crash", "it was ended by signal 11"},
        Odd{"exit", "exit code 3; on standard error it wrote last: out of?[31m lic"},
        Odd{"closes", "it closed its standard input or output"},
        Odd{"no-json", "'Loading model ...' is no JSON object"}, Odd{"half-json", "its answer: "},
        Odd{"nan", "its answer: "}, Odd{"long", "more than 67108864 bytes"},
        Odd{"refuses", "it says: no licence left"}),
    [](const auto& tested) {
      std::string name = tested.param.how;
      name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
      return name;
    });

TEST(CommandSimulator, OneThatIsSilentIsEndedWithItsFamily) {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("processes");
  const std::string text = error_of([&] { dug(program(odd("family " + file), 15.0)); });
  EXPECT_TRUE(contains(text, "it gave no answer within 15 s")) << text;
  std::ifstream processes(file);
  int own = 0;
  int child = 0;
  ASSERT_TRUE(processes >> own >> child);
  EXPECT_NE(::kill(own, 0), 0);
  // A killed process goes when it is next scheduled, and stays a zombie until its new parent looks.
  const auto state_of = [&] {
    std::string state;
    std::ifstream(("/proc/" + std::to_string(child) + "/stat")) >> state >> state >> state;
    return state;
  };
  std::string state = state_of();
  for (int i = 0; i < 1000 && !state.empty() && state != "Z"; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    state = state_of();
  }
  EXPECT_TRUE(state.empty() || state == "Z") << state;
}

TEST(CommandSimulator, StartsAgainAfterACrash) {
  const test::TemporaryFolder folder;
  const SimulatorKind kind = program(odd("crash-once " + folder.file("crashed")));
  EXPECT_TRUE(contains(error_of([&] { dug(kind); }), "signal 11"));
  EXPECT_GT(dug(kind).payload_mass, 50.0);
}

TEST(CommandSimulator, OneThatEndsAfterSomeDigsLosesNone) {
  const SimulatorKind kind = program(odd("crash-third"));
  const double payload = dug(kind).payload_mass;
  for (int i = 0; i < 8; ++i) EXPECT_EQ(dug(kind).payload_mass, payload);
}

TEST(CommandSimulator, IsNotStartedForEver) {
  const SimulatorKind kind = program(odd("crash"));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(contains(error_of([&] { dug(kind); }), "by signal 11"));
  EXPECT_TRUE(contains(error_of([&] { dug(kind); }),
                       "it failed 3 times in a row and is not started again; the last time: it was "
                       "ended by signal 11"));
}

TEST(CommandSimulator, OutputThatNobodyAskedForIsNoted) {
  const SimulatorKind kind = program(odd("unasked"));
  dug(kind);
  ::usleep(100000);
  EXPECT_TRUE(contains(error_of([&] { dug(kind); }), "without being asked: 'done"));
}

TEST(CommandSimulator, PassesOnWhatItWritesOnStandardError) {
  std::mutex mutex;
  std::vector<std::string> notes;
  SimulatorCommand command = {odd("none")};
  command.on_note = [&](const std::string& line) {
    const std::lock_guard lock(mutex);
    notes.push_back(line);
  };
  {
    const SimulatorKind kind = command_simulator(command);
    dug(kind);
    dug(kind);
  }
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes.front(), "step?[2J one");
}

TEST(CommandSimulator, ASearchGoesOnAfterFailures) {
  const test::TemporaryFolder folder;
  const SimulatorKind kind = program(odd("crash-once " + folder.file("crashed")));
  const auto simulator = kind.make(test::zx120(), test::loam(), 40.0);
  DigSearchOptions options;
  options.stop.evaluations = 30;
  options.threads = 2;
  const auto found =
      search_dig(test::zx120(), *simulator, level_planning_ground(test::zx120(), 0.1), options);
  ASSERT_TRUE(found);
  EXPECT_GE(found->failed, 1);
  EXPECT_TRUE(contains(found->first_failure, "signal 11")) << found->first_failure;
}

TEST(WordsOf, PartsAtSpacesButNotInQuotes) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(words_of("  a 'b c'd \"e'f\" '' "), (Words{"a", "b cd", "e'f", ""}));
  EXPECT_EQ(words_of("a;b $HOME *"), (Words{"a;b", "$HOME", "*"}));
}

TEST(Base64, GivesTheSameNumbersBack) {
  for (const std::size_t count : {0U, 1U, 2U, 3U, 4U, 100U}) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < count; ++i) numbers.push_back(std::sqrt(i) - 1.0 / 3.0);
    std::vector<double> read(count);
    const std::string text = base64_of(numbers.data(), count);
    ASSERT_TRUE(read_base64(text, read.data(), count));
    EXPECT_EQ(read, numbers);
    EXPECT_FALSE(read_base64(text + "A", read.data(), count));
    for (std::size_t i = 0; i < text.size(); ++i) {
      std::string bad = text;
      bad[i] = bad[i] == '=' ? 'A' : '=';
      EXPECT_FALSE(read_base64(bad, read.data(), count)) << i;
    }
  }
  const double one = 1.0;
  EXPECT_EQ(base64_of(&one, 1), "AAAAAAAA8D8=");
}

}  // namespace
}  // namespace excavplan
