// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/change/bulking.hpp>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "change/low_objects.hpp"
#include "scans/scan_checks.hpp"
#include "support/block_heap.hpp"
#include "support/dig_survey.hpp"

namespace excavplan {
namespace {

using namespace test;
using scenes::degree;
using scenes::Part;
using scenes::Points;

struct Fault {
  std::string name;
  std::function<void(Survey&, Random&)> spoil;
  double slope = 0.0;
  double roughness = 0.0;
  bool never_trusted = true;
};

std::vector<Fault> faults() {
  const auto scaled = [](double factor) {
    return [factor](Survey& s, Random&) { s.move_all(Affine(Eigen::Scaling(factor))); };
  };
  const auto moved = [](Survey& s, Random& random) {
    const double turn = random.uniform(0.0, 5.0) * degree;
    Survey::move(s.after, scenes::random_motion(random.uniform(0.05, 1.0), turn, random));
  };
  return {
      {"millimetres", scaled(1000.0)},
      {"centimetres", scaled(100.0)},
      {"one scan in millimetres",
       [](Survey& s, Random&) { Survey::move(s.after, Affine(Eigen::Scaling(1000.0))); }},
      {"camera",
       [](Survey& s, Random& random) {
         s.move_all(camera(random.uniform(30.0, 89.0) * degree, random.uniform(3.0, 9.0)));
       }},
      {"z down",
       [](Survey& s, Random& random) {
         s.move_all(Eigen::Translation3d(0.0, 0.0, random.uniform(-3.0, 3.0)) *
                    turned(pi, Eigen::Vector3d::UnitX()));
       }},
      {"y up", [](Survey& s, Random&) { s.move_all(turned(-0.5 * pi, Eigen::Vector3d::UnitX())); }},
      {"tilted by 18 .. 45 degrees",
       [](Survey& s, Random& random) {
         s.move_all(turned(random.uniform(18.0, 45.0) * degree, level_axis(random)));
       }},
      {"tilted by 5 .. 18 degrees",
       [](Survey& s, Random& random) {
         s.move_all(turned(random.uniform(5.0, 18.0) * degree, level_axis(random)));
       },
       0.0, 0.0, false},
      {"moved on level ground", moved, 0.0, 0.0, false},
      {"moved on rough ground", moved, 8.0 * degree, 0.02, false},
      {"swapped", [](Survey& s, Random&) { std::swap(s.before, s.after); }},
  };
}

TEST(ScanChecks, NoBadSurveyIsTrustedAndWrong) {
  constexpr std::size_t surveys = 14;
  for (const Fault& fault : faults()) {
    std::vector<int> trusted(surveys);
    std::vector<int> wrong(surveys);
    parallel_for(surveys, 0, [&](std::size_t i) {
      const std::uint64_t seed = 501 + i;
      Random random(seed, 99);
      Survey survey(seed, true, fault.slope, fault.roughness);
      fault.spoil(survey, random);
      const Answer answer = answer_to(survey.scans());
      trusted[i] = answer.trusted() ? 1 : 0;
      wrong[i] = is_trusted_and_wrong(answer, survey.dig) ? 1 : 0;
    });
    for (std::size_t i = 0; i < surveys; ++i) {
      EXPECT_EQ(wrong[i], 0) << fault.name << ", seed " << 501 + i;
      if (fault.never_trusted) {
        EXPECT_EQ(trusted[i], 0) << fault.name << ", seed " << 501 + i;
      }
    }
  }
}

using Heights = std::function<double(double, double)>;

bool looks_swapped(const Heights& before, const Heights& after) {
  SurfacePair pair;
  pair.before.height = pair.after.height = flat_ground({-3.0, -2.0, 3.0, 2.0}, 0.05);
  for (const auto& [map, heights] :
       {std::pair(&pair.before.height, &before), std::pair(&pair.after.height, &after)}) {
    for (Eigen::Index col = 0; col < map->z.cols(); ++col) {
      for (Eigen::Index row = 0; row < map->z.rows(); ++row)
        map->z(row, col) = (*heights)(map->x(col), map->y(row));
    }
  }
  const std::vector<Warning> doubts = check_slopes({&pair}, measure_change(pair));
  return std::any_of(doubts.begin(), doubts.end(), [](const Warning& warning) {
    return warning.code == WarningCode::looks_swapped;
  });
}

/// A cone with its point cut off.
double heap(const Eigen::Vector2d& from_centre, double angle, double height) {
  return std::clamp(std::tan(angle) * (0.8 - from_centre.norm()), 0.0, height);
}

TEST(ScanChecks, ASteepHeapIsOneOfExchangedScansOnlyBesideAGentleHole) {
  const auto pit_and_heap = [](double pit_angle, double heap_angle) {
    return looks_swapped(
        [](double, double) { return 0.0; },
        [&](double x, double y) {
          return heap({x - 1.5, y}, heap_angle, 0.5) - heap({x + 1.5, y}, pit_angle, 0.5);
        });
  };
  EXPECT_TRUE(pit_and_heap(35.0 * degree, 65.0 * degree));
  EXPECT_FALSE(pit_and_heap(65.0 * degree, 35.0 * degree));
  EXPECT_FALSE(pit_and_heap(60.0 * degree, 60.0 * degree)) << "soil that holds together";
}

TEST(ScanChecks, AHeapBetweenEarlierOnesIsASteepChangeAndNoSteepHeap) {
  constexpr double repose = 35.0 * degree;
  const auto earlier = [](double x, double y) {
    return std::max(heap({x - 1.5, y - 0.75}, repose, 0.5), heap({x - 1.5, y + 0.75}, repose, 0.5));
  };
  EXPECT_FALSE(looks_swapped(earlier, [&](double x, double y) {
    return std::max(earlier(x, y), heap({x - 1.5, y}, repose, 0.5)) -
           heap({x + 1.5, y}, 40.0 * degree, 0.3);
  }));
}

TEST(ScanChecks, GoodSurveysPass) {
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const bool sloped = seed % 3 == 0;
    const Survey survey(seed, seed % 2 == 0, sloped ? 8.0 * degree : 0.0, sloped ? 0.02 : 0.0);
    const Answer answer = answer_to(survey.scans());
    ASSERT_TRUE(answer.estimate) << answer.error;
    for (const char* code : {"units", "frame", "looks_swapped", "registration_beyond_prior",
                             "grass", "flat_water", "object_on_soil"}) {
      EXPECT_EQ(answer.warning(code), nullptr) << code << ", seed " << seed;
    }
    EXPECT_EQ(answer.warning("tilted") != nullptr, sloped);
    for (const Warning& warning : answer.estimate->warnings) {
      EXPECT_FALSE(warning.ends_trust) << warning.message;
    }
  }
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ScanChecks, AHoleNoBucketDigsNamesTheUnit) {
  for (const auto& [word, factor] : {std::pair("mm", 1000.0), std::pair("cm", 100.0)}) {
    Survey survey(2, true);
    survey.move_all(Affine(Eigen::Scaling(factor)));
    DigScans scans = survey.scans();
    const Answer answer = answer_to(scans);
    const Warning* units = answer.warning("units");
    ASSERT_NE(units, nullptr) << word;
    EXPECT_TRUE(contains(units->message, std::string("`unit` ") + word)) << units->message;
    for (const Warning& warning : answer.estimate->warnings) {
      EXPECT_TRUE(warning.code == WarningCode::units || !warning.ends_trust) << warning.message;
      EXPECT_NE(warning.code, WarningCode::sensor_place_inferred) << word;
    }
    scans.before.unit = scans.after.unit = 1.0 / factor;
    const Answer mended = answer_to(scans);
    EXPECT_TRUE(mended.trusted());
    EXPECT_EQ(mended.warning("units"), nullptr);
    EXPECT_FALSE(is_trusted_and_wrong(mended, survey.dig));
  }
}

TEST(ScanChecks, TheLikelyUnitIsFoundFromAWrongOneToo) {
  Survey survey(2, true);
  survey.move_all(Affine(Eigen::Scaling(1000.0)));
  DigScans scans = survey.scans();
  scans.before.unit = scans.after.unit = 0.3048;
  const Answer answer = answer_to(scans);
  ASSERT_NE(answer.warning("units"), nullptr);
  EXPECT_TRUE(contains(answer.warning("units")->message, "`unit` mm"))
      << answer.warning("units")->message;
}

TEST(ScanChecks, ACauseStandsForWhatFollowsFromIt) {
  const auto left = [](bool ends_trust) {
    std::string codes;
    for (const Warning& warning : causes_of({{WarningCode::units, "", ends_trust},
                                             {WarningCode::scans_do_not_fit, "", true},
                                             {WarningCode::implausible_fuel, "", false},
                                             {WarningCode::looks_swapped, "", true}})) {
      codes += code_text(warning.code) + " ";
    }
    return codes;
  };
  EXPECT_EQ(left(true), "units looks_swapped ");
  EXPECT_EQ(left(false), "units scans_do_not_fit implausible_fuel looks_swapped ");
}

TEST(ScanChecks, OneScanInOtherUnitsIsNamed) {
  Survey survey(3, true);
  Survey::move(survey.after, Affine(Eigen::Scaling(1000.0)));
  DigScans scans = survey.scans();
  EXPECT_TRUE(contains(answer_to(scans).error, "`after_unit`"));
  scans.after.unit = 0.001;
  EXPECT_TRUE(answer_to(scans).trusted());
}

TEST(ScanChecks, ACameraFrameNamesTheOption) {
  Survey survey(4, true);
  survey.move_all(camera(80.0 * degree, 6.0));
  const Answer answer = answer_to(survey.scans());
  const std::string text = answer.estimate ? answer.warning("frame")->message : answer.error;
  EXPECT_TRUE(contains(text, "as in the frame of a camera")) << text;
  EXPECT_TRUE(contains(text, "`before_frame`")) << text;
}

TEST(ScanChecks, GroundUprightInTheFrameIsNoGround) {
  Survey survey(4, true);
  survey.move_all(turned(-0.5 * pi, Eigen::Vector3d::UnitX()));
  const std::string error = answer_to(survey.scans()).error;
  EXPECT_TRUE(contains(error, "z is not up")) << error;
}

TEST(ScanChecks, AFrameThatIsGivenMayTilt) {
  Survey survey(6, true);
  survey.move_all(turned(25.0 * degree, Eigen::Vector3d::UnitX()));
  DigScans scans = survey.scans();
  const Answer answer = answer_to(scans);
  ASSERT_NE(answer.warning("tilted"), nullptr);
  EXPECT_TRUE(answer.warning("tilted")->ends_trust);
  const Eigen::Matrix4d back = turned(-25.0 * degree, Eigen::Vector3d::UnitX()).matrix();
  scans.before.site_from_scan = scans.after.site_from_scan = back;
  const Answer mended = answer_to(scans);
  EXPECT_EQ(mended.warning("tilted"), nullptr);
  EXPECT_TRUE(mended.trusted());
}

TEST(ScanChecks, AScanThatMovedFarIsBroughtBack) {
  Survey survey(6, true, 8.0 * degree, 0.02);
  const Affine motion =
      Eigen::Translation3d(0.5, -0.4, 0.2) * turned(3.0 * degree, Eigen::Vector3d(0.3, 0.2, 1.0));
  Survey::move(survey.after, motion);
  const Answer answer = answer_to(survey.scans());
  const Warning* moved = answer.warning("registration_beyond_prior");
  ASSERT_NE(moved, nullptr);
  EXPECT_FALSE(moved->ends_trust) << moved->message;
  EXPECT_FALSE(is_trusted_and_wrong(answer, survey.dig));
  const Eigen::Matrix4d rest = answer.estimate->registration->correction * motion.matrix();
  const Eigen::Vector4d middle(2.5, 0.0, 0.3, 1.0);
  EXPECT_LT((rest * middle - middle).norm(), 0.02);
}

TEST(ScanChecks, AScanThatMovedTooFarEndsTrust) {
  Survey survey(6, true, 8.0 * degree, 0.05);
  Survey::move(survey.after, Affine(Eigen::Translation3d(1.5, 1.5, 0.3)));
  const Answer answer = answer_to(survey.scans());
  EXPECT_FALSE(answer.trusted());
  if (const Warning* moved = answer.warning("registration_beyond_prior")) {
    EXPECT_TRUE(contains(moved->message, "`after_frame`")) << moved->message;
  }
}

TEST(ScanChecks, HeightsOfTwoDatumsEndTrust) {
  for (const double raised : {-9.0, 9.0, -30.0, 5000.0}) {
    Survey survey(6, true, 8.0 * degree, 0.02);
    Survey::move(survey.after, Affine(Eigen::Translation3d(0.0, 0.0, raised)));
    for (const bool registered : {true, false}) {
      DensityOptions options;
      options.registered = registered;
      options.threads = 1;
      const DensityEstimate found = estimate_density(survey.scans(), paper_law(), options);
      const Warning* apart = nullptr;
      for (const Warning& each : found.warnings) {
        if (contains(each.message, "must be within 10 m")) apart = &each;
      }
      EXPECT_EQ(apart != nullptr, std::abs(raised) > 10.0) << raised << registered;
      EXPECT_TRUE(!apart || apart->ends_trust);
    }
  }
}

TEST(ScanChecks, SwappedScansOfTwoAreasAreRefused) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Survey survey(seed, false);
    std::swap(survey.dump_before, survey.dump_after);
    EXPECT_TRUE(contains(answer_to(survey.scans()).error, "probably swapped in the dump area"));
    std::swap(survey.before, survey.after);
    EXPECT_TRUE(contains(answer_to(survey.scans()).error, "BEFORE and AFTER")) << seed;
  }
}

