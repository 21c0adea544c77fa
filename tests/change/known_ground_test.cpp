// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/change/known_ground.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <excavplan/change/bulking.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/scans/ground_update.hpp>

#include "base/non_finite.hpp"
#include "base/random.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

/// A trench of 2 m x 0.8 m through a layer of loose soil, 0.10 m thick over its half, 0.30 m deep
/// in all; its soil lies 4 m away.
struct Trench {
  double bulking = 1.25;
  double fallen = 0.0;  ///< loose soil on its floor [m]
  double loose = 0.10;  ///< [m]

  static bool is_in(double x, double y) { return x > 0.0 && x < 2.0 && std::abs(y) < 0.4; }
  double loose_at(double x, double y) const {
    return x > 1.0 && x < 2.6 && std::abs(y) < 1.0 ? loose : 0.0;
  }
  double cut_at(double x, double y) const { return is_in(x, y) ? 0.30 - loose_at(x, y) : 0.0; }

  double loose_dug() const { return loose * 1.0 * 0.8; }
  double bank_cut() const { return 0.30 * 1.6 - loose_dug(); }
  double heap() const { return bulking * bank_cut() + loose_dug() - fallen * 1.6; }

  SurfacePair scene(double noise, std::uint64_t seed) const {
    Random random(seed, 1);
    SurfacePair pair;
    pair.before.height = flat_ground({-1.5, -2.0, 6.5, 2.0}, 0.05);
    pair.after.height = pair.before.height;
    const double height = heap() / (1.5 * 1.5);
    for (Eigen::Index row = 0; row < pair.before.height.z.rows(); ++row) {
      for (Eigen::Index col = 0; col < pair.before.height.z.cols(); ++col) {
        const double x = pair.before.height.x(col);
        const double y = pair.before.height.y(row);
        const double ground = loose_at(x, y);
        const double rise = std::abs(x - 4.75) < 0.75 && std::abs(y) < 0.75 ? height : 0.0;
        const double fall = is_in(x, y) ? 0.30 - fallen : 0.0;
        pair.before.height.z(row, col) = ground + noise * random.normal();
        pair.after.height.z(row, col) = ground + rise - fall + noise * random.normal();
      }
    }
    return pair;
  }

  KnownGround known(const HeightMap& map, bool path_is_told) const {
    const auto layer = [&](const std::function<double(double, double)>& value) {
      Eigen::ArrayXXd all(map.z.rows(), map.z.cols());
      for (Eigen::Index row = 0; row < all.rows(); ++row) {
        for (Eigen::Index col = 0; col < all.cols(); ++col)
          all(row, col) = value(map.x(col), map.y(row));
      }
      return all;
    };
    KnownGround ground;
    ground.loose = layer([&](double x, double y) { return loose_at(x, y); });
    if (!path_is_told) return ground;
    ground.cut = layer([&](double x, double y) { return cut_at(x, y); });
    ground.cover = layer([&](double x, double y) { return is_in(x, y) ? 1.0 : 0.0; });
    return ground;
  }
};

TEST(KnownGround, LooseSoilThatIsDugAgainDoesNotSwell) {
  const Trench trench;
  const SurfacePair scene = trench.scene(0.003, 1);
  const VolumeChange plain = measure_change(scene);
  const VolumeChange change = measure_change(scene, trench.known(scene.before.height, false));
  EXPECT_FALSE(plain.cut);
  ASSERT_TRUE(change.cut);
  EXPECT_EQ(change.excavated.value, plain.excavated.value);
  EXPECT_NEAR(change.cut->loose.value, trench.loose_dug(), 0.003);
  EXPECT_NEAR(change.before.value, trench.bank_cut(), 0.006);
  EXPECT_EQ(change.cut->bank.value, change.before.value);
  EXPECT_NEAR(change.cut->bank_share(), trench.bank_cut() / 0.48, 0.01);
  const auto k = bulking_factor(change);
  ASSERT_TRUE(k);
  EXPECT_NEAR(k->value, trench.bulking, 3.0 * k->sd);
  EXPECT_LT(k->sd, 0.03);
  EXPECT_GT(trench.bulking - bulking_factor(plain)->value, 0.03);
}

TEST(KnownGround, SoilThatFellBackBelongsToTheCutWhereItIsTold) {
  Trench trench;
  trench.fallen = 0.06;
  const SurfacePair scene = trench.scene(0.003, 2);
  const VolumeChange change = measure_change(scene, trench.known(scene.before.height, true));
  ASSERT_TRUE(change.cut);
  EXPECT_NEAR(change.cut->bank.value, trench.bank_cut(), 0.006);
  EXPECT_NEAR(change.cut->fallen, trench.fallen * 1.6, 0.006);
  EXPECT_NEAR(bulking_factor(change)->value, trench.bulking, 0.03);
  const VolumeChange untold = measure_change(scene, trench.known(scene.before.height, false));
  EXPECT_NEAR(untold.before.value, trench.bank_cut() - trench.fallen * 1.6, 0.008);
}

