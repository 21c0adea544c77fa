// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Hostile searches, goals, libraries, plans and experiments: the rooms optimisation, planning,
/// library, plan and experiment. Also callbacks that throw.

#include <future>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/data_files.hpp>
#include <excavplan/experiments/experiment.hpp>
#include <excavplan/optimisation/search_analysis.hpp>
#include <excavplan/planning/library_build.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/non_finite.hpp"
#include "support/hostile.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using test::answers;
using test::finite;
using test::loam;
using test::refuses;
using test::zx120;

constexpr int most = std::numeric_limits<int>::max();

std::unique_ptr<const SoilSimulator> section(double density = 40.0) {
  return simulator_of_word("section").make(zx120(), loam(), density);
}
const Terrain& ground() {
  static const Terrain terrain = level_planning_ground(zx120(), 0.1);
  return terrain;
}

// ---- searches -----------------------------------------------------------------------------------

SearchProblem hill() {
  SearchProblem problem;
  problem.box = {Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(1.0, 1.0)};
  problem.objective = [](const Eigen::VectorXd& x) { return Evaluation(1.0 - x.squaredNorm()); };
  return problem;
}

SearchOptions few() {
  SearchOptions options;
  options.stop.evaluations = 12;
  options.threads = 2;
  return options;
}

TEST(HostileSearch, ProblemsThatAreNone) {
  ASSERT_TRUE(search(hill(), few()).feasible());
  const auto refused = [](const std::function<void(SearchProblem&)>& spoil) {
    SearchProblem problem = hill();
    spoil(problem);
    return refuses([&] { search(problem, few()); }, "search: ");
  };
  for (const double bad : {nan, infinity, -infinity, 1e308}) {
    EXPECT_TRUE(refused([=](SearchProblem& p) { p.box.lower[0] = bad; }));
    EXPECT_TRUE(refused([=](SearchProblem& p) {
      p.box.lower[1] = -1e308;
      p.box.upper[1] = bad;
    }));
    if (bad < 1e308 || !finite(bad)) {
      EXPECT_TRUE(refused([=](SearchProblem& p) { p.step = Eigen::Vector2d(bad, 0.1); }));
    }
  }
  EXPECT_TRUE(refused([](SearchProblem& p) { p.box.lower.resize(0); }));
  EXPECT_TRUE(refused([](SearchProblem& p) { p.box = {}; }));
  EXPECT_TRUE(refused([](SearchProblem& p) { p.step.resize(3); }));
  EXPECT_TRUE(refused([](SearchProblem& p) { p.objective = nullptr; }));
  EXPECT_TRUE(refused([](SearchProblem& p) { const SearchProblem taken = std::move(p); }));
}

TEST(HostileSearch, OptionsWithoutBounds) {
  const auto refused = [](const std::function<void(SearchOptions&)>& spoil) {
    SearchOptions options = few();
    spoil(options);
    return refuses([&] { search(hill(), options); });
  };
  const auto by = [&](auto method) {
    return refused([=](SearchOptions& o) { o.method = method; });
  };
  for (const int bad : {-1, most}) {
    EXPECT_TRUE(by(GeneticAlgorithm{bad}));
    EXPECT_TRUE(by(GeneticAlgorithm{50, 20, bad}));
    EXPECT_TRUE(by(MemeticSearch{bad}));
    EXPECT_TRUE(by(MemeticSearch{16, 4, bad}));
  }
  for (const double bad : {nan, infinity, -1.0}) {
    EXPECT_TRUE(by(GeneticAlgorithm{50, 20, 3, bad}));
    EXPECT_TRUE(by(GeneticAlgorithm{50, 20, 3, 0.9, bad}));
    EXPECT_TRUE(by(MemeticSearch{16, 4, 12, bad}));
    EXPECT_TRUE(refused([=](SearchOptions& o) { o.start = {Eigen::Vector2d(bad, nan)}; }));
  }
  EXPECT_TRUE(refused([](SearchOptions& o) { o.stop.seconds = nan; }));
  EXPECT_TRUE(refused([](SearchOptions& o) { o.stop.target = nan; }));
  EXPECT_TRUE(refused([](SearchOptions& o) { o.stop.evaluations = -1; }));
  EXPECT_TRUE(refused([](SearchOptions& o) { o.checkpoint_interval = nan; }));
  EXPECT_TRUE(refused([](SearchOptions& o) { o.start = {Eigen::Vector3d::Zero()}; }));
  EXPECT_TRUE(refused([](SearchOptions& o) { o.threads = 4294967295U; }));
  EXPECT_TRUE(by(GeneticAlgorithm{50, most}));
  EXPECT_TRUE(by(MemeticSearch{16, most}));
  EXPECT_TRUE(by(MemeticSearch{16, 4, 12, 0.25, 3, most}));
  SearchOptions generous = few();
  generous.method = MemeticSearch{16, most_evaluations / 12, 12, 0.25, most, most_evaluations};
  EXPECT_LE(search(hill(), generous).evaluations, 12);
}

