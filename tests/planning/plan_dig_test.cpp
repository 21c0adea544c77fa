// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/plan_dig.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "planning/dig_layout.hpp"
#include "planning/start_rule.hpp"
#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

/// A controller's own simulator: lifts 100 kg, at least cost with a drag of 1.2 m.
class OwnSimulator : public SoilSimulator {
 public:
  DigResult dig(const Terrain&, const DigPath& path, const DigOptions&) const override {
    DigResult result;
    result.payload_mass = 100.0;
    result.payload_volume = 0.4;
    result.energy.total = 1000.0 + 1e4 * std::pow(path.parameters.drag_length - 1.2, 2);
    return result;
  }
};

SimulatorKind own_simulator() {
  return {"own", "own 1", [](const Machine&, const SoilKind&, double) {
            return std::make_unique<const OwnSimulator>();
          }};
}

/// The same, and keeps the paths that it digs.
SimulatorKind recording_simulator(std::vector<DigPath>& dug) {
  class Recorder : public OwnSimulator {
   public:
    explicit Recorder(std::vector<DigPath>& dug) : dug_(dug) {}
    DigResult dig(const Terrain& ground, const DigPath& path,
                  const DigOptions& options) const override {
      dug_.push_back(path);
      return OwnSimulator::dig(ground, path, options);
    }

   private:
    std::vector<DigPath>& dug_;
  };
  return {"own", "own 1", [&dug](const Machine&, const SoilKind&, double) {
            return std::make_unique<const Recorder>(dug);
          }};
}

class PlanDig : public testing::Test {
 protected:
  static PlanOptions searched(int evaluations, unsigned threads = 0) {
    PlanOptions options;
    options.method = PlanMethod::search;
    options.search.stop.evaluations = evaluations;
    options.search.threads = threads;
    return options;
  }
  DigPlan plan(const GroundDensity& density, const PlanOptions& options = {}) const {
    return plan_dig(machine_, loam_, density, options);
  }
  Terrain rising(double rise) const {
    Terrain ground = level_planning_ground(machine_);
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      ground.bank.z.col(col) += rise * (ground.bank.x(col) - machine_.track_front);
    }
    return ground;
  }
  /// The same dig at another density.
  PlannedDig dug(const PlannedDig& dig, double density) const {
    return std::get<PlannedDig>(
        evaluate_dig(machine_, *default_simulator().make(machine_, loam_, density),
                     level_planning_ground(machine_), dig.parameters, dig.start_x));
  }
  static bool warns(const DigPlan& plan, const std::string& code) {
    return std::any_of(plan.warnings.begin(), plan.warnings.end(),
                       [&](const Warning& warning) { return code_text(warning.code) == code; });
  }
  /// All that a controller executes, to the last bit.
  static std::string bytes(const DigPlan& plan) {
    return to_json(plan.trajectory) + std::to_string(plan.evaluations) +
           std::to_string(plan.search->worth);
  }

  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam_ = load_soil(find_data_file("soils/loam.json"));
};

// ---- What is refused --------------------------------------------------------------------------

TEST_F(PlanDig, DensitiesThatAreNoneAreRefused) {
  for (const double percent : {-1.0, 101.0, std::nan("")}) {
    EXPECT_EQ(test::error_of([&] { plan(percent); }).find("the density is "), 0U) << percent;
  }
  EXPECT_EQ(test::error_of([&] {
              plan({40.0, -1.0});
            }),
            "the standard deviation of the density is -1, must be at least 0 and finite");
}

TEST_F(PlanDig, ASearchRefusesALibraryThatLacksItsDensity) {
  auto library = std::make_shared<PathLibrary>(shipped_library(machine_, loam_));
  auto& entries = library->entries;
  entries.erase(std::remove_if(entries.begin(), entries.end(),
                               [](const auto& entry) { return entry.density_percent > 30.0; }),
                entries.end());
  PlanOptions options = searched(10);
  options.library = library;
  EXPECT_NE(test::error_of([&] { plan(80.0, options); }).find("80 is outside its range"),
            std::string::npos);
  entries.clear();
  EXPECT_NE(test::error_of([&] {
              plan_dig(machine_, loam_, 40.0, rising(0.1), options);
            }).find("holds no entry"),
            std::string::npos);
}

