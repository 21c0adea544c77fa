// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/library/path_library.hpp>

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include <excavplan/data_files.hpp>
#include <excavplan/error.hpp>
#include <excavplan/library/library_build.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/json.hpp"
#include "library/library_row.hpp"
#include "library/shared_tasks.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;
using test::content_of;
using test::TemporaryFolder;

PathLibraryEntry entry(double density, const DigParameters& parameters, double mass) {
  return {density, {parameters, 6.0, mass, 0.3, 10e3, 4.0}, 100, 0.0, {}, {}};
}

PathLibrary small_library() {
  PathLibrary library;
  library.machine = "zx120";
  library.soil = "loam";
  library.machine_fingerprint = "0123456789abcdef";
  library.soil_fingerprint = "fedcba9876543210";
  library.simulator = "height-map 1";
  library.cell_size = 0.05;
  library.seed = 7;
  library.search = "by hand";
  library.entries = {entry(0.0, {0.8, 0.30, 1.5}, 400.0), entry(50.0, {0.7, 0.40, 1.9}, 500.0),
                     entry(100.0, {1.3, 0.10, 0.3}, 300.0)};
  library.entries[0].midway = {0.01, -0.02};
  library.entries[1].jump = true;
  return library;
}

/// The same digs, twice as heavy, on a slope of 0.2 as well.
PathLibrary sloped_library() {
  PathLibrary library = small_library();
  for (int i = 0; i < 3; ++i) {
    PathLibraryEntry steep = library.entries[static_cast<std::size_t>(i)];
    steep.slope = 0.2;
    steep.dig.payload_mass *= 2.0;
    library.entries.push_back(steep);
  }
  return library;
}