TEST(HostileSearch, AnalysisOfWhatDoesNotFit) {
  const SearchBox box = hill().box;
  const SearchResult good = search(hill(), few());
  EXPECT_NO_THROW(explain(box, good));
  EXPECT_NO_THROW(explain({}, SearchResult{}));
  EXPECT_TRUE(refuses([&] { explain({}, good); }, "of one dimension"));
  SearchResult bad = good;
  bad.best.resize(1);
  EXPECT_TRUE(refuses([&] { explain(box, bad); }, "of one dimension"));
  bad = good;
  bad.history[0].point.resize(7);
  EXPECT_TRUE(refuses([&] { explain(box, bad); }, "of one dimension"));
  for (const double number : {nan, infinity, -1.0}) {
    EXPECT_TRUE(refuses([&] { explain(box, good, number); }, "share"));
    EXPECT_TRUE(refuses([&] { explain(box, good, 0.98, number); }, "radius"));
  }
  const NoisyObjective one = [](const Eigen::VectorXd&, int) { return Evaluation(1.0); };
  EXPECT_TRUE(refuses([&] { evaluate_again(good, nullptr); }, "objective is empty"));
  for (const int count : {0, -1, most}) {
    EXPECT_TRUE(refuses([&] { evaluate_again(good, one, 5, count); }, "repeats"));
  }
  EXPECT_TRUE(evaluate_again({}, one).empty());
  EXPECT_FALSE(to_csv(SearchResult{}).empty());
  EXPECT_STREQ(name(static_cast<SearchRecord::Origin>(99)), "");
  EXPECT_STREQ(name(static_cast<StopReason>(99)), "");
}

TEST(HostileSearch, CallbacksThatThrowAreHeard) {
  for (const unsigned threads : {1U, 4U}) {
    SearchOptions options = few();
    options.threads = threads;
    options.progress = [](const SearchProgress&) -> bool { throw std::runtime_error("my own"); };
    EXPECT_THROW(search(hill(), options), std::runtime_error);
    options.progress = [](const SearchProgress&) -> bool { throw 7; };
    EXPECT_THROW(search(hill(), options), int);
    DigSearchOptions dig;
    dig.threads = threads;
    dig.stop.evaluations = 8;
    dig.progress = options.progress;
    const std::vector<PossibleSoil> soils = {{section().release(), 0.5},
                                             {section().release(), 0.5}};
    EXPECT_THROW(search_dig(zx120(), soils, ground(), dig), int);
    for (const PossibleSoil& soil : soils) delete soil.simulator;
  }
}

// ---- digs ---------------------------------------------------------------------------------------

TEST(HostileDig, GoalsAndBounds) {
  DigSearchOptions good;
  good.stop.evaluations = 4;
  good.threads = 1;
  good.objective = DigObjective::Goal::priced;
  const std::vector<test::Member<DigSearchOptions>> members = {
      {"swing", [](DigSearchOptions& o) -> double& { return o.objective.swing; }},
      {"dump_height", [](DigSearchOptions& o) -> double& { return o.objective.dump_height; }},
      {"rest", [](DigSearchOptions& o) -> double& { return o.objective.rest_of_cycle; }},
      {"price", [](DigSearchOptions& o) -> double& { return o.objective.time_price; }},
      {"fill", [](DigSearchOptions& o) -> double& { return o.objective.min_fill; }},
      {"lower", [](DigSearchOptions& o) -> double& { return o.bounds.lower.drag_length; }},
      {"upper", [](DigSearchOptions& o) -> double& { return o.bounds.upper.drag_length; }},
      {"start", [](DigSearchOptions& o) -> double& { return o.start_rule.x; }}};
  const auto simulator = section();
  test::make_hostile<DigSearchOptions>(
      good, members, {{"search_dig", [&](const DigSearchOptions& o) {
                         const auto found = search_dig(zx120(), *simulator, ground(), o);
                         return !found || finite(found->worth);
                       }}});
  DigSearchOptions no_goal = good;
  no_goal.objective.goal = static_cast<DigObjective::Goal>(99);
  EXPECT_TRUE(refuses([&] { search_dig(zx120(), *simulator, ground(), no_goal); }, "goal is none"));
  EXPECT_TRUE(refuses([&] { search_dig({}, *simulator, ground(), good); }, "machine"));
  EXPECT_TRUE(refuses([&] { search_dig(zx120(), *simulator, {}, good); }, "map is empty"));
  EXPECT_TRUE(refuses([&] { evaluate_dig({}, *simulator, ground(), {}); }, "machine"));
  EXPECT_TRUE(refuses([&] {
    evaluate_dig(zx120(), *simulator, ground(), paper_fixed_path(), StartRule::Kind::searched);
  }));
  for (const double x : test::hostile_numbers) {
    EXPECT_TRUE(answers([&] {
      return evaluate_dig(zx120(), *simulator, ground(), paper_fixed_path(), x).index() == 1;
    }));
  }
  EXPECT_NO_THROW(describe(DigFailure()));
  EXPECT_NO_THROW(describe(NearestDig{}));
  EXPECT_EQ(DigObjective().worth(PlannedDig{}), 0.0);
}

