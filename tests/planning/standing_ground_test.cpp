// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/standing_ground.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "support/machine_file.hpp"

/// @file
/// Ground under and about the tracks, as scans with noise, clods, outliers and shadows. Each fault
/// is drawn beyond its limit, and its harmless counterpart within it.

namespace excavplan::test {
namespace {

using Ground = std::function<double(double x, double y)>;

const double front_of_tracks = 1.8, half = 1.3;  // of its tracks [m]

struct Scene {
  std::string kind;
  bool can_stand = true;
  bool is_seen_from_cab = false;  ///< with shadows, and nothing under the machine
  Ground height = [](double, double) { return 0.0; };
};

/// One of the machine's four sides, from where a fault lies outward.
struct Beside {
  int side = 0;  ///< ahead, left, behind, right
  /// From the tracks outward, negative under them [m].
  double away(double x, double y) const {
    const double all[] = {x - front_of_tracks, y - half, -x - front_of_tracks, -y - half};
    return all[side];
  }
  /// Along the side, 0 in its middle [m].
  double along(double x, double y) const { return side % 2 == 0 ? y : x; }
};

double sign(Random& random) { return random.uniform() < 0.5 ? -1.0 : 1.0; }

Scene wrong_height(Random& random, bool bad) {
  const double z = sign(random) * (bad ? random.uniform(0.3, 2.0) : random.uniform(0.0, 0.12));
  return {"height", !bad, random.uniform() < 0.5, [z](double, double) { return z; }};
}

Scene tilt(Random& random, bool bad) {
  const double slope =
      std::tan(degree * (bad ? random.uniform(4.0, 30.0) : random.uniform(0.0, 2.0)));
  const double heading = random.uniform(0.0, 2.0 * pi);
  const double along = slope * std::cos(heading), aside = slope * std::sin(heading);
  return {"tilt", !bad, random.uniform() < 0.5,
          [=](double x, double y) { return along * x + aside * y; }};
}

/// The whole side falls, steeply.
Scene cliff(Random& random, bool bad) {
  const double depth = random.uniform(0.6, 3.5);
  const double from = depth * (bad ? random.uniform(0.0, 0.8) : random.uniform(1.3, 1.8));
  const Beside at{static_cast<int>(random.index(4))};
  // What lies in the shadow of an edge further off, no scan from the cab shows.
  const bool can_be_seen = from < 1.5 && depth < 3.0;
  return {"cliff", !bad, can_be_seen && random.uniform() < 0.7, [=](double x, double y) {
            return -depth * std::clamp(8.0 * (at.away(x, y) - from), 0.0, 1.0);
          }};
}

/// Along one of the sides or under the machine.
Scene trench(Random& random, bool bad) {
  const double depth = random.uniform(0.7, 2.0), width = random.uniform(0.6, 1.5);
  const Beside at{1 + static_cast<int>(random.index(3))};
  const double from = bad ? random.uniform(-0.9, 0.7 * depth) : depth * random.uniform(1.3, 1.8);
  return {"trench", !bad, false, [=](double x, double y) {
            const double in = at.away(x, y) - from;
            return in > 0.0 && in < width ? -depth : 0.0;
          }};
}

/// A pit with its walls, ahead: the machine's own, or nearer to the tracks than it digs, or wider.
Scene cut(Random& random, bool bad) {
  const double depth = random.uniform(0.7, 1.5), length = random.uniform(1.5, 3.0);
  const bool wide = bad && random.uniform() < 0.5;
  const double from = bad ? random.uniform(0.0, 0.25) : random.uniform(0.55, 0.8);
  const double width = wide ? random.uniform(1.2, 2.0) : random.uniform(0.35, 0.5);
  return {"cut", !bad, random.uniform() < 0.5, [=](double x, double y) {
            const double in = x - front_of_tracks - from;
            return in > 0.0 && in < length && std::abs(y) < width ? -depth : 0.0;
          }};
}

Scene spoil(Random& random, bool bad) {
  const double high = random.uniform(0.4, 1.0), radius = random.uniform(0.7, 1.2);
  const double heading = random.uniform(0.0, 2.0 * pi);
  const double x0 = bad ? random.uniform(-front_of_tracks, front_of_tracks)
                        : (front_of_tracks + radius + 0.2) * std::cos(heading);
  const double y0 = bad ? random.uniform(-half, half)
                        : (half + radius + 0.2) * (std::sin(heading) < 0.0 ? -1.0 : 1.0);
  return {"spoil", !bad, false, [=](double x, double y) {
            return std::max(0.0, high * (1.0 - std::hypot(x - x0, y - y0) / radius));
          }};
}

/// Beside the machine, which it neither lifts nor turns.
Scene wall_or_heap(Random& random, bool) {
  const double high = random.uniform(0.5, 3.0), from = random.uniform(0.2, 0.9);
  const Beside at{1 + static_cast<int>(random.index(3))};
  const bool is_wall = random.uniform() < 0.5;
  const double rise = is_wall ? 20.0 : random.uniform(0.5, 0.8);
  return {"wall", true, random.uniform() < 0.5, [=](double x, double y) {
            const double ends = std::max(0.0, std::abs(at.along(x, y)) - 2.5);
            return std::clamp(rise * (at.away(x, y) - from - ends), 0.0, high);
          }};
}

Scene scene_of(std::uint64_t seed) {
  using Make = Scene (*)(Random&, bool);
  static const std::vector<Make> kinds = {wrong_height, tilt,  cliff, trench,
                                          cut,          spoil, cliff, wall_or_heap};
  Random random(seed, 1);
  const bool bad = (seed / kinds.size()) % 2 == 0;
  return kinds[seed % kinds.size()](random, bad);
}

/// Whether a sensor on the cab sees a place.
bool is_in_view(const Ground& ground, double x, double y, double z) {
  const double x0 = 0.5, y0 = 0.4, z0 = 3.0;
  if (std::abs(x) < front_of_tracks + 0.1 && std::abs(y) < half + 0.1) return false;
  constexpr int steps = 60;
  for (int i = 1; i < steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    if (ground(x0 + t * (x - x0), y0 + t * (y - y0)) > z0 + t * (z - z0) + 0.02) return false;
  }
  return true;
}

/// Points 5 to 15 mm off ground with clods of 2 cm; one in 500 is an outlier.
Scan scan_of(const Scene& scene, std::uint64_t seed) {
  Random random(seed, 2);
  const double noise = random.uniform(0.005, 0.015), per_area = random.uniform(100.0, 300.0);
  const double phase = random.uniform(0.0, 2.0 * pi);
  auto cloud = std::make_shared<Cloud>();
  const double x_min = -8.5, x_max = 9.5, y_max = 8.0;
  const int count = static_cast<int>(per_area * (x_max - x_min) * 2.0 * y_max);
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(x_min, x_max), y = random.uniform(-y_max, y_max);
    const double clods = 0.02 * (std::sin(7.0 * x + phase) + std::sin(6.0 * y + x - phase));
    const double z = scene.height(x, y);
    if (scene.is_seen_from_cab && !is_in_view(scene.height, x, y, z)) continue;
    const double outlier = random.uniform() < 0.002 ? random.uniform(-2.0, 2.0) : 0.0;
    cloud->points.emplace_back(x, y, z + clods + noise * random.normal() + outlier);
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  scan.name = scene.kind + " " + std::to_string(seed);
  return scan;
}

bool ends_trust(const std::vector<Warning>& warnings) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [](const Warning& each) { return each.ends_trust; });
}

