// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <excavplan/change/bulking.hpp>
#include <excavplan/change/volume_change.hpp>

#include "base/random.hpp"
#include "change/attribution.hpp"
#include "support/survey_scenes.hpp"

namespace excavplan {
namespace {

using scenes::Dig;
using Shape = std::function<double(double x, double y)>;

constexpr Rectangle extent = scenes::whole_extent;

double dug(double x, double y) { return scenes::change_at(Dig{}, scenes::Part::whole, x, y); }

double box(double x, double y, const Rectangle& r, double height) {
  return r.contains(x, y) ? height : 0.0;
}

/// A cone of 35 degrees.
double cone(double x, double y, const Eigen::Vector2d& centre, double radius) {
  const double away = std::hypot(x - centre.x(), y - centre.y());
  return std::max(0.0, (radius - away) * std::tan(35.0 * scenes::degree));
}
double cone_volume(double radius) {
  return pi / 3.0 * std::pow(radius, 3) * std::tan(35.0 * scenes::degree);
}

/// Mean heights of 5 cm cells.
HeightMap scanned(const Shape& shape, std::uint64_t scan, double noise = 0.002) {
  constexpr int fine = 4;
  Random random(5, scan);
  HeightMap map = flat_ground(extent, 0.05);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      double sum = 0.0;
      for (int i = 0; i < fine * fine; ++i) {
        sum += shape(map.x(col) + 0.05 * ((i % fine + 0.5) / fine - 0.5),
                     map.y(row) + 0.05 * ((i / fine + 0.5) / fine - 0.5));
      }
      map.z(row, col) = sum / (fine * fine) + noise * random.normal();
    }
  }
  return map;
}

VolumeChange change_of(const Shape& after, const ChangeOptions& options = {}) {
  static const HeightMap before = scanned([](double, double) { return 0.0; }, 1);
  return measure_change(before, scanned(after, 2), options);
}

bool warns(const VolumeChange& change, const std::string& code, bool ends_trust) {
  return std::any_of(change.warnings.begin(), change.warnings.end(), [&](const Warning& w) {
    return code_text(w.code) == code && w.ends_trust == ends_trust;
  });
}

/// The open change whose text begins so; fails the test without one.
AttributedChange open_change(const VolumeChange& change, const std::string& what) {
  for (const AttributedChange& open : change.attribution) {
    if (open.what.rfind(what, 0) == 0) return open;
  }
  ADD_FAILURE() << "no open change " << what;
  return {};
}

bool reads(const VolumeChange& change, double bulking) {
  return std::any_of(change.readings.begin(), change.readings.end(), [&](const Reading& r) {
    return std::abs(r.bulking.value - bulking) < 0.01 * bulking;
  });
}

const double hole = Dig{}.pit_volume();

TEST(Attribution, SceneWithoutDoubtHasTheDeviationOfItsScans) {
  const VolumeChange change = change_of(dug);
  EXPECT_NEAR(bulking_factor(change)->value, 1.25, 0.005);
  EXPECT_LE(bulking_factor(change)->sd, 1.5 * bulking_errors(change).scans);
  ASSERT_EQ(change.attribution.size(), 1u) << "the ground under the heap";
  EXPECT_FALSE(change.attribution[0].counted);
}

TEST(Attribution, GroundThatGaveWayUnderTheHeapIsOneOfTheReadings) {
  for (const double depth : {0.005, 0.01, 0.02, 0.03}) {
    const auto pressed = [&](double x, double y) {
      const double heap = Dig{}.dumped(x - scenes::dump_offset, y);
      return dug(x, y) - (heap > 0.0 ? std::min(depth, heap) : 0.0);
    };
    const VolumeChange change = change_of(pressed);
    ASSERT_FALSE(change.readings.empty());
    const Reading& reading = change.readings.back();
    ASSERT_EQ(reading.kinds, std::vector<ChangeKind>{ChangeKind::pressed});
    EXPECT_TRUE(is_unseen(reading));
    EXPECT_LE(std::abs(reading.bulking.value - 1.25), 2.0 * reading.bulking.sd) << depth;
    EXPECT_LT(reading.bulking.sd, 0.06);
  }
}