TEST_F(PlanDig, ACheckpointOfAnotherSearchIsRefusedBeforeAnyDigOfTheSearch) {
  constexpr std::size_t most_probes = 10;  // that tell simulators apart
  const test::TemporaryFolder folder;
  for (const double sd : {0.0, 8.0}) {
    std::vector<DigPath> dug;
    PlanOptions options = searched(60, 1);
    options.simulator = recording_simulator(dug);
    options.search.checkpoint = folder.file("search.json");
    const GroundDensity density(40.0, sd);
    plan_dig(machine_, loam_, density, rising(0.1), options);
    EXPECT_GT(dug.size(), 3 * most_probes);
    dug.clear();
    options.search.resume = true;
    ++options.search.seed;
    const auto resumed = [&] { plan_dig(machine_, loam_, density, rising(0.1), options); };
    EXPECT_NE(test::error_of(resumed, ErrorKind::bad_file).find("which differs from"),
              std::string::npos);
    EXPECT_LT(dug.size(), most_probes) << sd;
  }
}

// ---- Looking up -------------------------------------------------------------------------------

TEST_F(PlanDig, LooksUpOnLevelGroundWithoutADig) {
  const DigPlan found = plan(40.0);
  ASSERT_TRUE(found.dig);
  const PlannedDig entry = look_up(shipped_library(machine_, loam_), 40.0);
  EXPECT_EQ(found.dig->start_x, entry.start_x);
  EXPECT_EQ(found.dig->energy, entry.energy);
  EXPECT_EQ(found.method, PlanMethod::library);
  EXPECT_EQ(found.start_rule, "of the library");
  EXPECT_EQ(found.evaluations, 0);
  EXPECT_EQ(found.look_up->error->loss, 0.0);
  EXPECT_FALSE(found.search);
  EXPECT_TRUE(found.trustworthy && found.warnings.empty() && found.reason.empty());
}

TEST_F(PlanDig, GivesThePathAndATrajectoryFromAboveTheGround) {
  const DigPlan found = plan(40.0);
  EXPECT_EQ(found.path.start_x, found.dig->start_x);
  EXPECT_FALSE(found.path.approach.empty());
  EXPECT_EQ(found.trajectory.points.front().phase, DigPhase::approach);
  EXPECT_EQ(found.trajectory.points.back().phase, DigPhase::lift);
  EXPECT_NEAR(found.trajectory.dig_duration(), found.dig->duration, 0.2);
  PlanOptions slow;
  slow.trajectory.speed_fraction = 0.4;
  EXPECT_GT(plan(40.0, slow).trajectory.duration(), 1.5 * found.trajectory.duration());
}

TEST_F(PlanDig, TheGroundAfterItIsKnownWhereTheDigChangedIt) {
  const DigPlan found = plan(40.0);
  const auto simulator = default_simulator().make(machine_, loam_, 40.0);
  const Terrain level = level_planning_ground(machine_);
  const HeightMap after = simulator->dig(level, found.path).after(level).surface();
  const Eigen::ArrayXXd& z = found.ground_after.z;
  EXPECT_TRUE((z.isFinite() == (after.z != 0.0)).all());
  EXPECT_TRUE((z.isNaN() || z == after.z).all());
  EXPECT_LT(z.isNaN().select(0.0, z).minCoeff(), -0.2);
  EXPECT_LT(z.isFinite().count(), z.size() / 2);
}

TEST_F(PlanDig, DigsTheLibrarysPathOnGivenGround) {
  const Terrain gentle = rising(0.02);
  PlanOptions options;
  options.search.start_rule = StartRule::Kind::least_work;
  const DigPlan found = plan_dig(machine_, loam_, 40.0, gentle, options);
  EXPECT_EQ(found.evaluations, 1);
  EXPECT_EQ(found.start_rule, "least work of the links' own weight");
  EXPECT_NEAR(found.look_up->slope, std::atan(0.02), 1e-6);
  EXPECT_TRUE(found.look_up->error && found.trustworthy);
  const auto same = evaluate_dig(machine_, *default_simulator().make(machine_, loam_, 40.0), gentle,
                                 found.dig->parameters, StartRule::Kind::least_work);
  EXPECT_EQ(found.dig->energy, std::get<PlannedDig>(same).energy);
  const DigPlan anywhere = plan_dig(machine_, loam_, 40.0, gentle);
  EXPECT_EQ(anywhere.start_rule, "searched with the path");
  EXPECT_GT(anywhere.evaluations, 5);
  const DigObjective& goal = options.search.objective;
  EXPECT_GE(goal.rank(*anywhere.dig), goal.rank(*found.dig));
}