std::string error_in(const std::string& content) {
  const TemporaryFolder folder;
  const std::string file = folder.write("library.json", content);
  const std::string text = test::error_of([&] { load_path_library(file); }, ErrorKind::bad_file);
  return text == "no error" ? text : text.substr(file.size());
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

TEST(PathLibrary, TakesTheNearerDigWhereTheOptimumJumps) {
  const PathLibrary library = small_library();
  EXPECT_DOUBLE_EQ(look_up(library, 74.0).parameters.drag_length, 1.9);
  EXPECT_DOUBLE_EQ(look_up(library, 76.0).parameters.drag_length, 0.3);
}

TEST(PathLibrary, BlendsBetweenSlopes) {
  const PathLibrary library = sloped_library();
  EXPECT_DOUBLE_EQ(look_up(library, 25.0, 0.0).payload_mass, 450.0);
  EXPECT_DOUBLE_EQ(look_up(library, 25.0, 0.2).payload_mass, 900.0);
  EXPECT_DOUBLE_EQ(look_up(library, 25.0, 0.05).payload_mass, 562.5);
}

TEST(PathLibrary, TakesTheNearerSlopeWhereTheOptimumJumps) {
  PathLibrary library = sloped_library();
  library.entries[0].jump_slope = true;
  EXPECT_DOUBLE_EQ(look_up(library, 0.0, 0.09).payload_mass, 400.0);
  EXPECT_DOUBLE_EQ(look_up(library, 0.0, 0.11).payload_mass, 800.0);
  EXPECT_DOUBLE_EQ(look_up(library, 20.0, 0.09).payload_mass, 440.0) << "0 % is the nearer density";
  EXPECT_DOUBLE_EQ(look_up(library, 50.0, 0.1).payload_mass, 750.0);
}

TEST(PathLibrary, TellsItsErrorMidwayAndNoneAtItsEntries) {
  const PathLibrary library = small_library();
  EXPECT_DOUBLE_EQ(look_up_error(library, 25.0).loss, 0.01);
  EXPECT_DOUBLE_EQ(look_up_error(library, 25.0).expectation, -0.02);
  EXPECT_DOUBLE_EQ(look_up_error(library, 12.5).loss, 0.0075);
  EXPECT_EQ(look_up_error(library, 0.0).loss, 0.0);
  EXPECT_EQ(look_up_error(library, 50.0).expectation, 0.0);
}

TEST(PathLibrary, TellsItsErrorMidwayBetweenSlopes) {
  PathLibrary library = sloped_library();
  library.entries[0].midway_slope = {0.03, 0.01};
  library.entries[1].midway_slope = {0.02, -0.04};
  EXPECT_DOUBLE_EQ(look_up_error(library, 0.0, 0.1).loss, 0.03);
  EXPECT_DOUBLE_EQ(look_up_error(library, 0.0, 0.05).loss, 0.0225);
  EXPECT_DOUBLE_EQ(look_up_error(library, 25.0, 0.1).loss, 0.01 + 0.03);
  EXPECT_DOUBLE_EQ(look_up_error(library, 25.0, 0.1).expectation, -0.02 - 0.04);
  EXPECT_DOUBLE_EQ(look_up_error(library, 25.0, 0.0).loss, 0.01);
  EXPECT_EQ(look_up_error(library, 50.0, 0.2).loss, 0.0);
}

TEST(PathLibrary, OutsideItIsAnError) {
  PathLibrary library = small_library();
  library.entries.erase(library.entries.begin());
  const auto refusal = [&](double density, double slope) {
    return test::error_of([&] { look_up(library, density, slope); });
  };
  EXPECT_EQ(refusal(40.0, 0.0), "library: density [%] 40 is outside its range 50 .. 100");
  EXPECT_EQ(refusal(60.0, 0.1), "library: slope [rad] 0.1 is outside its range 0 .. 0");
  EXPECT_NE(refusal(std::nan(""), 0.0), "no error");
  EXPECT_NE(refusal(60.0, std::nan("")), "no error");
  EXPECT_THROW(look_up(PathLibrary{}, 50.0), Error);
}

TEST(PathLibrary, BetweenTwoDigsWithNoneFeasibleAmidIsAnError) {
  PathLibrary library = small_library();
  library.gaps = {{75.0, 0.0}};
  EXPECT_EQ(test::error_of([&] { look_up(library, 60.0); }),
            "library: no dig is feasible at a density of 75 % on a slope of 0 rad");
  EXPECT_NO_THROW(look_up(library, 40.0));
  EXPECT_NO_THROW(look_up(library, 100.0));
}

TEST(PathLibrary, ASlopeWithoutAnyDigIsNotInterpolatedAcross) {
  PathLibrary library = sloped_library();
  library.gaps = {{0.0, 0.1}, {50.0, 0.1}, {100.0, 0.1}};
  EXPECT_EQ(test::error_of([&] { look_up(library, 50.0, 0.05); }),
            "library: no dig is feasible at any density on a slope of 0.1 rad");
  EXPECT_NO_THROW(look_up(library, 50.0, 0.2));
}

TEST(PathLibrary, FileRoundTripGivesTheSameBytes) {
  PathLibrary library = sloped_library();
  library.gaps = {{75.0, 0.0}, {20.0, 0.2}};
  const TemporaryFolder folder;
  const std::string text = to_json(library);
  EXPECT_EQ(to_json(load_path_library(folder.write("library.json", text))), text);
}

TEST(PathLibrary, BadFilesAreRefusedByName) {
  const std::string good = to_json(small_library());
  const std::size_t seal = sealed("").size();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good.substr(0, good.size() - seal);
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return error_in(sealed(text.replace(at, from.size(), to)));
  };
  EXPECT_EQ(error_in(good), "no error");
  EXPECT_EQ(with("\"version\": 4", "\"version\": 5"),
            ": version: is 5, this program reads version 4");
  EXPECT_EQ(with("\"version\": 4", "\"version\": 3"),
            ": version: is 3, this program reads version 4; build the library again: "
            "build-path-library --out FILE");
  EXPECT_EQ(with("excavplan-path-library", "excavplan-soil"),
            ": format: is 'excavplan-soil', expected 'excavplan-path-library'");
  EXPECT_EQ(with("\"penetration_angle_rad\": 0.8", "\"penetration_angle_rad\": 8"),
            ": entries[0].path.penetration_angle_rad: is 8, must be in 0.2 .. 1.4");
  EXPECT_EQ(with("\"density_percent\": 50.0", "\"density_percent\": 0.0"),
            ": entries: slopes, and densities of a slope, must rise, entry 2 does not");
  EXPECT_EQ(with("\"soil\"", "\"sole\""), ": soil: is missing");
  EXPECT_EQ(with("\"seed\": 7", "\"seed\": 7, \"colour\": 3"),
            ": colour: is not a key of this file");
  EXPECT_EQ(with("\"seed\": 7", "\"seed\": 7, \"seed\": 8"), ": key 'seed' stands twice");
  EXPECT_NE(error_in(good.substr(0, good.size() / 2)).find("not valid JSON"), std::string::npos);
  EXPECT_THROW(load_path_library("/nowhere/library.json"), Error);
}

TEST(PathLibrary, EveryChangedByteIsNoticed) {
  const std::string good = to_json(small_library());
  for (std::size_t i = 0; i + 1 < good.size(); i += 7) {
    std::string text = good;
    text[i] = static_cast<char>(text[i] ^ 1);
    EXPECT_NE(error_in(text), "no error") << i;
  }
}

constexpr DigParameters short_dig{1.1, 0.2, 0.5};
constexpr DigParameters long_dig{0.85, 0.15, 1.5};

