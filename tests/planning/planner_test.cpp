// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_search.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include "simulation/section_simulator.hpp"

#include "support/errors.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

/// A user's own simulator: lifts what the three numbers say, at a price of its own.
class HandMade : public SoilSimulator {
 public:
  explicit HandMade(double best_drag = 1.0) : best_drag_(best_drag) {}
  DigResult dig(const Terrain&, const DigPath& path, const DigOptions&) const override {
    ++digs;
    DigResult result;
    result.payload_mass = 100.0;
    result.energy.total = 1e4 + std::pow(path.parameters.drag_length - best_drag_, 2) * 1e5 +
                          std::pow(path.parameters.penetration_length - 0.4 * best_drag_, 2) * 1e4;
    return result;
  }

  mutable std::atomic<int> digs{0};

 private:
  double best_drag_;
};

class Planner : public testing::Test {
 protected:
  HeightMapSimulator simulator(double density) const { return {machine_, soil_, density}; }

  static DigSearchOptions small_search(unsigned threads = 0) {
    DigSearchOptions options;
    options.stop.evaluations = 60;
    options.threads = threads;
    return options;
  }

  Terrain slope(double rise) const {
    Terrain slope = level_;
    for (Eigen::Index col = 0; col < slope.bank.z.cols(); ++col) {
      slope.bank.z.col(col) += rise * (slope.bank.x(col) - 5.0);
    }
    return slope;
  }

  Machine weakened(double torque) const {
    Machine weak = machine_;
    for (JointLimits& limits : weak.limits) limits.torque = torque;
    return weak;
  }

  /// Efficiency of a dig, 0 if it cannot be done.
  double efficiency(double density, const Terrain& ground, const DigParameters& dig,
                    const StartRule& start) const {
    const auto outcome = evaluate_dig(machine_, simulator(density), ground, dig, start);
    const auto* planned = std::get_if<PlannedDig>(&outcome);
    return planned ? planned->efficiency() : 0.0;
  }

  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind soil_ = load_soil(find_data_file("soils/loam.json"));
  const Terrain level_ = level_planning_ground(machine_);
};

TEST_F(Planner, EvaluatesThePapersFixedPath) {
  const auto outcome = evaluate_dig(machine_, simulator(40.0), level_, paper_fixed_path());
  const PlannedDig& dig = std::get<PlannedDig>(outcome);
  EXPECT_NEAR(dig.payload_volume, 0.2, 0.03);  // half of the cut, as in docs/judge.md
  EXPECT_NEAR(dig.efficiency(), dig.payload_mass / dig.energy, 1e-15);
  EXPECT_GT(dig.duration,
            3.0);  // a dig takes 4-8 s (Caterpillar Performance Handbook, cycle times)
  EXPECT_LT(dig.duration, 8.0);
}

/// Energy and stall as given.
class Told : public SoilSimulator {
 public:
  Told(double energy, bool stalls) : energy_(energy), stalls_(stalls) {}
  DigResult dig(const Terrain&, const DigPath&, const DigOptions&) const override {
    DigResult result;
    result.payload_mass = 100.0;
    result.energy.total = energy_;
    if (stalls_) result.stall = Stall{};
    return result;
  }

 private:
  double energy_;
  bool stalls_;
};

TEST_F(Planner, SpreadIsTheDeviationOverTheSoilsThatDoNotStall) {
  const Told light(1000.0, false), heavy(3000.0, false), hopeless(1e6, true);
  const PlannedDig dig = std::get<PlannedDig>(
      evaluate_dig(machine_, light, level_, paper_fixed_path(), StartRule::Kind::least_work));
  const DigPath path = std::get<DigPath>(
      make_dig_path(machine_, dig.parameters, dig.start_x, boom_plane_profile(level_)));
  const auto spread_in = [&](const std::vector<PossibleSoil>& soils) {
    return dig_spread(machine_, soils, level_, dig, path);
  };
  const DigSpread spread = spread_in({{&light, 0.2}, {&heavy, 0.6}, {&hopeless, 0.2}});
  // Two values with probabilities of 1/4 and 3/4.
  const double share = std::sqrt(0.25 * 0.75);
  EXPECT_NEAR(spread.energy, share * 2000.0, 1e-9);
  EXPECT_NEAR(spread.efficiency, share * (100.0 / 1000.0 - 100.0 / 3000.0), 1e-12);
  EXPECT_EQ(spread.payload_mass, 0.0);
  EXPECT_DOUBLE_EQ(spread.stall_probability, 0.2);
  EXPECT_EQ(spread_in({{&hopeless, 1.0}}).stall_probability, 1.0);
  EXPECT_THROW(spread_in({{&light, 0.5}}), Error);
}

TEST_F(Planner, ExpectationsAreTheMeansOverAllSoils) {
  const Told light(1000.0, false), middle(2000.0, false), heavy(6000.0, false);
  const Told hopeless(1e6, true);
  DigSearchOptions options = small_search(1);
  options.stop.evaluations = 10;
  const auto all =
      search_dig(machine_, {{&light, 0.2}, {&middle, 0.5}, {&heavy, 0.3}}, level_, options);
  ASSERT_TRUE(all);
  EXPECT_NEAR(all->expected.dig.energy, 0.2 * 1000.0 + 0.5 * 2000.0 + 0.3 * 6000.0, 1e-9);
  EXPECT_NEAR(all->expected.worth, 0.2 / 10.0 + 0.5 / 20.0 + 0.3 / 60.0, 1e-12);
  // of those in which the machine does not stall, each by its share among them
  const auto some =
      search_dig(machine_, {{&light, 0.2}, {&hopeless, 0.2}, {&heavy, 0.6}}, level_, options);
  ASSERT_TRUE(some);
  EXPECT_NEAR(some->expected.dig.energy, 0.25 * 1000.0 + 0.75 * 6000.0, 1e-9);
  EXPECT_NEAR(some->expected.worth, 0.2 / 10.0 + 0.6 / 60.0, 1e-12);
}