// ---- Whether the surface is the soil ------------------------------------------------------------

constexpr std::size_t points_on_soil = 150000;

/// A share of the returns from grass that the dig took away and the heap covers.
void grow_grass(Survey& survey, double share, double height) {
  Random random(7);
  for (Points* points : {&survey.before, &survey.after}) {
    for (Eigen::Vector3d& point : *points) {
      const bool dug = points == &survey.after &&
                       scenes::change_at(survey.dig, Part::whole, point.x(), point.y()) != 0.0;
      if (!dug && random.uniform() < share) point.z() += random.uniform(0.0, height);
    }
  }
}

TEST(Cover, GrassEndsTrust) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Survey survey(seed, true, 0.0, 0.0, points_on_soil);
    const bool lawn = seed % 2 == 0;
    grow_grass(survey, lawn ? 1.0 : 0.4, lawn ? 0.03 : 0.02);
    const Answer answer = answer_to(survey.scans());
    EXPECT_FALSE(answer.trusted()) << seed;
    if (answer.estimate) {
      EXPECT_NE(answer.warning("grass"), nullptr) << seed;
    } else {
      EXPECT_TRUE(contains(answer.error, "as on grass")) << answer.error;
    }
  }
}

/// Fills a share of the depth of the pit.
void flood(Survey& survey, double share) {
  const double level = -(1.0 - share) * survey.dig.pit_depth;
  for (Eigen::Vector3d& point : survey.after) {
    if (survey.dig.dug(point.x(), point.y()) < 0.0) point.z() = std::max(point.z(), level);
  }
}