CellOutcome outcome(double density, const DigParameters& dig, double mass) {
  return {entry(density, dig, mass), 10};
}

LibraryRow row_of(const std::vector<CellOutcome>& outcomes) {
  std::vector<double> densities;
  for (const CellOutcome& one : outcomes) densities.push_back(one.entry->density_percent);
  LibraryRow row({}, densities);
  for (const CellOutcome& one : outcomes) row.take(one.entry->density_percent, one);
  return row;
}

TEST(LibraryRow, TriesTheBetterKindOfDigOnTheOtherSideUntilItIsNot) {
  using Better = Midway::Better;
  LibraryRow row =
      row_of({outcome(0, short_dig, 500), outcome(10, short_dig, 450), outcome(20, long_dig, 390),
              outcome(30, long_dig, 359), outcome(40, long_dig, 330)});
  EXPECT_EQ(row.unmeasured().size(), 4U);
  for (const auto& pair : row.unmeasured()) row.take(pair, {{}, 1, Better::neither});
  EXPECT_TRUE(row.looks_due().empty());
  row.take({10, 20}, {{0.03, 0.0}, 2, Better::below});
  ASSERT_EQ(row.looks_due().size(), 1U);
  const LibraryRow::Look look = row.looks_due()[0];
  EXPECT_EQ(look.density, 20.0);
  const auto starts = row.starts_of(look);
  ASSERT_EQ(starts.size(), 2U);
  EXPECT_EQ(starts[0].entry->density_percent, 10.0);
  EXPECT_EQ(starts[1].entry->density_percent, 0.0);
  row.take(look, outcome(20, short_dig, 405));
  // The border has moved: both sides of 20 % are measured anew, and 30 % is asked next.
  EXPECT_EQ(row.unmeasured(), (std::vector<LibraryRow::Pair>{{10, 20}, {20, 30}}));
  row.take({10, 20}, {{}, 1, Better::neither});
  row.take({20, 30}, {{0.01, 0.0}, 2, Better::below});
  ASSERT_EQ(row.looks_due().size(), 1U);
  EXPECT_EQ(row.looks_due()[0].density, 30.0);
  row.take(row.looks_due()[0], outcome(30, short_dig, 357));
  EXPECT_TRUE(row.looks_due().empty()) << "a worse dig is not taken, nor searched twice";
  PathLibrary library;
  row.add_to(library);
  EXPECT_EQ(library.entries[2].dig.payload_mass, 405.0);
  EXPECT_EQ(library.entries[3].dig.payload_mass, 359.0);
  EXPECT_EQ(library.evaluations(), 5 * 100 + 4 + 2 + 1 + 2 + 2 * 10) << "every dig counts";
}

TEST(LibraryRow, LooksAgainAtADigBelowTheLineThroughItsNeighbours) {
  LibraryRow row =
      row_of({outcome(0, short_dig, 500), outcome(5, short_dig, 475), outcome(10, short_dig, 451),
              outcome(15, short_dig, 420), outcome(20, short_dig, 407), outcome(25, short_dig, 387),
              outcome(30, short_dig, 367)});
  ASSERT_EQ(row.looks_due().size(), 1U);
  EXPECT_EQ(row.looks_due()[0].density, 15.0);
  EXPECT_EQ(row.starts_of(row.looks_due()[0]).size(), 2U);
  row.take(row.looks_due()[0], outcome(15, short_dig, 428));
  EXPECT_TRUE(row.looks_due().empty());
  // What is at the end of a line may be 1 % below it, and nothing is known where they are far
  // apart.
  const auto looks_at_the_end = [](double mass) {
    return row_of({outcome(0, short_dig, mass), outcome(5, short_dig, 475),
                   outcome(10, short_dig, 451), outcome(15, short_dig, 428)})
        .looks_due()
        .size();
  };
  EXPECT_EQ(looks_at_the_end(497), 0U);
  EXPECT_EQ(looks_at_the_end(493), 1U);
  const auto far_apart = {outcome(0, short_dig, 500), outcome(50, short_dig, 300),
                          outcome(100, short_dig, 250)};
  EXPECT_TRUE(row_of(far_apart).looks_due().empty());
}

TEST(Midway, TellsWhichKindOfDigIsBetter) {
  using Better = Midway::Better;
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind gravel = load_soil(find_data_file("soils/gravel.json"));
  const PathLibrary library = load_path_library(find_data_file("libraries/zx120-gravel.json"));
  const PlannedDig loose = look_up(library, 20.0);  // short and steep
  const PlannedDig dense = look_up(library, 80.0);  // long and flat
  const auto better = [&](double density, const PlannedDig& below, const PlannedDig& above) {
    const LibraryCell cell{&machine, &gravel, 0.0, density};
    return measure_midway(cell, library.cell_size, below, above, loose.efficiency()).better;
  };
  EXPECT_EQ(better(25.0, loose, dense), Better::below);
  EXPECT_EQ(better(25.0, dense, loose), Better::above);
  EXPECT_EQ(better(75.0, loose, dense), Better::above);
  EXPECT_EQ(better(25.0, loose, look_up(library, 25.0)), Better::neither) << "of one kind";
}