TEST_F(Planner, APathOffTheMapIsNoSpreadButAnError) {
  const DigPath path = std::get<DigPath>(
      make_dig_path(machine_, paper_fixed_path(), 6.0, [](double) { return 0.0; }));
  const HeightMapSimulator soil = simulator(40.0);
  Terrain small = level_;
  small.bank.origin.x() += 50.0;
  EXPECT_THROW(dig_spread(machine_, {{&soil, 1.0}}, small, {}, path), Error);
}

TEST_F(Planner, SlopeOfTheGroundIsTheLineThroughWhatIsKnown) {
  EXPECT_EQ(boom_plane_slope(level_, machine_.track_front), 0.0);
  Terrain ground = slope(0.2);
  EXPECT_NEAR(boom_plane_slope(ground, machine_.track_front), std::atan(0.2), 1e-12);
  ground.bank.z.rightCols(20).setConstant(std::nan(""));
  ground.bank.z.leftCols(10) += 1.0;  // under the machine
  EXPECT_NEAR(boom_plane_slope(ground, machine_.track_front), std::atan(0.2), 1e-12);
  const Terrain bend = sloped_planning_ground(machine_, 0.2, 0.05);
  EXPECT_NEAR(boom_plane_slope(bend, 0.0, machine_.track_front - 0.1), 0.0, 1e-12);
  ground.bank.z.setConstant(std::nan(""));
  EXPECT_TRUE(std::isnan(boom_plane_slope(ground, machine_.track_front)));
}

TEST_F(Planner, PlannedPathBeatsThePapersFixedPath) {
  for (const double density : {10.0, 40.0, 80.0}) {
    const double fixed = efficiency(density, level_, paper_fixed_path(), {});
    EXPECT_EQ(fixed > 0.0, density < 50.0) << "the machine's front lifts in dense soil";
    const auto found = search_dig(machine_, simulator(density), level_, small_search());
    ASSERT_TRUE(found);
    EXPECT_GT(found->dig.efficiency(), fixed) << density;
  }
}

TEST_F(Planner, TheRanksAreThoseOfAllDigsSimulated) {
  const auto found = search_dig(machine_, simulator(60.0), level_, small_search());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->ranks.size(), static_cast<std::size_t>(found->evaluations));
  double best = 0.0;
  for (const double rank : found->ranks) best = std::isnan(rank) ? best : std::max(best, rank);
  EXPECT_DOUBLE_EQ(best, found->worth);
  const auto stalls = std::count_if(found->ranks.begin(), found->ranks.end(),
                                    [](double rank) { return std::isnan(rank); });
  EXPECT_EQ(stalls, found->infeasible + found->failed);
}

TEST_F(Planner, SameSeedSameBytesForAnyNumberOfThreads) {
  const auto one = search_dig(machine_, simulator(60.0), level_, small_search(1));
  for (const unsigned threads : {2U, 8U}) {
    const auto many = search_dig(machine_, simulator(60.0), level_, small_search(threads));
    EXPECT_EQ(one->dig.parameters.penetration_angle, many->dig.parameters.penetration_angle);
    EXPECT_EQ(one->dig.parameters.penetration_length, many->dig.parameters.penetration_length);
    EXPECT_EQ(one->dig.parameters.drag_length, many->dig.parameters.drag_length);
    EXPECT_EQ(one->dig.energy, many->dig.energy);
    EXPECT_EQ(one->evaluations, many->evaluations);
    ASSERT_EQ(one->ranks.size(), many->ranks.size());
    for (std::size_t i = 0; i < one->ranks.size(); ++i) {
      EXPECT_TRUE(one->ranks[i] == many->ranks[i] || std::isnan(one->ranks[i])) << i;
    }
  }
}

TEST_F(Planner, AKnownGoodPathIsNeverLost) {
  const auto good = search_dig(machine_, simulator(80.0), level_, small_search());
  DigSearchOptions options = small_search();
  options.seed = 99;
  options.stop.evaluations = 1;
  options.start = {good->dig.parameters};
  const auto again = search_dig(machine_, simulator(80.0), level_, options);
  EXPECT_EQ(again->dig.efficiency(), good->dig.efficiency());
  EXPECT_EQ(again->evaluations, 1);
  EXPECT_EQ(again->stopped_by, StopReason::evaluations);
}

TEST_F(Planner, ThePapersAlgorithmOnRequest) {
  DigSearchOptions options;
  GeneticAlgorithm paper;
  paper.population = 8;
  paper.generations = 3;
  options.method = paper;
  const auto found = search_dig(machine_, simulator(40.0), level_, options);
  ASSERT_TRUE(found);
  EXPECT_LE(found->evaluations + found->refused, 24);
  EXPECT_EQ(found->stopped_by, StopReason::generations);
}

TEST_F(Planner, HundredDigsReachTheOptimumFromAnySeed) {
  DigSearchOptions options;
  options.stop.evaluations = 100;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    options.seed = seed;
    const auto found = search_dig(machine_, simulator(40.0), level_, options);
    EXPECT_GT(found->dig.efficiency(), 0.98 * 15.74e-3) << seed;  // of long searches
  }
}

TEST_F(Planner, PathsThatCannotBeDrivenCostNoDig) {
  DigSearchOptions options = small_search();
  options.bounds.lower.drag_length = 2.8;  // most angles bring the heel down on the cut
  options.bounds.upper.penetration_angle = 0.9;
  const auto found = search_dig(machine_, simulator(40.0), level_, options);
  ASSERT_TRUE(found);
  EXPECT_GT(found->refused, 5);
  EXPECT_GE(found->dig.parameters.drag_length, 2.8);
  EXPECT_LE(found->dig.parameters.penetration_angle, 0.9);
}