TEST_F(PlanDig, LooksUpTheSlopeWhereItDigsOnGroundThatBends) {
  struct Bend {
    double x;  // where level ground begins to rise [m]
    double degrees;
    double density;
  };
  for (const Bend& bend : {Bend{4.0, 14.0, 70.0}, Bend{4.0, 20.0, 75.0}, Bend{4.5, 14.0, 60.0},
                           Bend{5.0, 20.0, 60.0}}) {
    SCOPED_TRACE(std::to_string(bend.x) + " m, " + std::to_string(bend.degrees));
    Terrain ground = level_planning_ground(machine_);
    const double rise = std::tan(bend.degrees * std::acos(-1.0) / 180.0);
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      ground.bank.z.col(col) += rise * std::max(0.0, ground.bank.x(col) - bend.x);
    }
    const DigPlan found = plan_dig(machine_, loam_, bend.density, ground);
    ASSERT_TRUE(found.dig) << found.reason;
    const double mean = boom_plane_slope(ground, machine_.track_front);
    EXPECT_GT(std::abs(found.look_up->slope - mean), 0.01);
  }
}

TEST_F(PlanDig, DistrustsGroundThatTheLibraryDoesNotCover) {
  PathLibrary narrow = shipped_library(machine_, loam_);
  const auto steep = [](const PathLibraryEntry& entry) { return std::abs(entry.slope) > 0.06; };
  narrow.entries.erase(std::remove_if(narrow.entries.begin(), narrow.entries.end(), steep),
                       narrow.entries.end());
  PlanOptions options;
  options.library = std::make_shared<PathLibrary>(narrow);
  const DigPlan found = plan_dig(machine_, loam_, 40.0, rising(0.2), options);
  ASSERT_TRUE(found.dig);
  EXPECT_TRUE(warns(found, "slope_outside_library"));
  EXPECT_FALSE(found.trustworthy || found.look_up->error);
}

TEST_F(PlanDig, DistrustsGroundAboveOrBelowTheTracks) {
  for (const double height : {-1.5, -0.5, -0.1, 0.0, 0.1, 0.4, 1.4}) {
    Terrain ground = level_planning_ground(machine_);
    ground.bank.z += height;
    const DigPlan found = plan_dig(machine_, loam_, 40.0, ground);
    EXPECT_EQ(warns(found, "ground_above_tracks"), height > 0.2) << height;
    EXPECT_EQ(warns(found, "ground_below_tracks"), height < -0.2) << height;
    EXPECT_EQ(found.trustworthy, std::abs(height) < 0.2) << height;
  }
}

TEST_F(PlanDig, ADensityThatTheLibraryLacksIsAReasonNotAnError) {
  PathLibrary part = shipped_library(machine_, loam_);
  const auto soft = [](const PathLibraryEntry& entry) { return entry.density_percent < 50.0; };
  part.entries.erase(std::remove_if(part.entries.begin(), part.entries.end(), soft),
                     part.entries.end());
  PlanOptions options;
  options.library = std::make_shared<PathLibrary>(part);
  const DigPlan none = plan(40.0, options);
  EXPECT_FALSE(none.dig || none.stopped);
  EXPECT_NE(none.reason.find("density"), std::string::npos) << none.reason;
}

TEST_F(PlanDig, APathThatDoesNotWorkHereIsAReason) {
  Terrain unknown = level_planning_ground(machine_);
  unknown.bank.z.rightCols(unknown.bank.z.cols() * 9 / 10).setConstant(std::nan(""));
  const DigPlan none = plan_dig(machine_, loam_, 40.0, unknown);
  EXPECT_FALSE(none.dig);
  EXPECT_EQ(none.reason.rfind("the library's path does not work here", 0), 0U) << none.reason;
}