/// Digs all three by itself.
TEST(Midway, JumpsWhereAMixIsWorseThanEitherDig) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  int jumps = 0;
  int mixes = 0;
  for (const char* soil : {"loam", "gravel"}) {
    const SoilKind kind = load_soil(find_data_file(std::string("soils/") + soil + ".json"));
    const PathLibrary library =
        load_path_library(find_data_file(std::string("libraries/zx120-") + soil + ".json"));
    for (const auto& [low, high] : {std::pair(0.0, 40.0), {20.0, 80.0}, {10.0, 30.0}}) {
      const PlannedDig below = look_up(library, low);
      const PlannedDig above = look_up(library, high);
      if (!far_apart(below, above)) continue;
      const LibraryCell cell{&machine, &kind, 0.0, 0.5 * (low + high)};
      const auto efficiency = [&](const PlannedDig& dig) {
        const HeightMapSimulator simulator(machine, kind, cell.density_percent);
        const auto outcome =
            evaluate_dig(machine, simulator, level_planning_ground(machine, library.cell_size),
                         dig.parameters, dig.start_x);
        return std::get<PlannedDig>(outcome).efficiency();
      };
      const double mix = efficiency(dig_between(below, above, 0.5, false));
      const double worse = std::min(efficiency(below), efficiency(above));
      const Midway found =
          measure_midway(cell, library.cell_size, below, above, below.efficiency());
      EXPECT_EQ(found.jump, mix < worse) << soil << low;
      EXPECT_NEAR(found.error.loss, 1.0 - std::max(mix, worse) / below.efficiency(), 1e-9);
      ++(found.jump ? jumps : mixes);
    }
  }
  EXPECT_GT(jumps, 0);
  EXPECT_GT(mixes, 0);
}

class LibraryBuilding : public testing::Test {
 protected:
  static LibraryBuildOptions quick() {
    LibraryBuildOptions options;
    options.search.method = AnchoredSearch{6, 1, 8, 8};
    options.search.cell_size = 0.1;
    options.threads = 1;
    return options;
  }
  LibraryGrid grid(std::vector<double> densities, std::vector<double> slopes = {0.0}) const {
    return {{machine_}, {soil_}, std::move(slopes), std::move(densities)};
  }
  static std::string texts(const LibraryBuild& build) {
    std::string all;
    for (const PathLibrary& library : build.libraries) all += to_json(library);
    return all;
  }
  static std::string build(const LibraryGrid& grid, const LibraryBuildOptions& options) {
    return texts(build_path_libraries(grid, options));
  }
  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind soil_ = load_soil(find_data_file("soils/loam.json"));
};

TEST_F(LibraryBuilding, SameBytesForAnyNumberOfThreads) {
  LibraryBuildOptions options = quick();
  const std::string one = build(grid({20, 45, 60}), options);
  for (const unsigned threads : {2U, 8U, 32U}) {
    options.threads = threads;
    EXPECT_EQ(build(grid({20, 45, 60}), options), one) << threads;
  }
}

TEST_F(LibraryBuilding, AnEntryDoesNotDependOnTheOthers) {
  const auto entries = build_path_libraries(grid({10, 20, 35, 40}), quick()).libraries[0].entries;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double density = entries[i].density_percent;
    const auto alone = build_path_libraries(grid({density}), quick()).libraries[0].entries[0];
    EXPECT_EQ(alone.dig.energy, entries[i].dig.energy) << density;
    EXPECT_EQ(alone.dig.payload_mass, entries[i].dig.payload_mass) << density;
  }
}

TEST(LibraryWatch, CountsDigsNotCalls) {
  int told = 0;
  LibraryBuildOptions options;
  options.progress = [&](const LibraryProgress& now) {
    told = now.evaluations;
    return true;
  };
  LibraryWatch watch(options);
  const auto one = watch.of("one"), other = watch.of("other");
  SearchProgress progress;
  for (const int evaluations : {1, 2, 2, 3}) {
    progress.evaluations = evaluations;
    one(progress);
    other(progress);
  }
  EXPECT_EQ(told, 6);
}