const Reading* reading_with_water(const VolumeChange& change) {
  for (const Reading& reading : change.readings) {
    if (contains(reading.what, "with water")) return &reading;
  }
  return nullptr;
}

/// A bucket that drags level leaves such a floor, so that only a bulking factor that no soil has
/// ends trust.
TEST(Cover, WaterOnRoughGroundIsToldAndEndsTrustWhereTheSoilSpeaksForIt) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Survey survey(seed, true, 0.0, 0.015, points_on_soil);
    EXPECT_EQ(answer_to(survey.scans()).warning("flat_water"), nullptr) << seed;
    flood(survey, 0.2);
    const Answer answer = answer_to(survey.scans());
    if (answer.warning("flat_water") == nullptr) continue;
    const double k = answer.estimate->bulking->value;
    EXPECT_EQ(answer.warning("flat_water")->ends_trust, k > 1.75) << k;
    EXPECT_TRUE(reading_with_water(answer.estimate->change)) << seed;
    ++found;
  }
  EXPECT_GE(found, 3) << "of four; the floor of one is as even by chance";
}

TEST(Cover, GrassInASmallDigEndsTrust) {
  for (const std::uint64_t seed : {6U, 15U}) {
    Survey survey(seed, true, 0.0, 0.0, points_on_soil);
    grow_grass(survey, 0.4, 0.02);
    EXPECT_FALSE(answer_to(survey.scans()).trusted()) << seed;
  }
}