/// Of the trench's floor 0.4 m are not seen.
SurfacePair half_hidden(const Trench& trench, std::uint64_t seed) {
  SurfacePair scene = trench.scene(0.003, seed);
  HeightMap& after = scene.after.height;
  for (Eigen::Index row = 0; row < after.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < after.z.cols(); ++col) {
      const bool is_hidden =
          after.x(col) > -0.3 && after.x(col) < 0.4 && std::abs(after.y(row)) < 0.7;
      if (is_hidden) after.z(row, col) = std::nan("");
    }
  }
  return scene;
}

TEST(KnownGround, AFloorThatIsHiddenLiesWhereTheBucketPassed) {
  Trench trench;
  trench.fallen = 0.06;
  const SurfacePair scene = half_hidden(trench, 3);
  const VolumeChange told = measure_change(scene, trench.known(scene.before.height, true));
  EXPECT_NEAR(told.excavated.value, 0.24 * 1.6, 0.012);
  EXPECT_LT(told.excavated.sd, 0.02);
  EXPECT_EQ(std::count_if(told.warnings.begin(), told.warnings.end(),
                          [](const Warning& warning) { return warning.ends_trust; }),
            0);
  const AreaChange& area = told.areas.front();
  const auto at = [&](const Eigen::ArrayXXd& layer, double x, double y) {
    const HeightMap& grid = area.difference;
    return layer(static_cast<Eigen::Index>((y - grid.origin.y()) / grid.cell_size),
                 static_cast<Eigen::Index>((x - grid.origin.x()) / grid.cell_size));
  };
  EXPECT_TRUE(std::isnan(at(area.difference.z, 0.22, 0.02)));
  EXPECT_NEAR(at(area.filled, 0.22, 0.02), -0.24, 0.01);
  EXPECT_TRUE(std::isnan(at(area.filled, 1.02, 0.02)));
  const VolumeChange untold = measure_change(scene, trench.known(scene.before.height, false));
  EXPECT_GT(std::abs(untold.excavated.value - 0.24 * 1.6), 0.02);
}

TEST(KnownGround, AFloorThatNobodySawIsNotTrusted) {
  const Trench trench;
  SurfacePair scene = trench.scene(0.003, 5);
  HeightMap& after = scene.after.height;
  for (Eigen::Index row = 0; row < after.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < after.z.cols(); ++col) {
      const bool is_hidden =
          after.x(col) > 0.5 && after.x(col) < 2.3 && std::abs(after.y(row)) < 0.7;
      if (is_hidden) after.z(row, col) = std::nan("");
    }
  }
  const VolumeChange change = measure_change(scene, trench.known(scene.before.height, true));
  ASSERT_TRUE(change.cut);
  EXPECT_GT(change.cut->unseen_area, 0.5 * change.cut->swept_area);
  EXPECT_TRUE(std::any_of(change.warnings.begin(), change.warnings.end(), [](const Warning& each) {
    return each.code == WarningCode::zone_unseen;
  }));
}

TEST(KnownGround, SoilFarFromWhereTheBucketWasEmptiedIsNoHeap) {
  const Trench trench;
  const SurfacePair scene = trench.scene(0.003, 6);
  ChangeOptions options;
  options.heap_near = Rectangle{4.0, -1.0, 5.5, 1.0};
  EXPECT_NEAR(measure_change(scene, options).dumped.value, trench.heap(), 0.01);
  options.spill_distance = 3.0;  // the heap lies 2 m from the hole
  EXPECT_NEAR(measure_change(scene, options).dumped.value, trench.heap(), 0.01);
  options.spill_distance = ChangeOptions().spill_distance;
  options.heap_near = Rectangle{1.0, 1.2, 3.0, 2.0};
  EXPECT_EQ(measure_change(scene, options).dumped.value, 0.0);
}

TEST(KnownGround, WhatWasGuessedBeforeIsInTheError) {
  const Trench trench;
  const SurfacePair scene = trench.scene(0.003, 4);
  KnownGround known = trench.known(scene.before.height, true);
  const double sure = measure_change(scene, known).excavated.sd;
  known.guessed_sd = known.cover * 0.1;
  const double guessed = measure_change(scene, known).excavated.sd;
  EXPECT_NEAR(std::sqrt(guessed * guessed - sure * sure), 0.1 * 1.6, 0.02);
}