TEST_F(LibraryBuilding, ProgressOfACellIsThatOfAllItsSearches) {
  const LibraryCell cell{&machine_, &soil_, 0.0, 30.0};
  const DigParameters dig{0.8, 0.3, 1.5};  // far better at 40 and 50 % than any dig can be
  const std::vector<CellOutcome> parents = {{entry(40.0, dig, 4e4), 1}, {entry(50.0, dig, 4e4), 1}};
  int told = 0;
  const auto outcome =
      compute_cell(cell, quick().search, parents, [&](const SearchProgress& progress) {
        EXPECT_GE(progress.evaluations, told);
        told = progress.evaluations;
        return true;
      });
  EXPECT_GT(outcome->evaluations, 8);  // more than the search from its neighbours may make
  EXPECT_EQ(told, outcome->evaluations);
}

TEST_F(LibraryBuilding, MorePointsThanCanBeCountedAreRefused) {
  LibraryBuildOptions options = quick();
  std::get<AnchoredSearch>(options.search.method).points = 300000000;
  EXPECT_EQ(test::error_of([&] { build_path_libraries(grid({20}), options); }),
            "library: points must be <= 1000000, got 300000000");
}

TEST_F(LibraryBuilding, AnotherSeedGivesAnotherLibrary) {
  LibraryBuildOptions options = quick();
  const std::string one = build(grid({20}), options);
  options.search.seed = 2;
  EXPECT_NE(build(grid({20}), options), one);
}

TEST_F(LibraryBuilding, AnyShardsMergeToTheSameBytes) {
  const LibraryGrid cells = grid({15, 20, 30, 70}, {0.0, 0.1});
  const std::string whole = build(cells, quick());
  for (const int count : {1, 3, 8, 11}) {
    const TemporaryFolder folder;
    LibraryBuildOptions options = quick();
    options.folder = folder.file("cells");
    for (int i = count; i >= 1; --i) build_library_shard(cells, {i, count}, options);
    options.only_merge = true;
    EXPECT_EQ(build(cells, options), whole) << count;
  }
}

TEST_F(LibraryBuilding, MergingNamesACellThatIsMissing) {
  const TemporaryFolder folder;
  LibraryBuildOptions options = quick();
  options.folder = folder.file("cells");
  build_library_shard(grid({0, 100}), {1, 2}, options);
  options.only_merge = true;
  const std::string text = test::error_of(
      [&] {
        build_path_libraries(grid({0, 100}), options);
      },
      ErrorKind::bad_file);
  EXPECT_NE(text.find("zx120-loam-slope0-density100-"), std::string::npos) << text;
  EXPECT_NE(text.find("is missing: the shard"), std::string::npos) << text;
}

TEST_F(LibraryBuilding, GoesOnFromWhatIsDone) {
  const LibraryGrid cells = grid({20, 30, 40});
  const std::string whole = build(cells, quick());
  const TemporaryFolder folder;
  LibraryBuildOptions options = quick();
  options.folder = folder.file("cells");
  for (const int limit : {1, 7, 30}) {
    options.progress = [&](const LibraryProgress& now) { return now.evaluations < limit; };
    const LibraryBuild part = build_path_libraries(cells, options);
    EXPECT_TRUE(part.stopped);
    EXPECT_TRUE(part.libraries.empty());
    EXPECT_LT(part.cells_done, part.cells);
  }
  options.progress = {};
  EXPECT_EQ(build(cells, options), whole);
  options.only_merge = true;
  EXPECT_EQ(build(cells, options), whole);
}

TEST_F(LibraryBuilding, DamagedCellsAreNamedAndComputedAnew) {
  const LibraryGrid cells = grid({0, 10});
  const TemporaryFolder folder;
  LibraryBuildOptions options = quick();
  options.folder = folder.file("cells");
  const std::string whole = build(cells, options);
  std::vector<std::string> files;
  for (const auto& file : fs::directory_iterator(options.folder)) files.push_back(file.path());
  ASSERT_EQ(files.size(), 2U);
  std::ofstream(files[0]) << content_of(files[0]).substr(0, 100);
  std::ofstream(files[1]) << content_of(files[0]);
  std::vector<std::string> notes;
  options.note = [&](const std::string& note) { notes.push_back(note); };
  EXPECT_EQ(build(cells, options), whole);
  ASSERT_EQ(notes.size(), 2U);
  for (const std::string& note : notes) {
    EXPECT_EQ(note.find(options.folder), 0U) << note;
    EXPECT_NE(note.find("it is computed anew"), std::string::npos) << note;
  }
}

TEST_F(LibraryBuilding, CellsOfAnotherSearchAreNotTaken) {
  const TemporaryFolder folder;
  LibraryBuildOptions options = quick();
  options.search.seed = 2;
  const std::string second = build(grid({20}), options);
  options.folder = folder.file("cells");
  options.search.seed = 1;
  build(grid({20}), options);
  options.search.seed = 2;
  EXPECT_EQ(build(grid({20}), options), second);
}