TEST_F(Planner, RangesOfTheSearchAreChecked) {
  DigSearchOptions options;
  options.bounds.lower.drag_length = 0.3;
  options.bounds.upper.drag_length = 0.1;
  EXPECT_EQ(
      test::error_of([&] { search_dig(machine_, simulator(40.0), level_, options); }),
      "the upper end of the search range of the drag length is 0.1, must be finite and not below "
      "the lower end");
  options = {};
  options.objective.time_price = -1.0;
  EXPECT_THROW(search_dig(machine_, simulator(40.0), level_, options), Error);
}

// ---- Where the dig begins ----------------------------------------------------------------------

TEST_F(Planner, StartOfLeastWorkIsNearlyTheBestStart) {
  const Terrain rising = slope(0.268);
  for (const Terrain* ground : {&level_, &rising}) {
    for (const DigParameters& dig : {DigParameters{0.9, 0.25, 1.2}, DigParameters{0.8, 0.2, 2.0}}) {
      double best = 0.0;
      for (double x = 3.5; x < 8.0; x += 0.1) {
        best = std::max(best, efficiency(40.0, *ground, dig, x));
      }
      EXPECT_GT(efficiency(40.0, *ground, dig, StartRule::Kind::least_work), 0.9 * best);
      EXPECT_LT(efficiency(40.0, *ground, dig, StartRule::Kind::largest_margin), 0.98 * best);
    }
  }
}

TEST_F(Planner, StartIsTakenAsGivenOrSearchedToo) {
  const auto given = evaluate_dig(machine_, simulator(40.0), level_, paper_fixed_path(), 5.77);
  EXPECT_EQ(std::get<PlannedDig>(given).start_x, 5.77);
  EXPECT_THROW(evaluate_dig(machine_, simulator(40.0), level_, paper_fixed_path(),
                            StartRule::Kind::searched),
               Error);
  DigSearchOptions options = small_search();
  options.start_rule = StartRule::Kind::searched;
  const auto found = search_dig(machine_, simulator(40.0), level_, options);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->insight.seen.size(), 4U);
  EXPECT_EQ(efficiency(40.0, level_, found->dig.parameters, found->dig.start_x),
            found->dig.efficiency());
}

TEST_F(Planner, StartOfLeastWorkKeepsOffUnknownGround) {
  const double free_start =
      std::get<PlannedDig>(evaluate_dig(machine_, simulator(40.0), level_, paper_fixed_path(),
                                        StartRule::Kind::least_work))
          .start_x;
  Terrain holed = level_;
  const auto col =
      static_cast<Eigen::Index>((free_start - 1.2 - holed.bank.origin.x()) / holed.bank.cell_size);
  holed.bank.z.block(holed.bank.z.rows() / 2, col, 2, 2) = std::nan("");
  const auto outcome = evaluate_dig(machine_, simulator(40.0), holed, paper_fixed_path(),
                                    StartRule::Kind::least_work);
  ASSERT_TRUE(std::holds_alternative<PlannedDig>(outcome));
  EXPECT_GT(std::get<PlannedDig>(outcome).start_x, free_start + 0.5);
}

// ---- What is best ------------------------------------------------------------------------------

TEST(DigObjective, IsMassPerWhatItIsTold) {
  PlannedDig dig;
  dig.payload_mass = 500.0;
  dig.energy = 20e3;
  dig.cycle_energy = 80e3;
  dig.cycle_time = 16.0;
  using Goal = DigObjective::Goal;
  EXPECT_EQ(DigObjective(Goal::cycle).worth(dig), 500.0 / 80e3);
  EXPECT_EQ(DigObjective(Goal::energy).worth(dig), 500.0 / 20e3);
  EXPECT_EQ(DigObjective(Goal::time).worth(dig), 500.0 / 16.0);
  DigObjective priced = Goal::priced;
  priced.time_price = 1000.0;
  EXPECT_EQ(priced.worth(dig), 500.0 / 96e3);
}

TEST(DigObjective, RanksADigThatFillsEnoughBeforeAnyThatDoesNot) {
  const DigObjective cycle = DigObjective::Goal::cycle;
  EXPECT_EQ(cycle.min_fill, 0.8);
  EXPECT_EQ(cycle.rank(3.0, 0.8), 3.0);
  EXPECT_LT(cycle.rank(5.0, 0.79), cycle.rank(3.0, 0.8));
  EXPECT_GT(cycle.rank(3.0, 0.6), cycle.rank(4.0, 0.5)) << "where it cannot, the fuller one";
  EXPECT_EQ(DigObjective(DigObjective::Goal::energy).rank(3.0, 0.01), 3.0);
}

TEST(DigObjective, SaysWhatMattersToItsGoal) {
  EXPECT_EQ(describe(DigObjective()), "energy, min_fill 0");
  DigObjective cycle = DigObjective::Goal::cycle;
  cycle.swing = 1.5;
  EXPECT_EQ(describe(cycle),
            "cycle, min_fill 0.8, swing_rad 1.5, dump_height_m 3, rest_of_cycle_s 0");
  DigObjective priced = DigObjective::Goal::priced;
  priced.time_price = 30.0;
  EXPECT_EQ(describe(priced).find("priced, time_price_w 30, min_fill 0, swing_rad"), 0U);
}

TEST_F(Planner, EachGoalIsServedBestByItsOwnDig) {
  DigSearchOptions options = small_search();
  using Goal = DigObjective::Goal;
  const auto best_for = [&](const DigObjective& objective) {
    options.objective = objective;
    return search_dig(machine_, simulator(10.0), level_, options)->dig;
  };
  DigObjective priced = Goal::priced;
  priced.time_price = 1e9;  // nothing but time counts
  const DigObjective time = Goal::time, energy = Goal::energy, cycle = Goal::cycle;
  const PlannedDig by_time = best_for(time), by_energy = best_for(energy);
  EXPECT_GT(time.worth(by_time), time.worth(by_energy));
  EXPECT_GT(energy.worth(by_energy), energy.worth(by_time));
  EXPECT_GT(cycle.worth(best_for(cycle)), cycle.worth(by_energy));
  EXPECT_NEAR(time.worth(best_for(priced)), time.worth(by_time), 0.01 * time.worth(by_time));
}

