// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include <excavplan/base/data_files.hpp>
#include <excavplan/ground/map_files.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/soil/ground_in_soil.hpp>

#include "support/machine_file.hpp"
#include "support/tool_answers.hpp"

/// @file
/// --ground and --ground-out: the state of the ground from dig to dig, and the grids of other
/// programs.

namespace excavplan::test {
namespace {

/// A grid of the same value that covers the dig and, if it is wide, the heap.
void write_grid(const TemporaryFolder& folder, const std::string& name, double value,
                double half_width = 6.0) {
  const HeightMap map = flat_ground({1.0, -half_width, 9.5, half_width}, 0.05, value);
  write_map(folder.file(name), {map, {{"value", "value", map.z}}});
}

TEST_F(Tools, GroundGoesFromDigToDig) {
  const std::string one = folder.file("one.tif");
  const std::string two = folder.file("two.tif");
  const json first = answer("simulate-dig", {"--density", "40", "--ground-out", one});
  const json second =
      answer("simulate-dig", {"--density", "40", "--ground", one, "--ground-out", two});
  const Machine machine = load_machine(shipped("machines/zx120.json"));
  const DigScene dug = run_scene(
      machine, loam(), 40.0,
      undisturbed(flat_ground(scene_extent(machine, default_dump_point()), usual_cell(machine))));
  const DigScene again = run_scene(machine, loam(), 40.0, dug.after);
  EXPECT_EQ(first.at("payload_mass_kg"), dug.dig.payload_mass);
  EXPECT_NEAR(second.at("payload_mass_kg"), again.dig.payload_mass, 1e-9);
  EXPECT_NEAR(second.at("energy_kj"), again.dig.energy.total / 1000.0, 1e-9);
  EXPECT_TRUE((load_ground(one).terrain.bank.z == dug.after.bank.z).all());
  EXPECT_LT((load_ground(two).terrain.bank.z - again.after.bank.z).abs().maxCoeff(), 1e-9);
  EXPECT_LT((load_ground(two).terrain.loose - again.after.loose).abs().maxCoeff(), 1e-9);
  EXPECT_EQ(second.at("ground_state").at("bank_density_percent"), nullptr);
}

TEST_F(Tools, GridsOfOtherProgramsAreGround) {
  write_grid(folder, "bank.asc", -0.3);
  write_grid(folder, "loose.asc", 0.3);
  write_grid(folder, "density.asc", 60.0);
  const std::string file = folder.write("ground.json", R"({"bank": "bank.asc", "loose": "loose.asc",
          "bank_density_percent": "density.asc", "frame": "quarry"})");
  const json result = answer("simulate-dig", {"--density", "20", "--ground", file});
  EXPECT_NEAR(result.at("density_percent"), 60.0, 1e-9);
  EXPECT_NEAR(result.at("ground_state").at("bank_density_percent"), 60.0, 1e-9);
  EXPECT_EQ(result.at("ground_state").at("frame"), "quarry");
  const json plan = answer("plan-path", {"--density", "20", "--ground", file});
  EXPECT_NEAR(plan.at("density_percent"), 60.0, 1e-9);
  folder.write("untold.json", R"({"bank": "bank.asc", "loose": "loose.asc"})");
  const json by_option =
      answer("simulate-dig", {"--density", "60", "--ground", folder.file("untold.json")});
  EXPECT_NEAR(by_option.at("energy_kj"), result.at("energy_kj"), 1e-6);
  EXPECT_NEAR(by_option.at("payload_mass_kg"), result.at("payload_mass_kg"), 1e-6);
}

TEST_F(Tools, GroundThatIsTooNarrowForAHeapIsDug) {
  write_grid(folder, "bank.asc", 0.0, 2.5);
  const std::string file = folder.write("ground.json", R"({"bank": "bank.asc"})");
  const json result = answer("simulate-dig", {"--density", "40", "--ground", file});
  const json usual = answer("simulate-dig", {"--density", "40"});
  EXPECT_EQ(result.at("dump_at_m"), nullptr);
  EXPECT_NEAR(result.at("payload_mass_kg"), usual.at("payload_mass_kg"), 1.0);
}

TEST_F(Tools, PlanPathForetellsTheGround) {
  const std::string file = folder.file("after.tif");
  answer("plan-path", {"--density", "40", "--ground-out", file});
  const Terrain after = load_ground(file, loam()).terrain;
  EXPECT_LT(after.surface().z.minCoeff(), -0.1);
  const json next = answer("plan-path", {"--density", "40", "--ground", file});
  EXPECT_EQ(next.at("ground"), "as in the ground file");
}

TEST_F(Tools, RunExperimentBeginsOnTheGround) {
  write_grid(folder, "bank.asc", 0.0);
  write_grid(folder, "density.asc", 90.0);
  const std::string file =
      folder.write("ground.json", R"({"bank": "bank.asc", "bank_density_percent": "density.asc"})");
  const std::string out = folder.file("out.tif");
  const json result =
      answer("run-experiment", {"--densities", "40", "--ground", file, "--ground-out", out});
  EXPECT_EQ(result.at("conditions").at(0).at("density_percent"), 40.0);
  EXPECT_EQ(result.at("ground_state").at("bank_density_percent"), nullptr);
  const GroundState after = load_ground(out, loam());
  EXPECT_LT(after.terrain.surface().z.minCoeff(), -0.05);
  EXPECT_GT(after.terrain.surface().z.maxCoeff(), 0.1);
  EXPECT_NEAR(*bank_density_percent(after.terrain, loam(), {4.0, -0.5, 6.0, 0.5}), 90.0, 1e-9);
}

TEST_F(BadInput, GroundStandsInPlaceOfATerrain) {
  const std::string file = folder.file("one.tif");
  answer("simulate-dig", {"--density", "40", "--ground-out", file});
  const Words on_file = {"--density", "40", "--ground", file};
  refused(2, "--ground excludes --terrain", "simulate-dig", on_file + Words{"--terrain", file});
  refused(2, "--ground excludes --cell", "simulate-dig", on_file + Words{"--cell", "10cm"});
  refused(2, "--ground excludes --attitude", "plan-path", on_file + Words{"--attitude", "1,1"});
  const std::string text = folder.write("text.json", "[]");
  refused(3, text + ": expected a JSON object", "simulate-dig",
          {"--density", "40", "--ground", text});
}

}  // namespace
}  // namespace excavplan::test