TEST_F(LibraryBuilding, LooksAgainWhereNeighboursKnowBetter) {
  LibraryGrid cells = grid({20, 30, 40, 50, 60, 70, 80});
  cells.soils = {load_soil(find_data_file("soils/gravel.json"))};  // two kinds of digs compete
  LibraryBuildOptions options = quick();
  const TemporaryFolder folder;
  options.folder = folder.file("cells");
  const PathLibrary library = build_path_libraries(cells, options).libraries[0];
  int better = 0;
  for (const auto& file : fs::directory_iterator(options.folder)) {
    const auto cell = nlohmann::json::parse(content_of(file.path()))["entry"];
    for (const PathLibraryEntry& entry : library.entries) {
      if (cell["density_percent"] != entry.density_percent) continue;
      const double own = cell["efficiency_kg_per_kj"].get<double>() / 1000.0;
      EXPECT_GE(entry.dig.efficiency(), own * (1.0 - 1e-12));
      better += entry.dig.efficiency() > 1.001 * own ? 1 : 0;
    }
  }
  EXPECT_GT(better, 0);
  options.folder.clear();
  options.threads = 3;
  EXPECT_EQ(build(cells, options), to_json(library));
}

TEST_F(LibraryBuilding, MeasuresWhatIsLostMidwayBetweenSlopes) {
  const PathLibrary library =
      build_path_libraries(grid({20, 40}, {-0.1, 0.0, 0.1}), quick()).libraries[0];
  int dug_midway = 0;
  for (const PathLibraryEntry& entry : library.entries) {
    if (entry.slope == 0.1) {
      EXPECT_EQ(entry.midway_slope.loss, 0.0);
      continue;
    }
    // The very dig that is looked up there, on ground of that slope.
    const double slope = entry.slope + 0.05;
    const PlannedDig looked_up = look_up(library, entry.density_percent, slope);
    const Terrain ground = sloped_planning_ground(machine_, slope, library.cell_size);
    const HeightMapSimulator simulator(machine_, soil_, entry.density_percent);
    const auto dug =
        evaluate_dig(machine_, simulator, ground, looked_up.parameters, looked_up.start_x);
    if (const auto* dig = std::get_if<PlannedDig>(&dug)) {
      ++dug_midway;
      EXPECT_NEAR(entry.midway_slope.expectation, looked_up.efficiency() / dig->efficiency() - 1.0,
                  1e-9);
    }
    EXPECT_EQ(look_up_error(library, entry.density_percent, slope).loss, entry.midway_slope.loss);
    EXPECT_LT(entry.midway_slope.loss, 0.5);
  }
  EXPECT_GT(dug_midway, 0);
}

TEST_F(LibraryBuilding, AddsDensitiesWhereTheLookUpLosesMost) {
  LibraryBuildOptions options = quick();
  options.refine = 0.02;
  const PathLibrary fine = build_path_libraries(grid({0, 100}), options).libraries[0];
  ASSERT_GE(fine.entries.size(), 11U);
  EXPECT_LE(fine.entries.size(), 101U);
  for (std::size_t i = 0; i + 1 < fine.entries.size(); ++i) {
    const double width = fine.entries[i + 1].density_percent - fine.entries[i].density_percent;
    EXPECT_GE(width, 1.0);
    EXPECT_LE(width, 10.0);
    EXPECT_TRUE(fine.entries[i].midway.loss <= options.refine || width < 2.0);
  }
  options.threads = 2;
  EXPECT_EQ(build(grid({0, 100}), options), to_json(fine));
}

TEST_F(LibraryBuilding, MachinesAndSoilsMakeALibraryEach) {
  LibraryGrid cells = grid({20, 70}, {-0.1, 0.0});
  cells.soils.push_back(load_soil(find_data_file("soils/sand.json")));
  const auto libraries = build_path_libraries(cells, quick()).libraries;
  ASSERT_EQ(libraries.size(), 2U);
  EXPECT_EQ(libraries[0].soil, "loam");
  EXPECT_EQ(libraries[1].soil, "sand");
  for (const PathLibrary& library : libraries) {
    ASSERT_EQ(library.entries.size(), 4U);
    EXPECT_EQ(library.entries[0].slope, -0.1);
    EXPECT_EQ(library.entries[3].slope, 0.0);
  }
}