TEST_F(PlanDig, RefusesWhatTheCallerCouldHavePrevented) {
  EXPECT_EQ(test::error_of([&] { plan(140.0); }), "the density is 140, must be in 0 .. 100 %");
  EXPECT_THROW(plan(std::nan("")), Error);
  EXPECT_THROW(plan(GroundDensity(40.0, -1.0)), Error);
  PlanOptions sand;
  sand.library = std::make_shared<PathLibrary>(
      shipped_library(machine_, load_soil(find_data_file("soils/sand.json"))));
  EXPECT_NE(test::error_of([&] { plan(40.0, sand); }).find("its soil is sand, not loam"),
            std::string::npos);
  SoilKind peat = loam_;
  peat.name = "peat";
  EXPECT_NE(test::error_of([&] { shipped_library(machine_, peat); }).find("no library of zx120 in"),
            std::string::npos);
}

TEST_F(PlanDig, NoNameLeadsToAnotherFileThanAShippedLibrary) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.file("data/libraries"));
  folder.write("evil-loam-energy.json", "");
  Machine machine = machine_;
  for (const std::string& name : {std::string("../../evil"), std::string(), std::string(".."),
                                  std::string("/x"), std::string(1000000, 'x')}) {
    machine.name = name;
    EXPECT_EQ(test::error_of([&] {
                shipped_library(machine, loam_, {}, folder.file("data"));
              }).rfind("no library of ", 0),
              0U)
        << name.substr(0, 20);
  }
}

// ---- Searching --------------------------------------------------------------------------------

TEST_F(PlanDig, SearchBeginsWithTheLibrarysDig) {
  const DigPlan first = plan(60.0, searched(1));
  const PlannedDig known = look_up(shipped_library(machine_, loam_), 60.0);
  EXPECT_EQ(first.dig->parameters.drag_length, known.parameters.drag_length);
  PlanOptions for_time = searched(1);
  for_time.search.objective = DigObjective::Goal::time;  // no library is shipped
  EXPECT_FALSE(plan(60.0, for_time).dig) << "the first dig of its own lifts the machine";
  PlanOptions own = searched(1);
  own.search.start = {paper_fixed_path()};
  EXPECT_EQ(plan(60.0, own).dig->parameters.drag_length, paper_fixed_path().drag_length);
}

/// The paper, section 2.3.3: "these parameters are assigned random values within specified ranges".
TEST_F(PlanDig, ThePapersAlgorithmBeginsAtRandomUnlessALibraryIsGiven) {
  const auto library = std::make_shared<PathLibrary>(shipped_library(machine_, loam_));
  const Eigen::VectorXd known = to_vector(look_up(*library, 60.0).parameters);
  const auto digs_known = [&](const PlanOptions& options) {
    std::vector<DigPath> dug;
    PlanOptions recorded = options;
    recorded.simulator = recording_simulator(dug);
    plan(60.0, recorded);
    return std::any_of(dug.begin(), dug.end() - 1,
                       [&](const DigPath& path) { return to_vector(path.parameters) == known; });
  };
  PlanOptions options = searched(0, 1);
  GeneticAlgorithm small;
  small.population = 20;
  small.generations = 2;
  options.search.method = small;
  EXPECT_FALSE(digs_known(options));
  options.library = library;
  EXPECT_TRUE(digs_known(options));
}

TEST_F(PlanDig, SearchHasABudgetUnlessToldOtherwise) {
  PlanOptions options = searched(0);
  options.simulator = own_simulator();
  EXPECT_EQ(plan(40.0, options).search->stopped_by, StopReason::evaluations);
  EXPECT_EQ(plan(40.0, options).evaluations, 600);
  EXPECT_EQ(plan(40.0, options).search->ranks.size(), 600U);
  const DigPlan uncertain = plan(GroundDensity(40.0, 5.0), options);
  EXPECT_GE(uncertain.evaluations, 300);
  EXPECT_LE(uncertain.evaluations, 3 * 100 + 3 * 100 + 3);
}

// docs/methods.md#planning: "spends the first third of its 600 digs on the path with the start of
// least work, then frees the start".
TEST_F(PlanDig, ASearchFreesTheStartAfterAThirdOfItsDigs) {
  std::vector<DigPath> dug;
  PlanOptions options = searched(0, 1);
  options.simulator = recording_simulator(dug);
  ASSERT_EQ(plan(40.0, options).evaluations, 600);
  const DigLayout layout(machine_, level_planning_ground(machine_));
  const auto of_least_work = [&](int from, int to) {
    return std::count_if(dug.begin() + from, dug.begin() + to, [&](const DigPath& path) {
      const auto laid = path_by(layout, path.parameters, StartRule::Kind::least_work);
      const auto* usual = std::get_if<DigPath>(&laid);
      return usual && usual->start_x == path.start_x;
    });
  };
  EXPECT_EQ(of_least_work(0, 200), 200);
  EXPECT_LT(of_least_work(200, 300), 50);
}