TEST(HostileDig, SoilsThatMayBe) {
  const auto simulator = section();
  DigSearchOptions options;
  options.stop.evaluations = 3;
  const auto path = std::get<DigPath>(
      make_dig_path_anywhere(zx120(), paper_fixed_path(), boom_plane_profile(ground())));
  for (const std::vector<PossibleSoil>& soils : {std::vector<PossibleSoil>{},
                                                 {{nullptr, 1.0}},
                                                 {{simulator.get(), nan}},
                                                 {{simulator.get(), infinity}},
                                                 {{simulator.get(), 0.5}},
                                                 {{simulator.get(), -1.0}}}) {
    EXPECT_TRUE(refuses([&] { search_dig(zx120(), soils, ground(), options); }, "probability"));
    EXPECT_TRUE(refuses([&] { dig_spread(zx120(), soils, ground(), {}, path); }, "probability"));
  }
  EXPECT_TRUE(refuses([&] { dig_spread(zx120(), {{simulator.get(), 1.0}}, ground(), {}, {}); }));
  for (const double bad : {nan, infinity, -1.0, 1e300}) {
    EXPECT_TRUE(refuses([&] { possible_densities(bad, 5.0); }, "mean density"));
    EXPECT_TRUE(refuses([&] { require_density({bad, 0.0}); }, "density"));
    if (bad == 1e300) continue;
    EXPECT_TRUE(refuses([&] { possible_densities(50.0, bad); }, "standard deviation"));
    EXPECT_TRUE(refuses([&] { require_density({50.0, bad}); }, "standard deviation"));
    EXPECT_TRUE(refuses([&] { PossibleGround(default_simulator(), zx120(), loam(), {bad, 0.0}); }));
  }
  for (const int count : test::hostile_counts) {
    EXPECT_TRUE(refuses([&] { possible_densities(50.0, 5.0, count); }, "number of possible"));
  }
  PossibleGround moved(simulator_of_word("section"), zx120(), loam(), {50.0, 8.0});
  const PossibleGround taken = std::move(moved);
  EXPECT_TRUE(refuses([&] { search_dig(zx120(), moved.soils(), ground(), options); }, "probab"));
  EXPECT_EQ(taken.soils().size(), 3U);
  EXPECT_TRUE(refuses([] { PossibleGround({}, zx120(), loam(), 50.0); }, "simulator ''"));
}

// ---- plans and experiments ----------------------------------------------------------------------

TEST(HostilePlan, ArgumentsAndOptions) {
  const auto refused = [](const std::function<void(PlanOptions&)>& spoil, const char* what) {
    PlanOptions options;
    spoil(options);
    return refuses([&] { plan_dig(zx120(), loam(), 50.0, options); }, what);
  };
  EXPECT_TRUE(refuses([] { plan_dig({}, loam(), 50.0); }, "machine"));
  EXPECT_TRUE(refuses([] { plan_dig(zx120(), {}, 50.0); }, "soil"));
  EXPECT_TRUE(refuses([] { plan_dig(zx120(), loam(), 50.0, Terrain{}); }, "ground to dig on"));
  EXPECT_TRUE(refuses([] { plan_dig(zx120(), loam(), nan); }, "density is nan"));
  EXPECT_TRUE(refuses([] { plan_dig(zx120(), loam(), {50.0, infinity}); }, "deviation"));
  for (const double bad : {nan, infinity, -1.0, 0.0, 1e-9, 1e300}) {
    EXPECT_TRUE(refused([=](PlanOptions& o) { o.cell_size = bad; }, "cell size"));
    EXPECT_TRUE(
        refused([=](PlanOptions& o) { o.trajectory.speed_fraction = bad == 1e-9 ? 2 : bad; },
                "speed_fraction"));
  }
  EXPECT_TRUE(refused([](PlanOptions& o) { o.method = static_cast<PlanMethod>(7); }, "method"));
  EXPECT_TRUE(refused([](PlanOptions& o) { o.search.objective.swing = nan; }, "swing"));
  EXPECT_TRUE(
      refused([](PlanOptions& o) { o.library = std::make_shared<PathLibrary>(); }, "does not fit"));
  EXPECT_TRUE(refused(
      [](PlanOptions& o) {
        o.simulator = {};
        o.method = PlanMethod::search;
      },
      "simulator ''"));
  EXPECT_TRUE(refuses([] { shipped_library({}, {}); }));
}