TEST(Cover, WaterOnEvenGroundIsAReading) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Survey survey(seed, true, 0.0, 0.0, points_on_soil);
    flood(survey, seed % 2 == 0 ? 0.12 : 0.4);
    const Answer answer = answer_to(survey.scans());
    ASSERT_TRUE(answer.estimate) << seed;
    const VolumeChange& change = answer.estimate->change;
    const Reading* water = reading_with_water(change);
    ASSERT_NE(water, nullptr) << seed;
    const Measured& k = water->bulking;
    EXPECT_NEAR(k.value, survey.dig.bulking, 2.0 * k.sd + 0.005 * k.value) << seed;
    EXPECT_LT(k.value + 1.5 * k.sd, answer.estimate->bulking->value) << "of any depth, but some";
    EXPECT_LT(k.sd, 0.2 * k.value) << seed;
    EXPECT_LT(water->weight, 0.05) << "the likeliest reading is a level floor";
    double sum = 0.0;
    for (const Reading& reading : change.readings) sum += reading.weight;
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_LT(bulking_errors(change).scans, 0.01) << "readings do not widen the deviation";
    EXPECT_FALSE(change.attribution.back().counted);
    EXPECT_LT(change.attribution.back().volume.value, 0.0);
  }
}

/// Takes away the points over one wall of the pit.
void hide_a_wall(const scenes::Dig& dig, Points& points) {
  const auto is_hidden = [&](const Eigen::Vector3d& point) {
    const double depth = -dig.dug(point.x(), point.y()) / dig.pit_depth;
    return point.x() < 0.0 && depth > 0.05 && depth < 0.95;
  };
  points.erase(std::remove_if(points.begin(), points.end(), is_hidden), points.end());
}