struct Tally {
  int clear = 0, faulty = 0, false_alarms = 0, missed = 0;
};

/// @param trusts  whether a scene is trusted, by its scan
template <typename Trusts>
Tally tally_of(std::uint64_t scenes, const Trusts& trusts) {
  Tally tally;
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    const Scene scene = scene_of(seed);
    const bool trusted = trusts(scan_of(scene, seed));
    ++(scene.can_stand ? tally.clear : tally.faulty);
    if (scene.can_stand && !trusted) ++tally.false_alarms;
    if (!scene.can_stand && trusted) ++tally.missed;
    if (scene.can_stand == trusted) continue;
    std::cout << scene.kind << ' ' << seed << (scene.can_stand ? " false alarm" : " missed")
              << (scene.is_seen_from_cab ? ", from the cab\n" : "\n");
  }
  return tally;
}

bool can_stand(const Scan& scan) {
  return !ends_trust(standing_ground(zx120(), standing_ground_from_scan(scan, zx120())).warnings);
}

/// Whether a plan on the scan is trusted, but for what else than the standing ground ends trust.
bool plans(const Scan& scan) {
  static const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  PlanOptions options;
  options.search.start_rule = StartRule::Kind::least_work;
  options.standing_on = standing_ground_from_scan(scan, zx120());
  const Terrain ground =
      terrain_from_scan(scan, planning_extent(zx120()), usual_cell(zx120())).terrain;
  const DigPlan plan = plan_dig(zx120(), loam, 40.0, ground, options);
  EXPECT_EQ(plan.trustworthy, !ends_trust(plan.warnings));
  const std::vector<WarningCode> others = {WarningCode::ground_unlike_library,
                                           WarningCode::slope_outside_library,
                                           WarningCode::obstacle_in_strip};
  return std::none_of(plan.warnings.begin(), plan.warnings.end(), [&](const Warning& each) {
    return each.ends_trust && std::count(others.begin(), others.end(), each.code) == 0;
  });
}