TEST_F(Planner, WaitingTimeAndDumpHeightMatterToTheGoalsOfTheCycle) {
  DigObjective objective = DigObjective::Goal::time;
  const auto fixed =
      std::get<PlannedDig>(evaluate_dig(machine_, simulator(40.0), level_, paper_fixed_path()));
  DigSearchOptions options;
  options.method = MemeticSearch{0, 0, 1, 0.0, 0, 0, 0.2};
  options.start = {paper_fixed_path()};
  options.start_rule = fixed.start_x;
  options.objective = objective;
  options.objective.rest_of_cycle = 5.0;
  const auto waited = search_dig(machine_, simulator(40.0), level_, options);
  EXPECT_NEAR(waited->dig.cycle_time, fixed.cycle_time + 5.0, 1e-9);
  EXPECT_NEAR(waited->worth, fixed.payload_mass / (fixed.cycle_time + 5.0), 1e-9);
  options.objective.dump_height = 4.0;
  EXPECT_GT(search_dig(machine_, simulator(40.0), level_, options)->dig.cycle_energy,
            waited->dig.cycle_energy + 500.0 * 9.8);
}

TEST_F(Planner, FillsTheBucketAsFarAsItIsAskedTo) {
  DigSearchOptions options = small_search();
  const double free = search_dig(machine_, simulator(0.0), level_, options)->dig.fill;
  options.objective.min_fill = 0.5 * (1.0 + free);
  EXPECT_LT(free, options.objective.min_fill);
  EXPECT_GE(search_dig(machine_, simulator(0.0), level_, options)->dig.fill,
            options.objective.min_fill);
}

TEST_F(Planner, WhereTheFillCannotBeReachedTheFullestDigIsFound) {
  DigSearchOptions options = small_search();
  options.bounds.upper.penetration_length = 0.15;
  options.bounds.upper.drag_length = 0.5;
  const double free = search_dig(machine_, simulator(40.0), level_, options)->dig.fill;
  options.objective.min_fill = 0.95;
  const auto relaxed = search_dig(machine_, simulator(40.0), level_, options);
  EXPECT_LT(relaxed->dig.fill, 0.95);
  EXPECT_GE(relaxed->dig.fill, free);
}

TEST_F(Planner, AMachineWithoutTheDataOfTheCycleIsRefusedForItsGoals) {
  Machine old = machine_;
  old.swing.reset();
  DigSearchOptions options = small_search();
  EXPECT_TRUE(search_dig(old, simulator(40.0), level_, options));
  options.objective = DigObjective::Goal::cycle;
  EXPECT_NE(test::error_of([&] {
              search_dig(old, simulator(40.0), level_, options);
            }).find("its file lacks swing (speed_rad_per_s, torque_n_m, inertia_kg_m2)"),
            std::string::npos);
}

// ---- Soil that is not known --------------------------------------------------------------------

TEST(PossibleDensities, AreGaussHermiteNodesFarFromTheEnds) {
  // Abramowitz and Stegun 25.4.46, three nodes: 0 and +-sqrt(3) sd, weights 2/3 and 1/6.
  const auto nodes = possible_densities(50.0, 4.0, 3);
  ASSERT_EQ(nodes.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(nodes[static_cast<std::size_t>(i)].percent, 50.0 + (i - 1) * 4.0 * std::sqrt(3.0),
                1e-3);
    EXPECT_NEAR(nodes[static_cast<std::size_t>(i)].probability, i == 1 ? 2.0 / 3.0 : 1.0 / 6.0,
                1e-4);
  }
}

