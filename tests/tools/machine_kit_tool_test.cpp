// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "support/tool_answers.hpp"
#include "support/urdf_file.hpp"

/// @file
/// machine-kit, and the tools that find what it made.

namespace excavplan::test {
namespace {

const Words small_kit = {"--soil",   "loam", "--densities", "0,50,100",
                         "--slopes", "0",    "--draws",     "20"};

TEST_F(Tools, FromAUrdfToAPlan) {
  const std::string urdf = folder.write("digger.urdf", urdf_of(zx120_joints()));
  const json kit = answer("machine-kit", Words{urdf} + small_kit);
  EXPECT_TRUE(warns(kit, "urdf_scaled"));
  EXPECT_TRUE(warns(kit, "urdf_placeholder"));
  expect_keys(kit, "number",
              {"reach_m/ground", "reach_m/depth", "reach_m/height", "digging_force_kn/bucket",
               "digging_force_kn/arm", "capacity_m3/struck", "capacity_m3/heaped",
               "robot_joints/boom/sign", "robot_joints/boom/zero_rad", "soils/0/entries",
               "soils/0/evaluations", "soils/0/example/payload_mass_kg", "wall_time_s"});
  for (const char* file : {"machine.json", "joints.svg", "reach.svg", "laws/digger-loam.json",
                           "libraries/digger-loam-cycle.json"}) {
    EXPECT_TRUE(fs::is_regular_file(folder.file("digger-kit") + "/" + file)) << file;
  }
  const json plan = answer("plan-path", {"--machine", urdf, "--density", "40"});
  EXPECT_GT(number(plan, "/payload_mass_kg"), 300.0);
  EXPECT_TRUE(warns(plan, "urdf_scaled")) << "every tool says what is not the machine's own";
  const json by_folder =
      answer("plan-path", {"--machine", folder.file("digger-kit"), "--density", "40"});
  EXPECT_EQ(by_folder.at("path"), plan.at("path"));
  EXPECT_FALSE(warns(by_folder, "urdf_scaled")) << "its sources say so";
  const json by_file =
      answer("plan-path", {"--machine", folder.file("digger-kit/machine.json"), "--density", "40"});
  EXPECT_EQ(by_file.at("path"), plan.at("path"));
  const json experiment = answer("run-experiment", {"--machine", folder.file("digger-kit"),
                                                    "--goal", "cycle", "--densities", "40"});
  EXPECT_EQ(experiment.at("conditions").size(), 1U);
}

TEST_F(Tools, FromADataSheetToAPlan) {
  json sheet = {{"name", "digger"},
                {"operating_mass_kg", 19500},
                {"bucket_capacity_m3", 0.8},
                {"ground_reach_m", 9.7},
                {"depth_m", 6.62}};
  const std::string file = folder.write("sheet.json", sheet.dump());
  const Words to_kit = {"--output", folder.file("digger")};
  const json kit = answer("machine-kit", Words{"--data-sheet", file} + to_kit + small_kit);
  EXPECT_TRUE(warns(kit, "data_sheet_fitted"));
  EXPECT_GT(kit.at("fitted").size(), 40U);
  EXPECT_TRUE(fs::is_regular_file(folder.file("digger/measures.svg")));
  const json plan = answer("plan-path", {"--machine", folder.file("digger"), "--density", "40"});
  EXPECT_FALSE(warns(plan, "data_sheet_differs"));
  sheet["height_m"] = 14.0;
  const std::string wrong = folder.write("wrong.json", sheet.dump());
  answer("machine-kit", Words{"--data-sheet", wrong, "--output", folder.file("off")} + small_kit);
  const json off = answer("plan-path", {"--machine", folder.file("off"), "--density", "40"});
  EXPECT_TRUE(warns(off, "data_sheet_differs"));
  sheet["ground_reach_m"] = 9700;
  const std::string refused = folder.write("refused.json", sheet.dump());
  EXPECT_EQ(run_program("machine-kit", {"--data-sheet", refused}).code, 3);
}

// The picture is there though the machine cannot make the dig of a kit.
TEST_F(Tools, AUrdfIsDrawnAsUnderstood) {
  auto joints = zx120_joints();
  joints[1].axis = "0 -1 0";
  joints[1].limit = "lower=\"1.1\" upper=\"1.2\"";
  const std::string urdf = folder.write("digger.urdf", urdf_of(joints));
  const std::string plot = folder.file("joints.svg");
  EXPECT_EQ(run_program("machine-kit", Words{urdf, "--plot", plot} + small_kit).code, 2);
  const std::string drawn = content_of(plot);
  for (const char* text : {"boom = -boom_joint", "arm = arm_joint", "swing_joint", "tooth tip"}) {
    EXPECT_TRUE(contains(drawn, text)) << text;
  }
}

TEST_F(Tools, AKitHoldsTheLawOfItsMachine) {
  if (!fs::exists(std::string(EXCAVPLAN_BIN) + "/estimate-density")) GTEST_SKIP();
  answer("machine-kit", Words{"zx200", "--output", folder.file("kit")} + small_kit);
  const json estimate =
      answer("estimate-density", quickstart(folder) + Words{"--machine", folder.file("kit")});
  EXPECT_EQ(estimate.at("law"), "zx200-loam");
}

TEST_F(Tools, AKitOfAnotherMachineIsRefused) {
  const std::string file = folder.write("digger.json", content_of(shipped("machines/zx200.json")));
  answer("machine-kit", Words{file} + small_kit);
  EXPECT_EQ(run_program("plan-path", {"--machine", file, "--density", "40"}).code, 0);
  auto changed = json::parse(content_of(file));
  changed["geometry"]["arm_length_m"] = 2.5;
  folder.write("digger.json", changed.dump());
  const ProgramResult result = run_program("plan-path", {"--machine", file, "--density", "40"});
  EXPECT_EQ(result.code, 2);
  EXPECT_TRUE(contains(result.err, "digger-kit/libraries/zx200-loam-cycle.json")) << result.err;
}

/// The right one of 0.42 m3 too.
TEST_F(Tools, AMachineThatItsDataSheetContradictsIsNotTrusted) {
  for (const double capacity : {0.25, 0.42}) {
    json machine = json::parse(content_of(shipped("machines/zx120.json")));
    machine["data_sheet"] = {{"bucket_capacity_m3", capacity}};
    const std::string file = folder.write("sheet.json", machine.dump());
    for (const Words& words : {Words{"plan-path", "--density", "40", "--machine", file},
                               Words{"run-experiment", "--densities", "40", "--machine", file}}) {
      const json found = answer(words[0], Words(words.begin() + 1, words.end()));
      EXPECT_EQ(warns(found, "data_sheet_differs"), capacity < 0.4) << words[0];
      if (found.contains("trustworthy")) {
        EXPECT_EQ(found.at("trustworthy"), capacity > 0.4) << found.at("warnings");
      }
    }
  }
}

TEST_F(Tools, AMachineWithoutAKitIsToldOfIt) {
  const ProgramResult result = run_program("plan-path", {"--machine", "zx200", "--density", "40"});
  EXPECT_EQ(result.code, 2);
  EXPECT_TRUE(contains(result.err, "make one with machine-kit")) << result.err;
}

/// A machine of the same shape and strength in another size.
json scaled(json value, double size, const std::string& key = {}) {
  if (value.is_structured()) {
    for (auto& [name, part] : value.items()) {
      part = scaled(part, size, value.is_array() ? key : name);
    }
    return value;
  }
  const std::vector<std::pair<std::string, double>> powers = {
      {"mass_kg", 3.0}, {"_n_m", 4.0}, {"kg_m2", 5.0}, {"power_w", 3.5}, {"_m", 1.0}};
  for (const auto& [unit, power] : powers) {
    const bool ends = key.size() >= unit.size() && key.substr(key.size() - unit.size()) == unit;
    if (ends && value.is_number()) return value.get<double>() * std::pow(size, power);
  }
  return value;
}

TEST_F(Tools, AMachineThatCannotDigLeavesNoKit) {
  json toy = json::parse(content_of(shipped("machines/zx120.json")));
  toy.erase("cylinders");
  toy = scaled(toy, 0.1);
  const std::string file = folder.write("toy.json", toy.dump());
  const ProgramResult small = run_program("machine-kit", Words{file} + small_kit);
  EXPECT_EQ(small.code, 2);
  EXPECT_TRUE(
      contains(small.err, file + ": the length of the bucket [m] is 0.123, must be at least 0.2"))
      << small.err;
  json stiff = json::parse(content_of(shipped("machines/zx120.json")));
  stiff.erase("cylinders");
  stiff["joints"]["boom"]["upper_rad"] = -1.1;
  const std::string other = folder.write("stiff.json", stiff.dump());
  const ProgramResult high = run_program("machine-kit", Words{other} + small_kit);
  EXPECT_EQ(high.code, 2);
  EXPECT_TRUE(contains(high.err, other + ": a dig of its size cannot be driven: ")) << high.err;
  for (const char* kit : {"toy-kit", "stiff-kit"})
    EXPECT_FALSE(fs::exists(folder.file(kit))) << kit;
}

TEST_F(Tools, AMachineThatHardlyLiftsDumpsLower) {
  const Words search = {"--machine",     "generic-mini", "--density", "40",  "--search",
                        "--evaluations", "15",           "--cell",    "0.05"};
  const json plan = answer("plan-path", search);
  EXPECT_TRUE(warns(plan, "dump_height_lowered"));
  EXPECT_LT(number(plan, "/goal_parameters/dump_height_m"), 2.9);
  EXPECT_FALSE(
      warns(answer("plan-path", search + Words{"--dump-height", "2"}), "dump_height_lowered"));
  const ProgramResult high = run_program("plan-path", search + Words{"--dump-height", "3"});
  EXPECT_EQ(high.code, 2);
  EXPECT_TRUE(contains(high.err, "the dump height is 3 m")) << high.err;
  EXPECT_FALSE(warns(answer("plan-path", {"--density", "40"}), "dump_height_lowered"));
}

// Each shipped machine fills its bucket in loam, with a mass of its class.
TEST_F(Tools, ShippedMachinesDig) {
  const std::vector<std::pair<std::string, double>> machines = {
      {"zx200", 950.0}, {"generic-20t", 1200.0}, {"generic-mini", 46.0}};
  for (const auto& [machine, mass] : machines) {
    const json kit =
        answer("machine-kit", Words{machine, "--output", folder.file(machine)} + small_kit);
    const json& example = kit.at("soils").at(0).at("example");
    EXPECT_NEAR(number(example, "/payload_mass_kg"), mass, 0.15 * mass) << machine;
    EXPECT_GT(number(example, "/fill_fraction"), 0.8) << machine;
  }
}

}  // namespace
}  // namespace excavplan::test