TEST(KnownGround, GroundWithoutLooseSoilIsAsUnknownGround) {
  Trench trench;
  trench.loose = 0.0;
  const SurfacePair scene = trench.scene(0.003, 3);
  const VolumeChange plain = measure_change(scene);
  const VolumeChange change = measure_change(scene, trench.known(scene.before.height, false));
  EXPECT_NEAR(change.before.value, plain.before.value, 1e-12);
  EXPECT_NEAR(change.after.value, plain.after.value, 1e-12);
  EXPECT_EQ(change.cut->loose.value, 0.0);
  EXPECT_EQ(change.cut->bank_share(), 1.0);
}

TEST(KnownGround, ADigThatLeftNoHoleEndsTrust) {
  const Trench trench;
  const SurfacePair dug = trench.scene(0.003, 4);
  const SurfacePair still = {dug.before, trench.scene(0.003, 5).before, {}};
  const auto ends_trust = [](const VolumeChange& change) {
    return std::any_of(change.warnings.begin(), change.warnings.end(), [](const Warning& each) {
      return each.code == WarningCode::no_hole_found && each.ends_trust;
    });
  };
  EXPECT_TRUE(ends_trust(measure_change(still, trench.known(dug.before.height, false))));
  EXPECT_FALSE(ends_trust(measure_change(dug, trench.known(dug.before.height, false))));
  EXPECT_FALSE(ends_trust(measure_change(still))) << "nobody says that there was a dig";
}

TEST(KnownGround, ALayerOfAnotherSizeIsRefused) {
  const Trench trench;
  const SurfacePair scene = trench.scene(0.003, 1);
  KnownGround known = trench.known(scene.before.height, false);
  known.swelling.setZero(3, 4);
  EXPECT_EQ(test::error_of([&] { measure_change(scene, known); }).substr(0, 41),
            "known ground: a layer of 3 x 4 cells, mus");
}

// ---- The ground after ---------------------------------------------------------------------------

GroundState state_of(const Eigen::ArrayXXd& bank, const Eigen::ArrayXXd& loose) {
  GroundState state;
  state.terrain = undisturbed({{0.0, 0.0}, 0.5, bank});
  state.terrain.loose = loose;
  state.seen.setConstant(bank.rows(), bank.cols(), 100.0);
  state.deviation.setConstant(bank.rows(), bank.cols(), 0.01);
  return state;
}

SeenGround seen_as(const Eigen::ArrayXXd& heights, double sd) {
  SeenGround seen;
  seen.surface = {{0.0, 0.0}, 0.5, heights};
  seen.deviation.setConstant(heights.rows(), heights.cols(), sd);
  seen.time = 200.0;
  return seen;
}

TEST(UpdatedGround, WhatDidNotChangeIsTheMeanOfLeastVariance) {
  const auto one = [](double value) { return Eigen::ArrayXXd::Constant(1, 1, value); };
  SeenGround seen = seen_as(one(0.32), 0.01);
  seen.common_sd = 0.0;
  const GroundState after = updated_ground(state_of(one(0.2), one(0.1)), seen);
  EXPECT_NEAR(after.terrain.bank.z(0, 0), 0.21, 1e-12);
  EXPECT_EQ(after.terrain.loose(0, 0), 0.1);
  EXPECT_NEAR(after.deviation(0, 0), 0.01 / std::sqrt(2.0), 1e-9);
  EXPECT_EQ(after.seen(0, 0), 200.0);
}

TEST(UpdatedGround, ASurveyBetweenTheCellsIsNotMoved) {
  const auto sloping = [](double offset) {
    HeightMap map = flat_ground({offset, offset, 2.0 + offset, 2.0 + offset}, 0.05);
    for (Eigen::Index col = 0; col < map.z.cols(); ++col) map.z.col(col).setConstant(map.x(col));
    return map;
  };
  const HeightMap truth = sloping(0.0);
  GroundState unknown;
  unknown.terrain = undisturbed(truth);
  unknown.terrain.bank.z.setConstant(nan);
  SeenGround seen;
  seen.surface = sloping(0.017);
  const HeightMap& bank = updated_ground(unknown, seen).terrain.bank;
  EXPECT_LT((bank.z - truth.z).block(1, 1, 38, 38).abs().maxCoeff(), 1e-9);
}

TEST(UpdatedGround, TheErrorThatASurveySharesStays) {
  const auto one = [](double value) { return Eigen::ArrayXXd::Constant(1, 1, value); };
  GroundState state = state_of(one(0.2), one(0.0));
  for (int i = 0; i < 1000; ++i) state = updated_ground(state, seen_as(one(0.2), 0.005));
  EXPECT_GE(state.deviation(0, 0), SeenGround{}.common_sd);
  EXPECT_LT(state.deviation(0, 0), 1.1 * SeenGround{}.common_sd);
}