TEST(Attribution, HeapThinnerThanACentimetreHasNoReadingOfPressedGround) {
  constexpr double thickness = 0.006;
  const Rectangle pit = {-1.5, -0.9, 1.5, 0.9};
  const Rectangle heap = {3.2, -2.5, 7.7, 2.5};
  const auto thin = [&](double x, double y) {
    return box(x, y, pit, -0.02) + box(x, y, heap, thickness);
  };
  const auto level = [](double, double) { return 0.0; };
  const VolumeChange change =
      measure_change(scanned(level, 1, 0.0005), scanned(thin, 2, 0.0005), {});
  for (const AttributedChange& open : change.attribution) {
    EXPECT_EQ(open.what.find("gave way"), std::string::npos);
  }
  ASSERT_FALSE(change.readings.empty());
  EXPECT_NEAR(change.readings.front().bulking.value, 4.5 * 5.0 * thickness / (5.4 * 0.02), 0.1);
}

TEST(Attribution, SecondHeapIsCountedAndTheOtherReadingStated) {
  const double extra = cone_volume(0.4);
  const auto two = [](double x, double y) { return dug(x, y) + cone(x, y, {3.2, -1.8}, 0.4); };
  const VolumeChange change = change_of(two);
  const double with_it = 1.25 + extra / hole;
  EXPECT_NEAR(bulking_factor(change)->value, with_it, 0.005);
  EXPECT_TRUE(open_change(change, "a second heap").counted);
  EXPECT_TRUE(reads(change, 1.25));
  const auto interval = bulking_interval(change);
  ASSERT_TRUE(interval);
  EXPECT_LT((*interval)[0], 1.25) << "a reading of more than 5 % lies in the interval";
  EXPECT_GT((*interval)[1], with_it);
  EXPECT_LT(std::abs(with_it - 1.25), 3.0 * bulking_factor(change)->sd);
  double weights = 0.0;
  for (const Reading& reading : change.readings) weights += reading.weight;
  EXPECT_NEAR(weights, 1.0, 1e-9);
}

TEST(Attribution, TwoHeapsAlikeAreSummed) {
  const double radius = std::cbrt(0.5) * Dig{}.heap_radius();
  const auto two = [&](double x, double y) {
    return scenes::change_at(Dig{}, scenes::Part::dig, x, y) + cone(x, y, {4.5, 1.2}, radius) +
           cone(x, y, {6.5, -1.2}, radius);
  };
  const VolumeChange change = change_of(two);
  EXPECT_NEAR(bulking_factor(change)->value, 1.25, 0.005);
  EXPECT_FALSE(warns(change, "attribution_open", true));
}

TEST(Attribution, SecondHoleIsCountedWhereTheSoilNeedsIt) {
  const Rectangle second = {2.2, -2.2, 3.2, -0.9};
  const double fallen = 0.15 * 1.3;
  Dig dig;
  dig.bulking = 1.25 * (hole + fallen) / hole;  // its soil lies in the heap
  const auto two = [&](double x, double y) {
    return scenes::change_at(dig, scenes::Part::whole, x, y) + box(x, y, second, -0.15);
  };
  const VolumeChange change = change_of(two);
  EXPECT_NEAR(change.before.value, hole + fallen, 0.005);
  EXPECT_NEAR(bulking_factor(change)->value, 1.25, 0.01);
  EXPECT_TRUE(open_change(change, "a second hole").counted);
}

TEST(Attribution, RutsThatJoinTheHoleAreCutOff) {
  for (const double depth : {0.01, 0.03}) {
    const auto with_ruts = [&](double x, double y) {
      const double scene = dug(x, y);
      const double ruts = box(x, y, {-2.6, -2.4, -0.2, 2.2}, 0.0) +
                          box(x, y, {-0.9, 0.0, -0.4, 2.45}, -depth) +
                          box(x, y, {0.6, 0.0, 1.1, 2.45}, -depth);
      return scene < 0.0 ? std::min(scene, ruts) : scene > 0.0 ? scene : ruts;
    };
    const VolumeChange change = change_of(with_ruts);
    EXPECT_NEAR(change.before.value, hole, 0.015 * hole) << depth;
    EXPECT_FALSE(open_change(change, "ruts").counted) << depth;
  }
}

TEST(Attribution, StripThatMayBeAScrapeOrARutIsInTheInterval) {
  for (const double depth : {0.03, 0.04}) {
    const double fallen = depth * 0.85 * 2.8;
    Dig dig;
    dig.bulking = 1.25 * (hole + fallen) / hole;  // its soil lies in the heap
    const auto scraped = [&](double x, double y) {
      return scenes::change_at(dig, scenes::Part::whole, x, y) +
             box(x, y, {2.2, -2.2, 3.05, 0.6}, -depth);
    };
    const VolumeChange change = change_of(scraped);
    const AttributedChange strip = open_change(change, "a lone strip like ruts");
    EXPECT_EQ(strip.kind, ChangeKind::ruts);
    EXPECT_GT(strip.probability, 0.1);
    EXPECT_TRUE(reads(change, 1.25)) << depth;
    EXPECT_LT((*bulking_interval(change))[0], 1.25) << depth;
    EXPECT_LT(std::abs(bulking_factor(change)->value - 1.25), 3.0 * bulking_factor(change)->sd);
  }
}