TEST(PossibleDensities, HaveTheMomentsOfTheCutDistribution) {
  for (const auto& [mean, sd] : {std::pair{95.0, 20.0}, {0.0, 5.0}, {40.0, 1000.0}}) {
    std::array<double, 4> true_moments{}, moments{};
    for (int i = 0; i < 100000; ++i) {
      const double d = (i + 0.5) / 1000.0;
      const double weight = std::exp(-0.5 * std::pow((d - mean) / sd, 2));
      for (int k = 0; k < 4; ++k)
        true_moments[static_cast<std::size_t>(k)] += weight * std::pow(d / 100.0, k);
    }
    for (const PossibleDensity& node : possible_densities(mean, sd, 2)) {
      EXPECT_GT(node.percent, 0.0);
      EXPECT_LT(node.percent, 100.0);
      for (int k = 0; k < 4; ++k) {
        moments[static_cast<std::size_t>(k)] +=
            node.probability * std::pow(node.percent / 100.0, k);
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(moments[k], true_moments[k] / true_moments[0], 1e-5) << mean << " " << k;
    }
  }
  EXPECT_THROW(possible_densities(40.0, 0.0), Error);
  EXPECT_THROW(possible_densities(101.0, 5.0), Error);
}

TEST_F(Planner, OnAverageNoPathBeatsTheOneForTheUncertainSoil) {
  const HeightMapSimulator soft = simulator(10.0), hard = simulator(60.0);
  const std::vector<PossibleSoil> soils = {{&soft, 0.5}, {&hard, 0.5}};
  const auto found = search_dig(machine_, soils, level_, small_search());
  ASSERT_TRUE(found);
  EXPECT_GE(found->evaluations, 2 * found->expected.evaluations);
  const auto average = [&](const PlannedDig& dig) {
    return 0.5 * efficiency(10.0, level_, dig.parameters, dig.start_x) +
           0.5 * efficiency(60.0, level_, dig.parameters, dig.start_x);
  };
  EXPECT_NEAR(found->expected.worth, average(found->expected.dig), 1e-15);
  double known = 0.0;
  for (const HeightMapSimulator* one : {&soft, &hard}) {
    const auto best = search_dig(machine_, *one, level_, small_search());
    EXPECT_GT(found->expected.worth, average(best->dig));
    known += 0.5 * best->dig.efficiency();
  }
  EXPECT_GE(found->worth_if_known, 0.99 * known);  // each search knows the bests of the others
  EXPECT_GE(found->value_of_knowing(), 0.0);
}

TEST_F(Planner, KnowingOneCertainSoilIsWorthNothing) {
  const HeightMapSimulator only = simulator(40.0);
  DigSearchOptions options;
  options.stop.evaluations = 120;
  const auto found = search_dig(machine_, {{&only, 1.0}}, level_, options);
  EXPECT_GE(found->value_of_knowing(), 0.0);
  EXPECT_LT(found->value_of_knowing(), 0.005);
  EXPECT_THROW(search_dig(machine_, {{&only, 0.5}}, level_, options), Error);
}

// ---- Interrupted -------------------------------------------------------------------------------

TEST_F(Planner, AnInterruptedSearchGoesOnFromItsCheckpoint) {
  const std::string file =
      testing::TempDir() + "dig_search_checkpoint" + std::to_string(::getpid()) + ".json";
  std::remove(file.c_str());
  const auto at_once = search_dig(machine_, simulator(40.0), level_, small_search());
  DigSearchOptions options = small_search();
  options.checkpoint = file;
  options.progress = [](const SearchProgress& p) { return p.evaluations < 25; };
  const auto part = search_dig(machine_, simulator(40.0), level_, options);
  EXPECT_TRUE(part->stopped);
  options.resume = true;
  int fresh = 0;
  options.progress = [&](const SearchProgress&) { return ++fresh > 0; };
  const auto resumed = search_dig(machine_, simulator(40.0), level_, options);
  EXPECT_EQ(resumed->dig.energy, at_once->dig.energy);
  EXPECT_EQ(resumed->evaluations, at_once->evaluations);
  EXPECT_THROW(search_dig(machine_, simulator(41.0), level_, options), Error);
  EXPECT_THROW(search_dig(machine_, simulator(40.0), slope(0.1), options), Error);
  std::remove(file.c_str());
}

/// Stalls under a torque of its own, wherever it is.
class Stuck : public SoilSimulator {
 public:
  explicit Stuck(double torque) : torque_(torque) {}
  DigResult dig(const Terrain&, const DigPath&, const DigOptions&) const override {
    DigResult result;
    result.stall = Stall{DigPhase::drag, Joint::arm, 0.5, torque_};
    return result;
  }

 private:
  double torque_;
};

class DigCheckpoint : public Planner {
 protected:
  void SetUp() override { TearDown(); }
  void TearDown() override { std::remove(file_.c_str()); }

  void search(const SoilSimulator& simulator, const Terrain& terrain, bool resume) const {
    DigSearchOptions options = small_search(1);
    options.stop.evaluations = 6;
    options.checkpoint = file_;
    options.resume = resume;
    search_dig(machine_, simulator, terrain, options);
  }
  void begin(const SoilSimulator& simulator) const { search(simulator, level_, false); }
  /// What is said of the checkpoint when another search takes it.
  std::string refusal(const SoilSimulator& simulator) const { return refusal(simulator, level_); }
  std::string refusal(const SoilSimulator& simulator, const Terrain& terrain) const {
    return test::error_of([&] { search(simulator, terrain, true); }, ErrorKind::bad_file);
  }
  bool refuses(const SoilSimulator& simulator) const {
    return refusal(simulator).find("which differs from") != std::string::npos;
  }
  HeightMapSimulator in(const char* soil, double density) const {
    return {machine_, load_soil(find_data_file(std::string("soils/") + soil + ".json")), density};
  }

  const std::string file_ =
      testing::TempDir() + "excavplan_dig_checkpoint_" + std::to_string(::getpid()) + ".json";
};

TEST_F(DigCheckpoint, OfAnotherSoilIsRefusedWhereThePapersDigStallsInBoth) {
  for (const auto& simulator : {in("gravel", 80.0), in("clay", 100.0)}) {
    const auto dig = evaluate_dig(machine_, simulator, level_, paper_fixed_path());
    ASSERT_TRUE(std::holds_alternative<DigFailure>(dig));
  }
  begin(in("gravel", 80.0));
  EXPECT_EQ(refusal(in("gravel", 80.0)), "no error");
  EXPECT_TRUE(refuses(in("clay", 100.0)));
  EXPECT_TRUE(refuses(in("gravel", 80.0 + 1e-9)));
  EXPECT_TRUE(
      refuses(SectionSimulator(machine_, load_soil(find_data_file("soils/gravel.json")), 80.0)));
  EXPECT_TRUE(refuses(
      HeightMapSimulator(weakened(1e5), load_soil(find_data_file("soils/gravel.json")), 80.0)));
}

TEST_F(DigCheckpoint, OfAnotherSimulatorWithoutANameIsRefusedByWhatItDoes) {
  begin(Stuck(1e6));
  EXPECT_EQ(refusal(Stuck(1e6)), "no error");
  EXPECT_TRUE(refuses(Stuck(2e6)));
  EXPECT_TRUE(refuses(HandMade()));
  TearDown();
  begin(HandMade(0.8));
  EXPECT_EQ(refusal(HandMade(0.8)), "no error");
  EXPECT_TRUE(refuses(HandMade(0.9)));
}

TEST_F(DigCheckpoint, OfGroundOfAnotherDensityIsRefused) {
  Terrain dense = level_, loose = level_;
  dense.bank_void_ratio = loose.loose_void_ratio =
      Eigen::ArrayXXd::Constant(level_.loose.rows(), level_.loose.cols(), 0.7);
  const HandMade simulator;
  search(simulator, dense, false);
  EXPECT_EQ(refusal(simulator, dense), "no error");
  EXPECT_NE(refusal(simulator, loose), "no error");
}

TEST_F(DigCheckpoint, IsWrittenAsOftenAsAsked) {
  for (const double interval : {0.0, 1e9}) {
    TearDown();
    DigSearchOptions options = small_search(1);
    options.checkpoint = file_;
    options.checkpoint_interval = interval;
    options.progress = [&](const SearchProgress& progress) {
      EXPECT_EQ(std::ifstream(file_).good(), interval == 0.0);
      return progress.evaluations < 3;
    };
    search_dig(machine_, HandMade(), level_, options);
    EXPECT_TRUE(std::ifstream(file_).good());
  }
}

/// The search for three soils, stopped at some call of its progress and gone on with.
class UncertainSearch : public Planner {
 protected:
  void SetUp() override { TearDown(); }
  void TearDown() override {
    for (const std::string& file : files()) std::remove(file.c_str());
  }

  std::vector<std::string> files() const {
    return {file_, file_ + ".soil1", file_ + ".soil2", file_ + ".soil3"};
  }
  bool is_there(std::size_t i) const { return std::ifstream(files()[i]).good(); }

  DigSearchOptions options(unsigned threads = 1, bool resume = true) const {
    DigSearchOptions options = small_search(threads);
    options.stop.evaluations = 40;
    options.start_rule = 5.5;  // no time goes into the layout
    options.checkpoint = file_;
    options.resume = resume;
    return options;
  }
  std::optional<UncertainDigSearchResult> run(const DigSearchOptions& options) const {
    return search_dig(machine_, soils_, level_, options);
  }
  /// Stops at a call of the progress, of all searches together. @return whether there was so many
  bool stopped_at(int call, DigSearchOptions options) const {
    int calls = 0;
    options.progress = [&](const SearchProgress&) { return ++calls < call; };
    const auto part = run(options);
    if (calls < call) return false;
    EXPECT_EQ(calls, call);  // who wants it stopped is not asked again
    EXPECT_TRUE(!part ||
                (part->expected.stopped && part->expected.stopped_by == StopReason::cancelled));
    return true;
  }
  int digs() const { return short_.digs + middle_.digs + long_.digs; }

  static std::string text_of(const std::optional<UncertainDigSearchResult>& result) {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    const DigSearchResult& found = result.value().expected;
    const PlannedDig& dig = found.dig;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      text << dig.parameters.*info.field << ' ';
    }
    text << dig.start_x << ' ' << dig.payload_mass << ' ' << dig.payload_volume << ' ' << dig.energy
         << ' ' << dig.duration << ' ' << found.worth << ' ' << found.evaluations << ' '
         << found.refused << ' ' << found.infeasible << ' ' << found.stopped << ' '
         << name(found.stopped_by) << ' ' << found.insight.second_basin.value_or(-1);
    for (const auto* ranges : {&found.insight.seen, &found.insight.fitted}) {
      for (const ParameterRange& range : *ranges) text << ' ' << range.low << ' ' << range.high;
    }
    text << ' ' << result->worth_if_known << ' ' << result->evaluations;
    return text.str();
  }

  const HandMade short_{0.8}, middle_{1.2}, long_{2.0};
  const std::vector<PossibleSoil> soils_ = {{&short_, 0.3}, {&middle_, 0.5}, {&long_, 0.2}};
  const std::string file_ =
      testing::TempDir() + "excavplan_uncertain_" + std::to_string(::getpid()) + ".json";
};

