// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_search.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include <sys/stat.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <tuple>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/planning/library_build.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/json.hpp"
#include "base/text.hpp"
#include "planning/library_tasks.hpp"
#include "planning/planned_digs.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;
using test::content_of;
using test::TemporaryFolder;

PathLibraryEntry entry(double density, const DigParameters& parameters, double mass) {
  return {density, 0.0, {parameters, 6.0, mass, 0.3, 10e3, 4.0, 0.7, 50e3, 14.0}, 100, {}, {}};
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
  library.objective = DigObjective::Goal::cycle;
  library.search = "by hand";
  library.entries = {entry(0.0, {0.8, 0.30, 1.5}, 400.0), entry(50.0, {0.7, 0.40, 1.9}, 500.0),
                     entry(100.0, {1.3, 0.10, 0.3}, 300.0)};
  library.entries[0].to_next_density.midway = {0.01, -0.02};
  library.entries[1].to_next_density.between = Between::nearest;
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
  EXPECT_DOUBLE_EQ(between.cycle_energy, 50e3);
}

TEST(PathLibrary, TakesTheNearerDigWhereAMixIsWorse) {
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

TEST(PathLibrary, TakesTheNearerSlopeWhereAMixIsWorse) {
  PathLibrary library = sloped_library();
  library.entries[0].to_next_slope.between = Between::nearest;
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
  library.entries[0].to_next_slope.midway = {0.03, 0.01};
  library.entries[1].to_next_slope.midway = {0.02, -0.04};
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
  library.objective = DigObjective::Goal::priced;
  library.objective.time_price = 40.0;
  library.objective.dump_height = 2.0;
  const PathLibrary priced = load_path_library(folder.write("priced.json", to_json(library)));
  EXPECT_EQ(describe(priced.objective), describe(library.objective));
  EXPECT_EQ(file_name(priced), "zx120-loam-priced.json");
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
  EXPECT_EQ(with("\"version\": 6", "\"version\": 7"),
            ": version: is 7, this program reads version 6");
  EXPECT_EQ(with("\"version\": 6", "\"version\": 5"),
            ": version: is 5, this program reads version 6");
  EXPECT_EQ(with("\"goal\": \"cycle\"", "\"goal\": \"speed\""),
            ": goal: is 'speed', which is no goal");
  EXPECT_EQ(with("\"min_fill\": 0.8", "\"min_fill\": 8"),
            ": goal_parameters.min_fill: is 8, must be in 0 .. 1");
  EXPECT_EQ(with("\"goal\": \"cycle\"", "\"goal\": \"energy\""),
            ": goal_parameters.dump_height_m: is not a key of this file");
  EXPECT_EQ(with("excavplan-path-library", "excavplan-soil"),
            ": format: is 'excavplan-soil', expected 'excavplan-path-library'");
  EXPECT_EQ(with("\"penetration_angle_rad\": 0.8", "\"penetration_angle_rad\": 8"),
            ": entries[0].path.penetration_angle_rad: is 8, must be in 0 .. 1.5707963267948966");
  EXPECT_EQ(with("\"density_percent\": 50.0", "\"density_percent\": 0.0"),
            ": entries: slopes, and densities of a slope, must rise, entry 2 does not");
  EXPECT_EQ(with("\"soil\"", "\"sole\""), ": soil: is missing");
  EXPECT_EQ(with("\"seed\": 7", "\"seed\": 7, \"colour\": 3"),
            ": colour: is not a key of this file");
  EXPECT_EQ(with("\"seed\": 7", "\"seed\": 7, \"seed\": 8"), ": key 'seed' appears twice");
  EXPECT_NE(error_in(good.substr(0, good.size() / 2)).find("not valid JSON"), std::string::npos);
  EXPECT_THROW(load_path_library("/nowhere/library.json"), Error);
}

TEST(PathLibrary, NamesThatAreNotUtf8AreNotWritten) {
  PathLibrary library = small_library();
  library.machine = "zx\xff";
  const std::string text = test::error_of([&] { to_json(library); });
  EXPECT_NE(text.find("not UTF-8"), std::string::npos) << text;
}

TEST(PathLibrary, EveryChangedByteIsNoticed) {
  const std::string good = to_json(small_library());
  for (std::size_t i = 0; i + 1 < good.size(); i += 7) {
    std::string text = good;
    text[i] = static_cast<char>(text[i] ^ 1);
    EXPECT_NE(error_in(text), "no error") << i;
  }
}

class LibraryBuilding : public testing::Test {
 protected:
  static LibraryBuildOptions quick() {
    LibraryBuildOptions options;
    options.search.objective = DigObjective::Goal::energy;
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

TEST_F(LibraryBuilding, TheSearchOfAnEntryDoesNotDependOnTheOthers) {
  const TemporaryFolder folder;
  LibraryBuildOptions options = quick();
  const auto entries_of = [&](const std::string& name, const std::vector<double>& densities) {
    options.folder = folder.file(name);
    build(grid(densities), options);
    std::map<std::string, std::string> files;
    for (const auto& file : fs::directory_iterator(options.folder)) {
      files[file.path().filename()] = content_of(file.path());
    }
    return files;
  };
  const auto all = entries_of("all", {10, 20, 35, 40});
  for (const double density : {10.0, 20.0, 35.0, 40.0}) {
    const auto alone = entries_of(number_text(density), {density});
    for (const auto& [name, text] : alone) EXPECT_EQ(all.at(name), text) << name;
  }
}

TEST_F(LibraryBuilding, ProgressCountsEveryDigOnce) {
  for (const unsigned threads : {1U, 3U}) {
    int told = 0;
    std::size_t done = 0;
    LibraryBuildOptions options = quick();
    options.threads = threads;
    options.progress = [&](const LibraryProgress& now) {
      EXPECT_GE(now.evaluations, told);
      EXPECT_LE(now.evaluations, told + 1);
      told = now.evaluations;
      done = now.entries_done;
      return true;
    };
    const LibraryBuild build = build_path_libraries(grid({0, 10, 50}), options);
    EXPECT_EQ(told, build.libraries[0].evaluations());
    EXPECT_EQ(done, 3U);
    EXPECT_EQ(build.entries, 3U);
  }
}

/// Answers of the search for the entry of 30 %.
class LibraryTasks : public LibraryBuilding {
 protected:
  LibraryAnswer answer(const LibraryTask& task) {
    return read_answer(job_, task.place, "task", do_task(job_, to_text(task), count_));
  }
  static double efficiency(const LibraryAnswer& answer) { return answer.dig.efficiency(); }
  const LibraryJob job_{grid({30}), quick().search};
  const LibraryPlace place_{0, 0, 0.0, 30.0};
  int told_ = 0;
  const std::function<bool(int, double)> count_ = [this](int digs, double) {
    told_ += digs;
    return true;
  };
};

TEST_F(LibraryTasks, WorseThanItsNeighboursLetExpectAnEntryIsSearchedFromNothingToo) {
  PlannedDig near{{0.8, 0.3, 1.5}, 6.0, 100.0, 0.3, 10e3, 4.0};
  const LibraryTask modest = first_search(job_, place_, {{40.0, near}, {50.0, near}});
  EXPECT_LE(answer(modest).evaluations, 8);
  near.payload_mass = 4e4;  // far better at 40 and 50 % than any dig can be
  told_ = 0;
  const LibraryAnswer bold = answer(first_search(job_, place_, {{40.0, near}, {50.0, near}}));
  EXPECT_GT(bold.evaluations, 8);
  EXPECT_EQ(told_, bold.evaluations);
}

TEST_F(LibraryTasks, ADigOfAnotherKindIsTakenOnlyWhereItIsClearlyBetter) {
  const LibraryAnswer own = answer({place_});
  LibraryTask other{place_};
  other.starts = {own.dig.parameters};
  other.known = 0.9 * efficiency(own);
  const LibraryAnswer better = answer(other);
  EXPECT_TRUE(better.feasible);
  EXPECT_GE(efficiency(better), efficiency(own));
  other.known = 1.1 * efficiency(own);
  const LibraryAnswer worse = answer(other);
  EXPECT_FALSE(worse.feasible);
  EXPECT_LE(worse.evaluations, 4) << "half the effort is enough to know";
}

TEST_F(LibraryTasks, ClearlyBetterIsMoreThanAFifthOfAPercent) {
  LibraryJob brief = job_;
  std::get<AnchoredSearch>(brief.search.method).inherited_evaluations = 2;  // half: the start alone
  LibraryTask other{place_};
  const LibraryAnswer own = answer(other);
  other.starts = {own.dig.parameters};
  for (const auto& [gain, is_taken] : {std::pair{0.0015, false}, {0.0025, true}}) {
    other.known = own.rank / (1.0 + gain);
    const std::string text = do_task(brief, to_text(other), {});
    EXPECT_EQ(read_answer(brief, place_, "task", text).feasible, is_taken) << gain;
  }
}

/// Every dig lifts the same mass at the same cost.
class EvenSimulator : public SoilSimulator {
 public:
  EvenSimulator(double mass, double volume) : mass_(mass), volume_(volume) {}
  DigResult dig(const Terrain&, const DigPath&, const DigOptions&) const override {
    DigResult result;
    result.payload_mass = mass_;
    result.payload_volume = volume_;
    result.energy.total = 1e6;
    return result;
  }

 private:
  double mass_;
  double volume_;
};

TEST_F(LibraryTasks, AFillOfExactlyTheLeastIsEnough) {
  const auto evaluations = [&](double fill) {
    LibraryJob job = job_;
    job.search.objective.min_fill = 0.5;
    const double volume = fill * heaped_capacity(machine_);
    job.search.simulator = {"even", "even 1", [volume](const Machine&, const SoilKind&, double) {
                              return std::make_unique<const EvenSimulator>(300.0, volume);
                            }};
    const LibraryAnswer found =
        read_answer(job, place_, "task", do_task(job, to_text({place_}), {}));
    EXPECT_EQ(found.dig.fill, fill);
    return found.evaluations;
  };
  const int once = evaluations(0.75);
  EXPECT_EQ(evaluations(0.5), once);
  EXPECT_GT(evaluations(0.5 - 1e-9), once) << "with too little it is searched once more";
}

TEST_F(LibraryTasks, DigsAreMeasuredAsTheyAre) {
  const PlannedDig own = answer({place_}).dig;
  PlannedDig nowhere = own;
  nowhere.parameters = {0.2, 0.9, 3.0};
  const LibraryAnswer measured = answer({place_, {own, nowhere}});
  EXPECT_EQ(measured.evaluations, 2);
  ASSERT_EQ(measured.measured.size(), 2U);
  EXPECT_DOUBLE_EQ(measured.measured[0], own.efficiency());
  EXPECT_EQ(measured.measured[1], 0.0);
}

TEST_F(LibraryTasks, AStoppedTaskHasNoAnswer) {
  EXPECT_EQ(do_task(job_, to_text({place_}), [](int, double) { return false; }), "");
}

TEST_F(LibraryTasks, AnAnswerForAnotherPlaceIsRefused) {
  const std::string text = do_task(job_, to_text({place_}), {});
  LibraryPlace other = place_;
  other.density_percent = 40.0;
  EXPECT_NE(test::error_of([&] { read_answer(job_, other, "f", text); }, ErrorKind::bad_file)
                .find("which is another entry than"),
            std::string::npos);
}

TEST_F(LibraryTasks, AnAnswerThatLacksAKeyIsRefused) {
  auto json = nlohmann::ordered_json::parse(do_task(job_, to_text({place_}), {}));
  json.erase("checksum");
  json["answer"].erase("feasible");
  EXPECT_EQ(test::error_of([&] { read_answer(job_, place_, "f", sealed_text(json)); },
                           ErrorKind::bad_file)
                .find("f: answer: "),
            0U);
}

TEST_F(LibraryBuilding, MorePointsThanCanBeCountedAreRefused) {
  LibraryBuildOptions options = quick();
  std::get<AnchoredSearch>(options.search.method).points = 300000000;
  EXPECT_EQ(test::error_of([&] { build_path_libraries(grid({20}), options); }),
            "points of a library search is 300000000, must be in 1 .. 1000000");
}

TEST_F(LibraryBuilding, AnotherSeedGivesAnotherLibrary) {
  LibraryBuildOptions options = quick();
  const std::string one = build(grid({20}), options);
  options.search.seed = 2;
  EXPECT_NE(build(grid({20}), options), one);
}

TEST_F(LibraryBuilding, GoesOnFromWhatIsDone) {
  const LibraryGrid cells = grid({20, 30, 40});
  const PathLibrary library = build_path_libraries(cells, quick()).libraries[0];
  const std::string whole = to_json(library);
  const int whole_evaluations = library.evaluations();
  const TemporaryFolder folder;
  LibraryBuildOptions options = quick();
  options.folder = folder.file("cells");
  for (const int limit : {1, 7, 30}) {
    options.progress = [&](const LibraryProgress& now) { return now.evaluations < limit; };
    const LibraryBuild part = build_path_libraries(cells, options);
    EXPECT_TRUE(part.stopped);
    EXPECT_TRUE(part.libraries.empty());
    EXPECT_LT(part.entries_done, part.entries);
  }
  options.progress = {};
  EXPECT_EQ(build(cells, options), whole);
  int digs = 0;
  options.progress = [&](const LibraryProgress& now) {
    digs = now.evaluations;
    return true;
  };
  EXPECT_EQ(build(cells, options), whole);
  EXPECT_LT(digs, whole_evaluations / 2) << "nothing but what comes after the entries";
}

TEST_F(LibraryBuilding, SeveralBuildsShareAFolder) {
  const LibraryGrid cells = grid({0, 10, 20, 35, 50, 60, 70, 85, 100}, {-0.1, 0.0, 0.1});
  const std::string whole = build(cells, quick());
  const TemporaryFolder folder;
  std::vector<std::string> results(3);
  std::vector<std::thread> builds;
  for (std::string& result : results) {
    builds.emplace_back([&] {
      LibraryBuildOptions options = quick();
      options.folder = folder.file("entries");
      result = build(cells, options);
    });
  }
  for (std::thread& one : builds) one.join();
  for (const std::string& result : results) EXPECT_EQ(result, whole);
}

TEST_F(LibraryBuilding, RemovesItsFilesAndNoOthers) {
  const TemporaryFolder folder;
  LibraryBuildOptions options = quick();
  options.folder = folder.file("entries");
  build(grid({0}), options);
  const std::string thesis = folder.write("entries/thesis.json", "years of work");
  const std::string copy = folder.write("entries/a.entry.json.old", "a copy");
  const std::string part = folder.write("entries/a.entry.json.part-host-1-2", "half");
  remove_library_entries(options.folder);
  EXPECT_EQ(content_of(thesis), "years of work");
  EXPECT_EQ(content_of(copy), "a copy");
  EXPECT_FALSE(fs::exists(part));
  fs::remove(thesis);
  fs::remove(copy);
  EXPECT_TRUE(fs::is_empty(options.folder));
  remove_library_entries(options.folder);
  EXPECT_FALSE(fs::exists(options.folder));
}

TEST_F(LibraryBuilding, DamagedEntriesAreNamedAndComputedAnew) {
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
    EXPECT_NE(note.find("it is computed again"), std::string::npos) << note;
  }
}

TEST_F(LibraryBuilding, AnEntryThatIsAPipeIsRefusedInsteadOfWaitedFor) {
  const LibraryGrid cells = grid({0});
  const TemporaryFolder folder;
  LibraryBuildOptions options = quick();
  options.folder = folder.file("cells");
  build(cells, options);
  const std::string entry = fs::directory_iterator(options.folder)->path();
  fs::remove(entry);
  ASSERT_EQ(::mkfifo(entry.c_str(), 0600), 0);
  EXPECT_EQ(test::error_about([&] { build(cells, options); }, entry), "is not a regular file");
}

TEST_F(LibraryBuilding, AWorkerRefusesWhatIsNoTaskOfItsGrid) {
  const LibraryWorker worker = library_worker(grid({0}), quick().search);
  const auto refusal = [&](const std::string& task) {
    return test::error_of([&] { worker(task); });
  };
  for (const std::string text : {"{", "{}"}) {
    EXPECT_EQ(refusal(text), "library worker: '" + text + "' is no task of a build");
  }
  EXPECT_EQ(refusal(R"({"place": {"machine": 1, "soil": 0, "slope": 0, "density_percent": 0},
                        "digs": [], "starts": [], "expected": 0, "known": 0})"),
            "library worker: the task is one of another grid");
}

TEST_F(LibraryBuilding, EntriesOfAnotherSearchAreNotTaken) {
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

TEST_F(LibraryBuilding, TakesTheNeighboursKindOfDigWhereItIsBetter) {
  LibraryGrid cells = grid({20, 30, 40, 50, 60, 70, 80});
  cells.soils = {load_soil(find_data_file("soils/gravel.json"))};  // two kinds of digs compete
  LibraryBuildOptions options = quick();
  const TemporaryFolder folder;
  options.folder = folder.file("entries");
  const PathLibrary library = build_path_libraries(cells, options).libraries[0];
  int better = 0;
  for (const auto& file : fs::directory_iterator(options.folder)) {
    const auto entry_file = nlohmann::json::parse(content_of(file.path()));
    for (const PathLibraryEntry& entry : library.entries) {
      const std::string place = "density " + number_text(entry.density_percent) + " %";
      if (entry_file["identity"].get<std::string>().find(place) == std::string::npos) continue;
      const auto& dig = entry_file["answer"]["dig"];
      const double own = dig["payload_mass"].get<double>() / dig["energy"].get<double>();
      EXPECT_GE(entry.dig.efficiency(), own * (1.0 - 1e-12));
      better += entry.dig.efficiency() > 1.001 * own ? 1 : 0;
    }
  }
  EXPECT_GT(better, 0);
  options.folder.clear();
  options.threads = 3;
  EXPECT_EQ(build(cells, options), to_json(library));
}

// In dense soil on rising ground a search may end at a dig that lifts nearly nothing.
TEST_F(LibraryBuilding, TakesTheKindOfDigOfTheNextSlopeWhereItIsBetter) {
  LibraryBuildOptions options;
  options.search.objective = DigObjective::Goal::energy;
  AnchoredSearch method;
  method.inherited_evaluations = 80;
  options.search.method = method;
  const std::vector<double> slopes = {0.043633231299858244,
                                      0.08726646259971649};  // 2.5 and 5 degrees
  const PathLibrary library = build_path_libraries(grid({95}, slopes), options).libraries[0];
  ASSERT_EQ(library.entries.size(), 2U);
  const HeightMapSimulator simulator(machine_, soil_, 95.0);
  const Terrain ground = sloped_planning_ground(machine_, slopes[1], library.cell_size);
  const PlannedDig& other = library.entries[0].dig;
  const auto dug = evaluate_dig(machine_, simulator, ground, other.parameters, other.start_x);
  EXPECT_GT(library.entries[1].dig.efficiency(), 0.9 * std::get<PlannedDig>(dug).efficiency());
}

TEST(PathLibrary, TakesTheDigOfOneEntryWhereTheOthersStall) {
  PathLibrary library = sloped_library();
  library.entries[0].to_next_density.between = Between::upper;
  EXPECT_DOUBLE_EQ(look_up(library, 0.0).payload_mass, 400.0);
  EXPECT_DOUBLE_EQ(look_up(library, 10.0).payload_mass, 500.0);
  EXPECT_DOUBLE_EQ(look_up(library, 50.0).payload_mass, 500.0);
  // Measured midway, 0.01; largest where the dig is farthest from its entry.
  EXPECT_DOUBLE_EQ(look_up_error(library, 10.0).loss, 0.016);
  EXPECT_DOUBLE_EQ(look_up_error(library, 25.0).loss, 0.01);
  EXPECT_DOUBLE_EQ(look_up_error(library, 50.0).loss, 0.0);
  library.entries[0].to_next_density.between = Between::lower;
  EXPECT_DOUBLE_EQ(look_up_error(library, 40.0).loss, 0.016);
  EXPECT_DOUBLE_EQ(look_up(library, 40.0).payload_mass, 400.0);
  EXPECT_DOUBLE_EQ(look_up(library, 50.0).payload_mass, 500.0);
}

/// Digs all three by itself.
TEST_F(LibraryBuilding, LooksUpWhatIsBestMidway) {
  int mixes = 0;
  int others = 0;
  LibraryBuildOptions usual;
  usual.search.objective = DigObjective::Goal::energy;
  for (const auto& [name, options] :
       {std::pair("gravel", quick()), {"gravel", usual}, {"clay", quick()}, {"loam", quick()}}) {
    LibraryGrid cells = grid({0, 10, 20, 25, 30, 40, 50, 60, 70, 80, 85, 90});
    cells.soils = {load_soil(find_data_file(std::string("soils/") + name + ".json"))};
    const PathLibrary library = build_path_libraries(cells, options).libraries[0];
    for (std::size_t i = 0; i + 1 < library.entries.size(); ++i) {
      const PathLibraryEntry& entry = library.entries[i];
      const PlannedDig& below = entry.dig;
      const PlannedDig& above = library.entries[i + 1].dig;
      const double middle = 0.5 * (entry.density_percent + library.entries[i + 1].density_percent);
      const auto efficiency = [&](const PlannedDig& dig) {
        const auto outcome = evaluate_dig(
            machine_, *default_simulator().make(machine_, cells.soils[0], middle),
            level_planning_ground(machine_, library.cell_size), dig.parameters, dig.start_x);
        const auto* dug = std::get_if<PlannedDig>(&outcome);
        return dug ? dug->efficiency() : 0.0;
      };
      const double lower = efficiency(below);
      const double upper = efficiency(above);
      const double worths[] = {efficiency(dig_between(below, above, 0.5)), std::min(lower, upper),
                               lower, upper};
      const double best = *std::max_element(std::begin(worths), std::end(worths));
      const Between between = entry.to_next_density.between;
      EXPECT_GE(worths[static_cast<std::size_t>(between)], 0.94 * best) << name << middle;
      EXPECT_TRUE(between != Between::nearest || far_apart(below, above)) << name << middle;
      ++(between == Between::mix ? mixes : others);
    }
  }
  EXPECT_GT(others, 0);
  EXPECT_GT(mixes, 0);
}

/// In dense gravel most mass per energy is in a bucket that is nearly empty, of which a plan says
/// that it is not worth making.
TEST_F(LibraryBuilding, DigsAreWorthMakingWhereTheGoalAsksForNoFill) {
  LibraryBuildOptions options;
  options.search.objective = DigObjective::Goal::energy;
  LibraryGrid cells = grid({95, 100});
  cells.soils = {load_soil(find_data_file("soils/gravel.json"))};
  const PathLibrary library = build_path_libraries(cells, options).libraries[0];
  EXPECT_EQ(library.objective.min_fill, 0.0);
  ASSERT_EQ(library.entries.size(), 2U);
  for (const PathLibraryEntry& entry : library.entries) {
    EXPECT_GE(entry.dig.fill, worth_making) << entry.density_percent;
  }
}

TEST_F(LibraryBuilding, MeasuresWhatIsLostMidwayBetweenSlopes) {
  const PathLibrary library =
      build_path_libraries(grid({20, 40}, {-0.1, 0.0, 0.1}), quick()).libraries[0];
  int dug_midway = 0;
  for (const PathLibraryEntry& entry : library.entries) {
    if (entry.to_next_slope.between == Between::nearest) continue;  // both count, one is looked up
    if (entry.slope == 0.1) {
      EXPECT_EQ(entry.to_next_slope.midway.loss, 0.0);
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
      EXPECT_NEAR(entry.to_next_slope.midway.expectation,
                  looked_up.efficiency() / dig->efficiency() - 1.0, 1e-9);
    }
    EXPECT_EQ(look_up_error(library, entry.density_percent, slope).loss,
              entry.to_next_slope.midway.loss);
    EXPECT_LT(entry.to_next_slope.midway.loss, 0.5);
  }
  EXPECT_GT(dug_midway, 0);
}

// The polynomial through n points is exact for one of degree n - 1. Where the logarithm of what
// every dig is worth is one of the density, the best worth midway is known and nothing is lost.
TEST_F(LibraryBuilding, TheBestMidwayIsExpectedFromUpToFourEntriesAround) {
  const auto loss = [&](const std::vector<double>& densities, int degree, double bend,
                        std::size_t entry) {
    const double middle = 0.5 * (densities.front() + densities.back());
    LibraryBuildOptions options = quick();
    options.search.simulator = {
        "even", "even 1", [=](const Machine&, const SoilKind&, double density) {
          const double mass = 200.0 * std::exp(bend * std::pow((density - middle) / 50.0, degree));
          return std::make_unique<const EvenSimulator>(mass, 0.4);
        }};
    const auto built = build_path_libraries(grid(densities), options).libraries;
    return built[0].entries[entry].to_next_density.midway.loss;
  };
  for (const double bend : {-1.0, 1.0}) {
    EXPECT_NEAR(loss({20, 30, 40}, 2, bend, 0), 0.0, 1e-12) << bend;
    EXPECT_NEAR(loss({20, 30, 40}, 2, bend, 1), 0.0, 1e-12) << bend;
    EXPECT_NEAR(loss({20, 30, 40, 50}, 3, bend, 1), 0.0, 1e-12) << bend;
  }
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
  const DigObjective energy;
  EXPECT_NO_THROW(require_fit(library, machine_, soil_, energy));
  const auto refusal = [&](const PathLibrary& other, const Machine& machine, const SoilKind& soil) {
    return test::error_of([&] { require_fit(other, machine, soil, energy); });
  };
  SoilKind wet = soil_;
  wet.water_content += 0.01;
  EXPECT_EQ(
      refusal(library, machine_, wet),
      "the library: does not fit; the numbers of soil loam have changed since it was computed; "
      "build-path-library makes one that does, a search needs none");
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

TEST_F(LibraryBuilding, ALibraryIsRefusedForAnotherGoalAndForAnotherCycle) {
  LibraryBuildOptions options = quick();
  options.search.objective = DigObjective::Goal::cycle;
  PathLibrary library = build_path_libraries(grid({20}), options).libraries[0];
  library.file = "l.json";
  const auto refusal = [&](const DigObjective& objective) {
    return test::error_of([&] { require_fit(library, machine_, soil_, objective); });
  };
  EXPECT_EQ(refusal(DigObjective::Goal::cycle), "no error");
  EXPECT_EQ(
      refusal(DigObjective::Goal::energy),
      "l.json: does not fit; its goal is " + describe(options.search.objective) +
          ", not energy, min_fill 0; build-path-library makes one that does, a search needs none");
  DigObjective other = DigObjective::Goal::cycle;
  other.dump_height = 2.5;
  EXPECT_NE(refusal(other).find("dump_height_m 3"), std::string::npos);
  other = DigObjective::Goal::cycle;
  other.min_fill = 0.5;
  EXPECT_NE(refusal(other).find("not cycle, min_fill 0.5"), std::string::npos);
}

TEST_F(LibraryBuilding, EntriesAreBestForTheGoal) {
  LibraryBuildOptions options = quick();
  const PathLibraryEntry energy = build_path_libraries(grid({0}), options).libraries[0].entries[0];
  options.search.objective = DigObjective::Goal::cycle;
  const PathLibraryEntry cycle = build_path_libraries(grid({0}), options).libraries[0].entries[0];
  EXPECT_GT(cycle.dig.payload_mass / cycle.dig.cycle_energy,
            energy.dig.payload_mass / energy.dig.cycle_energy);
  EXPECT_GE(cycle.dig.fill, 0.8);
}

TEST_F(LibraryBuilding, AMachineWithoutTheDataOfTheCycleIsRefusedForItsGoals) {
  LibraryGrid cells = grid({20});
  cells.machines[0].engine.reset();
  EXPECT_NO_THROW(require_buildable(cells, quick().search));
  EXPECT_NE(test::error_of([&] { require_buildable(cells, {}); }).find("its file lacks engine"),
            std::string::npos);
}

TEST_F(LibraryBuilding, NamesThatNoFileCouldHoldAreRefusedBeforeTheSearch) {
  const std::string rule = ", expected a text on one line without control characters";
  for (const auto& [name, fault] : std::vector<std::pair<std::string, std::string>>{
           {"lo\nam", "'lo?am'" + rule},
           {"\x1b[31mloam", "'?[31mloam'" + rule},
           {std::string("lo\0am", 5), "'lo?am'" + rule},
           {"loam\xe2\x80\xae", "'loam?'" + rule},
           {"lo\xff", "not UTF-8"},
           {std::string(1001, 'x'), "a text of 1001 bytes, expected at most 1000"}}) {
    const auto refusal = [](const LibraryGrid& cells, LibraryBuildOptions options) {
      options.progress = [](const LibraryProgress&) { return false; };
      return test::error_of([&] { build_path_libraries(cells, options); });
    };
    LibraryGrid of_machine = grid({20}), of_soil = grid({20});
    of_machine.machines[0].name = of_soil.soils[0].name = name;
    LibraryBuildOptions of_simulator = quick();
    of_simulator.search.simulator.name = name;
    EXPECT_EQ(refusal(of_machine, quick()), "library: the name of a machine is " + fault);
    EXPECT_EQ(refusal(of_soil, quick()), "library: the name of a soil is " + fault);
    EXPECT_EQ(refusal(grid({20}), of_simulator), "library: the name of a simulator is " + fault);
  }
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
}

TEST_F(LibraryBuilding, AnySimulatorCanBeSearchedWith) {
  LibraryBuildOptions options = quick();
  options.search.simulator = simulator_of_word("section");
  const PathLibrary library = build_path_libraries(grid({20}), options).libraries[0];
  EXPECT_EQ(library.simulator, options.search.simulator.name);
  EXPECT_NE(to_json(library), build(grid({20}), quick()));
  EXPECT_NO_THROW(require_fit(library, machine_, soil_, {}, options.search.simulator.name));
  EXPECT_NE(test::error_of([&] {
              require_fit(library, machine_, soil_, {});
            }).find("its simulator is " + options.search.simulator.name),
            std::string::npos);
}

using SoilAndGoal = std::tuple<const char*, DigObjective::Goal>;

class ShippedLibrary : public testing::TestWithParam<SoilAndGoal> {
 protected:
  HeightMapSimulator simulator(double density) const { return {machine_, soil_, density}; }

  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const std::string name_ = std::get<0>(GetParam());
  const DigObjective objective_ = std::get<1>(GetParam());
  const SoilKind soil_ = load_soil(find_data_file("soils/" + name_ + ".json"));
  const PathLibrary library_ = load_path_library(
      find_data_file("libraries/zx120-" + name_ + "-" + info_of(objective_.goal).word + ".json"));
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
  EXPECT_NO_THROW(require_fit(library_, machine_, soil_, objective_));
  const std::size_t cells = library_.entries.size() + library_.gaps.size();
  EXPECT_EQ(cells, 13U * 21U);
  for (std::size_t i = 0; i < library_.entries.size(); i += 5) {
    const PathLibraryEntry& entry = library_.entries[i];
    const auto outcome = evaluate_dig(machine_, simulator(entry.density_percent),
                                      ground(entry.slope), entry.dig.parameters, entry.dig.start_x);
    const PlannedDig& dig = std::get<PlannedDig>(outcome);
    EXPECT_NEAR(dig.energy, entry.dig.energy, 1e-6 * dig.energy) << entry.density_percent;
    EXPECT_NEAR(dig.payload_mass, entry.dig.payload_mass, 1e-6 * dig.payload_mass);
    EXPECT_NEAR(dig.cycle_energy, entry.dig.cycle_energy, 1e-6 * dig.cycle_energy);
    EXPECT_NEAR(dig.fill, entry.dig.fill, 1e-6);
  }
}

TEST_P(ShippedLibrary, LiftsMoreThanTheFixedPathOnLevelGround) {
  const std::vector<PathLibraryEntry> level = level_entries();
  ASSERT_EQ(level.size(), 21U);
  int evaluations = 0;
  int lossy = 0;
  double last = 1e9;
  for (const PathLibraryEntry& entry : level) {
    const double rank = objective_.rank(entry.dig);
    const auto fixed =
        evaluate_dig(machine_, simulator(entry.density_percent), ground(0.0), paper_fixed_path());
    if (const auto* possible = std::get_if<PlannedDig>(&fixed)) {
      EXPECT_GT(rank, objective_.rank(*possible));
    }
    EXPECT_LT(objective_.worth(entry.dig), last);
    if (entry.to_next_density.midway.loss > 0.03) ++lossy;
    last = objective_.worth(entry.dig);
    evaluations += entry.evaluations;
  }
  const int between_slopes = 6;
  EXPECT_LE(evaluations, (290 + between_slopes) * 21);
  EXPECT_LE(lossy, 4);
}

/// What is looked up between slopes gives little away at most places.
TEST_P(ShippedLibrary, LosesLittleBetweenItsSlopes) {
  std::vector<double> losses;
  for (const PathLibraryEntry& entry : library_.entries) {
    losses.push_back(entry.to_next_slope.midway.loss);
  }
  const auto most = losses.begin() + static_cast<std::ptrdiff_t>(losses.size() * 9 / 10);
  std::nth_element(losses.begin(), most, losses.end());
  EXPECT_LT(*most, 0.06);
}

/// A long search from nothing is the yardstick.
TEST_P(ShippedLibrary, HoldsNearlyTheBestDigs) {
  const DigObjective least = objective_.worthwhile();
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
    options.objective = least;
    options.stop.evaluations = 400;
    const auto best =
        search_dig(machine_, simulator(entry.density_percent), ground(entry.slope), options);
    ASSERT_TRUE(best);
    // Near the limits of the machine, with less than the least fill, there is little choice.
    if (entry.dig.fill < least.min_fill) {
      EXPECT_GE(entry.dig.fill, 0.95 * best->dig.fill) << entry.density_percent;
    } else {
      const double share = entry.density_percent > 60.0 ? 0.9 : 0.95;  // near the limits
      EXPECT_GE(least.rank(entry.dig), share * least.rank(best->dig)) << entry.density_percent;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Soils, ShippedLibrary,
                         testing::Combine(testing::Values("loam", "sand", "clay", "gravel"),
                                          testing::Values(DigObjective::Goal::cycle,
                                                          DigObjective::Goal::energy)));

TEST_F(LibraryBuilding, SameBytesWithWorkersElsewhere) {
  const LibraryGrid cells = grid({10, 20, 35, 70});
  const std::string whole = build(cells, quick());
  for (const std::size_t others : {1U, 3U}) {
    LibraryBuildOptions options = quick();
    std::atomic<int> tasks{0};
    const LibraryWorker worker = library_worker(cells, options.search);
    options.other_workers.assign(others, [&](const std::string& task) {
      ++tasks;
      return worker(task);
    });
    EXPECT_EQ(build(cells, options), whole);
    EXPECT_GT(tasks, 0);
  }
}

TEST_F(LibraryBuilding, AnErrorOfAWorkerEndsTheBuild) {
  LibraryBuildOptions options = quick();
  options.other_workers = {[](const std::string&) -> std::string {
    throw Error(ErrorKind::bad_input, "rank 1: no memory");
  }};
  EXPECT_EQ(test::error_of([&] {
              build_path_libraries(grid({0, 50, 100}), options);
            }),
            "rank 1: no memory");
}

TEST_F(LibraryBuilding, AnAnswerForOtherNumbersIsRefused) {
  LibraryBuildOptions options = quick();
  LibraryGrid other = grid({0, 50, 100});
  other.soils[0].water_content += 0.01;
  options.other_workers = {library_worker(other, options.search)};
  EXPECT_NE(test::error_of(
                [&] {
                  build_path_libraries(grid({0, 50, 100}), options);
                },
                ErrorKind::bad_file)
                .find("which is another entry than"),
            std::string::npos);
}

}  // namespace
}  // namespace excavplan
