// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/kit/data_sheet_machine.hpp>

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/kit/machine_kit.hpp>
#include <excavplan/kit/workspace.hpp>
#include <excavplan/planning/dig_search.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/simulators.hpp>

#include "base/files.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

using nlohmann::json;

/// The data sheet of a shipped machine; what it does not state by its numbers.
NamedDataSheet sheet_of(const std::string& name) {
  const MachineFile file = load_machine_file(find_data_file("machines/" + name + ".json"));
  const Machine& machine = file.machine;
  const Reach reach = reach_of(machine);
  DataSheet sheet = file.data_sheet;
  double mass = machine.body->mass;
  for (const LinkMass& link : machine.links) mass += link.mass;
  if (!sheet.operating_mass) sheet.operating_mass = mass;
  if (!sheet.bucket_capacity) sheet.bucket_capacity = heaped_capacity(machine);
  if (!sheet.bucket_force) sheet.bucket_force = bucket_force(machine);
  if (!sheet.arm_force) sheet.arm_force = arm_force(machine);
  if (!sheet.ground_reach) sheet.ground_reach = reach.ground;
  if (!sheet.depth) sheet.depth = reach.depth;
  if (!sheet.height) sheet.height = reach.height;
  sheet.bucket_width = machine.bucket.width_outside;
  return {name, sheet};
}

std::vector<std::string> without(const std::string& name) {
  std::vector<std::string> others = proportion_machines();
  others.erase(std::remove(others.begin(), others.end(), name), others.end());
  return others;
}

/// Within 10 % of all that the sheet says.
void expect_met(const FittedMachine& fitted, const DataSheet& sheet) {
  const Machine& machine = fitted.file.machine;
  const Reach reach = reach_of(machine);
  double mass = machine.body->mass;
  for (const LinkMass& link : machine.links) mass += link.mass;
  const auto near = [&](const char* what, std::optional<double> stated, double found) {
    const double ratio = stated ? found / *stated : 1.0;
    EXPECT_NEAR(ratio, 1.0, 0.1) << machine.name << ": " << what;
  };
  near("mass", sheet.operating_mass, mass);
  near("capacity", sheet.bucket_capacity, heaped_capacity(machine));
  near("bucket force", sheet.bucket_force, bucket_force(machine));
  near("arm force", sheet.arm_force, arm_force(machine));
  near("reach", sheet.ground_reach, reach.ground);
  near("depth", sheet.depth, reach.depth);
  near("height", sheet.height, reach.height);
  near("dump height", sheet.dump_height, dump_height(machine));
}

TEST(DataSheetMachine, MeetsTheSheetOfAMachineThatIsLeftOut) {
  for (const std::string& name : proportion_machines()) {
    const NamedDataSheet sheet = sheet_of(name);
    const FittedMachine fitted = machine_from_data_sheet(sheet, without(name));
    expect_met(fitted, sheet.sheet);
    EXPECT_TRUE(check_data_sheet(fitted.file.machine, sheet.sheet).empty()) << name;
  }
}

// Komatsu's brochure of the PC200-8 with bucket of 0.80 m3 and arms of 2.925, 2.41 and 1.84 m;
// Caterpillar's figures of the 320, stowerscat.com. PC350LC-8 and U17-3 are recalled, not looked
// up.
const std::vector<NamedDataSheet>& published() {
  static const std::vector<NamedDataSheet> sheets = {
      {"pc200-8",
       {19500, 0.8, 149e3, 108e3, 9.7, 6.62, 10.0, 7.11, 1.045, 110e3, 1.2985, 2.2, 4.07}},
      {"pc200-8-2.4",
       {19500, 0.8, 149e3, 127e3, 9.19, 6.095, 9.8, 6.89, 1.045, 110e3, 1.2985, 2.2, 4.07}},
      {"pc200-8-1.8",
       {19500, 0.8, 177e3, 145e3, 8.66, 5.38, 9.5, 6.63, 1.045, 110e3, 1.2985, 2.2, 4.07}},
      {"320", {22600, 1.19, 140.5e3, 106.7e3, 9.85, 6.71, 9.36, 6.49, {}, 128e3, 1.18, 2.38, 4.45}},
      {"pc350lc-8",
       {34400, 1.4, 228e3, 170e3, 10.92, 7.38, 10.21, 7.11, {}, 184e3, 0.995, 2.59, 4.955}},
      {"u17-3",
       {1700, 0.04, 15.2e3, 8.5e3, 3.85, 2.31, 3.54, 2.43, 0.45, 11.8e3, 0.95, 0.99, 1.58}}};
  return sheets;
}

TEST(DataSheetMachine, MeetsPublishedSheets) {
  for (const NamedDataSheet& sheet : published()) {
    expect_met(machine_from_data_sheet(sheet), sheet.sheet);
  }
}

// Boom and arm of the PC200-8 are 5.700 and 2.925 m, its bucket weighs 635 kg, its tracks stand on
// 3.275 m, says the brochure.
TEST(DataSheetMachine, FitsWhatTheBrochureSaysBesides) {
  const Machine machine = machine_from_data_sheet(published()[0]).file.machine;
  EXPECT_NEAR(machine.boom_length, 5.7, 0.1);
  EXPECT_NEAR(machine.arm_length, 2.925, 0.1);
  EXPECT_NEAR(machine.links[2].mass, 635.0, 0.1 * 635.0);
  EXPECT_NEAR(machine.body->front_edge, 0.5 * 3.275, 0.1);
}