TEST_F(LibraryBuilding, ALibraryIsRefusedForWhatItWasNotComputedFor) {
  const PathLibrary library = build_path_libraries(grid({20}), quick()).libraries[0];
  EXPECT_NO_THROW(require_fit(library, machine_, soil_, "l.json"));
  const auto refusal = [&](const PathLibrary& other, const Machine& machine, const SoilKind& soil) {
    return test::error_of([&] { require_fit(other, machine, soil, "l.json"); });
  };
  SoilKind wet = soil_;
  wet.water_content += 0.01;
  EXPECT_EQ(refusal(library, machine_, wet),
            "l.json: does not fit; the numbers of soil loam have changed since it was computed; "
            "build-path-library makes one that does");
  Machine heavy = machine_;
  heavy.links[0].mass += 1.0;
  EXPECT_NE(refusal(library, heavy, soil_).find("the numbers of machine zx120 have changed"),
            std::string::npos);
  heavy.name = "zx130";
  EXPECT_NE(refusal(library, heavy, soil_).find("its machine is zx120, not zx130"),
            std::string::npos);
  PathLibrary old = library;
  old.simulator = "height-map 0";
  EXPECT_NE(refusal(old, machine_, soil_).find("its simulator is height-map 0, not height-map "),
            std::string::npos);
}

TEST_F(LibraryBuilding, BadGridsAndOptionsAreRefused) {
  const auto refusal = [&](const LibraryGrid& cells, const LibraryBuildOptions& options) {
    return test::error_of([&] { build_path_libraries(cells, options); });
  };
  EXPECT_EQ(refusal(grid({}), quick()), "library: no densities [%] is asked for");
  EXPECT_EQ(refusal(grid({50, 40}), quick()),
            "library: densities [%] must rise inside 0 .. 100, got 40 at place 2");
  EXPECT_NE(refusal(grid({101}), quick()).find("got 101 at place 1"), std::string::npos);
  EXPECT_NE(refusal(grid({20}, {0.1, 0.1}), quick()).find("slopes [rad] must rise"),
            std::string::npos);
  LibraryBuildOptions options = quick();
  options.refine = 1.0;
  EXPECT_NE(refusal(grid({20}), options).find("refine must be"), std::string::npos);
  options = quick();
  options.only_merge = true;
  EXPECT_NE(refusal(grid({20}), options).find("a merge needs a folder"), std::string::npos);
  options = quick();
  EXPECT_THROW(build_library_shard(grid({20}), {1, 1}, options), Error);
  options.folder = testing::TempDir() + "excavplan_never_made";
  EXPECT_THROW(build_library_shard(grid({20}), {3, 2}, options), Error);
}

class ShippedLibrary : public testing::TestWithParam<const char*> {
 protected:
  HeightMapSimulator simulator(double density) const { return {machine_, soil_, density}; }

  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind soil_ = load_soil(find_data_file(std::string("soils/") + GetParam() + ".json"));
  const PathLibrary library_ =
      load_path_library(find_data_file(std::string("libraries/zx120-") + GetParam() + ".json"));
  Terrain ground(double slope) const {
    return sloped_planning_ground(machine_, slope, library_.cell_size);
  }
  std::vector<PathLibraryEntry> level_entries() const {
    std::vector<PathLibraryEntry> level;
    for (const PathLibraryEntry& entry : library_.entries) {
      if (entry.slope == 0.0) level.push_back(entry);
    }
    return level;
  }
};

TEST_P(ShippedLibrary, IsTrue) {
  EXPECT_NO_THROW(require_fit(library_, machine_, soil_, GetParam()));
  const std::size_t cells = library_.entries.size() + library_.gaps.size();
  EXPECT_EQ(cells, 13U * 21U);
  for (std::size_t i = 0; i < library_.entries.size(); i += 5) {
    const PathLibraryEntry& entry = library_.entries[i];
    const auto outcome = evaluate_dig(machine_, simulator(entry.density_percent),
                                      ground(entry.slope), entry.dig.parameters, entry.dig.start_x);
    const PlannedDig& dig = std::get<PlannedDig>(outcome);
    EXPECT_NEAR(dig.energy, entry.dig.energy, 1e-6 * dig.energy) << entry.density_percent;
    EXPECT_NEAR(dig.payload_mass, entry.dig.payload_mass, 1e-6 * dig.payload_mass);
  }
}

TEST_P(ShippedLibrary, LiftsMoreThanTheFixedPathOnLevelGround) {
  const std::vector<PathLibraryEntry> level = level_entries();
  ASSERT_EQ(level.size(), 21U);
  int evaluations = 0;
  double last = 1e9;
  for (const PathLibraryEntry& entry : level) {
    const double efficiency = entry.dig.efficiency();
    const auto fixed =
        evaluate_dig(machine_, simulator(entry.density_percent), ground(0.0), paper_fixed_path());
    if (const auto* possible = std::get_if<PlannedDig>(&fixed)) {
      EXPECT_GT(efficiency, possible->efficiency());
    }
    EXPECT_LT(efficiency, last);
    EXPECT_LT(entry.midway.loss, 0.03) << entry.density_percent;
    last = efficiency;
    evaluations += entry.evaluations;
  }
  const int between_slopes = 3;
  EXPECT_LE(evaluations, ((soil_.name == "gravel" ? 120 : 60) + between_slopes) * 21);
}