TEST(StandingGround, TellsGroundThatBearsTheMachineFromGroundThatDoesNot) {
  const Tally tally = tally_of(48, can_stand);
  EXPECT_EQ(tally.missed, 0) << "of " << tally.faulty;
  EXPECT_EQ(tally.false_alarms, 0) << "of " << tally.clear;
  EXPECT_GT(tally.faulty, 15);
  EXPECT_GT(tally.clear, 15);
}

TEST(StandingGround, NoPlanIsTrustedInTwoHundredScenesWithFewFalseAlarms) {
  const Tally tally = tally_of(200, plans);
  std::cout << tally.missed << " of " << tally.faulty << " missed, " << tally.false_alarms << " of "
            << tally.clear << " false alarms\n";
  EXPECT_EQ(tally.missed, 0) << "of " << tally.faulty;
  EXPECT_LE(tally.false_alarms, 0.03 * tally.clear);
}

HeightMap map_of(const Ground& ground) {
  HeightMap map = flat_ground(standing_extent(zx120()), 0.1);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      map.z(row, col) = ground(map.x(col), map.y(row));
    }
  }
  return map;
}

std::vector<std::string> codes_on(const Ground& ground) {
  std::vector<std::string> codes;
  for (const Warning& each : standing_ground(zx120(), map_of(ground)).warnings) {
    codes.push_back(code_text(each.code));
  }
  return codes;
}

using Codes = std::vector<std::string>;

TEST(StandingGround, EveryCheckHasBothItsSigns) {
  EXPECT_EQ(codes_on([](double, double) { return 0.0; }), Codes{});
  for (const auto& [z, code] : {std::pair{0.19, ""},
                                {0.21, "ground_above_tracks"},
                                {-0.19, ""},
                                {-0.21, "ground_below_tracks"}}) {
    EXPECT_EQ(codes_on([z = z](double, double) { return z; }), *code ? Codes{code} : Codes{}) << z;
  }
  for (const double degrees : {-3.2, -2.8, 2.8, 3.2}) {
    const double rise = std::tan(degrees * pi / 180.0);
    const Codes tilted = std::abs(degrees) > 3.0 ? Codes{"ground_tilted"} : Codes{};
    EXPECT_EQ(codes_on([rise](double x, double) { return rise * x; }), tilted) << degrees;
    EXPECT_EQ(codes_on([rise](double, double y) { return rise * y; }), tilted) << degrees;
  }
  const auto step = [](int side, double from, double z) {
    return codes_on([=](double x, double y) {
      const double all[] = {x - front_of_tracks, y - half, -x - front_of_tracks, -y - half};
      return all[side] > from ? z : 0.0;
    });
  };
  for (int side = 0; side < 4; ++side) {
    EXPECT_EQ(step(side, 0.8, -1.0), Codes{"drop_at_tracks"}) << side;
    EXPECT_EQ(step(side, 1.3, -1.0), Codes{}) << side;
    EXPECT_EQ(step(side, 0.3, -0.4), Codes{}) << side << ": shallow";
    EXPECT_EQ(step(side, 0.3, 2.0), Codes{}) << side << ": a wall";
  }
}

/// A diagonal view leaves open what lies straight ahead.
TEST(StandingGround, CornersShowNoSide) {
  const StandingGround found = standing_ground(
      zx120(), map_of([](double x, double y) {
        return std::abs(x) > front_of_tracks && std::abs(y) > half ? 0.0 : std::nan("");
      }));
  ASSERT_EQ(found.warnings.size(), 1U);
  EXPECT_EQ(found.warnings[0].code, WarningCode::ground_at_tracks_unseen);
  EXPECT_NE(found.warnings[0].message.find("ahead, left, behind, right"), std::string::npos)
      << found.warnings[0].message;
  EXPECT_FALSE(found.height || found.rise_ahead || found.rise_left);
}