// docs/methods.md#planning: 900 digs in coarse steps and 190 in fine ones.
TEST_F(PlanDig, ASearchIsScreened) {
  const Terrain ground = rising(0.1);
  const DigPlan found = plan_dig(machine_, loam_, 40.0, ground, searched(0, 1));
  ASSERT_TRUE(found.dig);
  EXPECT_GT(found.evaluations, 900);
  EXPECT_LE(found.evaluations, 900 + 190);
  EXPECT_EQ(found.search->ranks.size(), static_cast<std::size_t>(found.evaluations));
  const auto again = evaluate_dig(machine_, *default_simulator().make(machine_, loam_, 40.0),
                                  ground, found.dig->parameters, found.dig->start_x);
  EXPECT_EQ(std::get<PlannedDig>(again).payload_mass, found.dig->payload_mass);
  EXPECT_EQ(std::get<PlannedDig>(again).energy, found.dig->energy);
  const DigPlan thorough = plan_dig(machine_, loam_, 40.0, ground, searched(1500, 1));
  EXPECT_GT(found.search->worth, 0.99 * thorough.search->worth);
  EXPECT_EQ(bytes(plan_dig(machine_, loam_, 40.0, ground, searched(0, 3))), bytes(found));
}

// Where ground bends, something stands or no dig fills the bucket, it is as good as many digs.
TEST_F(PlanDig, AScreenedSearchIsAsGoodWhereTheBestDigsAreAtAnEdge) {
  Terrain bent = rising(0.0);
  bent.bank.z.rightCols(bent.bank.z.cols() / 2) -= 0.3;
  Terrain standing = rising(0.0);
  standing.obstacles =
      Eigen::ArrayXXd::Constant(standing.bank.z.rows(), standing.bank.z.cols(), std::nan(""));
  standing.obstacles(standing.obstacles.rows() / 2, standing.obstacles.cols() - 3) = 1.0;
  for (const Terrain& ground : {bent, standing}) {
    const DigPlan found = plan_dig(machine_, loam_, 40.0, ground, searched(0, 1));
    const DigPlan thorough = plan_dig(machine_, loam_, 40.0, ground, searched(1500, 1));
    EXPECT_GT(found.search->worth, 0.99 * thorough.search->worth);
  }
  const DigPlan in_hard = plan_dig(machine_, loam_, 80.0, rising(0.27), searched(0, 1));
  EXPECT_TRUE(warns(in_hard, "min_fill_relaxed"));
  const DigPlan thorough = plan_dig(machine_, loam_, 80.0, rising(0.27), searched(1500, 1));
  EXPECT_GT(in_hard.dig->fill, 0.98 * thorough.dig->fill);
}

// In the pit of three digs the most payload per energy of the dig is in a bucket that is nearly
// empty.
TEST_F(PlanDig, ForTheEnergyOfTheDigAloneTheDigIsWorthMakingToo) {
  Terrain pit = rising(0.0);
  const auto simulator = default_simulator().make(machine_, loam_, 80.0);
  DigSearchOptions search = budget_search();
  search.objective = DigObjective::Goal::energy;
  for (int i = 0; i < 3; ++i) {
    apply(simulator->dig(pit, search_dig(machine_, *simulator, pit, search)->path).patch, pit);
  }
  PlanOptions options = searched(0);
  options.search.objective = DigObjective::Goal::energy;
  const DigPlan found = plan_dig(machine_, loam_, 80.0, pit, options);
  ASSERT_TRUE(found.dig) << found.reason;
  EXPECT_GE(found.dig->fill, 0.1);
}

TEST_F(PlanDig, OwnNumbersOfAPolishCount) {
  PlanOptions few = searched(0, 1), many = searched(0, 1);
  std::get<MemeticSearch>(few.search.method).polish_evaluations = 5;
  std::get<MemeticSearch>(many.search.method).polish_evaluations = 200;
  EXPECT_NE(bytes(plan_dig(machine_, loam_, 40.0, rising(0.1), few)),
            bytes(plan_dig(machine_, loam_, 40.0, rising(0.1), many)));
}

