// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Simulators in shared libraries: what a sound one gives, and what is said of others.

#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/simulation/foreign_simulators.hpp>

#include "support/foreign_digs.hpp"

namespace excavplan {
namespace {

using test::contains;
using test::dug;
using test::error_of;

const std::string folder = EXCAVPLAN_PLUGINS;
const std::string example_plugin = folder + "/libcutting_resistance.so";
std::string odd_plugin(const std::string& how) { return folder + "/libodd_" + how + ".so"; }

TEST(PluginSimulator, DigsAndBalances) {
  const SimulatorKind kind = plugin_simulator(example_plugin);
  EXPECT_TRUE(contains(kind.name, "cutting resistance 1 (library ")) << kind.name;
  for (const double density : {0.0, 60.0}) {
    test::expect_sound_digs(*kind.make(test::zx120(), test::loam(), density));
  }
  EXPECT_GT(dug(kind, 80.0).energy.total, 1.3 * dug(kind, 10.0).energy.total);
}

TEST(PluginSimulator, LoadsBeyondTheMachineStallIt) {
  const DigResult dig = dug(plugin_simulator(odd_plugin("strong")));
  ASSERT_TRUE(dig.stall);
  EXPECT_EQ(dig.torques.size(), 5U);
  EXPECT_EQ(dig.peak_force, 1e6);
}

TEST(PluginSimulator, IsTheSameFromManyThreads) {
  for (const std::string& file : {example_plugin, odd_plugin("one_at_a_time")}) {
    const SimulatorKind kind = plugin_simulator(file);
    const auto simulator = kind.make(test::zx120(), test::loam(), 40.0);
    const DigResult first = test::dug(*simulator);
    std::vector<DigResult> results(6);
    std::vector<std::thread> threads;
    for (DigResult& result : results) {
      threads.emplace_back([&] { result = test::dug(*simulator); });
    }
    for (std::thread& thread : threads) thread.join();
    for (const DigResult& result : results) {
      EXPECT_EQ(result.energy.total, first.energy.total);
      EXPECT_EQ(result.payload_mass, first.payload_mass);
    }
  }
}

TEST(PluginSimulator, AnotherBuildHasAnotherName) {
  EXPECT_NE(plugin_simulator(odd_plugin("sound")).name, plugin_simulator(odd_plugin("risen")).name);
  EXPECT_EQ(plugin_simulator(odd_plugin("sound")).name, plugin_simulator(odd_plugin("sound")).name);
  const auto identity = [](double density) {
    return plugin_simulator(example_plugin).make(test::zx120(), test::loam(), density)->identity();
  };
  EXPECT_EQ(identity(40.0), identity(40.0));
  EXPECT_NE(identity(40.0), identity(41.0));
}

TEST(PluginSimulator, FilesThatAreNone) {
  const test::TemporaryFolder scratch;
  const auto said = [](const std::string& file) {
    const std::string text = error_of([&] { plugin_simulator(file); }, ErrorKind::bad_file);
    EXPECT_TRUE(contains(text, file)) << text;
    return text;
  };
  EXPECT_TRUE(contains(said(scratch.file("none.so")), "No such file"));
  EXPECT_TRUE(contains(said(scratch.write("text.so", "no library")), "cannot be loaded: "));
  EXPECT_TRUE(contains(said(folder + "/libno_simulator.so"),
                       "lacks the function excavplan_simulator_entry"));
  EXPECT_TRUE(
      contains(said(odd_plugin("other_version")),
               "is made for version 2 of simulator_plugin.h, this program takes version 1"));
  EXPECT_TRUE(contains(said(odd_plugin("no_description")), "does not know version 1"));
  EXPECT_TRUE(contains(said(odd_plugin("small")), "describes itself in 16 bytes"));
  EXPECT_TRUE(contains(said(odd_plugin("no_dig")), "lacks one of create, dig and destroy"));
  EXPECT_TRUE(contains(said(odd_plugin("tolerant")), "mass_tolerance is 0.9, must be in 0 .. 0.2"));
  EXPECT_TRUE(contains(said(odd_plugin("nameless")), "name is empty"));
}

TEST(PluginSimulator, BadAnswersAreRefusedByName) {
  const auto said = [](const std::string& how, double density = 40.0) {
    const std::string text = error_of([&] { dug(plugin_simulator(odd_plugin(how)), density); });
    EXPECT_TRUE(contains(text, "simulator 'odd 1 (library ")) << text;
    return text;
  };
  EXPECT_TRUE(contains(said("fails", 95.0), "it says: too?[31m dense"));
  EXPECT_TRUE(contains(said("fails"), "it says: xxxx"));
  EXPECT_TRUE(contains(said("nan_payload"), "its payload [kg] is nan"));
  EXPECT_TRUE(contains(said("nan_ground"), "its ground has a bank of nan m"));
  EXPECT_TRUE(contains(said("risen"), "a bank must not rise"));
  EXPECT_TRUE(contains(said("nothing"), "it gives neither loads nor an energy"));
  EXPECT_TRUE(contains(said("gives_up"), "its dig gave up, which it was not allowed to"));
  EXPECT_TRUE(contains(said("unbalanced"), "its balance of dry mass is off"));
}

}  // namespace
}  // namespace excavplan
