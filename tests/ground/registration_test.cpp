// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <excavplan/ground/registration.hpp>
#include "base/random.hpp"

#include "base/non_finite.hpp"
#include "support/errors.hpp"
#include "support/survey_scenes.hpp"

namespace excavplan {
namespace {

using scenes::degree;
using scenes::Ground;
using scenes::ScanErrors;

constexpr double cell_of_scans = 0.05;

ScanErrors rough_ground() {
  ScanErrors errors;
  errors.slope = 8.0 * degree;
  errors.roughness = 0.02;
  return errors;
}

/// Heights of a ground moved rigidly, found where the vertical line meets it.
template <typename Height>
Surface surface_of(const Height& height, const Eigen::Isometry3d& motion, double noise,
                   std::uint64_t seed) {
  Random random(seed);
  Surface surface;
  surface.height = flat_ground(scenes::dig_extent, cell_of_scans);
  const Eigen::Isometry3d back = motion.inverse();
  for (Eigen::Index col = 0; col < surface.height.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < surface.height.z.rows(); ++row) {
      const Eigen::Vector2d at(surface.height.x(col), surface.height.y(row));
      double z = height(at.x(), at.y());
      for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3d origin = back * Eigen::Vector3d(at.x(), at.y(), z);
        z += height(origin.x(), origin.y()) - origin.z();
      }
      surface.height.z(row, col) = z + noise * random.normal();
    }
  }
  return surface;
}

/// The motion as Alignment states it, about a centre.
Eigen::Isometry3d about(const Eigen::Vector3d& centre, const Eigen::Vector3d& shift,
                        const Eigen::Vector3d& turn) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(centre + shift);
  motion.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  motion.translate(-centre);
  return motion;
}

const Eigen::Vector3d shift(0.010, -0.008, 0.005);
const Eigen::Vector3d turn(0.2 * degree, -0.15 * degree, 0.3 * degree);

TEST(Align, FindsEveryPartOfAMotionOnRoughGround) {
  const Ground ground(rough_ground(), 3);
  const Surface before = surface_of(ground, Eigen::Isometry3d::Identity(), 0.001, 1);
  const Surface after = surface_of(ground, about(Eigen::Vector3d::Zero(), shift, turn), 0.001, 2);
  const Alignment found = align(before, after);
  EXPECT_TRUE(found.vertical_is_significant);
  EXPECT_TRUE(found.lateral_is_significant);
  for (const bool supported : found.supported) EXPECT_TRUE(supported);
  EXPECT_GT(found.stable_share, 0.95);
  const Eigen::Matrix4d rest =
      found.correction() * about(Eigen::Vector3d::Zero(), shift, turn).matrix();
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(-3, -2.5), Eigen::Vector2d(3, 2.5)}) {
    const Eigen::Vector4d point(corner.x(), corner.y(), ground(corner.x(), corner.y()), 1.0);
    const Eigen::Vector3d miss = (rest * point - point).head<3>();
    EXPECT_LT(miss.head<2>().norm(), 0.005) << "a tenth of a cell";
    EXPECT_LT(std::abs(miss.z()), 0.001);
  }
}

TEST(Align, ItsErrorsAreAsLargeAsItSays) {
  double squares = 0.0;
  constexpr int scans = 30;
  for (std::uint64_t seed = 1; seed <= scans; ++seed) {
    const Ground ground(rough_ground(), seed);
    const Surface before = surface_of(ground, Eigen::Isometry3d::Identity(), 0.002, 2 * seed);
    const Alignment found =
        align(before, surface_of(ground, Eigen::Isometry3d::Identity(), 0.002, 2 * seed + 1));
    const Motion& motion = found.found;
    squares += motion.dot(found.covariance.ldlt().solve(motion)) / 6.0;
  }
  EXPECT_GT(squares / scans, 0.3);
  EXPECT_LT(squares / scans, 1.5);
}