TEST(DataSheetMachine, EachNumberNamesItsSourceAndSpread) {
  const FittedMachine fitted = machine_from_data_sheet(sheet_of("zx200"));
  const json file = json::parse(fitted.file.text);
  EXPECT_NE(file.at("/links/sources/boom.mass_kg"_json_pointer).get<std::string>().find("spread"),
            std::string::npos);
  for (const FittedNumber& number : fitted.numbers) {
    EXPECT_FALSE(number.how.empty()) << number.key;
    if (number.key == "links.boom.mass_kg") {
      EXPECT_GT(number.spread.value_or(0.0), 0.05);
    }
  }
  ASSERT_EQ(fitted.file.warnings.size(), 1U);
  EXPECT_EQ(fitted.file.warnings[0].code, WarningCode::data_sheet_fitted);
  EXPECT_TRUE(fitted.file.machine.cylinders.has_value());
}

TEST(DataSheetMachine, FourFiguresAreEnough) {
  DataSheet least;
  least.operating_mass = 8000.0;
  least.bucket_capacity = 0.28;
  least.ground_reach = 6.9;
  least.depth = 4.1;
  expect_met(machine_from_data_sheet({"eight", least}), least);
}

TEST(DataSheetMachine, WhatCannotBeMetEndsTrust) {
  NamedDataSheet sheet = sheet_of("generic-20t");
  sheet.sheet.height = 15.0;
  const FittedMachine fitted = machine_from_data_sheet(sheet);
  const auto warnings = check_data_sheet(fitted.file.machine, fitted.file.data_sheet);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].ends_trust);
}

PlannedDig planned(const Machine& machine) {
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const auto simulator = default_simulator().make(machine, loam, 40.0);
  DigSearchOptions options = budget_search();
  options.objective = feasible_objective(machine, options.objective);
  options.stop.evaluations = 600;
  return search_dig(machine, *simulator, level_planning_ground(machine), options).value().dig;
}

// What a dig planned for the fitted machine differs from that of the full file, in loam at 40 %.
TEST(DataSheetMachine, ItsPlansAreNearThoseOfTheFullFile) {
  for (const std::string& name : proportion_machines()) {
    const PlannedDig full = planned(load_machine(find_data_file("machines/" + name + ".json")));
    const PlannedDig fitted =
        planned(machine_from_data_sheet(sheet_of(name), without(name)).file.machine);
    std::printf("%-12s payload %6.0f kg, fitted %6.0f; energy %6.1f kJ, fitted %6.1f\n",
                name.c_str(), full.payload_mass, fitted.payload_mass, 1e-3 * full.energy,
                1e-3 * fitted.energy);
    EXPECT_NEAR(fitted.payload_mass / full.payload_mass, 1.0, 0.15) << name;
    EXPECT_NEAR(fitted.energy / full.energy, 1.0, 0.15) << name;
  }
}

std::string complaint(const std::string& text) {
  const std::string file = testing::TempDir() + "sheet_" + std::to_string(::getpid()) + ".json";
  write_file(file, text);
  return test::error_of([&] { load_data_sheet(file); }, ErrorKind::bad_file);
}

TEST(DataSheetMachine, AWrongSheetIsRefusedByKeyValueAndRule) {
  const json good = {{"name", "digger"},
                     {"operating_mass_kg", 20000},
                     {"bucket_capacity_m3", 0.8},
                     {"ground_reach_m", 9.7},
                     {"depth_m", 6.6}};
  EXPECT_EQ(complaint(good.dump()), "no error");
  const auto with = [&](const char* key, const json& value) {
    json changed = good;
    changed[key] = value;
    return complaint(changed.dump());
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string missing = complaint("{}");
  for (const char* key :
       {"name", "operating_mass_kg", "bucket_capacity_m3", "ground_reach_m", "depth_m"}) {
    EXPECT_TRUE(has(missing, key)) << missing;
  }
  EXPECT_TRUE(has(with("ground_reach_m", 9700), "ground_reach_m: is 9700, must be in"));
  EXPECT_TRUE(has(with("operating_mass_kg", 20), "operating_mass_kg: is 20, must be in"));
  EXPECT_TRUE(has(with("bucket_force_n", 149), "bucket_force_n: is 149, must be in"));
  EXPECT_TRUE(has(with("swing_rate_rad_per_s", 12.4), "rpm"));
  EXPECT_TRUE(has(with("depth_m", -6.6), "depth_m: is -6.6"));
  EXPECT_TRUE(has(with("depth_m", "deep"), "depth_m"));
  EXPECT_TRUE(has(with("ground_reach_m", 31.8), "ft"));
  EXPECT_TRUE(has(with("dig_depth_m", 6.6), "dig_depth_m: is not a key"));
  EXPECT_TRUE(has(complaint(R"({"depth_m": NaN})"), "not valid JSON"));
}

}  // namespace
}  // namespace excavplan