TEST(Attribution, RutsAreWeighedToo) {
  const auto with_ruts = [](double x, double y) {
    return dug(x, y) + box(x, y, {2.0, -2.2, 2.5, 0.4}, -0.03) +
           box(x, y, {3.2, -2.2, 3.7, 0.4}, -0.03);
  };
  const VolumeChange change = change_of(with_ruts);
  EXPECT_NEAR(bulking_factor(change)->value, 1.25, 0.01);
  const double counted = 1.25 * hole / (hole + 2.0 * 0.03 * 0.5 * 2.6);
  EXPECT_TRUE(reads(change, counted)) << "what moves k by more than its deviation is a reading";
  EXPECT_FALSE(warns(change, "attribution_open", true));
}

TEST(Attribution, RoundAndPointedLumpsAreSoilAndBoxesAreNot) {
  const auto ball = [](double x, double y) {
    const double radius = std::cbrt(1.5 * 0.04 / pi);
    const double away = std::hypot(x - 3.2, y + 0.4);
    return std::sqrt(std::max(0.0, radius * radius - away * away));
  };
  const auto steep = [](double x, double y) {
    const double away = std::hypot(x - 3.2, y + 1.8);
    return std::max(0.0, (0.38 - away) * std::tan(57.0 * scenes::degree));
  };
  const VolumeChange lump = change_of([&](double x, double y) { return dug(x, y) + ball(x, y); });
  EXPECT_NEAR(bulking_factor(lump)->value, 1.25 + 0.04 / hole, 0.01);
  EXPECT_LT((*bulking_interval(lump))[0], 1.25) << "it may be a thing";
  const VolumeChange heap = change_of([&](double x, double y) { return dug(x, y) + steep(x, y); });
  const double volume = pi / 3.0 * std::pow(0.38, 3) * std::tan(57.0 * scenes::degree);
  EXPECT_NEAR(bulking_factor(heap)->value, 1.25 + volume / hole, 0.01);
  EXPECT_LT((*bulking_interval(heap))[0], 1.25);
}

TEST(Attribution, SecondHeapOfHardGroundIsNotDropped) {
  Dig dig;
  dig.bulking = 1.74;
  const double radius = std::cbrt(0.26 * hole * 3.0 / pi / std::tan(35.0 * scenes::degree));
  const auto hard = [&](double x, double y) {
    return scenes::change_at(dig, scenes::Part::whole, x, y) + cone(x, y, {3.0, -1.7}, radius);
  };
  const VolumeChange change = change_of(hard);
  const auto interval = bulking_interval(change);
  ASSERT_TRUE(interval);
  EXPECT_GT((*interval)[1], 2.0);
  EXPECT_TRUE(reads(change, 2.0) && reads(change, 1.74));
}

/// A ridge of an eighth of the hole on the side where no spill lies.
TEST(Attribution, OneOfTwoRidgesBesideTheHoleMayBeABerm) {
  const Dig dig;
  Dig berm = dig;
  berm.pit_depth = 0.0;
  berm.ridge_offset = -1.0;
  berm.ridge_height = 0.14;
  const VolumeChange change =
      change_of([&](double x, double y) { return dug(x, y) + berm.dug(x, y); });
  const double without = 1.25;
  EXPECT_NEAR(bulking_factor(change)->value, without + berm.ridge_volume() / hole, 0.01);
  EXPECT_TRUE(reads(change, without));
  EXPECT_LT((*bulking_interval(change))[0], without) << "all of that reading is in it";
  EXPECT_GT((*bulking_interval(change_of(dug)))[0], without - 0.02) << "one ridge is spill";
}

TEST(Attribution, WeightFarFromTheAnswerIsInTheDeviation) {
  const double extra = cone_volume(0.4);
  const auto two = [](double x, double y) { return dug(x, y) + cone(x, y, {3.2, -1.8}, 0.4); };
  const VolumeChange change = change_of(two);
  const double open = 1.0 - open_change(change, "a second heap").probability;
  const double sd = std::sqrt(open - 0.025) * extra / hole;
  EXPECT_NEAR(bulking_errors(change).attribution, sd, 0.03 * sd);
}