TEST_F(PlanDig, ASearchWithOwnNumbersIsMadeAsTold) {
  PlanOptions options = searched(0, 1);
  std::get<MemeticSearch>(options.search.method).generations = 3;
  EXPECT_LE(plan_dig(machine_, loam_, 40.0, rising(0.1), options).evaluations,
            evaluation_budget(false, true));
}

TEST_F(PlanDig, AScreenedSearchTellsItsProgress) {
  for (const double density : {40.0, 80.0}) {
    PlanOptions options = searched(0, 1);
    int last = 0;
    options.search.progress = [&](const SearchProgress& now) {
      EXPECT_GE(now.evaluations, last);
      EXPECT_GE(now.planned, now.evaluations);
      last = now.evaluations;
      return true;
    };
    EXPECT_EQ(plan_dig(machine_, loam_, density, rising(0.27), options).evaluations, last);
  }
}

TEST_F(PlanDig, AScreenedSearchThatIsCancelledGivesADigOfTheGroundItself) {
  const Terrain ground = rising(0.1);
  for (const int last : {20, 150, 300}) {
    PlanOptions options = searched(0, 1);
    options.search.progress = [=](const SearchProgress& now) { return now.evaluations < last; };
    const DigPlan part = plan_dig(machine_, loam_, 40.0, ground, options);
    ASSERT_TRUE(part.dig) << last;
    EXPECT_TRUE(part.stopped);
    EXPECT_EQ(part.search->stopped_by, StopReason::cancelled);
    EXPECT_LE(part.evaluations, last + 5) << "and of each of its best digs one";
    const auto again = evaluate_dig(machine_, *default_simulator().make(machine_, loam_, 40.0),
                                    ground, part.dig->parameters, part.dig->start_x);
    EXPECT_EQ(std::get<PlannedDig>(again).energy, part.dig->energy);
  }
}

TEST_F(PlanDig, AScreenedSearchThatWasCancelledResumes) {
  const test::TemporaryFolder folder;
  const DigPlan at_once = plan(40.0, searched(0, 1));
  for (const int last : {150, 330}) {
    PlanOptions options = searched(0, 1);
    options.search.checkpoint = folder.file(std::to_string(last) + ".json");
    options.search.progress = [=](const SearchProgress& now) { return now.evaluations < last; };
    EXPECT_TRUE(plan(40.0, options).stopped);
    options.search.progress = nullptr;
    options.search.resume = true;
    EXPECT_EQ(bytes(plan(40.0, options)), bytes(at_once)) << last;
  }
}

// StopRules::stall: evaluations without a better point, looked at after each round of polishes.
TEST_F(PlanDig, ASearchThatFindsNothingBetterEndsAndDoesNotBeginAgain) {
  PlanOptions options = searched(600);
  options.simulator = own_simulator();
  options.search.objective = DigObjective::Goal::energy;
  options.search.bounds.lower.drag_length = options.search.bounds.upper.drag_length = 1.5;
  options.search.start = {
      DigParameters{0.7, 0.3, 1.5}};  // all digs of this drag are worth the same
  options.search.stop.stall = 10;
  auto& method = std::get<MemeticSearch>(options.search.method);
  method.polish_evaluations = 12;
  const DigPlan found = plan(40.0, options);
  EXPECT_EQ(found.search->stopped_by, StopReason::stall);
  EXPECT_GT(found.evaluations, options.search.stop.stall);
  EXPECT_LE(found.evaluations, 1 + method.polish_evaluations);
}

TEST_F(PlanDig, SameSearchForAnyThreads) {
  for (const GroundDensity& density : {GroundDensity(30.0), GroundDensity(30.0, 6.0)}) {
    const std::string one = bytes(plan(density, searched(30, 1)));
    for (const unsigned threads : {2U, 5U}) {
      EXPECT_EQ(bytes(plan(density, searched(30, threads))), one) << threads;
    }
  }
}