TEST(HostileExperiment, ArgumentsAndResults) {
  const DensityLaw law = density_law_of(loam());
  EXPECT_TRUE(refuses([&] { run_experiment({}, loam(), law, 50.0); }, "machine"));
  EXPECT_TRUE(refuses([&] { run_experiment(zx120(), {}, law, 50.0); }, "soil"));
  for (const double bad : {nan, infinity, -1.0, 1e300}) {
    EXPECT_TRUE(refuses([&] { run_experiment(zx120(), loam(), law, bad); }, "relative density"));
    ExperimentOptions options;
    options.plan.cell_size = bad;
    EXPECT_TRUE(refuses([&] { run_experiment(zx120(), loam(), law, 50.0, options); }, "cell size"));
    options = {};
    options.fixed_path.drag_length = bad;
    EXPECT_TRUE(refuses([&] { run_experiment(zx120(), loam(), law, 50.0, options); }));
  }
  EXPECT_TRUE(refuses([&] { run_experiment(zx120(), loam(), {}, 50.0); }, "density law"));
  EXPECT_TRUE(refuses([] { static_cast<void>(ExperimentResult{}.gain_percent()); }, "worth"));
}

// ---- libraries ----------------------------------------------------------------------------------

PathLibrary small_library() {
  PathLibrary library = shipped_library(zx120(), loam());
  library.entries.resize(2);
  library.gaps.clear();
  return library;
}

TEST(HostileLibrary, LookUps) {
  const PathLibrary good = small_library();
  const double low = good.entries[0].density_percent, slope = good.entries[0].slope;
  ASSERT_NO_THROW(look_up(good, low, slope));
  for (const double bad : {nan, infinity, -1.0, 1e300}) {
    EXPECT_TRUE(refuses([&] { look_up(good, bad, slope); }, "density"));
    EXPECT_TRUE(refuses([&] { look_up(good, low, bad); }, "slope"));
    EXPECT_TRUE(refuses([&] { look_up_error(good, bad, slope); }, "density"));
    PathLibrary library = good;
    library.entries[0].density_percent = bad;
    EXPECT_TRUE(answers([&] { return finite(look_up(library, 50.0, slope).energy); }));
    library = good;
    for (PathLibraryEntry& entry : library.entries) entry.slope = bad;
    EXPECT_TRUE(answers([&] { return finite(look_up(library, low, slope).energy); }));
  }
  PathLibrary library = good;
  for (PathLibraryEntry& entry : library.entries) entry.dig.energy = nan;
  EXPECT_TRUE(refuses([&] { look_up(library, low, slope); }, "figure"));
  library = good;
  std::swap(library.entries[0], library.entries[1]);
  EXPECT_TRUE(answers([&] { return finite(look_up(library, low, slope).energy); }));
  PathLibrary moved = good;
  const PathLibrary taken = std::move(moved);
  EXPECT_TRUE(refuses([&] { look_up(moved, low); }, "holds no entry"));
  EXPECT_TRUE(refuses([] { look_up({}, 50.0); }, "holds no entry"));
  EXPECT_TRUE(refuses([&] { require_fit({}, zx120(), loam(), DigObjective()); }, "does not fit"));
}

TEST(HostileLibrary, Texts) {
  PathLibrary library = small_library();
  ASSERT_NO_THROW(to_json(library));
  library.search = "\xff";
  EXPECT_TRUE(refuses([&] { to_json(library); }, "path library: '/search' is not UTF-8"));
  library = small_library();
  library.entries[1].dig.energy = nan;
  EXPECT_TRUE(refuses([&] { to_json(library); }, "/entries/1/"));
  library.objective.goal = static_cast<DigObjective::Goal>(99);
  EXPECT_TRUE(refuses([&] { to_json(library); }, "goal is none"));
  EXPECT_TRUE(refuses([&] { file_name(library); }, "goal is none"));
  EXPECT_NO_THROW(file_name({}));
  EXPECT_NO_THROW(remove_library_entries(std::string(5000, 'x')));
  EXPECT_NO_THROW(remove_library_entries(""));
}