TEST(Attribution, LooseSoilOfAnEarlierDigIsAReading) {
  const auto ridge = [](double x, double y) {
    return std::abs(x) < 1.5 ? std::max(0.0, 0.2 - 0.65 * std::abs(y + 0.2)) : 0.0;
  };
  double loose = 0.0;
  for (double x = -3.0; x < 3.0; x += 0.01) {
    for (double y = -2.5; y < 2.5; y += 0.01) loose += dug(x, y) < 0.0 ? 1e-4 * ridge(x, y) : 0.0;
  }
  Dig dig;
  dig.bulking = 1.25 + loose / hole;
  const auto after = [&](double x, double y) {
    return scenes::change_at(dig, scenes::Part::whole, x, y) +
           (dug(x, y) < 0.0 ? 0.0 : ridge(x, y));
  };
  const VolumeChange change = measure_change(scanned(ridge, 1), scanned(after, 2));
  EXPECT_TRUE(warns(change, "earlier_soil", true));
  EXPECT_TRUE(reads(change, 1.25));
  EXPECT_LT(std::abs(bulking_factor(change)->value - 1.25), 1.96 * bulking_factor(change)->sd);
  const VolumeChange level = change_of(dug);
  EXPECT_FALSE(warns(level, "earlier_soil", false) || warns(level, "earlier_soil", true));
}

TEST(Attribution, ThinDigIsNotStirredGround) {
  const auto thin = [](double x, double y) {
    return box(x, y, {-1.5, -0.9, 1.5, 0.9}, -0.02) + box(x, y, {3.2, -2.0, 7.4, 2.0}, 0.008);
  };
  const auto level = [](double, double) { return 0.0; };
  const VolumeChange change = measure_change(scanned(level, 1, 0.0005), scanned(thin, 2, 0.0005));
  EXPECT_FALSE(warns(change, "stirred_ground", false) || warns(change, "stirred_ground", true));
}

TEST(Attribution, UprightThingsAndClodsAreToldApart) {
  const auto with_both = [](double x, double y) {
    double z = dug(x, y) + box(x, y, {3.0, -2.2, 3.4, -1.8}, 0.3);
    for (const double at : {2.0, 2.5, 3.0, 3.5}) z += cone(x, y, {at, 0.3}, 0.17);
    return z;
  };
  const VolumeChange change = change_of(with_both);
  EXPECT_FALSE(open_change(change, "a thing that is no soil").counted);
  const AttributedChange clods = open_change(change, "clods along the swing");
  EXPECT_TRUE(clods.counted);
  EXPECT_NEAR(clods.volume.value, 4.0 * cone_volume(0.17), 0.002);
}

/// Clods fall between hole and heap, where the bucket goes; the heap lies on the hole's other side.
TEST(Attribution, SmallRisesBehindTheHoleAreNoClodsOfTheSwing) {
  const auto with_both = [](double x, double y) {
    double z = dug(x, y);
    for (const double at : {2.5, 3.5}) z += cone(x, y, {at, 0.3}, 0.17);
    for (const double at : {-2.5, -2.0}) z += cone(x, y, {at, 2.0}, 0.17);
    return z;
  };
  const VolumeChange change = change_of(with_both);
  const AttributedChange clods = open_change(change, "clods along the swing");
  const AttributedChange rises = open_change(change, "small rises");
  EXPECT_NEAR(clods.volume.value, 2.0 * cone_volume(0.17), 0.001);
  EXPECT_NEAR(rises.volume.value, 2.0 * cone_volume(0.17), 0.001);
  EXPECT_LT(rises.probability, clods.probability);
}

/// Away from a pit of 8 cm it fell by 0.15 or 0.3 of that.
TEST(Attribution, GroundThatFellByFarLessThanAShallowHoleMayHaveSettled) {
  const auto level = [](double, double) { return 0.0; };
  for (const double depth : {0.012, 0.024}) {
    const auto shallow = [&](double x, double y) {
      return box(x, y, {-1.5, -0.9, 1.5, 0.9}, -0.08) + box(x, y, {5.0, -2.0, 7.4, 2.0}, 0.06) +
             box(x, y, {2.5, -1.0, 4.0, 0.5}, -depth);
    };
    const VolumeChange change =
        measure_change(scanned(level, 1, 0.0005), scanned(shallow, 2, 0.0005));
    const bool may_have_settled = depth < 0.02;
    const AttributedChange fall =
        open_change(change, may_have_settled ? "ground that fell a little" : "a second hole");
    EXPECT_EQ(fall.counted, !may_have_settled) << depth;
    const double fallen = may_have_settled ? 0.0 : 2.25 * depth;
    EXPECT_NEAR(change.before.value, 5.4 * 0.08 + fallen, 0.01) << depth;
  }
}