/// What is looked up between slopes gives little away at most places.
TEST_P(ShippedLibrary, LosesLittleBetweenItsSlopes) {
  std::vector<double> losses;
  for (const PathLibraryEntry& entry : library_.entries) {
    losses.push_back(entry.midway_slope.loss);
  }
  const auto most = losses.begin() + static_cast<std::ptrdiff_t>(losses.size() * 9 / 10);
  std::nth_element(losses.begin(), most, losses.end());
  EXPECT_LT(*most, 0.06);
}

/// A long search from nothing is the yardstick.
TEST_P(ShippedLibrary, HoldsNearlyTheBestDigs) {
  std::vector<PathLibraryEntry> some;
  const std::vector<PathLibraryEntry> level = level_entries();
  for (std::size_t i = 0; i < level.size(); i += 4) some.push_back(level[i]);
  for (const double share : {0.1, 0.9}) {  // steep down, steep up
    some.push_back(library_.entries[static_cast<std::size_t>(
        share * static_cast<double>(library_.entries.size()))]);
  }
  for (const PathLibraryEntry& entry : some) {
    DigSearchOptions options;
    options.seed = 99;
    options.stop.evaluations = 400;
    const auto best =
        search_dig(machine_, simulator(entry.density_percent), ground(entry.slope), options);
    ASSERT_TRUE(best);
    EXPECT_GE(entry.dig.efficiency(), 0.99 * best->dig.efficiency()) << entry.density_percent;
  }
}

INSTANTIATE_TEST_SUITE_P(Soils, ShippedLibrary, testing::Values("loam", "sand", "clay", "gravel"));

/// Processes as threads: each gets numbers and the parcels of all.
class Crew {
 public:
  explicit Crew(std::size_t size) : parcels_(size) {}
  std::size_t next() { return next_++; }
  std::vector<std::string> exchange(std::size_t member, const std::string& mine) {
    std::unique_lock<std::mutex> lock(mutex_);
    parcels_[member] = mine;
    const std::size_t round = round_;
    if (++arrived_ == parcels_.size()) {
      all_ = parcels_;
      arrived_ = 0;
      next_ = 0;
      ++round_;
      everybody_.notify_all();
    } else {
      everybody_.wait(lock, [&] { return round_ != round; });
    }
    return all_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable everybody_;
  std::vector<std::string> parcels_, all_;
  std::size_t arrived_ = 0, round_ = 0;
  std::atomic<std::size_t> next_{0};
};

class CrewMember : public WorkSharing {
 public:
  CrewMember(Crew& crew, std::size_t member) : crew_(crew), member_(member) {}
  std::size_t next() override { return crew_.next(); }
  std::vector<std::string> exchange(const std::string& mine) override {
    return crew_.exchange(member_, mine);
  }

 private:
  Crew& crew_;
  std::size_t member_;
};

TEST_F(LibraryBuilding, SameBytesInEveryOneOfSeveralProcesses) {
  const LibraryGrid cells = grid({10, 20, 35, 70});
  const std::string whole = build(cells, quick());
  for (const std::size_t size : {2U, 4U}) {
    Crew crew(size);
    std::vector<std::string> results(size);
    std::vector<std::thread> members;
    for (std::size_t i = 0; i < size; ++i) {
      members.emplace_back([&, i] {
        CrewMember member(crew, i);
        LibraryBuildOptions options = quick();
        options.sharing = &member;
        results[i] = build(cells, options);
      });
    }
    for (std::thread& member : members) member.join();
    for (const std::string& result : results) EXPECT_EQ(result, whole);
  }
}

TEST_F(LibraryBuilding, AnErrorOfOneProcessReachesAll) {
  const TemporaryFolder folder;
  Crew crew(2);
  std::vector<std::string> errors(2);
  std::vector<std::thread> members;
  for (std::size_t i = 0; i < 2; ++i) {
    members.emplace_back([&, i] {
      CrewMember member(crew, i);
      LibraryBuildOptions options = quick();
      options.sharing = &member;
      options.folder = folder.file("cells");
      options.only_merge = true;
      errors[i] =
          test::error_of([&] { build_path_libraries(grid({20}), options); }, ErrorKind::bad_file);
    });
  }
  for (std::thread& member : members) member.join();
  EXPECT_EQ(errors[0], errors[1]);
  EXPECT_NE(errors[0].find("is missing: the shard"), std::string::npos) << errors[0];
}

}  // namespace
}  // namespace excavplan