TEST_F(PlanDig, CancelledItGivesTheBestDigSoFarOrNone) {
  PlanOptions options = searched(60);
  options.search.progress = [](const SearchProgress& progress) { return progress.evaluations < 9; };
  const DigPlan part = plan(40.0, options);
  ASSERT_TRUE(part.dig);
  EXPECT_TRUE(part.stopped);
  EXPECT_EQ(part.search->stopped_by, StopReason::cancelled);
  EXPECT_FALSE(part.trajectory.points.empty());

  const DigPlan uncertain = plan(GroundDensity(40.0, 5.0), options);
  EXPECT_TRUE(uncertain.stopped && uncertain.dig);
  EXPECT_FALSE(uncertain.search->value_of_knowing);

  options.search.bounds.lower = options.search.bounds.upper = {1.4, 0.9, 3.0};  // stalls
  options.search.progress = [](const SearchProgress&) { return false; };
  for (const GroundDensity& density : {GroundDensity(40.0), GroundDensity(40.0, 5.0)}) {
    const DigPlan none = plan(density, options);
    EXPECT_TRUE(none.stopped && none.reason.empty());
    EXPECT_FALSE(none.dig);
  }
}

TEST_F(PlanDig, WhereNoDigCanBeDoneItSaysWhatCameNearest) {
  PlanOptions options = searched(5);
  options.search.bounds.lower = options.search.bounds.upper = {1.4, 0.9, 3.0};
  for (const GroundDensity& density : {GroundDensity(40.0), GroundDensity(40.0, 8.0)}) {
    const DigPlan none = plan(density, options);
    EXPECT_FALSE(none.dig || none.stopped);
    EXPECT_FALSE(none.reason.empty());
    ASSERT_TRUE(none.nearest);
    EXPECT_EQ(none.nearest->parameters.drag_length, 3.0);
    EXPECT_TRUE(none.trajectory.points.empty());
  }
}

TEST_F(PlanDig, SearchesInASuppliedSimulator) {
  PlanOptions options = searched(80);
  options.search.objective = DigObjective::Goal::energy;
  options.simulator = own_simulator();
  const DigPlan found = plan(40.0, options);
  EXPECT_NEAR(found.dig->parameters.drag_length, 1.2, 0.01);
  EXPECT_EQ(found.dig->payload_mass, 100.0);
}

TEST_F(PlanDig, ADigLookedUpIsDugInAnotherSimulatorThanTheLibrarys) {
  PlanOptions options;
  options.simulator = own_simulator();
  const DigPlan found = plan(40.0, options);
  EXPECT_EQ(found.dig->payload_mass, 100.0);
  EXPECT_EQ(found.evaluations, 1);
  EXPECT_EQ(found.dig->start_x, plan(40.0).dig->start_x);
}

// ---- The goal ---------------------------------------------------------------------------------

TEST_F(PlanDig, TellsTheCycleByItsParts) {
  const DigPlan found = plan(40.0);
  ASSERT_TRUE(found.cycle);
  EXPECT_EQ(found.cycle->dig.energy, found.dig->energy);
  EXPECT_EQ(found.cycle->total.energy, found.dig->cycle_energy);
  EXPECT_EQ(found.cycle->total.time, found.dig->cycle_time);
  EXPECT_GE(found.dig->fill, 0.8);
}

TEST_F(PlanDig, LooksUpInTheLibraryOfItsGoal) {
  PlanOptions energy;
  energy.search.objective = DigObjective::Goal::energy;
  const DigPlan found = plan(10.0, energy);
  EXPECT_EQ(found.dig->energy,
            look_up(shipped_library(machine_, loam_, DigObjective::Goal::energy), 10.0).energy);
  EXPECT_GT(found.dig->efficiency(), plan(10.0).dig->efficiency());
  PlanOptions time;
  time.search.objective = DigObjective::Goal::time;
  EXPECT_NE(test::error_of([&] { plan(40.0, time); }).find("for the goal time is shipped"),
            std::string::npos);
  energy.library = std::make_shared<PathLibrary>(shipped_library(machine_, loam_));
  EXPECT_NE(test::error_of([&] { plan(40.0, energy); }).find("its goal is cycle, min_fill"),
            std::string::npos);
}

TEST_F(PlanDig, NoRangeOfTheMachineEndsAtItsBestDig) {
  EXPECT_FALSE(warns(plan(40.0, searched(0)), "optimum_at_bound"));
}

TEST_F(PlanDig, SaysWhereTheBucketCannotBeFilledAsAsked) {
  PlanOptions options = searched(30);
  options.search.bounds.upper = {0.5, 0.3, 0.6};  // too flat for the scoop to fill it
  const DigPlan found = plan(40.0, options);
  EXPECT_LT(found.dig->fill, 0.8);
  EXPECT_TRUE(warns(found, "min_fill_relaxed"));
  EXPECT_TRUE(warns(found, "optimum_at_bound"));
  options.search.objective.min_fill = 0.0;
  EXPECT_FALSE(warns(plan(40.0, options), "min_fill_relaxed"));
}