TEST(Attribution, StirredGroundIsNoiseOfWhatLiesInIt) {
  const scenes::SmoothError churn(extent, 0.15, Random(8, 1));
  const auto stirred = [&](double x, double y) {
    return dug(x, y) + (x > 1.0 ? 0.015 * churn(x, y) : 0.0);
  };
  const VolumeChange change = change_of(stirred);
  EXPECT_TRUE(warns(change, "stirred_ground", false) || warns(change, "stirred_ground", true));
  EXPECT_LE(std::abs(bulking_factor(change)->value - 1.25), 1.96 * bulking_factor(change)->sd);
  EXPECT_GT(bulking_factor(change)->sd, 3.0 * bulking_errors(change).scans);
}

TEST(Attribution, RisesInTheDigAreaLieBesideNoHeapOfTheDumpArea) {
  const auto rises = [](double x, double y) {
    double z = scenes::change_at(Dig{}, scenes::Part::dig, x, y);
    for (const double at : {4.0, 5.5, 7.0}) z += cone(x, y, {at, -1.5}, 0.3);
    return z;
  };
  const auto heap = [](double x, double y) { return Dig{}.dumped(x - scenes::dump_offset, y); };
  const auto level = [](double, double) { return 0.0; };
  const VolumeChange change = measure_change(HeightMapPair{scanned(level, 1), scanned(rises, 2)},
                                             HeightMapPair{scanned(level, 3), scanned(heap, 4)});
  double rise = 0.0;
  for (const AttributedChange& open : change.attribution) {
    EXPECT_EQ(open.what.find("soil beside the heap"), std::string::npos) << open.what;
    if (open.what.rfind("a rise in the dig area", 0) == 0) rise += open.volume.value;
  }
  EXPECT_NEAR(rise, 3.0 * cone_volume(0.3), 0.005);
}

TEST(Attribution, GivenAreasLeaveNothingOpenOutside) {
  const auto two = [](double x, double y) { return dug(x, y) + cone(x, y, {3.2, -1.8}, 0.4); };
  ChangeOptions options;
  options.dump_area = Rectangle{4.3, -1.2, 8.0, 2.4};
  const VolumeChange change = change_of(two, options);
  EXPECT_NEAR(bulking_factor(change)->value, 1.25, 0.005);
  EXPECT_FALSE(open_change(change, "ground outside the given area").counted);
  EXPECT_FALSE(warns(change, "attribution_open", false));
}

TEST(Attribution, WhatLiesInAGivenAreaBelongsToTheDigWhateverItLooksLike) {
  const Rectangle like_a_rut = {2.0, -2.4, 2.85, 0.4};
  const auto with_both = [&](double x, double y) {
    return dug(x, y) + box(x, y, like_a_rut, -0.04) + box(x, y, {3.6, -2.2, 4.0, -1.8}, 0.3);
  };
  ChangeOptions options;
  options.dig_area = Rectangle{-2.0, -2.6, 3.0, 2.6};
  options.dump_area = Rectangle{3.2, -2.6, 8.0, 2.6};
  const VolumeChange change = change_of(with_both, options);
  EXPECT_NEAR(change.before.value, hole + 0.04 * 0.85 * 2.8, 0.01);
  EXPECT_NEAR(change.after.value, 1.25 * hole + 0.3 * 0.16, 0.01);
  EXPECT_FALSE(warns(change, "attribution_open", false));
  EXPECT_LE(bulking_factor(change)->sd, 1.5 * bulking_errors(change).scans);
}

/// 1.65 of the densest soil, over what 44 % of voids leave: 2.95.
TEST(Attribution, BlocksAreAsLikelyUpToTheVoidsOfTheDensestSoil) {
  EXPECT_DOUBLE_EQ(likelihood_of_bulking(2.9), likelihood_of_bulking(2.2));
  EXPECT_LT(likelihood_of_bulking(2.9), likelihood_of_bulking(1.5));
  EXPECT_LT(likelihood_of_bulking(3.3), 0.01);
}

}  // namespace
}  // namespace excavplan