TEST_F(UncertainSearch, StoppedAtAnyMomentAndResumedItGivesTheSameBytes) {
  DigSearchOptions at_once = options();
  at_once.checkpoint = {};
  const std::string expected = text_of(run(at_once));
  int moments = 0, in_last = 0;
  for (int call = 1;; call += 7) {
    TearDown();
    const auto threads = 1 + static_cast<unsigned>(moments) % 3;
    if (!stopped_at(call, options(threads))) break;
    ++moments;
    in_last += is_there(0) ? 1 : 0;
    if (moments % 3 == 0) stopped_at(call + 11, options(threads));
    ASSERT_EQ(text_of(run(options(threads))), expected) << call;
  }
  EXPECT_GT(in_last, 4);
  EXPECT_GT(moments - in_last, 12);
}

TEST_F(UncertainSearch, WhatIsKnownIsNotSimulatedAgain) {
  const auto digs_of = [&](const auto& work) {
    const int before = digs();
    work();
    return digs() - before;
  };
  const int whole = digs_of([&] { run(options()); });
  const int around = digs_of([&] { run(options()); });  // nothing left to search
  EXPECT_LT(around, whole / 4);
  for (const int call : {1, 20, 60, 110, 135, 160}) {
    TearDown();
    ASSERT_TRUE(stopped_at(call, options()));
    int known = 0;
    int checked = 0;  // the best of each file, to see whether that holds
    for (std::size_t i = 0; i < 4; ++i) {
      std::ifstream file(files()[i]);
      if (file) checked += i == 0 ? 3 : 1;
      for (std::string line; std::getline(file, line);) {
        if (line.find("\"point\"") != std::string::npos) known += i == 0 ? 3 : 1;
      }
    }
    EXPECT_GT(known, call * 3 / 4);  // the progress is reported for generations, too
    EXPECT_EQ(digs_of([&] { run(options()); }), whole - known + checked) << call;
  }
}

