// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/kit/kit_files.hpp>

#include <gtest/gtest.h>

#include "support/errors.hpp"
#include "support/kit_folder.hpp"

namespace excavplan::test {
namespace {

GoalNumbers none_given() { return GoalNumbers(objective_parameters().size()); }

TEST(KitFiles, AKitIsFoundByItsFolderItsMachineAndTheFileBesideIt) {
  const KitFolder folder;
  const std::string file = folder.kit() + "/machine.json", law = folder.kit() + "/laws/x-y.json";
  EXPECT_EQ(machine_path(folder.kit()), file);
  EXPECT_EQ(machine_path(folder.machine()), folder.machine());
  EXPECT_EQ(default_kit(folder.machine()), folder.kit());
  EXPECT_EQ(default_kit("zx200"), "zx200-kit");
  for (const std::string& word : {folder.kit(), file, folder.machine()}) {
    EXPECT_EQ(kit_law(word, load_machine(machine_path(word)), "loam"),
              folder.kit() + "/laws/digger-loam.json");
    EXPECT_FALSE(kit_law(word, load_machine(machine_path(word)), "sand"));
    EXPECT_FALSE(kit_file(word, "laws")) << "a folder";
  }
  EXPECT_NE(error_of([] { machine_path("zx9"); }).find("'zx9' is neither a file"),
            std::string::npos);
}

TEST(KitFiles, NumbersThatAreNotGivenAreThoseOfTheLibrary) {
  const KitFolder folder;
  DigObjective objective = DigObjective::Goal::cycle;
  objective.dump_height = 2.5;
  folder.add_library(objective);
  const Machine machine = load_machine(folder.machine());
  objective.dump_height = 3.0;
  objective.swing = 1.0;
  GoalNumbers given = none_given();
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (objective_parameters()[i].field == &DigObjective::swing) given[i] = 1.0;
  }
  const auto library = kit_library(folder.machine(), machine, "loam", given, objective);
  ASSERT_TRUE(library);
  EXPECT_EQ(library->machine, "digger");
  EXPECT_EQ(objective.dump_height, 2.5);
  EXPECT_EQ(objective.swing, 1.0);
  objective = DigObjective::Goal::energy;
  EXPECT_FALSE(kit_library(folder.machine(), machine, "loam", none_given(), objective));
}

TEST(KitFiles, ThePriceThatIsToldWithTheGoalStays) {
  const KitFolder folder;
  const Machine machine = load_machine(folder.machine());
  DigObjective objective = DigObjective::Goal::priced;
  objective.time_price = 1000.0;
  folder.add_library(objective);
  objective.time_price = 500.0;
  ASSERT_TRUE(kit_library(folder.machine(), machine, "loam", none_given(), objective));
  EXPECT_EQ(objective.time_price, 500.0);
}

}  // namespace
}  // namespace excavplan::test
