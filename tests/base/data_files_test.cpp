// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>

#include "support/errors.hpp"
#include "support/run_program.hpp"

/// @file
/// Where shipped files are found. tests/consumer looks for them from installed programs and
/// libraries.

namespace excavplan::test {
namespace {

namespace fs = std::filesystem;

/// The environment variable for as long as this lives.
class DataVariable {
 public:
  explicit DataVariable(const std::string& folder) {
    ::setenv("EXCAVPLAN_DATA", folder.c_str(), 1);
  }
  ~DataVariable() { ::unsetenv("EXCAVPLAN_DATA"); }
  DataVariable(const DataVariable&) = delete;
  DataVariable& operator=(const DataVariable&) = delete;
};

class DataFiles : public testing::Test {
 protected:
  /// A folder of data with one soil file.
  std::string folder_with(const std::string& name, const std::string& soil) const {
    fs::create_directories(temporary_.file(name + "/soils"));
    temporary_.write(name + "/soils/" + soil, "{}");
    return temporary_.file(name);
  }
  const TemporaryFolder temporary_;
};

TEST_F(DataFiles, ProgramsOfTheBuildTreeFindThemBesideTheirFolder) {
  EXPECT_STREQ(data_folder_of_package, "") << "no path is compiled into our own programs";
  EXPECT_EQ(find_data_file("soils/loam.json"),
            fs::canonical(EXCAVPLAN_BIN).parent_path() / "share/excavplan/soils/loam.json");
}

TEST_F(DataFiles, TheVariableComesBeforeThePackageAndThatBeforeTheProgram) {
  const std::string package = folder_with("package", "loam.json");
  EXPECT_EQ(find_data_file("soils/loam.json", package), package + "/soils/loam.json");
  const DataVariable variable(folder_with("named", "loam.json"));
  EXPECT_EQ(find_data_file("soils/loam.json", package), temporary_.file("named/soils/loam.json"));
}

TEST_F(DataFiles, AFolderThatLacksTheFileIsPassedOver) {
  const DataVariable variable(folder_with("named", "chalk.json"));
  EXPECT_EQ(find_data_file("soils/chalk.json"), temporary_.file("named/soils/chalk.json"));
  EXPECT_EQ(find_data_file("soils/loam.json"),
            fs::canonical(EXCAVPLAN_BIN).parent_path() / "share/excavplan/soils/loam.json");
}

TEST_F(DataFiles, AVariableThatNamesNoFolderIsAnErrorUnlessItIsEmpty) {
  const std::string file = temporary_.write("file", "{}");
  for (const std::string& named : {temporary_.file("none"), file}) {
    const DataVariable variable(named);
    const std::string text =
        error_of([] { find_data_file("soils/loam.json"); }, ErrorKind::bad_file);
    EXPECT_EQ(text.rfind("the environment variable EXCAVPLAN_DATA: found ", 0), 0U) << text;
    EXPECT_EQ(error_of([] { has_data_folder("soils"); }, ErrorKind::bad_file), text);
  }
  const DataVariable empty("");
  EXPECT_EQ(fs::path(find_data_file("soils/loam.json")).filename(), "loam.json");
}

TEST_F(DataFiles, WhatIsNowhereIsAnErrorThatNamesEveryFolder) {
  const std::string named = folder_with("named", "loam.json");
  const DataVariable variable(named);
  try {
    find_data_file("soils/chalk.json", "/nowhere/data");
    ADD_FAILURE() << "found";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_file);
    const std::string text = error.what();
    EXPECT_EQ(text.rfind("soils/chalk.json: not found in any of " + named + ", ", 0), 0U) << text;
    EXPECT_NE(text.find(", /nowhere/data, "), std::string::npos) << text;
    EXPECT_NE(text.find("/share/excavplan"), std::string::npos) << text;
  }
}

TEST_F(DataFiles, NoPathLeadsOutOfTheFolder) {
  const DataVariable variable(folder_with("named", "loam.json"));
  const std::string outside = temporary_.write("outside.json", "{}");
  for (const std::string& path : {outside, std::string("../outside.json"), std::string(".."),
                                  std::string("soils/../../outside.json"), std::string("/x")}) {
    const std::string text = error_of([&] { find_data_file(path); });
    EXPECT_NE(text.find("out of the folder of the data"), std::string::npos) << text;
  }
  for (const std::string& path : {std::string(), std::string(1000000, 'a'), std::string("soils")}) {
    EXPECT_NE(error_of([&] { find_data_file(path); }, ErrorKind::bad_file), "no error");
  }
}

}  // namespace
}  // namespace excavplan::test