TEST_F(UncertainSearch, StoppedBeforeTheLastSearchItKnowsTheBestSoFarAndLeavesNoFileOfThat) {
  DigSearchOptions stopped = options();
  int calls = 0;
  stopped.progress = [&](const SearchProgress&) { return ++calls < 70; };
  const auto part = run(stopped);
  ASSERT_TRUE(part);
  EXPECT_TRUE(part->expected.stopped);
  EXPECT_EQ(part->expected.stopped_by, StopReason::cancelled);
  EXPECT_FALSE(is_there(0));
  for (std::size_t i = 1; i < 4; ++i) EXPECT_TRUE(is_there(i)) << i;
  EXPECT_EQ(part->expected.evaluations, 3);  // the best dig for each soil, in all of them
  DigSearchOptions alone = options();
  alone.checkpoint = {};
  const auto first = search_dig(machine_, short_, level_, alone);  // done before the stop
  double average = 0.0;
  for (const PossibleSoil& soil : soils_) {
    const auto outcome =
        evaluate_dig(machine_, *soil.simulator, level_, first->dig.parameters, 5.5);
    average += soil.probability * std::get<PlannedDig>(outcome).efficiency();
  }
  EXPECT_GE(part->expected.worth, average);
}

TEST_F(UncertainSearch, BegunAnewItKeepsNothingOfAnEarlierOne) {
  run(options());
  const std::vector<PossibleSoil> others = {{&long_, 0.5}, {&middle_, 0.3}, {&short_, 0.2}};
  EXPECT_THROW(search_dig(machine_, others, level_, options()), Error);
  DigSearchOptions anew = options(1, false);
  int calls = 0;
  anew.progress = [&](const SearchProgress&) { return ++calls < 10; };
  search_dig(machine_, others, level_, anew);
  EXPECT_FALSE(is_there(0));
  DigSearchOptions plain = options();
  plain.checkpoint = {};
  EXPECT_EQ(text_of(search_dig(machine_, others, level_, options())),
            text_of(search_dig(machine_, others, level_, plain)));
  DigSearchOptions wrong = options(1, false);
  wrong.bounds.lower.drag_length = 0.3;
  wrong.bounds.upper.drag_length = 0.1;
  EXPECT_THROW(search_dig(machine_, others, level_, wrong), Error);
  EXPECT_TRUE(is_there(0));  // a slip costs no work done
}

TEST_F(UncertainSearch, FilesInThePlaceOfItsCheckpointsAreRefusedAndStay) {
  run(options());
  const std::string other = files()[2];
  const std::string checkpoint = test::content_of(other);
  for (const std::string& content : {std::string("mine"), checkpoint.substr(100)}) {
    std::ofstream(other) << content;
    for (const bool resume : {false, true}) {
      EXPECT_EQ(test::error_of([&] { run(options(1, resume)); }, ErrorKind::bad_file),
                other + ": is no checkpoint of a search; name another file, or remove this one");
    }
    EXPECT_EQ(test::content_of(other), content);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(is_there(i)) << i;
  }
  for (const std::size_t left : {100u, 0u}) {  // as a loss of power may leave it
    std::ofstream(other) << checkpoint.substr(0, left);
    EXPECT_TRUE(run(options(1, false)));
  }
}

TEST_F(UncertainSearch, FinishedItMayGoFurther) {
  run(options());
  DigSearchOptions further = options();
  further.stop.evaluations = 60;
  const std::string resumed = text_of(run(further));  // from other bests of the soils
  further.checkpoint = {};
  EXPECT_EQ(resumed, text_of(run(further)));
}

// ---- Ground ------------------------------------------------------------------------------------

TEST_F(Planner, DigsOnASlopeAndInAPit) {
  EXPECT_TRUE(std::holds_alternative<PlannedDig>(
      evaluate_dig(machine_, simulator(40.0), slope(0.1), paper_fixed_path())));

  const auto path = make_dig_path(machine_, paper_fixed_path(), 6.0, [](double) { return 0.0; });
  const Terrain pit = simulator(40.0).dig(level_, std::get<DigPath>(path)).after(level_);
  EXPECT_TRUE(std::holds_alternative<PlannedDig>(
      evaluate_dig(machine_, simulator(40.0), pit, paper_fixed_path())));
}

TEST_F(Planner, UnknownGroundUnderTheBucketIsAReason) {
  Terrain holed = level_;
  const auto col = static_cast<Eigen::Index>((5.0 - holed.bank.origin.x()) / holed.bank.cell_size);
  holed.bank.z.block(holed.bank.z.rows() / 2, col, 3, 3) = std::nan("");
  const auto outcome = evaluate_dig(machine_, simulator(40.0), holed, paper_fixed_path(), 6.05);
  const DigFailure& failure = std::get<DigFailure>(outcome);
  EXPECT_EQ(std::get<Infeasible>(failure).reason, Infeasible::Reason::unknown_ground);
  EXPECT_EQ(describe(failure), "the path runs over ground that is unknown or off the map");
}

TEST_F(Planner, NoGroundAtAllIsNoPlan) {
  Terrain unknown = level_;
  unknown.bank.z.setConstant(std::nan(""));
  const auto found = search_dig(machine_, simulator(40.0), unknown, small_search());
  EXPECT_FALSE(found);
  ASSERT_TRUE(found.nearest);
  EXPECT_GT(found.nearest->violation, 1.0);
  EXPECT_FALSE(found.nearest->start_x);
  const auto outcome = evaluate_dig(machine_, simulator(40.0), unknown, found.nearest->parameters,
                                    StartRule::Kind::least_work);
  EXPECT_EQ(found.nearest->reason, describe(std::get<DigFailure>(outcome)));
}