TEST(UpdatedGround, BankIsTheLowestThatWasEverSeenOrSwept) {
  Eigen::ArrayXXd bank(1, 5);
  bank << 0.0, 0.0, 0.0, 0.0, nan;
  Eigen::ArrayXXd loose(1, 5);
  loose << 0.1, 0.0, 0.0, 0.0, 0.0;
  Eigen::ArrayXXd heights(1, 5);
  heights << -0.2, 0.3, -0.1, nan, 0.4;
  SeenGround seen = seen_as(heights, 0.002);
  seen.changed = Eigen::ArrayXXi::Ones(1, 5);
  seen.swept.setConstant(1, 5, nan);
  seen.swept(0, 2) = -0.25;
  const GroundState after = updated_ground(state_of(bank, loose), seen);
  EXPECT_NEAR(after.terrain.bank.z(0, 0), -0.2, 1e-12);
  EXPECT_NEAR(after.terrain.loose(0, 0), 0.0, 1e-12);
  EXPECT_NEAR(after.terrain.bank.z(0, 1), 0.0, 1e-12);
  EXPECT_NEAR(after.terrain.loose(0, 1), 0.3, 1e-12);
  EXPECT_NEAR(after.terrain.bank.z(0, 2), -0.25, 1e-12);
  EXPECT_NEAR(after.terrain.loose(0, 2), 0.15, 1e-12);
  EXPECT_EQ(after.terrain.bank.z(0, 3), 0.0);
  EXPECT_EQ(after.seen(0, 3), 100.0);
  EXPECT_NEAR(after.terrain.bank.z(0, 4), 0.4, 1e-12);
  EXPECT_EQ(after.terrain.loose(0, 4), 0.0);
}

TEST(UpdatedGround, WhatNobodyDugIsNoLongerKnownWell) {
  const auto one = [](double value) { return Eigen::ArrayXXd::Constant(1, 1, value); };
  const GroundState after = updated_ground(state_of(one(0.2), one(0.0)), seen_as(one(0.5), 0.002));
  EXPECT_NEAR(after.terrain.bank.z(0, 0), 0.2, 1e-12);
  EXPECT_NEAR(after.terrain.loose(0, 0), 0.3, 1e-12);
  EXPECT_EQ(after.deviation(0, 0), reopened_sd);
}

TEST(UpdatedGround, WhatABalanceFilledStandsUntilItIsSeen) {
  const auto one = [](double value) { return Eigen::ArrayXXd::Constant(1, 1, value); };
  const GroundState before = state_of(one(0.30), one(0.0));
  SeenGround hidden = seen_as(one(nan), 0.002);
  hidden.changed = Eigen::ArrayXXi::Ones(1, 1);
  hidden.filled = one(0.70);
  const GroundState filled = updated_ground(before, hidden);
  EXPECT_EQ(filled.terrain.bank.z(0, 0), 0.30);
  EXPECT_NEAR(filled.terrain.loose(0, 0), 0.40, 1e-12);
  EXPECT_NEAR(filled.deviation(0, 0), 0.20, 1e-12);
  EXPECT_EQ(filled.seen(0, 0), 100.0);
  SeenGround seen = seen_as(one(0.60), 0.002);
  seen.changed = Eigen::ArrayXXi::Zero(1, 1);
  const GroundState after = updated_ground(filled, seen);
  EXPECT_EQ(after.terrain.bank.z(0, 0), 0.30);
  EXPECT_NEAR(after.terrain.loose(0, 0), 0.30, 1e-12);
  EXPECT_LT(after.deviation(0, 0), 0.01);
}

TEST(UpdatedGround, ThingsInTheWayAreNotedAndTheGroundBelowStays) {
  const auto one = [](double value) { return Eigen::ArrayXXd::Constant(1, 1, value); };
  SeenGround seen = seen_as(one(nan), 0.002);
  seen.obstacles = one(1.5);
  const GroundState after = updated_ground(state_of(one(0.2), one(0.1)), seen);
  EXPECT_EQ(after.terrain.obstacles(0, 0), 1.5);
  EXPECT_EQ(after.terrain.bank.z(0, 0), 0.2);
  const GroundState gone = updated_ground(after, seen_as(one(0.3), 0.01));
  EXPECT_TRUE(std::isnan(gone.terrain.obstacles(0, 0)));
}

TEST(UpdatedGround, DugSoilMixesWithTheLooseSoilThatLayThere) {
  const auto one = [](double value) { return Eigen::ArrayXXd::Constant(1, 1, value); };
  GroundState state = state_of(one(0.0), one(0.1));
  state.terrain.loose_void_ratio = one(0.8);
  SeenGround seen = seen_as(one(0.3), 0.002);
  seen.changed = Eigen::ArrayXXi::Ones(1, 1);
  const GroundState after = updated_ground(state, seen, 1.0);
  const double solids = 0.1 / 1.8 + 0.2 / 2.0;
  EXPECT_NEAR(after.terrain.loose_void_ratio(0, 0), 0.3 / solids - 1.0, 1e-12);
}

}  // namespace
}  // namespace excavplan