LibraryGrid small_grid() { return {{zx120()}, {loam()}, {0.0}, {0.0, 50.0}}; }

LibraryBuildOptions quick() {
  LibraryBuildOptions options;
  options.search.method = AnchoredSearch{4, 1, 2, 4};
  options.search.cell_size = 0.2;
  options.search.simulator = simulator_of_word("section");
  options.threads = 2;
  return options;
}

TEST(HostileLibrary, GridsAndSearches) {
  const auto refused = [](const std::function<void(LibraryGrid&, LibrarySearch&)>& spoil) {
    LibraryGrid grid = small_grid();
    LibraryBuildOptions options = quick();
    spoil(grid, options.search);
    const auto worker = refuses([&] { library_worker(grid, options.search); });
    return worker ? refuses([&] { build_path_libraries(grid, options); }) : worker;
  };
  using Grid = LibraryGrid&;
  using Search = LibrarySearch&;
  EXPECT_TRUE(refused([](Grid g, Search) { g = {}; }));
  EXPECT_TRUE(refused([](Grid g, Search) { g.machines = {Machine{}}; }));
  EXPECT_TRUE(refused([](Grid g, Search) { g.soils = {SoilKind{}}; }));
  EXPECT_TRUE(refused([](Grid g, Search) { g.machines.push_back(zx120()); }));
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    EXPECT_TRUE(refused([=](Grid g, Search) { g.slopes = {bad}; }));
    EXPECT_TRUE(refused([=](Grid g, Search) { g.densities_percent = {bad}; }));
    EXPECT_TRUE(refused([=](Grid, Search s) { s.cell_size = bad; }));
    EXPECT_TRUE(refused([=](Grid, Search s) { s.objective.swing = bad; }));
  }
  for (const int bad : {-1, most}) {
    EXPECT_TRUE(refused([=](Grid, Search s) { s.method = AnchoredSearch{bad}; }));
    EXPECT_TRUE(refused([=](Grid, Search s) { s.method = AnchoredSearch{32, bad}; }));
    EXPECT_TRUE(refused([=](Grid, Search s) { s.method = AnchoredSearch{32, 2, bad}; }));
    EXPECT_TRUE(refused([=](Grid, Search s) { s.method = AnchoredSearch{32, 2, 45, bad}; }));
  }
  EXPECT_TRUE(refused([](Grid, Search s) { s.simulator = {}; }));
  EXPECT_TRUE(refused([](Grid, Search s) { s.seed = std::numeric_limits<std::uint64_t>::max(); }));
  LibraryBuildOptions options = quick();
  options.threads = 4000000000U;
  EXPECT_TRUE(refuses([&] { build_path_libraries(small_grid(), options); }, "number of threads"));
}

TEST(HostileLibrary, WorkersAndCallbacks) {
  const LibraryWorker worker = library_worker(small_grid(), quick().search);
  for (const char* text : {"", "{}", "null", "[1,2", "\xff",
                           R"({"place":{"machine":9,"soil":0,"slope":0.0,"density_percent":0.0},)"
                           R"("digs":[],"starts":[],"expected":0.0,"known":0.0})"}) {
    EXPECT_TRUE(refuses([&] { worker(text); }, "library worker")) << text;
  }
  LibraryBuildOptions options = quick();
  options.other_workers = {nullptr};
  EXPECT_TRUE(refuses([&] { build_path_libraries(small_grid(), options); }, "empty function"));
  options = quick();
  options.progress = [](const LibraryProgress&) -> bool { throw 7; };
  EXPECT_THROW(build_path_libraries(small_grid(), options), int);
  // The thread of the build waits in its first dig until the other worker has got the other entry.
  const auto build_with = [](const LibraryWorker& other) {
    std::promise<void> called;
    const std::shared_future<void> heard = called.get_future().share();
    LibraryBuildOptions both = quick();
    both.threads = 1;
    both.progress = [heard](const LibraryProgress&) {
      heard.wait();
      return true;
    };
    both.other_workers = {[&](const std::string& task) {
      called.set_value();
      return other(task);
    }};
    build_path_libraries(small_grid(), both);
  };
  EXPECT_THROW(build_with([](const std::string&) -> std::string { throw 8; }), int);
  EXPECT_THROW(build_with([](const std::string&) { return std::string("nonsense"); }), Error);
}

}  // namespace
}  // namespace excavplan