TEST(StandingGround, AQuarterOfTheTracksMayNotHangInTheAir) {
  const auto hollow = [](double ahead, double left, double depth) {
    return [=](double x, double y) {
      const double along = ahead * x, across = left * y;
      const bool is_there = along > 0.0 && along < front_of_tracks && across > 0.0 && across < half;
      return is_there ? -depth : 0.0;
    };
  };
  for (const auto& [ahead, left, name] : {std::tuple(1.0, 1.0, "front left"),
                                          {1.0, -1.0, "front right"},
                                          {-1.0, 1.0, "rear left"},
                                          {-1.0, -1.0, "rear right"}}) {
    const auto warnings = standing_ground(zx120(), map_of(hollow(ahead, left, 0.4))).warnings;
    ASSERT_EQ(warnings.size(), 1U) << name;
    EXPECT_EQ(warnings[0].code, WarningCode::ground_below_tracks);
    EXPECT_TRUE(warnings[0].ends_trust);
    EXPECT_NE(warnings[0].message.find(name), std::string::npos) << warnings[0].message;
    EXPECT_EQ(codes_on(hollow(ahead, left, 0.25)), Codes{}) << name;
  }
}

TEST(StandingGround, AStoneUnderTheTracksIsLessThanSoil) {
  const auto block = [](double width) {
    return [=](double x, double y) {
      return x > 0.0 && x < width && y > 0.0 && y < width ? 0.3 : 0.0;
    };
  };
  EXPECT_EQ(codes_on(block(0.2)), Codes{});
  const auto warnings = standing_ground(zx120(), map_of(block(0.5))).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, WarningCode::soil_under_tracks);
  EXPECT_EQ(warnings[0].message.find("0.25 m2"), 0U) << warnings[0].message;
}

TEST(StandingGround, TheOwnCutIsStraightAheadAndNotTooNear) {
  const auto cut = [](double from, double width) {
    return codes_on([=](double x, double y) {
      return x > front_of_tracks + from && x < front_of_tracks + 3.0 && std::abs(y) < width ? -1.2
                                                                                            : 0.0;
    });
  };
  EXPECT_EQ(cut(0.5, 0.4), Codes{});
  EXPECT_EQ(cut(0.3, 0.4), Codes{"drop_at_tracks"});
  EXPECT_EQ(cut(0.5, 1.2), Codes{"drop_at_tracks"});
}

TEST(StandingGround, WhatLiesInTheShadowOfAnEdgeCountsFromTheEdge) {
  const double unseen = std::nan("");
  const auto behind = [&](double seen_from) {
    return codes_on([=](double x, double) {
      const double away = -x - front_of_tracks;
      return away < 1.2 ? 0.0 : away < seen_from ? unseen : -2.0;
    });
  };
  EXPECT_EQ(behind(2.6), Codes{"drop_at_tracks"});
  EXPECT_EQ(behind(5.0), Codes{});
}

TEST(StandingGround, SaysWhichGroundItDoesNotKnow) {
  const StandingGround found = standing_ground(
      zx120(), map_of([](double x, double) { return x > front_of_tracks ? 0.0 : std::nan(""); }));
  ASSERT_EQ(found.warnings.size(), 1U);
  EXPECT_EQ(found.warnings[0].code, WarningCode::ground_at_tracks_unseen);
  EXPECT_FALSE(found.warnings[0].ends_trust);
  EXPECT_NE(found.warnings[0].message.find("left, behind, right"), std::string::npos);
  EXPECT_TRUE(found.height && found.rise_left && !found.rise_ahead);
  EXPECT_NEAR(found.seen, 0.28, 0.05);
  EXPECT_TRUE(standing_ground(zx120(), map_of([](double x, double) {
                                return x > front_of_tracks ? 0.3 * (x - front_of_tracks)
                                                           : std::nan("");
                              }))
                  .warnings[0]
                  .ends_trust == false)
      << "a slope that begins ahead of the tracks";
}

TEST(StandingGround, AnEarlierScanOnlyFillsWhatThePresentOneDoesNotShow) {
  const HeightMap present =
      map_of([](double x, double) { return x > front_of_tracks ? -1.0 : std::nan(""); });
  const HeightMap both = known_from_both(present, map_of([](double, double) { return 0.1; }));
  EXPECT_EQ(height_at(both, 3.0, 0.0), -1.0) << "dug since";
  EXPECT_EQ(height_at(both, -3.0, 0.0), 0.1);
}

TEST(StandingGround, TracksMayEndBehindTheSwingAxis) {
  Machine machine = zx120();
  machine.track_front = -0.5;
  if (machine.body) machine.body->front_edge = -0.5;
  const StandingGround found = standing_ground(machine, map_of([](double, double) { return 0.4; }));
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_EQ(found.warnings[0].code, WarningCode::ground_above_tracks);
}

}  // namespace
}  // namespace excavplan::test
