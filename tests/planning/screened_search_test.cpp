// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/planning/screened_search.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/non_finite.hpp"

namespace excavplan {
namespace {

DigSearchOptions small_search(unsigned threads) {
  DigSearchOptions options = budget_search();
  options.threads = threads;
  options.stop.evaluations = 150;
  return options;
}

class ScreenedSearch : public testing::Test {
 protected:
  Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  SoilKind soil_ = load_soil(find_data_file("soils/loam.json"));
  HeightMapSimulator simulator_{machine_, soil_, 40.0};
};

TEST_F(ScreenedSearch, FindsADigOfTheGroundItself) {
  const Terrain ground = sloped_planning_ground(machine_, 0.1, 0.05);
  const auto screened = search_screened(machine_, simulator_, ground, small_search(1));
  ASSERT_TRUE(screened);
  const auto usual = search_dig(machine_, simulator_, ground, small_search(1));
  ASSERT_TRUE(usual);
  EXPECT_GT(screened->worth, 0.97 * usual->worth);
  const auto again =
      evaluate_dig(machine_, simulator_, ground, screened->dig.parameters, screened->dig.start_x);
  ASSERT_TRUE(std::holds_alternative<PlannedDig>(again));
  EXPECT_EQ(std::get<PlannedDig>(again).payload_mass, screened->dig.payload_mass);
  EXPECT_LE(screened->evaluations, 150 + Screening().confirmed);
}

TEST_F(ScreenedSearch, IsTheSameForAnyNumberOfThreads) {
  const Terrain ground = level_planning_ground(machine_);
  const auto one = search_screened(machine_, simulator_, ground, small_search(1));
  const auto three = search_screened(machine_, simulator_, ground, small_search(3));
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->worth, three->worth);
  EXPECT_EQ(one->dig.start_x, three->dig.start_x);
}

/// Stalls in fine steps.
class CoarseStepsOnly : public SoilSimulator {
 public:
  explicit CoarseStepsOnly(const SoilSimulator& other) : other_(other) {}
  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override {
    DigResult result = other_.dig(terrain, path, options);
    const double step = (path.poses[1].bucket.x - path.poses[0].bucket.x);
    if (std::abs(step) < 0.02) result.stall = Stall();
    return result;
  }

 private:
  const SoilSimulator& other_;
};

TEST_F(ScreenedSearch, CancelledBeforeADigInFineStepsItSaysSo) {
  const CoarseStepsOnly simulator(simulator_);
  DigSearchOptions options = small_search(1);
  options.progress = [](const SearchProgress& now) { return now.evaluations < 100; };
  const auto found = search_screened(machine_, simulator, level_planning_ground(machine_), options);
  EXPECT_FALSE(found);
  EXPECT_TRUE(found.stopped);
}

/// Keeps the numbers of the digs that it made.
class Noting : public SoilSimulator {
 public:
  explicit Noting(const SoilSimulator& other) : other_(other) {}
  DigResult dig(const Terrain& terrain, const DigPath& path,
                const DigOptions& options) const override {
    made.push_back(path.parameters);
    return other_.dig(terrain, path, options);
  }

  mutable std::vector<DigParameters> made;

 private:
  const SoilSimulator& other_;
};

/// Before any is polished: of 45 % of the digs some 15 % do not drag.
TEST_F(ScreenedSearch, LooksAtDigsThatDoNotDragToo) {
  const Noting simulator(simulator_);
  DigSearchOptions options = small_search(1);
  ASSERT_TRUE(search_screened(machine_, simulator, level_planning_ground(machine_), options));
  const auto first = simulator.made.begin();
  const auto without = std::count_if(
      first, first + 67, [](const DigParameters& dig) { return dig.drag_length == 0.0; });
  EXPECT_GT(without, 5);
  EXPECT_LT(without, 25);
}

TEST_F(ScreenedSearch, AFewDigsAreASearchToo) {
  for (const int digs : {1, 2, 5}) {
    DigSearchOptions options = small_search(1);
    options.stop.evaluations = digs;
    EXPECT_TRUE(search_screened(machine_, simulator_, level_planning_ground(machine_), options))
        << digs;
  }
  DigSearchOptions endless = small_search(1);
  endless.stop.evaluations = 100000000;
  EXPECT_THROW(search_screened(machine_, simulator_, level_planning_ground(machine_), endless),
               Error);
}

TEST(CoarserGround, HoldsAsMuchSoil) {
  Terrain ground = undisturbed(flat_ground({0.0, 0.0, 0.4, 0.6}, 0.1));
  ground.bank.z(0, 0) = 0.4;
  ground.loose(1, 1) = 0.8;
  ground.bank.z(5, 3) = std::numeric_limits<double>::quiet_NaN();
  ground.loose_void_ratio.setConstant(6, 4, 1.0);
  ground.loose_void_ratio(1, 1) = 0.8;
  const Terrain coarse = coarser(ground, 2);
  EXPECT_EQ(coarse.bank.z.rows(), 3);
  EXPECT_EQ(coarse.bank.z.cols(), 2);
  EXPECT_DOUBLE_EQ(coarse.bank.cell_size, 0.2);
  EXPECT_DOUBLE_EQ(coarse.bank.z(0, 0), 0.1);
  EXPECT_DOUBLE_EQ(coarse.loose(0, 0), 0.2);
  EXPECT_NEAR(coarse.loose_void_ratio(0, 0), 0.8, 1e-6);
  EXPECT_DOUBLE_EQ(coarse.bank.z(2, 1), 0.0);
  EXPECT_THROW(coarser(ground, 0), Error);
}

TEST(CoarserGround, DoesNotKnowWhatNoCellTells) {
  Terrain ground = undisturbed(flat_ground({0.0, 0.0, 0.4, 0.4}, 0.1));
  ground.bank_void_ratio.setConstant(4, 4, nan);
  ground.loose_void_ratio.setConstant(4, 4, nan);
  const Terrain coarse = coarser(ground, 2);
  EXPECT_TRUE(coarse.bank_void_ratio.isNaN().all());
  EXPECT_TRUE(coarse.loose_void_ratio.isNaN().all());
  EXPECT_TRUE((coarse.bank.z == 0.0).all());
}

// The mean of equal values of different weight may round to a value above all of them, which the
// simulator would refuse as looser than the loosest.
TEST(CoarserGround, KeepsAStateThatIsTheSameEverywhere) {
  Terrain ground = undisturbed(flat_ground({0.0, 0.0, 0.4, 0.4}, 0.1));
  for (const double state : {1.283, 0.7, 1.1}) {
    ground.loose_void_ratio.setConstant(4, 4, state);
    for (int i = 1; i <= 50; ++i) {
      ground.loose = Eigen::ArrayXXd::Random(4, 4).abs();
      EXPECT_TRUE((coarser(ground, 2).loose_void_ratio == state).all());
    }
  }
}

}  // namespace
}  // namespace excavplan