TEST(Cover, AWallThatWasSeenBeforeAloneEndsTrust) {
  constexpr std::size_t sparse = 30000;  // so that cells lie between points anyway
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Survey survey(seed, true, 0.0, 0.0, sparse);
    EXPECT_EQ(answer_to(survey.scans()).warning("hole_in_shadow"), nullptr) << seed;
    hide_a_wall(survey.dig, survey.after);
    const Answer hidden = answer_to(survey.scans());
    ASSERT_NE(hidden.warning("hole_in_shadow"), nullptr) << seed;
    EXPECT_TRUE(contains(hidden.warning("hole_in_shadow")->message, "`sensor_origin`"));
    EXPECT_FALSE(hidden.trusted());
    hide_a_wall(survey.dig, survey.before);
    EXPECT_EQ(answer_to(survey.scans()).warning("hole_in_shadow"), nullptr) << seed;
  }
}

TEST(Cover, AFloorAsRoughAsTheGroundIsNoWater) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Survey survey(seed, true, 0.0, 0.015, points_on_soil);
    EXPECT_EQ(reading_with_water(answer_to(survey.scans()).estimate->change), nullptr) << seed;
  }
}

/// A box 0.4 m wide whose top is 0.35 m above the surface in its middle.
void set_down(Survey& survey, double x, double y, double ground) {
  for (Eigen::Vector3d& point : survey.after) {
    if (std::max(std::abs(point.x() - x), std::abs(point.y() - y)) > 0.2) continue;
    point.z() = std::max(point.z(), ground + 0.35);
  }
}