TEST(Align, WhatTheSceneDoesNotShowStaysAtZero) {
  const auto level = [](double, double) { return 0.0; };
  const Surface before = surface_of(level, Eigen::Isometry3d::Identity(), 0.002, 1);
  const Surface after = surface_of(level, about(Eigen::Vector3d::Zero(), shift, turn), 0.002, 2);
  const Alignment found = align(before, after);
  EXPECT_TRUE(found.vertical_is_significant);
  EXPECT_FALSE(found.lateral_is_significant);
  EXPECT_NEAR(found.motion(2), shift.z(), 0.0002);
  EXPECT_NEAR(found.motion(3), turn.x(), 0.0001);
  EXPECT_NEAR(found.motion(4), turn.y(), 0.0001);
  for (const int i : {0, 1, 5}) {
    EXPECT_EQ(found.motion(i), 0.0);
    EXPECT_FALSE(found.supported[static_cast<std::size_t>(i)]);
  }
  EXPECT_GT(std::sqrt(found.covariance(0, 0)), 0.015) << "about its prior, 20 mm";
}

TEST(Align, EdgesOfAHoleOnLevelGroundDoNotPassForAShift) {
  const auto level = [](double, double) { return 0.0; };
  const auto hole = [](double x, double y) {
    const double inside = std::min({x + 1.1, 1.0 - x, y + 0.5, 0.45 - y});
    return -std::clamp(1.2 * inside, 0.0, 0.3);
  };
  const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Alignment found = align(surface_of(level, still, 0.008, 2 * seed),
                                  surface_of(hole, still, 0.008, 2 * seed + 1));
    EXPECT_FALSE(found.lateral_is_significant) << found.found.transpose();
    EXPECT_LT(found.found.head<2>().norm(), 0.01) << found.found.transpose();
  }
}

TEST(Align, ScansThatDidNotMoveAreLeftAlone) {
  int applied = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Ground ground(rough_ground(), seed);
    const Alignment found =
        align(surface_of(ground, Eigen::Isometry3d::Identity(), 0.003, 2 * seed),
              surface_of(ground, Eigen::Isometry3d::Identity(), 0.003, 2 * seed + 1));
    applied += found.motion.isZero() ? 0 : 1;
  }
  EXPECT_LE(applied, 2) << "one in fifty by chance";
}

TEST(Align, SurvivesFortyPerCentOfChangedGround) {
  const Ground ground(rough_ground(), 5);
  const Surface before = surface_of(ground, Eigen::Isometry3d::Identity(), 0.002, 1);
  Surface after = surface_of(ground, about(Eigen::Vector3d::Zero(), shift, turn), 0.002, 2);
  const Alignment undisturbed = align(before, after);
  for (Eigen::Index col = 0; col < after.height.z.cols() * 4 / 10; ++col) {
    for (Eigen::Index row = 0; row < after.height.z.rows(); ++row) {
      after.height.z(row, col) -= 0.25 + 0.05 * std::sin(0.3 * static_cast<double>(row));
    }
  }
  const Alignment found = align(before, after);
  EXPECT_NEAR(found.stable_share, 0.6, 0.02);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found.motion(i), undisturbed.motion(i), 0.002);
  for (int i = 3; i < 6; ++i) EXPECT_NEAR(found.motion(i), undisturbed.motion(i), 0.001);
}

double heap(double x, double y, double height) {
  return std::max(0.0, height - 0.7 * std::hypot(x, y));
}

/// Of ground that was known, away from where the machine worked.
AlignmentOptions known_ground() {
  AlignmentOptions options;
  options.left_out = Rectangle{-3.0, -2.5, -2.0, -2.0};
  return options;
}

using Heights = std::function<double(double, double)>;

/// Of ground that was known, from scans with a noise of 10 mm.
Alignment aligned(const Heights& before, const Heights& after, std::uint64_t seed) {
  const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
  return align(surface_of(before, still, 0.01, 2 * seed),
               surface_of(after, still, 0.01, 2 * seed + 1), known_ground());
}

