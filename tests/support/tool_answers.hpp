// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "support/run_program.hpp"

/// @file
/// Runs the tools and reads their answers: what the tests of several tools share.

namespace excavplan::test {
namespace fs = std::filesystem;
using nlohmann::json;
using Words = std::vector<std::string>;

Words operator+(Words first, const Words& second);

std::string shipped(const std::string& file);
std::string shared(const std::string& file);

/// What a tool answers with --json; nothing but one object may stand on standard output.
json answer(const std::string& tool, const Words& words, int code = 0);

double number(const json& object, const std::string& pointer);

Words warning_codes(const json& object);

bool warns(const json& object, const std::string& code);

/// Every key is there and of the type that nlohmann calls by this name.
void expect_keys(const json& object, const std::string& type, const Words& pointers);

inline const Words volume_keys = {
    "volume/excavated_m3", "volume/excavated_sd_m3", "volume/spilled_m3", "volume/spilled_sd_m3",
    "volume/dumped_m3",    "volume/dumped_sd_m3",    "volume/before_m3",  "volume/before_sd_m3",
    "volume/after_m3",     "volume/after_sd_m3"};
inline const Words path_keys = {"path/penetration_angle_rad", "path/penetration_length_m",
                                "path/drag_length_m", "path/start_x_m"};
inline const Words cost_keys = {"payload_mass_kg", "energy_kj", "efficiency_kg_per_kj"};

inline const Words small_library = {"--points", "8", "--polish", "8", "--inherited", "8"};

Words quickstart(const TemporaryFolder&);

/// A copy of a scan with its coordinates in mm.
std::string in_millimetres(const TemporaryFolder& folder, const std::string& scan);

/// Two scans of the whole scene and what really happened.
struct ScanFiles {
  std::string before;
  std::string after;
  json truth;
};

ScanFiles scan_pair(const TemporaryFolder& folder, int density, int seed);

class Tools : public testing::Test {
 protected:
  TemporaryFolder folder;
};

class BadInput : public Tools {
 protected:
  /// The tool refuses with this code, gives this reason and leaves no file behind.
  void refused(int code, const std::string& reason, const std::string& tool, const Words& words) {
    const Words before = files();
    const ProgramResult result = run_program(tool, words);
    std::string command = tool;
    for (const std::string& word : words) command += " " + word;
    EXPECT_EQ(result.code, code) << command << '\n' << result.err;
    EXPECT_EQ(result.out, "") << command;
    EXPECT_EQ(result.err.rfind(tool + ": ", 0), 0U) << command << '\n' << result.err;
    EXPECT_TRUE(contains(result.err, reason)) << command << '\n' << result.err;
    EXPECT_EQ(files(), before) << command;
  }

  Words files() const {
    Words names;
    for (const auto& entry : fs::directory_iterator(folder.file(""))) {
      names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  const std::string scan = shipped("quickstart/before.pcd");
  const std::string later_scan = shipped("quickstart/after.pcd");
  const std::string letter = folder.write("letter.txt", "Dear reader,\nthis is not a cloud.\n");
  const std::string plot = folder.file("plot.svg");
};

class RealScans : public Tools {
 protected:
  void SetUp() override {
    if (!fs::exists(shared("README.md"))) {
      GTEST_SKIP() << EXCAVPLAN_SHARED_DATA << ": real scans are not here";
    }
  }
  const std::string terrain = shared("site-terrain/terrain.pcd");
};

}  // namespace excavplan::test