TEST(Cover, ACrateIsTakenOut) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Survey survey(seed, true, 0.0, 0.0, points_on_soil);
    const scenes::Dig& dig = survey.dig;
    if (seed % 2 == 0) {
      set_down(survey, dig.pit_x, dig.pit_y, -dig.pit_depth);
    } else {
      const double x = scenes::dump_offset + dig.heap_x + 0.3 * dig.heap_radius();
      set_down(survey, x, dig.heap_y, dig.dumped(x - scenes::dump_offset, dig.heap_y));
    }
    const Answer answer = answer_to(survey.scans());
    ASSERT_NE(answer.warning("object_on_soil"), nullptr) << seed;
    const Measured& k = *answer.estimate->bulking;
    EXPECT_NEAR(k.value, dig.bulking, 3.0 * k.sd) << seed;
    EXPECT_NEAR(k.value, dig.bulking, 0.05 * dig.bulking) << seed;
  }
}

/// Ground that was left standing would look the same.
TEST(Cover, ACrateAsHighAsTheGroundWasEndsTrust) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Survey survey(seed, true, 0.0, 0.0, points_on_soil);
    set_down(survey, survey.dig.pit_x, survey.dig.pit_y, -0.35);
    const Answer answer = answer_to(survey.scans());
    ASSERT_NE(answer.warning("object_on_soil"), nullptr) << seed;
    EXPECT_TRUE(contains(answer.warning("object_on_soil")->message, "left standing"));
    EXPECT_FALSE(answer.trusted()) << seed;
    const Measured& k = *answer.estimate->bulking;
    EXPECT_NEAR(k.value, survey.dig.bulking, 3.0 * k.sd) << seed;
  }
}

/// A plateau of 0.45 m in a hole 1 m wide, both with upright sides.
Eigen::ArrayXXd plateau(double ground_before) {
  Eigen::ArrayXXd z = Eigen::ArrayXXd::Zero(40, 40);
  z.block(10, 10, 20, 20).setConstant(ground_before);
  z.block(15, 15, 9, 9).setZero();
  return z;
}

TEST(Cover, WhatStoodOutBeforeIsNoThing) {
  constexpr double cell = 0.05;
  const Eigen::ArrayXXd after = plateau(-0.3);
  const Eigen::ArrayXXd level = Eigen::ArrayXXd::Zero(40, 40);
  const std::vector<LevelTop> tops = level_tops(level, after, cell);
  ASSERT_EQ(tops.size(), 1U);
  EXPECT_FALSE(tops[0].is_sure);
  EXPECT_EQ(tops[0].cells.size(), 81U);
  EXPECT_TRUE(level_tops(plateau(-0.15), after, cell).empty());
}

TEST(Cover, BlocksOfSoilAreNoCrates) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const HeightMap heap = test::surveyed(test::block_heap({}, seed).fine, 0.05);
    const Eigen::ArrayXXd level = Eigen::ArrayXXd::Zero(heap.z.rows(), heap.z.cols());
    EXPECT_TRUE(level_tops(level, heap.z, heap.cell_size).empty()) << seed;
  }
}

}  // namespace
}  // namespace excavplan