TEST_F(PlanDig, ADigThatLiftsNextToNothingIsNotWorthMaking) {
  PlanOptions options = searched(10);
  options.search.bounds.lower = {0.2, 0.01, 0.3};
  options.search.bounds.upper = {0.4, 0.02, 0.3};
  const DigPlan none = plan(40.0, options);
  EXPECT_FALSE(none.dig || none.stopped);
  EXPECT_EQ(none.reason.rfind("no dig is worth making: the best found", 0), 0U) << none.reason;
  EXPECT_TRUE(none.trajectory.points.empty());
}

// ---- The density ------------------------------------------------------------------------------

TEST_F(PlanDig, FiguresScatterWithTheDensity) {
  const DigPlan sure = plan(40.0);
  const DigPlan scattered = plan(GroundDensity(40.0, 8.0));
  EXPECT_EQ(scattered.dig->energy, sure.dig->energy);
  EXPECT_EQ(sure.spread.efficiency, 0.0);
  EXPECT_EQ(scattered.evaluations, 3);
  const double soft = dug(*sure.dig, 32.0).efficiency();
  const double firm = dug(*sure.dig, 48.0).efficiency();
  EXPECT_NEAR(scattered.spread.efficiency, 0.5 * (soft - firm), 0.1 * (soft - firm));
}

TEST_F(PlanDig, SearchForAnUncertainDensitySaysWhatKnowingItIsWorth) {
  const DigPlan found = plan(GroundDensity(40.0, 8.0), searched(30));
  EXPECT_GE(found.search->value_of_knowing.value(), 0.0);
  EXPECT_LT(*found.search->value_of_knowing, 0.05);
  EXPECT_GT(found.spread.energy, 0.0);
  EXPECT_FALSE(plan(40.0, searched(5)).search->value_of_knowing);
}

TEST_F(PlanDig, OnUnevenGroundAnUncertainDensityIsSearchedAsThoroughlyAsAKnownOne) {
  Terrain ground = level_planning_ground(machine_);
  for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < ground.bank.z.rows(); ++row) {
      const double x = (ground.bank.x(col) - 6.0) / 0.9;
      const double y = ground.bank.y(row) / 0.55;
      ground.bank.z(row, col) = 0.14 * 0.9 * x - 0.4 * std::max(0.0, 1.0 - x * x - y * y);
    }
  }
  PlanOptions options;
  options.method = PlanMethod::search;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    options.search.seed = seed;
    const DigPlan known = plan_dig(machine_, loam_, {40.0}, ground, options);
    const DigPlan uncertain = plan_dig(machine_, loam_, {40.0, 2.0}, ground, options);
    ASSERT_TRUE(known.dig && uncertain.dig) << seed << uncertain.reason;
    EXPECT_GT(uncertain.search->worth, 0.9 * known.search->worth) << seed;
  }
}

TEST_F(PlanDig, ADensityThatIsNotTrustedIsPassedOn) {
  GroundDensity density = 40.0;
  density.trustworthy = false;
  density.soil = "sand";
  const DigPlan found = plan(density);
  EXPECT_FALSE(found.trustworthy);
  EXPECT_TRUE(warns(found, "density_not_trustworthy") && warns(found, "law_of_other_soil"));
  EXPECT_TRUE(found.look_up->error) << "the ground is the library's";
  density.trustworthy = true;
  EXPECT_FALSE(plan(density).trustworthy) << "of sand";
  density.soil = "loam";
  EXPECT_TRUE(plan(density).trustworthy);
  EXPECT_TRUE(plan(density).warnings.empty());
}

TEST_F(PlanDig, AStallThatIsLikelyIsNotTrusted) {
  PlanOptions options = searched(30);
  options.search.bounds.lower = {1.0, 0.6, 0.5};
  const SoilKind clay = load_soil(find_data_file("soils/clay.json"));
  const DigPlan risky = plan_dig(machine_, clay, GroundDensity(45.0, 15.0), options);
  EXPECT_GT(risky.spread.stall_probability, 0.05);
  EXPECT_TRUE(warns(risky, "may_stall"));
  EXPECT_FALSE(risky.trustworthy);
}

}  // namespace
}  // namespace excavplan