TEST_F(Planner, WhereTheMachineAlwaysStallsTheNearestDigIsTheOneThatGoesOnLongest) {
  const Machine weak = weakened(8e3);
  const HeightMapSimulator hard(weak, soil_, 100.0), medium(weak, soil_, 90.0);
  const auto found = search_dig(weak, hard, level_, small_search());
  ASSERT_FALSE(found);
  ASSERT_TRUE(found.nearest && found.nearest->start_x);
  const auto share_left = [&](const DigParameters& dig, const StartRule& start) {
    const auto outcome = evaluate_dig(weak, hard, level_, dig, start);
    const Stall& stall = std::get<Stall>(std::get<DigFailure>(outcome));
    const double share = stall.travelled / (dig.penetration_length + dig.drag_length);
    return std::clamp(1.0 - share, 0.01, 1.0);
  };
  const DigParameters& nearest = found.nearest->parameters;
  EXPECT_NEAR(found.nearest->violation, share_left(nearest, *found.nearest->start_x), 1e-12);
  EXPECT_EQ(found.nearest->reason, describe(std::get<DigFailure>(evaluate_dig(
                                       weak, hard, level_, nearest, *found.nearest->start_x))));
  EXPECT_LT(found.nearest->violation, share_left(paper_fixed_path(), StartRule::Kind::least_work));

  DigSearchOptions second = small_search();
  ++second.seed;
  const auto softer = search_dig(weak, medium, level_, second);
  ASSERT_FALSE(softer);
  const auto uncertain = search_dig(weak, {{&hard, 0.5}, {&medium, 0.5}}, level_, small_search());
  ASSERT_FALSE(uncertain);
  ASSERT_TRUE(uncertain.nearest);
  EXPECT_EQ(uncertain.nearest->violation,
            std::min(found.nearest->violation, softer.nearest->violation));
}

TEST_F(Planner, AStallIsAReason) {
  const Machine weak = weakened(15e3);
  const HeightMapSimulator hard(weak, soil_, 100.0);
  const auto outcome = evaluate_dig(weak, hard, level_, paper_fixed_path());
  const std::string text = describe(std::get<DigFailure>(outcome));
  EXPECT_NE(text.find("stalls in the phase"), std::string::npos) << text;
}

TEST_F(Planner, PlansWithAnySimulator) {
  const auto found = search_dig(machine_, HandMade(), level_, small_search());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->dig.parameters.drag_length, 1.0, 0.05);
}

TEST(BoomPlaneProfile, IsTheSurfaceInTheBoomPlane) {
  HeightMap map = flat_ground({0, -1, 4, 1}, 0.1);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      map.z(row, col) = 0.3 * map.x(col) + 0.2 * map.y(row);
    }
  }
  const GroundProfile profile = boom_plane_profile(map);
  EXPECT_NEAR(profile(2.0), 0.6, 1e-12);
  EXPECT_TRUE(std::isnan(profile(9.0)));
}

/// In a furrow the boom plane is its bottom, and one row of cells of a scan is off by its noise.
TEST(StartProfile, IsTheMedianUnderTheBucket) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  HeightMap map = flat_ground({0, -1.5, 6, 1.5}, 0.05);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row)
      map.z(row, col) = 0.1 * map.x(col) + std::min(0.0, std::abs(map.y(row)) - 0.5);
  }
  const double half = 0.5 * machine.bucket.width_outside;
  EXPECT_NEAR(start_profile(map, machine)(2.0), 0.2 + 0.5 * half - 0.5, 0.01);
  HeightMap noisy = map;
  const Eigen::Index middle = noisy.z.rows() / 2;
  noisy.z.middleRows(middle - 1, 2) += 0.05;
  EXPECT_NEAR(start_profile(noisy, machine)(2.0), start_profile(map, machine)(2.0), 1e-9);
  noisy.z.topRows(middle).setConstant(std::nan(""));
  EXPECT_TRUE(std::isfinite(start_profile(noisy, machine)(2.0)));
  noisy.z.topRows(middle + 2).setConstant(std::nan(""));
  EXPECT_TRUE(std::isnan(start_profile(noisy, machine)(2.0)));
  EXPECT_TRUE(std::isnan(start_profile(map, machine)(9.0)));
  EXPECT_EQ(start_profile(undisturbed(map), machine)(2.0), start_profile(map, machine)(2.0));
}

// The paper's regression (section 3.1): d = 161.57 k - 152.87, R2 = 0.9811; curvature of the exact
// law alone gives 0.983 (docs/methods.md#density-law).
TEST(Calibration, SimulatorFreedOfFallbackGivesThePapersLine) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const DensityCalibration calibration = calibrate_density(machine, loam);
  EXPECT_EQ(calibration.samples.size(), 21U);
  const auto line = std::get<DensityLine>(calibration.form("line"));
  EXPECT_NEAR(line.a, 161.57, 0.05 * 161.57);
  EXPECT_NEAR(line.b, -152.87, 0.05 * 152.87);
  EXPECT_GT(line.r2, 0.975);
  EXPECT_LT(line.r2, 0.990);
  for (const char* key : {"closed_form", "closed_form_as_measured"}) {
    EXPECT_GE(std::get<DensityClosedForm>(calibration.form(key)).r2, 0.999);
  }
  for (const auto& sample : calibration.samples) {
    EXPECT_NEAR(sample.bulking_factor, sample.bulking_factor_true, 1e-3);
    EXPECT_GE(sample.bulking_factor_measured, sample.bulking_factor_true - 2e-3);
  }
}

TEST(Calibration, TheShippedLawIsWhatTheSimulatorGives) {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const DensityCalibration calibration = calibrate_density(machine, loam);
  const DensityLaw law = load_density_law(find_data_file("laws/zx120-loam.json"));
  for (const auto& sample : calibration.samples) {
    EXPECT_NEAR(density_of_bulking(law.form, sample.bulking_factor_measured),
                density_of_bulking(calibration.form("closed_form_as_measured"),
                                   sample.bulking_factor_measured),
                0.01);
  }
}

}  // namespace
}  // namespace excavplan