/// By centimetres.
class HeapThatGrew : public testing::TestWithParam<int> {
 protected:
  double growth() const { return 0.01 * GetParam(); }
};

constexpr std::uint64_t scans = 4;

TEST_P(HeapThatGrew, EvenlyIsNoShiftOfKnownGround) {
  for (const double beside : {0.0, 0.5}) {
    const auto grown = [&](double by) {
      return [=](double x, double y) {
        return std::max(heap(x + 0.9, y + 0.8, 0.7 + by), heap(x - 1.5, y - 1.2, beside));
      };
    };
    for (std::uint64_t seed = 1; seed <= scans; ++seed) {
      const Alignment found = aligned(grown(0.0), grown(growth()), seed);
      EXPECT_FALSE(found.lateral_is_significant) << seed << ": " << found.found.transpose();
      EXPECT_EQ(found.motion(0), 0.0);
      EXPECT_EQ(found.motion(1), 0.0);
    }
  }
}

TEST_P(HeapThatGrew, OnOneSideIsNoShiftOfKnownGround) {
  const auto grown = [&](double by) {
    return [=](double x, double y) {
      return std::max(heap(x + 0.9, y + 0.8, x > -0.9 ? 0.7 + by : 0.7),
                      heap(x - 1.5, y - 1.2, 0.5));
    };
  };
  for (std::uint64_t seed = 1; seed <= scans; ++seed) {
    const Alignment found = aligned(grown(0.0), grown(growth()), seed);
    EXPECT_EQ(found.motion(0), 0.0) << seed << ": " << found.found.transpose();
    EXPECT_EQ(found.motion(1), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Align, HeapThatGrew, testing::Values(2, 4, 6, 8, 9));

TEST(Align, OneHeapOfKnownGroundIsTooFewForAShift) {
  const auto one = [](double x, double y) { return heap(x, y, 0.7); };
  const auto moved = [](double x, double y) { return heap(x - 0.05, y, 0.7); };
  const Alignment found = aligned(one, moved, 1);
  EXPECT_EQ(found.motion(0), 0.0) << "its soil may have been pushed from one side to the other";
}

TEST(Align, HeapsThatWerePushedDifferentWaysShowNoShift) {
  const auto heaps = [](double push) {
    return [=](double x, double y) {
      return std::max({heap(x - 2.0 - push, y - 1.5, 0.5), heap(x + 2.0 - push, y - 1.5, 0.5),
                       heap(x - 2.0, y + 1.4 - push, 0.5), heap(x + 0.4, y + 1.4 + push, 0.5),
                       heap(x, y - 1.5 + push, 0.5)});
    };
  };
  const Alignment found = aligned(heaps(0.0), heaps(0.06), 1);
  EXPECT_EQ(found.motion(0), 0.0) << "two of five agree";
  EXPECT_EQ(found.motion(1), 0.0);
}

TEST(Align, FlanksThatFaceOneWayDoNotTellGrowthFromAShift) {
  const auto benches = [](double grown) {
    return [=](double x, double) {
      return std::clamp(0.7 * (x + 2.0) + grown, 0.0, 0.5) +
             std::clamp(0.7 * (x - 1.0) + grown, 0.0, 0.5);
    };
  };
  const Alignment found = aligned(benches(0.0), benches(0.04), 1);
  EXPECT_EQ(found.motion(0), 0.0) << found.found.transpose();
}

TEST(Align, HeapsOfKnownGroundThatNobodyTouchedShowAShift) {
  const Eigen::Vector3d moved(0.05, -0.04, 0.0);
  const Eigen::Isometry3d motion(Eigen::Translation3d{moved});
  for (const double growth : {0.0, 0.06}) {
    const auto heaps = [](double grown) {
      return [=](double x, double y) {
        return heap(x - 1.5, y - 1.2, 0.7) + heap(x + 1.2, y - 0.8, 0.6) +
               heap(x - 1.2, y + 1.4, 0.5 + grown);
      };
    };
    const Alignment found = align(surface_of(heaps(0.0), Eigen::Isometry3d::Identity(), 0.005, 1),
                                  surface_of(heaps(growth), motion, 0.005, 2), known_ground());
    EXPECT_TRUE(found.lateral_is_significant) << growth;
    EXPECT_NEAR(found.motion(0), moved.x(), 0.01) << growth;
    EXPECT_NEAR(found.motion(1), moved.y(), 0.01) << growth;
  }
}

TEST(Align, GroundOfWhichNoCellIsAsItWasShowsNoMotion) {
  Surface before;
  before.height = flat_ground({0, 0, 6, 6}, 0.1);
  Surface after = before;
  const std::array<double, 3> furrows = {0.0, 0.17, 0.07};  // where level, their slope is not
  for (Eigen::Index col = 0; col < after.height.z.cols(); ++col) {
    after.height.z.col(col) = furrows[static_cast<std::size_t>(col % 3)];
  }
  const Alignment found = align(before, after);
  EXPECT_TRUE(found.motion.isZero());
  EXPECT_EQ(found.stable_share, 0.0);
  EXPECT_LT(found.residual_sd, 1.0);
  EXPECT_TRUE(found.left.allFinite());
}

TEST(Align, RealignedMapsAgreeOnStableGround) {
  const Ground ground(rough_ground(), 7);
  const Surface before = surface_of(ground, Eigen::Isometry3d::Identity(), 0.0, 1);
  const Surface after = surface_of(ground, about(Eigen::Vector3d::Zero(), shift, turn), 0.0, 2);
  const Alignment found = align(before, after);
  const auto rms = [&](const HeightMap& map) {
    return std::sqrt((map.z - before.height.z).square().mean());
  };
  EXPECT_GT(rms(after.height), 0.005);
  EXPECT_LT(rms(realigned(after.height, found)), 0.0008);
}

TEST(Align, CentreAndShiftAreTold) {
  Alignment alignment;
  alignment.centre = {1.0, 2.0, 0.5};
  alignment.motion << 0.1, 0.0, 0.0, 0.0, 0.0, 0.01;
  const Eigen::Vector4d centre(1.0, 2.0, 0.5, 1.0);
  EXPECT_NEAR((alignment.correction() * centre - centre).head<3>().norm(), 0.1, 1e-12);
  const HeightMap map = flat_ground({0.0, 2.0, 1.0, 4.0}, 0.1);
  EXPECT_NEAR(alignment.largest_shift(map), std::hypot(0.1, 0.01), 1e-4)
      << "the corner at (0, 2), which the turn moves by (0, -0.01)";
}

TEST(Align, SurfacesThatDoNotFitAreRefused) {
  const auto message = [](const Surface& before, const Surface& after,
                          const AlignmentOptions& options = {}) {
    return test::error_of([&] { align(before, after, options); });
  };
  Surface one;
  one.height = flat_ground({0, 0, 2, 2}, 0.1);
  Surface other;
  other.height = flat_ground({0, 0, 2, 2.1}, 0.1);
  EXPECT_EQ(message(one, other),
            "align: the surfaces must be on one grid: same origin, cell and size");
  Surface unseen = one;
  unseen.height.z.setConstant(nan);
  EXPECT_EQ(message(one, unseen),
            "the surfaces share 0 known cells with known neighbours and no steep gradient, "
            "at least 100 are needed: do they overlap, with points enough for cells of 0.10 m?");
  AlignmentOptions of_known_ground;
  of_known_ground.left_out = Rectangle{0.0, 0.0, 1.0, 1.0};
  EXPECT_EQ(message(one, unseen, of_known_ground), message(one, unseen));
  AlignmentOptions options;
  options.turn_prior = 0.0;
  EXPECT_EQ(message(one, one, options), "align: turn_prior is 0, must be positive and finite");
}

}  // namespace
}  // namespace excavplan
