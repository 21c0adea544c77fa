// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/path_library.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/data_files.hpp>
#include <excavplan/error.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "json_file.hpp"

namespace excavplan {
namespace {

PathLibraryEntry entry(double density, const DigParameters& parameters, double mass) {
  return {density, {parameters, 6.0, mass, 0.3, 10e3, 4.0}, 100};
}

PathLibrary small_library() {
  return {"zx120",
          "loam",
          0.05,
          7,
          50,
          20,
          60,
          {entry(0.0, {0.8, 0.30, 1.5}, 400.0), entry(50.0, {0.7, 0.40, 1.9}, 500.0),
           entry(100.0, {1.3, 0.10, 0.3}, 300.0)}};
}

/// Tests run side by side: one file each.
std::string library_file() {
  return testing::TempDir() + "excavplan_library_" + std::to_string(::getpid()) + ".json";
}

std::string error_of(const std::string& content) {
  const std::string file = library_file();
  std::ofstream(file) << content;
  std::string text = "no error";
  try {
    load_path_library(file);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::bad_file);
    text = std::string(e.what()).substr(file.size());
  }
  std::remove(file.c_str());
  return text;
}

TEST(PathLibrary, LooksUpEntriesAndBlendsBetweenThem) {
  const PathLibrary library = small_library();
  EXPECT_DOUBLE_EQ(look_up(library, 50.0).parameters.drag_length, 1.9);
  const PlannedDig between = look_up(library, 25.0);
  EXPECT_DOUBLE_EQ(between.parameters.penetration_angle, 0.75);
  EXPECT_DOUBLE_EQ(between.parameters.penetration_length, 0.35);
  EXPECT_DOUBLE_EQ(between.parameters.drag_length, 1.7);
  EXPECT_DOUBLE_EQ(between.payload_mass, 450.0);
}

TEST(PathLibrary, DoesNotBlendDigsOfDifferentKinds) {
  const PathLibrary library = small_library();
  EXPECT_DOUBLE_EQ(look_up(library, 74.0).parameters.drag_length, 1.9);
  EXPECT_DOUBLE_EQ(look_up(library, 76.0).parameters.drag_length, 0.3);
}

TEST(PathLibrary, OutsideItsDensitiesIsAnError) {
  PathLibrary library = small_library();
  library.entries.erase(library.entries.begin());
  try {
    look_up(library, 40.0);
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "library: density 40 % is outside its range 50 .. 100 %");
  }
  EXPECT_THROW(look_up(library, std::nan("")), Error);
}

TEST(PathLibrary, FileRoundTripGivesTheSameBytes) {
  const std::string file = library_file();
  const std::string text = to_json(small_library());
  write_file(file, text);
  EXPECT_EQ(to_json(load_path_library(file)), text);
  std::remove(file.c_str());
}

TEST(PathLibrary, BadFilesAreRefusedByName) {
  const std::string good = to_json(small_library());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return error_of(text.replace(at, from.size(), to));
  };
  EXPECT_EQ(error_of(good), "no error");
  EXPECT_EQ(with("\"version\": 1", "\"version\": 2"),
            ": version: is 2, this program reads version 1");
  EXPECT_EQ(with("excavplan-path-library", "excavplan-soil"),
            ": format: is 'excavplan-soil', expected 'excavplan-path-library'");
  EXPECT_EQ(with("\"penetration_angle_rad\": 0.8", "\"penetration_angle_rad\": 8"),
            ": entries[0].path.penetration_angle_rad: is 8, must be in 0.2 .. 1.4");
  EXPECT_EQ(with("\"density_percent\": 50.0", "\"density_percent\": 0.0"),
            ": entries: densities must rise, entry 2 does not");
  EXPECT_EQ(with("\"soil\"", "\"sole\""), ": soil: is missing");
  EXPECT_EQ(with("\"seed\": 7", "\"seed\": 7, \"colour\": 3"),
            ": colour: is not a key of this file");
  EXPECT_EQ(with("\"seed\": 7", "\"seed\": 7, \"seed\": 8"), ": key 'seed' stands twice");
  EXPECT_NE(error_of(good.substr(0, good.size() / 2)).find("not valid JSON"), std::string::npos);
  EXPECT_THROW(load_path_library("/nowhere/library.json"), Error);
}

class LibraryBuild : public testing::Test {
 protected:
  static LibraryBuildOptions quick() {
    LibraryBuildOptions options;
    GeneticAlgorithm genetic;
    genetic.population = 12;
    genetic.generations = 3;
    options.search.method = genetic;
    return options;
  }
  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind soil_ = load_soil(find_data_file("soils/loam.json"));
};

TEST_F(LibraryBuild, SameBytesForAnyNumberOfThreads) {
  LibraryBuildOptions options = quick();
  options.search.threads = 1;
  const std::string one = to_json(build_path_library(machine_, soil_, {20, 60}, options));
  for (const unsigned threads : {2U, 8U}) {
    options.search.threads = threads;
    EXPECT_EQ(to_json(build_path_library(machine_, soil_, {20, 60}, options)), one);
  }
}

TEST_F(LibraryBuild, GoesOnFromWhatIsDone) {
  LibraryBuildOptions options = quick();
  const PathLibrary whole = build_path_library(machine_, soil_, {20, 60, 80}, options);
  options.progress = [](std::size_t done, std::size_t, const PathLibraryEntry&) {
    return done < 2;
  };
  const PathLibrary part = build_path_library(machine_, soil_, {20, 60, 80}, options);
  EXPECT_EQ(part.entries.size(), 2U);
  options.progress = nullptr;
  options.done = part.entries;
  EXPECT_EQ(to_json(build_path_library(machine_, soil_, {20, 60, 80}, options)), to_json(whole));
}

TEST_F(LibraryBuild, BadDensitiesAreRefused) {
  EXPECT_THROW(build_path_library(machine_, soil_, {}, quick()), Error);
  EXPECT_THROW(build_path_library(machine_, soil_, {50, 40}, quick()), Error);
  EXPECT_THROW(build_path_library(machine_, soil_, {101}, quick()), Error);
}

TEST_F(LibraryBuild, TheShippedLibraryIsTrue) {
  const PathLibrary library = load_path_library(find_data_file("libraries/zx120-loam.json"));
  EXPECT_EQ(library.entries.size(), 21U);
  const Terrain ground = level_planning_ground(machine_, library.cell);
  double last = 1e9;
  for (const PathLibraryEntry& entry : library.entries) {
    const HeightMapSimulator simulator(machine_, soil_, entry.density_percent);
    const auto outcome = evaluate_dig(machine_, simulator, ground, entry.dig.parameters);
    const PlannedDig& dig = std::get<PlannedDig>(outcome);
    EXPECT_NEAR(dig.energy, entry.dig.energy, 1e-6 * dig.energy) << entry.density_percent;
    EXPECT_NEAR(dig.payload_mass, entry.dig.payload_mass, 1e-6 * dig.payload_mass);
    const auto fixed = evaluate_dig(machine_, simulator, ground, paper_fixed_path());
    if (const auto* possible = std::get_if<PlannedDig>(&fixed)) {
      EXPECT_GT(dig.efficiency(), possible->efficiency());
    } else {
      EXPECT_EQ(entry.density_percent, 100.0);  // where the machine stalls on the fixed path
    }
    EXPECT_LT(dig.efficiency(), last);
    last = dig.efficiency();
  }
}

}  // namespace
}  // namespace excavplan
