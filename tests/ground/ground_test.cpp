// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <excavplan/change/bulking.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/resampling.hpp>

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "base/random.hpp"
#include "change/change_zones.hpp"
#include "change/systematic_errors.hpp"
#include "ground/grid_cells.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

// ---------------------------------------------------------------------------------------------
// The scene: pit, spill ridge and heap with closed-form volumes.

constexpr double pit_volume = 0.559946;
constexpr double ridge_volume = 0.077902;
constexpr double heap_volume = 0.622030;
const double heap_radius =
    std::cbrt(3.0 * heap_volume / (3.141592653589793 * std::tan(35.0 * degree)));  // 0.9466 m
const double scene_bulking = (ridge_volume + heap_volume) / pit_volume;            // 1.25

using Shape = std::function<double(double x, double y)>;

/// Place and heading of the pit, with the ridge beside it.
struct PitFrame {
  double u;
  double v;
  PitFrame(double x, double y) {
    const double along = std::cos(17.0 * degree);
    const double across = std::sin(17.0 * degree);
    u = (x - 3.013) * along + (y - 2.293) * across;
    v = -(x - 3.013) * across + (y - 2.293) * along;
  }
};

double pit(double x, double y) {
  const PitFrame p(x, y);
  const double inside = std::min(1.1 - std::abs(p.u), 0.5 - std::abs(p.v));
  return -std::clamp(inside * std::tan(70.0 * degree), 0.0, 0.3);
}

double ridge(double x, double y) {
  const PitFrame p(x, y);
  const double away = std::hypot(std::max(std::abs(p.u) - 1.1, 0.0), p.v - 0.85);
  return std::max(0.0, 0.15 - away * std::tan(35.0 * degree));
}

double heap_at(double x, double y, double centre_x, double centre_y) {
  const double away = std::hypot(x - centre_x, y - centre_y);
  return std::max(0.0, (heap_radius - away) * std::tan(35.0 * degree));
}

double heap(double x, double y) { return heap_at(x, y, 8.479, 2.534); }

double whole_dig(double x, double y) { return pit(x, y) + ridge(x, y) + heap(x, y); }

constexpr Rectangle scene = {0.0, 0.0, 11.0, 5.0};

/// Mean height of a shape over each cell.
HeightMap map_of(const Shape& shape, const Rectangle& extent = scene, double cell = 0.05) {
  constexpr int divisions = 8;
  HeightMap map = flat_ground(extent, cell);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      double sum = 0.0;
      for (int i = 0; i < divisions; ++i) {
        for (int j = 0; j < divisions; ++j) {
          sum += shape(map.x(col) + cell * ((i + 0.5) / divisions - 0.5),
                       map.y(row) + cell * ((j + 0.5) / divisions - 0.5));
        }
      }
      map.z(row, col) = sum / (divisions * divisions);
    }
  }
  return map;
}

const HeightMap& dug_scene() {
  static const HeightMap map = map_of(whole_dig);
  return map;
}

/// Noise of a cell in a scan of 0.1 million points over 30 m^2: 8.3 points in 5 cm x 5 cm.
double cell_noise(double point_noise) { return point_noise / std::sqrt(8.33); }

HeightMap noisy(HeightMap map, double sd, std::uint64_t seed, std::uint64_t scan) {
  Random random(seed, scan);
  for (Eigen::Index i = 0; i < map.z.size(); ++i) map.z.data()[i] += sd * random.normal();
  return map;
}

/// White noise smoothed by a Gaussian: height errors that neighbouring cells share.
Eigen::ArrayXXd smooth_noise(const HeightMap& map, double sd, double length, std::uint64_t seed,
                             std::uint64_t scan) {
  const double width = length / map.cell_size / std::sqrt(2.0);
  const int reach = static_cast<int>(std::ceil(3.0 * width));
  Random random(seed, scan);
  Eigen::ArrayXXd white(map.z.rows() + 2 * reach, map.z.cols() + 2 * reach);
  for (Eigen::Index i = 0; i < white.size(); ++i) white.data()[i] = random.normal();
  Eigen::ArrayXd weight(2 * reach + 1);
  for (int i = -reach; i <= reach; ++i) weight(i + reach) = std::exp(-0.5 * i * i / width / width);
  weight /= std::sqrt(weight.square().sum());
  Eigen::ArrayXXd along = Eigen::ArrayXXd::Zero(map.z.rows(), white.cols());
  for (int i = 0; i <= 2 * reach; ++i) along += weight(i) * white.middleRows(i, map.z.rows());
  Eigen::ArrayXXd both = Eigen::ArrayXXd::Zero(map.z.rows(), map.z.cols());
  for (int i = 0; i <= 2 * reach; ++i) both += weight(i) * along.middleCols(i, map.z.cols());
  return sd * both;
}

/// Takes discs of 10 to 25 cm radius out of a map until the given share is unknown.
void punch_holes(HeightMap& map, double share, std::uint64_t seed, std::uint64_t scan) {
  Random random(seed, scan);
  const Rectangle extent = map.extent();
  double area = share * (extent.x_max - extent.x_min) * (extent.y_max - extent.y_min);
  while (area > 0.0) {
    const double radius = random.uniform(0.10, 0.25);
    const double x = random.uniform(extent.x_min, extent.x_max);
    const double y = random.uniform(extent.y_min, extent.y_max);
    area -= 3.141592653589793 * radius * radius;
    for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
        if (std::hypot(map.x(col) - x, map.y(row) - y) < radius) map.z(row, col) = nan;
      }
    }
  }
}

int count_of(const VolumeChange& change, const std::string& code) {
  return static_cast<int>(
      std::count_if(change.warnings.begin(), change.warnings.end(),
                    [&](const Warning& warning) { return code_text(warning.code) == code; }));
}

std::string message_of(const VolumeChange& change, const std::string& code) {
  for (const Warning& warning : change.warnings) {
    if (code_text(warning.code) == code) return warning.message;
  }
  return "no warning " + code;
}

int zones_of(const VolumeChange& change, ZoneKind kind) {
  return static_cast<int>(std::count_if(change.zones.begin(), change.zones.end(),
                                        [&](const ChangeZone& zone) { return zone.kind == kind; }));
}

bool covers(const Measured& figure, double truth) {
  return std::abs(figure.value - truth) <= 1.96 * figure.sd;
}

/// How often the 95 % interval held the truth, and the mean and spread of the error.
struct Score {
  int seeds = 0;
  int covered = 0;
  double sum = 0.0;
  double squares = 0.0;

  void add(const Measured& figure, double truth) {
    const double error = figure.value / truth - 1.0;
    ++seeds;
    covered += covers(figure, truth) ? 1 : 0;
    sum += error;
    squares += error * error;
  }
  double bias() const { return sum / seeds; }
  double rms() const { return std::sqrt(squares / seeds); }
};

struct Scores {
  Score before, after, spilled, k;
};

/// Measures the scene in 40 pairs of scans.
Scores score(const std::function<HeightMap(HeightMap, std::uint64_t, std::uint64_t)>& scan) {
  const HeightMap ground = flat_ground(scene, 0.05);
  Scores scores;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const VolumeChange change = measure_change(scan(ground, seed, 1), scan(dug_scene(), seed, 2));
    scores.before.add(change.before, pit_volume);
    scores.after.add(change.after, ridge_volume + heap_volume);
    scores.spilled.add(change.spilled, ridge_volume);
    scores.k.add(bulking_factor(change).value_or(Measured{}), scene_bulking);
  }
  return scores;
}

/// What the scores are, for the message of a test that fails.
std::string text_of(const Scores& scores) {
  std::string text;
  const auto add = [&](const char* name, const Score& s) {
    text += std::string(name) + ": bias " + std::to_string(100.0 * s.bias()) + " %, rms " +
            std::to_string(100.0 * s.rms()) + " %, covered " + std::to_string(s.covered) + " of " +
            std::to_string(s.seeds) + "\n";
  };
  add("before", scores.before);
  add("after", scores.after);
  add("spilled", scores.spilled);
  add("k", scores.k);
  return text;
}

// ---------------------------------------------------------------------------------------------

TEST(HeightMap, FlatGroundCoversItsExtent) {
  const HeightMap map = flat_ground({-1.0, 2.0, 2.0, 3.01}, 0.1, 0.5);
  EXPECT_EQ(map.z.cols(), 30);
  EXPECT_EQ(map.z.rows(), 11);
  EXPECT_TRUE((map.z == 0.5).all());
  EXPECT_NEAR(map.x(0), -0.95, 1e-12);
  EXPECT_NEAR(map.y(10), 3.05, 1e-12);
  EXPECT_NEAR(map.extent().x_max, 2.0, 1e-12);
  EXPECT_NEAR(map.extent().y_max, 3.1, 1e-12);
}

TEST(HeightMap, ImpossibleGroundIsRefused) {
  EXPECT_THROW(flat_ground({0, 0, 0, 1}, 0.1), Error);
  EXPECT_THROW(flat_ground({0, 0, 1, -1}, 0.1), Error);
  EXPECT_THROW(flat_ground({0, 0, nan, 1}, 0.1), Error);
  EXPECT_THROW(flat_ground({0, 0, 1, 1}, 0.0), Error);
  EXPECT_THROW(flat_ground({0, 0, 1, 1}, nan), Error);
  EXPECT_EQ(test::error_of([] {
              flat_ground({0, 0, 1000, 1001}, 0.1);
            }),
            "a map of 1000 m x 1001 m in cells of 0.1 m holds 100100000 cells, most are 2e+07");
}

TEST(HeightMap, HeightBetweenCentresIsExactOnPlanes) {
  const auto plane = [](double x, double y) { return 0.3 + 0.2 * x - 0.7 * y; };
  const HeightMap map = map_of(plane, {-1, -2, 3, 1}, 0.1);
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-0.95, 2.95);
    const double y = random.uniform(-1.95, 0.95);
    EXPECT_NEAR(height_at(map, x, y), plane(x, y), 1e-12);
  }
}

TEST(HeightMap, HeightWithinHalfACellOfTheBorderIsThatOfTheNearestCentres) {
  const HeightMap map = map_of([](double x, double) { return x; }, {0, 0, 1, 1}, 0.1);
  EXPECT_NEAR(height_at(map, 0.0, 0.0), 0.05, 1e-12);
  EXPECT_NEAR(height_at(map, 1.0, 1.0), 0.95, 1e-12);
  EXPECT_TRUE(std::isnan(height_at(map, -0.001, 0.5)));
  EXPECT_TRUE(std::isnan(height_at(map, 0.5, 1.001)));
  EXPECT_TRUE(std::isnan(height_at(map, nan, 0.5)));
  EXPECT_TRUE(std::isnan(height_at(HeightMap{}, 0.0, 0.0)));
}

TEST(HeightMap, HeightBesideAnUnknownCellIsUnknown) {
  HeightMap map = flat_ground({0, 0, 1, 1}, 0.1, 2.0);
  map.z(5, 5) = nan;
  EXPECT_TRUE(std::isnan(height_at(map, 0.55, 0.55)));
  EXPECT_TRUE(std::isnan(height_at(map, 0.51, 0.55)));
  EXPECT_TRUE(std::isnan(height_at(map, 0.46, 0.46)));
  EXPECT_EQ(height_at(map, map.x(4), map.y(5)), 2.0) << "a known cell's own centre";
  EXPECT_EQ(height_at(map, 0.44, 0.55), 2.0);
}

TEST(HeightMap, ResamplingFillsNarrowGapsAndLeavesWideOnesUnknown) {
  const HeightMap plane = map_of([](double x, double y) { return 0.2 * x - 0.1 * y; });
  HeightMap seen = plane;
  seen.z.block(20, 20, 40, 4).setConstant(nan);   // 0.2 m wide, 2 m long
  seen.z.block(20, 60, 40, 10).setConstant(nan);  // 0.5 m wide
  seen.z.block(0, 100, 4, 4).setConstant(nan);    // at the border
  const Rectangle extent = {0.5, 0.0, 9.5, 4.0};
  const HeightMap map = resampled(seen, extent, 0.04, 0.3);
  EXPECT_NEAR(height_at(map, 1.1, 2.0), 0.2 * 1.1 - 0.1 * 2.0, 1e-6);
  EXPECT_TRUE(std::isnan(height_at(map, 3.25, 2.0)));
  EXPECT_TRUE(std::isnan(height_at(map, 5.1, 0.1)));
  EXPECT_FALSE(std::isnan(height_at(resampled(seen, extent, 0.04, 0.5), 3.25, 2.0)));
  EXPECT_NEAR(unseen_area(map), 0.5 * 2.0 + 0.2 * 0.2, 0.2) << "half a cell more around it";
  EXPECT_EQ(unseen_area(plane), 0.0);
}

TEST(HeightMap, GridsAreTheSameOnlyInEveryPart) {
  const HeightMap map = flat_ground({0, 0, 1, 2}, 0.1);
  EXPECT_TRUE(same_grid(map, flat_ground({0, 0, 1, 2}, 0.1, 7.0)));
  EXPECT_FALSE(same_grid(map, flat_ground({0, 0, 1.1, 2}, 0.1)));
  EXPECT_FALSE(same_grid(map, flat_ground({1e-6, 0, 1, 2}, 0.1)));
  HeightMap other = map;
  other.cell_size = 0.1001;
  EXPECT_FALSE(same_grid(map, other));
  other.cell_size = 0.1 * (1.0 + 1e-12);
  EXPECT_TRUE(same_grid(map, other));
}

// ---------------------------------------------------------------------------------------------

TEST(VolumeChange, ExactMapsGiveTheClosedFormVolumes) {
  const VolumeChange change = measure_change(flat_ground(scene, 0.05), dug_scene());
  EXPECT_NEAR(change.excavated.value, pit_volume, 0.003 * pit_volume);
  EXPECT_NEAR(change.spilled.value, ridge_volume, 0.003 * ridge_volume);
  EXPECT_NEAR(change.dumped.value, heap_volume, 0.003 * heap_volume);
  EXPECT_EQ(change.before.value, change.excavated.value);
  EXPECT_NEAR(change.after.value, change.spilled.value + change.dumped.value, 1e-12);
  EXPECT_EQ(change.zones.size(), 3u);
  EXPECT_TRUE(change.warnings.empty()) << change.warnings[0].message;
  const auto k = bulking_factor(change);
  ASSERT_TRUE(k);
  EXPECT_NEAR(k->value, scene_bulking, 0.001 * scene_bulking);
}

TEST(VolumeChange, ZonesAndDifferenceAreHandedOver) {
  const HeightMap ground = flat_ground(scene, 0.05);
  const VolumeChange change = measure_change(ground, dug_scene());
  ASSERT_EQ(change.areas.size(), 1u);
  const AreaChange& area = change.areas[0];
  EXPECT_TRUE(same_grid(area.difference, ground));
  const auto kind_at = [&](double x, double y) {
    const int zone =
        area.zone(static_cast<Eigen::Index>(y / 0.05), static_cast<Eigen::Index>(x / 0.05));
    return zone < 0 ? std::string("stable")
                    : std::to_string(
                          static_cast<int>(change.zones[static_cast<std::size_t>(zone)].kind));
  };
  EXPECT_EQ(kind_at(3.013, 2.293), std::to_string(static_cast<int>(ZoneKind::dig)));
  EXPECT_EQ(kind_at(2.76, 3.10), std::to_string(static_cast<int>(ZoneKind::spill)));
  EXPECT_EQ(kind_at(8.479, 2.534), std::to_string(static_cast<int>(ZoneKind::dump)));
  EXPECT_EQ(kind_at(6.0, 2.5), "stable");
  for (const ChangeZone& zone : change.zones) {
    EXPECT_EQ(zone.unknown_share, 0.0);
    if (zone.kind != ZoneKind::dump) continue;
    EXPECT_NEAR(zone.area, 3.1416 * std::pow(heap_radius + 0.10, 2), 0.1);
    EXPECT_NEAR(zone.extent.x_min, 8.479 - heap_radius - 0.10, 0.05);
    EXPECT_NEAR(zone.extent.x_max, 8.479 + heap_radius + 0.10, 0.05);
  }
}

TEST(VolumeChange, NoisyScansGiveTheVolumesInsideTheirInterval) {
  const Scores five = score([](HeightMap map, std::uint64_t seed, std::uint64_t scan) {
    return noisy(std::move(map), cell_noise(0.005), seed, scan);
  });
  SCOPED_TRACE(text_of(five));
  EXPECT_LT(std::abs(five.before.bias()), 0.001);
  EXPECT_LT(std::abs(five.after.bias()), 0.001);
  EXPECT_LT(five.k.rms(), 0.002);
  for (const Score& s : {five.before, five.after, five.k}) EXPECT_GE(s.covered, 36);

  const Scores twenty = score([](HeightMap map, std::uint64_t seed, std::uint64_t scan) {
    return noisy(std::move(map), cell_noise(0.020), seed, scan);
  });
  SCOPED_TRACE(text_of(twenty));
  EXPECT_LT(std::abs(twenty.before.bias()), 0.002);
  EXPECT_LT(std::abs(twenty.after.bias()), 0.002);
  EXPECT_LT(twenty.k.rms(), 0.006);
  for (const Score& s : {twenty.before, twenty.after, twenty.k}) EXPECT_GE(s.covered, 36);
}

TEST(VolumeChange, CorrelatedNoiseWidensTheInterval) {
  const Scores scores = score([](HeightMap map, std::uint64_t seed, std::uint64_t scan) {
    map.z += smooth_noise(map, 0.005, 0.25, seed, scan);
    return noisy(std::move(map), cell_noise(0.005), seed, scan + 10);
  });
  SCOPED_TRACE(text_of(scores));
  EXPECT_LT(scores.k.rms(), 0.04);
  for (const Score& s : {scores.before, scores.after, scores.k}) EXPECT_GE(s.covered, 36);
}

TEST(VolumeChange, HolesInTheScansAreFilledAndWidenTheInterval) {
  const Scores scores = score([](HeightMap map, std::uint64_t seed, std::uint64_t scan) {
    punch_holes(map, 0.05, seed, scan);
    return noisy(std::move(map), cell_noise(0.005), seed, scan);
  });
  SCOPED_TRACE(text_of(scores));
  EXPECT_LT(std::abs(scores.k.bias()), 0.005);
  EXPECT_LT(scores.k.rms(), 0.02);
  for (const Score& s : {scores.before, scores.after, scores.k}) EXPECT_GE(s.covered, 36);
}

TEST(VolumeChange, UnknownCellsInThePitAreFilledAndCounted) {
  HeightMap after = dug_scene();
  int unknown = 0;
  for (Eigen::Index col = 56; col < 64; ++col) {
    for (Eigen::Index row = 42; row < 48; ++row, ++unknown) after.z(row, col) = nan;
  }
  const VolumeChange change = measure_change(flat_ground(scene, 0.05), after);
  EXPECT_NEAR(change.excavated.value, pit_volume, 0.003 * pit_volume);
  ASSERT_EQ(zones_of(change, ZoneKind::dig), 1);
  for (const ChangeZone& zone : change.zones) {
    if (zone.kind != ZoneKind::dig) continue;
    EXPECT_NEAR(zone.unknown_share, unknown * 0.0025 / zone.area, 1e-12);
  }
  EXPECT_TRUE(std::isnan(change.areas[0].difference.z(44, 60))) << "unknown stays unknown";
  EXPECT_EQ(count_of(change, "zone_partly_unseen"), 0);
  ChangeOptions strict;
  strict.max_unknown_share = 0.01;
  EXPECT_EQ(count_of(measure_change(flat_ground(scene, 0.05), after, strict), "zone_partly_unseen"),
            1);
}

TEST(VolumeChange, UnknownCellsOutsideTheSurveyAreNotFilled) {
  HeightMap after = dug_scene();
  after.z.leftCols(20).setConstant(nan);
  after.z.topRows(5).setConstant(nan);
  const VolumeChange change = measure_change(flat_ground(scene, 0.05), after);
  EXPECT_NEAR(change.excavated.value, pit_volume, 0.003 * pit_volume);
  EXPECT_TRUE(change.warnings.empty());
  EXPECT_TRUE((change.areas[0].zone.leftCols(20) == -1).all());
}

TEST(VolumeChange, FlatNoisyGroundHasNoZone) {
  const HeightMap ground = flat_ground(scene, 0.05);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const VolumeChange change =
        measure_change(noisy(ground, 0.005, seed, 1), noisy(ground, 0.005, seed, 2));
    EXPECT_TRUE(change.zones.empty()) << "seed " << seed;
    EXPECT_EQ(change.before.value, 0.0);
    EXPECT_EQ(change.after.value, 0.0);
    EXPECT_EQ(count_of(change, "no_hole_found"), 1);
    EXPECT_FALSE(bulking_factor(change));
    EXPECT_NEAR(change.areas[0].noise_sd, 0.005 * std::sqrt(2.0), 0.0002);
  }
}

TEST(VolumeChange, ExactFlatGroundHasNoZone) {
  const HeightMap ground = flat_ground(scene, 0.05);
  EXPECT_TRUE(measure_change(ground, ground).zones.empty());
}

TEST(VolumeChange, OffsetBetweenTheScansIsTakenOff) {
  const HeightMap before = noisy(flat_ground(scene, 0.05), cell_noise(0.005), 5, 1);
  HeightMap after = noisy(dug_scene(), cell_noise(0.005), 5, 2);
  const VolumeChange level = measure_change(before, after);
  after.z += 0.005;
  const VolumeChange raised = measure_change(before, after);
  EXPECT_NEAR(raised.areas[0].datum - level.areas[0].datum, 0.005, 1e-9);
  EXPECT_NEAR(raised.before.value, level.before.value, 1e-9);
  EXPECT_NEAR(raised.after.value, level.after.value, 1e-9);
}

TEST(VolumeChange, RoughTerrainUnderTheDigChangesNothing) {
  const auto rough = [](double x, double y) {
    return 0.14 * x - 0.05 * y + 0.02 * std::sin(5.0 * x) * std::cos(3.0 * y);
  };
  const HeightMap before = map_of(rough);
  HeightMap after = before;
  after.z += dug_scene().z;
  const VolumeChange change = measure_change(before, after);
  EXPECT_NEAR(change.before.value, pit_volume, 0.003 * pit_volume);
  EXPECT_NEAR(change.after.value, ridge_volume + heap_volume, 0.002);
}

TEST(VolumeChange, StableGroundIsFoundWhereMostOfTheMapChanged) {
  constexpr Rectangle tight = {1.9, 1.4, 4.1, 3.2};  // the pit and a rim about it
  const HeightMap before = noisy(flat_ground(tight, 0.05), cell_noise(0.005), 9, 1);
  const HeightMap after = noisy(map_of(pit, tight), cell_noise(0.005), 9, 2);
  const VolumeChange change = measure_change(before, after);
  const double dug = -0.0025 * map_of(pit, tight).z.sum();
  EXPECT_NEAR(change.before.value, dug, 0.02 * dug);
  EXPECT_EQ(count_of(change, "little_stable_ground"), 1);
}

TEST(VolumeChange, ScansThatDoNotFitAreSaid) {
  const HeightMap tilted = map_of([](double x, double) { return 0.2 * x; });
  EXPECT_EQ(count_of(measure_change(flat_ground(scene, 0.05), tilted), "scans_do_not_fit"), 1);
}

TEST(VolumeChange, FourMapsGiveTheSameVolumesAsTheWholeScene) {
  constexpr Rectangle dig_area = {0.0, 0.0, 6.0, 5.0};
  constexpr Rectangle dump_area = {6.0, 0.0, 11.0, 5.0};
  const auto dig = HeightMapPair{flat_ground(dig_area, 0.05), map_of(whole_dig, dig_area)};
  const auto dump = HeightMapPair{flat_ground(dump_area, 0.05), map_of(whole_dig, dump_area)};
  const VolumeChange apart = measure_change(dig, dump);
  const VolumeChange whole = measure_change(flat_ground(scene, 0.05), dug_scene());
  EXPECT_NEAR(apart.excavated.value, whole.excavated.value, 1e-4);
  EXPECT_NEAR(apart.spilled.value, whole.spilled.value, 1e-4);
  EXPECT_NEAR(apart.dumped.value, whole.dumped.value, 1e-4);
  ASSERT_EQ(apart.areas.size(), 2u);
  const int dump_zone = apart.areas[1].zone(50, 50);
  ASSERT_GE(dump_zone, 0);
  EXPECT_EQ(apart.zones[static_cast<std::size_t>(dump_zone)].kind, ZoneKind::dump);
  EXPECT_TRUE(apart.warnings.empty());
}

TEST(VolumeChange, DatumErrorMakesBeforeAndAfterErrAgainstEachOther) {
  const VolumeChange change =
      measure_change(noisy(flat_ground(scene, 0.05), 0.005, 3, 1), noisy(dug_scene(), 0.005, 3, 2));
  EXPECT_LT(change.covariance_before_after, 0.0);
  EXPECT_GT(change.covariance_before_after, -change.before.sd * change.after.sd);
}

TEST(VolumeChange, GivenAreasDecideWhatIsHoleAndHeap) {
  const auto two_digs = [](double x, double y) {
    return whole_dig(x, y) - heap_at(x, y, 6.0, 1.2) * 1.5;
  };
  const HeightMap before = flat_ground(scene, 0.05);
  const HeightMap after = map_of(two_digs);
  const VolumeChange free = measure_change(before, after);
  EXPECT_NEAR(free.excavated.value, pit_volume, 0.002) << "the hole that the soil fits";
  ChangeOptions options;
  options.dig_area = Rectangle{1.0, 1.0, 5.0, 4.0};
  options.dump_area = Rectangle{7.0, 1.0, 10.0, 4.0};
  const VolumeChange chosen = measure_change(before, after, options);
  EXPECT_NEAR(chosen.excavated.value, pit_volume, 0.002);
  EXPECT_NEAR(chosen.spilled.value, ridge_volume, 0.001);
  EXPECT_NEAR(chosen.dumped.value, heap_volume, 0.002);
  EXPECT_EQ(count_of(chosen, "other_change"), 1);
  EXPECT_EQ(zones_of(chosen, ZoneKind::other), 1);
}

TEST(VolumeChange, UnrelatedChangesAreLeftOutWithAWarning) {
  const auto with_visitor = [](double x, double y) {
    return whole_dig(x, y) + (x > 10.0 && x < 10.3 && y > 4.0 && y < 4.5 ? 0.4 : 0.0);
  };
  const VolumeChange change = measure_change(flat_ground(scene, 0.05), map_of(with_visitor));
  EXPECT_NEAR(change.after.value, ridge_volume + heap_volume, 0.002);
  ASSERT_EQ(change.warnings.size(), 1u);
  EXPECT_EQ(change.warnings[0].code, WarningCode::other_change);
  EXPECT_EQ(
      change.warnings[0].message,
      "ground that rose by 0.06 m^3 over 0.34 m^2 around (10.15, 4.25) m is neither hole, "
      "spill nor heap: excluded from all volumes; `dig_area` and `dump_area` take it in, if it "
      "belongs to them");
}

TEST(VolumeChange, HeapRightBesideTheHoleIsStillTheHeap) {
  const auto close = [](double x, double y) { return pit(x, y) + heap_at(x, y, 2.5, 3.85); };
  const VolumeChange change = measure_change(flat_ground(scene, 0.05), map_of(close));
  EXPECT_NEAR(change.dumped.value, heap_volume, 0.02);
  EXPECT_EQ(count_of(change, "no_dumped_soil"), 0);
}

TEST(VolumeChange, DumpedSoilOutsideTheScansIsSaid) {
  const auto without_heap = [](double x, double y) { return pit(x, y) + ridge(x, y); };
  const VolumeChange change = measure_change(flat_ground(scene, 0.05), map_of(without_heap));
  EXPECT_NEAR(change.excavated.value, pit_volume, 0.002);
  EXPECT_NEAR(change.spilled.value, ridge_volume, 0.001);
  EXPECT_EQ(change.dumped.value, 0.0);
  EXPECT_EQ(
      message_of(change, "no_dumped_soil"),
      "the hole is 0.56 m^3, but only 0 m^3 rose away from it and 0.078 m^3 beside it: the "
      "dumped soil is not in the scans, so the bulking factor is unknown; give scans that show "
      "it, or those of the dump area by `dump_before` and `dump_after`");
  EXPECT_FALSE(bulking_factor(change));
}

TEST(VolumeChange, SmallRiseAwayFromTheHoleIsNotTakenForTheHeap) {
  const auto bump = [](double x, double y) {
    return pit(x, y) + 4.0 * ridge(x, y) + 0.1 * heap(x, y);
  };
  const VolumeChange change = measure_change(flat_ground(scene, 0.05), map_of(bump));
  EXPECT_GT(change.after.value, 0.5 * change.before.value);
  EXPECT_EQ(count_of(change, "no_dumped_soil"), 1);
  EXPECT_FALSE(bulking_factor(change));
}

TEST(VolumeChange, SwappedScansAreSaid) {
  const VolumeChange change = measure_change(dug_scene(), flat_ground(scene, 0.05));
  EXPECT_NE(message_of(change, "looks_swapped").find("before and after are probably swapped: 0.62"),
            std::string::npos)
      << message_of(change, "looks_swapped");
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const HeightMap before = noisy(flat_ground(scene, 0.05), cell_noise(0.02), seed, 1);
    const HeightMap after = noisy(dug_scene(), cell_noise(0.02), seed, 2);
    EXPECT_EQ(count_of(measure_change(after, before), "looks_swapped"), 1);
    EXPECT_EQ(count_of(measure_change(before, after), "looks_swapped"), 0);
  }
}

/// Two boxes, of which the heap is a little smaller than the hole: a contradiction between exact
/// scans, and none between scans that err by that much.
TEST(VolumeChange, ScansThatMayErrSoAreNotSaidToBeSwapped) {
  const auto boxes = [](double x, double y) {
    const bool beside = std::abs(y - 2.5) < 0.5;
    return (beside && std::abs(x - 3.0) < 0.5 ? -0.20 : 0.0) +
           (beside && std::abs(x - 8.0) < 0.5 ? 0.193 : 0.0);
  };
  const HeightMap flat = flat_ground(scene, 0.05);
  const HeightMap dug = map_of(boxes);
  EXPECT_EQ(count_of(measure_change(flat, dug), "looks_swapped"), 1);
  int within_error = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const VolumeChange change =
        measure_change(noisy(flat, 0.05, seed, 1), noisy(dug, 0.05, seed, 2));
    const double error = std::sqrt(std::pow(change.before.sd, 2) + std::pow(change.after.sd, 2) -
                                   2.0 * change.covariance_before_after);
    const double missing = change.before.value - change.after.value;
    const bool shrank = change.after.value < 0.97 * change.before.value;
    EXPECT_EQ(count_of(change, "looks_swapped"), shrank && missing > 2.0 * error ? 1 : 0) << seed;
    within_error += shrank && missing < 1.9 * error ? 1 : 0;
  }
  EXPECT_GT(within_error, 0);
}

/// What a hole and a heap err is what the volumes of their kind err.
/// That of hole and heap has, beside that of their zones, what strewn soil may do to the datum.
TEST(VolumeChange, TheErrorOfAZoneHasAllItsSources) {
  const VolumeChange change =
      measure_change(noisy(flat_ground(scene, 0.05), 0.01, 1, 1), noisy(dug_scene(), 0.01, 1, 2));
  const Eigen::Matrix3d scans = change.errors.scans();
  EXPECT_GT(change.errors.faces(0, 0), 0.02 * scans(0, 0));
  const std::pair<ZoneKind, Eigen::Index> kinds[] = {{ZoneKind::dig, 0}, {ZoneKind::dump, 2}};
  for (const auto& [kind, at] : kinds) {
    ASSERT_EQ(zones_of(change, kind), 1);
    for (const ChangeZone& zone : change.zones) {
      if (zone.kind == kind) {
        EXPECT_NEAR(zone.volume.sd / std::sqrt(scans(at, at)), 1.0, 0.02);
      }
    }
  }
}

/// Most of the ground keeps its height to 0.02 mm and a third to 0.06 mm some 5 mm lower: the
/// datum is that of the first, though both spreads are below the least noise that is stated.
TEST(VolumeChange, TheDatumIsThatOfTheDensestChanges) {
  const HeightMap before = flat_ground({0.0, 0.0, 3.0, 3.0}, 0.05);
  HeightMap after = before;
  Random random(9);
  for_each_cell(after.z, [&](Cell at) {
    const bool lower = at.col < 20;
    const double sd = lower ? 6e-5 : 2e-5;
    after.z(at.row, at.col) += (lower ? 0.0 : 0.005) + sd * random.normal();
  });
  const VolumeChange change = measure_change(before, after);
  EXPECT_NEAR(change.areas.front().datum, 0.005, 1e-5);
}

/// On maps without noise a third of the ground, all cut to one level, is as dense as the rest.
TEST(VolumeChange, WithoutNoiseTheDatumIsTheLevelThatDidNotChange) {
  const HeightMap before = flat_ground({0.0, 0.0, 6.0, 6.0}, 0.05);
  const Eigen::ArrayXXd unknown = nan * before.z;
  for (const double change : {-0.1, 0.1}) {
    HeightMap after = before;
    after.z.block(20, 20, 70, 70) += change;
    const ChangedGround found = find_change(after.z - before.z, unknown, before.cell_size, {});
    EXPECT_NEAR(found.datum, 0.0, 1e-9) << change;
    EXPECT_LT(found.zone(0, 0), 0) << change;
    EXPECT_GE(found.zone(55, 55), 0) << change;
  }
}

/// Soil of 2 cm beside the pit is as high as the bends of the scan.
TEST(VolumeChange, BendsOfAScanHideNoThinSoil) {
  const Shape thinly_spilled = [](double x, double y) {
    const PitFrame p(x, y);
    const bool is_covered = std::abs(p.u) < 1.1 && p.v > -1.4 && p.v < -0.6;
    return whole_dig(x, y) + (is_covered ? 0.02 : 0.0);
  };
  const HeightMap before = noisy(flat_ground(scene, 0.05), 0.004, 1, 1);
  const VolumeChange straight = measure_change(before, noisy(map_of(thinly_spilled), 0.004, 1, 2));
  EXPECT_EQ(count_of(straight, "systematic_errors"), 0);
  const std::pair<const char*, Shape> bends[] = {
      {"waves", [](double x, double) { return 0.02 * std::sin(4.0 * x); }},
      {"oblique waves", [](double x, double y) { return 0.02 * std::sin(2.0 * x + 2.5 * y); }},
      {"a bowl", [](double x, double y) { return 0.004 * (std::pow(x - 5.0, 2) + y * y); }},
      {"a saddle", [](double x, double y) { return 0.006 * (x - 5.0) * (y - 2.0); }}};
  for (const auto& [name, bend] : bends) {
    const Shape& by = bend;
    const Shape bent = [&](double x, double y) { return thinly_spilled(x, y) + by(x, y); };
    const VolumeChange change = measure_change(before, noisy(map_of(bent), 0.004, 1, 2));
    EXPECT_EQ(count_of(change, "systematic_errors"), 1) << name;
    EXPECT_NEAR(change.before.value, straight.before.value, 0.01 * pit_volume) << name;
    EXPECT_NEAR(change.after.value, straight.after.value, 0.015 * pit_volume) << name;
  }
}

/// On ground of 200 x 100 cells that did not change but for two zones beside each other in its
/// middle.
ChangedGround ground_with(const Shape& error) {
  ChangedGround ground;
  ground.difference = Eigen::ArrayXXd(100, 200);
  ground.zone = Eigen::ArrayXXi::Constant(100, 200, -1);
  ground.zone.block(40, 80, 20, 20) = 0;
  ground.zone.block(40, 100, 20, 20) = 1;
  ground.zone_is_cut = {false, false};
  Random random(4);
  for_each_cell(ground.difference, [&](Cell at) {
    const double x = 0.05 * static_cast<double>(at.col);
    const double y = 0.05 * static_cast<double>(at.row);
    ground.difference(at.row, at.col) = error(x, y) + 0.002 * random.normal();
  });
  ground.residual = (ground.zone < 0).select(ground.difference, nan);
  return ground;
}

TEST(VolumeChange, DomingIsTakenOffWhereAllGroundHasIt) {
  ChangedGround bowl =
      ground_with([](double x, double y) { return 0.004 * (x * x - 0.5 * x * y + 2.0 * y * y); });
  const Eigen::MatrixXd left = take_doming_off(bowl, 0.05);
  EXPECT_LT(bowl.difference.block(40, 80, 20, 40).abs().mean(), 0.002);
  EXPECT_LT(std::sqrt(bowl.residual.isNaN().select(0.0, bowl.residual).square().mean()), 0.0021);
  ASSERT_EQ(left.size(), 4);
  EXPECT_GT(left(0, 1), 0.5 * left(0, 0));                // what is left of it is one dome
  const double of_cells = std::sqrt(left.sum()) / 800.0;  // of the mean of all their cells
  EXPECT_GT(of_cells, 0.5e-5);
  EXPECT_LT(of_cells, 10e-5);
  const std::pair<const char*, Shape> others[] = {
      {"noise", [](double, double) { return 0.0; }},
      {"a plane", [](double x, double y) { return 0.01 * x - 0.02 * y; }},
      {"a bump", [](double x, double y) {
         return 0.03 * std::exp(-std::pow(x - 5.0, 2) - std::pow(y - 2.5, 2));
       }}};
  for (const auto& [name, error] : others) {
    ChangedGround ground = ground_with(error);
    const Eigen::ArrayXXd difference = ground.difference;
    EXPECT_TRUE(take_doming_off(ground, 0.05).isZero(0.0)) << name;
    EXPECT_TRUE((ground.difference == difference).all()) << name;
  }
}

/// Its error is that of an edge which thins out beyond the zone, along the rim of the heap.
TEST(VolumeChange, SoilTooThinToTellWidensTheInterval) {
  const auto thin_of = [](double noise) {
    const VolumeChange change = measure_change(noisy(flat_ground(scene, 0.05), noise, 1, 1),
                                               noisy(dug_scene(), noise, 1, 2));
    EXPECT_LT(change.errors.thin(0, 0), 1e-7) << "by the datum alone";
    return std::sqrt(change.errors.thin(2, 2));
  };
  EXPECT_LT(thin_of(0.004), 1e-4) << "likewise";
  const double lowest = 3.0 * std::sqrt(2.0) * 0.03 / 3.0;  // that is told, of 3 x 3 cells
  const double beyond = lowest / 0.3 - lowest / 0.5;
  const double edge = 8.0 * heap_radius;  // of a square about it: the sides of its cells
  EXPECT_NEAR(thin_of(0.03) / (edge * 0.15 * beyond * beyond), 1.15, 0.25);
}

TEST(VolumeChange, ErrorsThatNeighboursShareEndTrust) {
  const HeightMap before = noisy(flat_ground(scene, 0.05), 0.004, 1, 1);
  for (const double sd : {0.004, 0.016}) {
    HeightMap after = noisy(dug_scene(), 0.004, 1, 2);
    after.z += smooth_noise(after, sd, 0.4, 3, 3);
    const VolumeChange change = measure_change(before, after);
    EXPECT_EQ(count_of(change, "scans_do_not_fit"), sd > 0.01 ? 1 : 0) << sd;
    ChangeOptions stated;
    stated.sensor_pattern_sd = 0.012;
    EXPECT_EQ(count_of(measure_change(before, after, stated), "scans_do_not_fit"), 0) << sd;
  }
}

TEST(VolumeChange, ZoneThatTheSurveyCutsOffIsSaid) {
  constexpr Rectangle cut = {0.0, 0.0, 8.4, 5.0};
  const VolumeChange change = measure_change(flat_ground(cut, 0.05), map_of(whole_dig, cut));
  EXPECT_EQ(count_of(change, "zone_at_border"), 1);
}

/// A prism of 27 degrees along the section of the heap at the edge: half of its height squared, by
/// its slope of 0.5.
TEST(VolumeChange, SoilBeyondTheEdgeOfTheSurveyMayBeAPrismOfTheGentlestSlope) {
  constexpr Rectangle half = {0.0, 0.0, 8.5, 5.0};
  const VolumeChange change = measure_change(flat_ground(half, 0.05), map_of(whole_dig, half));
  const double slope = std::tan(35.0 * degree);
  const double squares_of_section = 2.0 / 3.0 * std::pow(heap_radius, 3) * slope * slope;
  const double prism = 0.5 * squares_of_section / 0.5;
  EXPECT_NEAR(std::sqrt(change.errors.holes(2, 2)), prism, 0.02 * prism);
}

/// What is said of zones at the edge, where one is.
const Warning* edge_warning(const VolumeChange& change) {
  for (const Warning& warning : change.warnings) {
    if (warning.code == WarningCode::zone_at_border) return &warning;
  }
  return nullptr;
}

TEST(VolumeChange, AHeapThatThinsOutAtTheEdgeOfTheSurveyIsWholeButForLitres) {
  const auto cut_at = [](double x_max) {
    const Rectangle extent = {0.0, 0.0, x_max, 5.0};
    return measure_change(flat_ground(extent, 0.05), map_of(whole_dig, extent));
  };
  const VolumeChange at_toe = cut_at(9.35);
  const Warning* const said = edge_warning(at_toe);
  ASSERT_NE(said, nullptr);
  EXPECT_FALSE(said->ends_trust) << said->message;
  EXPECT_NE(said->message.find("up to 0.006 m^3 may lie beyond"), std::string::npos)
      << said->message;
  EXPECT_GT(at_toe.dumped.sd, 0.0015);
  const VolumeChange at_slope = cut_at(9.15);
  ASSERT_NE(edge_warning(at_slope), nullptr);
  EXPECT_TRUE(edge_warning(at_slope)->ends_trust);
}

/// What the edge hides is bounded only by soil that falls towards it as loose soil lies.
TEST(VolumeChange, NothingBoundsSoilThatRunsOnBeyondTheEdgeOfTheSurvey) {
  constexpr Rectangle extent = {0.0, 0.0, 10.0, 5.0};
  const auto with_tail = [](double x, double y, double height, double fall) {
    const bool is_tail = x > 9.2 && std::abs(y - 2.534) < 0.4;
    return is_tail ? std::max(0.0, height - fall * (x - 9.6)) : 0.0;
  };
  const auto ridge_across = [](double x, double y) {
    const PitFrame p(x, y);
    return p.u < -1.1 ? std::max(0.0, 0.15 - 0.7 * std::abs(p.v - 0.85)) : 0.0;
  };
  const std::pair<const char*, Shape> scenes[] = {
      {"level", [&](double x, double y) { return with_tail(x, y, 0.03, 0.0); }},
      {"growing", [&](double x, double y) { return with_tail(x, y, 0.03, -0.13); }},
      {"falling 1:10", [&](double x, double y) { return with_tail(x, y, 0.09, 0.1); }},
      {"a ridge", ridge_across}};
  for (const auto& [name, soil] : scenes) {
    const auto scene = [&soil = soil](double x, double y) { return whole_dig(x, y) + soil(x, y); };
    const VolumeChange change = measure_change(flat_ground(extent, 0.05), map_of(scene, extent));
    const Warning* const said = edge_warning(change);
    ASSERT_NE(said, nullptr) << name;
    EXPECT_TRUE(said->ends_trust) << name << ": " << said->message;
  }
}

TEST(VolumeChange, AHeapAgainstTheHoleIsTheHeapThoughCrumbsLieElsewhere) {
  constexpr Rectangle extent = {0.0, 0.0, 11.0, 6.0};
  const auto crumb = [](double x, double y) {
    return std::max(0.0, (0.2 - std::hypot(x - 8.0, y - 2.5)) * std::tan(35.0 * degree));
  };
  const auto beside = [&](double x, double y) {
    return pit(x, y) + heap_at(x, y, 2.7, 4.0) + crumb(x, y);
  };
  const VolumeChange change = measure_change(flat_ground(extent, 0.05), map_of(beside, extent));
  EXPECT_EQ(count_of(change, "no_dumped_soil"), 0);
  const double crumbs = 3.141592653589793 / 3.0 * std::pow(0.2, 3) * std::tan(35.0 * degree);
  EXPECT_NEAR(change.dumped.value, heap_volume + crumbs, 0.01 * heap_volume);
  const auto k = bulking_factor(change);
  ASSERT_TRUE(k);
  EXPECT_NEAR(k->value, (heap_volume + crumbs) / pit_volume, 0.01);
}

TEST(VolumeChange, MapsThatDoNotFitAreRefused) {
  const auto message = [](const HeightMap& before, const HeightMap& after,
                          const ChangeOptions& options = {}) {
    return test::error_of([&] { measure_change(before, after, options); });
  };
  const HeightMap ground = flat_ground(scene, 0.05);
  EXPECT_EQ(message(ground, flat_ground(scene, 0.1)),
            "the maps before and after must be on one grid: same origin, cell and size");
  HeightMap unseen = ground;
  unseen.z.setConstant(nan);
  unseen.z.topLeftCorner(3, 3).setZero();
  EXPECT_EQ(
      message(ground, unseen),
      "the maps before and after share 9 known cells, at least 100 are needed: do they overlap, "
      "with points enough for cells of 0.050 m?");
  ChangeOptions options;
  options.growth = 6.0;
  EXPECT_EQ(message(ground, ground, options),
            "growth is 6, must be positive and not above detection (5)");
  options = {};
  options.margin = -1.0;
  EXPECT_EQ(message(ground, ground, options), "margin is -1, must be 0 or more");
  options = {};
  options.dig_area = Rectangle{1, 1, 0, 2};
  EXPECT_EQ(message(ground, ground, options),
            "dig_area is empty: x from 1 to 0, y from 1 to 2; each must grow");
}

// ---------------------------------------------------------------------------------------------

VolumeChange volumes(Measured before, Measured after, double covariance) {
  VolumeChange change;
  change.before = before;
  change.after = after;
  change.covariance_before_after = covariance;
  return change;
}

TEST(Bulking, FactorAndItsErrorFollowTheDeltaMethod) {
  const auto k = bulking_factor(volumes({0.5, 0.01}, {0.6, 0.006}, 0.0));
  ASSERT_TRUE(k);
  EXPECT_NEAR(k->value, 1.2, 1e-12);
  EXPECT_NEAR(k->sd, 1.2 * std::hypot(0.02, 0.01), 1e-12);
}

TEST(Bulking, ErrorsAgainstEachOtherAddUp) {
  // Fully opposed errors: the relative errors add.
  const auto opposed = bulking_factor(volumes({0.5, 0.01}, {0.6, 0.006}, -0.01 * 0.006));
  EXPECT_NEAR(opposed->sd, 1.2 * 0.03, 1e-12);
  // Common ones: their difference is left.
  const auto common = bulking_factor(volumes({0.5, 0.01}, {0.6, 0.006}, 0.01 * 0.006));
  EXPECT_NEAR(common->sd, 1.2 * 0.01, 1e-12);
}

TEST(Bulking, ErrorAgreesWithRepeatedMeasurement) {
  Random random(11);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int trials = 20000;
  for (int i = 0; i < trials; ++i) {
    const double shared = random.normal();
    const double before = 0.5 + 0.004 * random.normal() + 0.003 * shared;
    const double after = 0.6 + 0.003 * random.normal() - 0.004 * shared;
    const double k = bulking_factor(volumes({before, 0.0}, {after, 0.0}, 0.0))->value;
    sum += k;
    squares += k * k;
  }
  const double sd = std::sqrt(squares / trials - std::pow(sum / trials, 2));
  const auto k = bulking_factor(volumes({0.5, 0.005}, {0.6, 0.005}, -0.003 * 0.004));
  EXPECT_NEAR(k->sd, sd, 0.02 * sd);
}

TEST(Bulking, NoHoleOrNoHeapGivesNoFactor) {
  EXPECT_FALSE(bulking_factor(volumes({0.0, 0.1}, {0.6, 0.1}, 0.0)));
  EXPECT_FALSE(bulking_factor(volumes({0.5, 0.1}, {0.0, 0.1}, 0.0)));
  VolumeChange change = volumes({0.5, 0.1}, {0.6, 0.1}, 0.0);
  change.warnings.push_back({WarningCode::no_dumped_soil, ""});
  EXPECT_FALSE(bulking_factor(change));
}

TEST(Bulking, FallbackIsTakenOutOfTheMeasuredFactor) {
  // A share f of the cut lies in the pit as loose soil: k_measured = (k - f) / (1 - f).
  for (const double k : {1.0, 1.25, 1.6}) {
    for (const double f : {0.0, 0.1, 0.3}) {
      EXPECT_NEAR(free_of_fallback((k - f) / (1.0 - f), f), k, 1e-12);
    }
  }
  EXPECT_THROW(free_of_fallback(1.2, 1.0), Error);
  EXPECT_THROW(free_of_fallback(1.2, -0.1), Error);
  EXPECT_THROW(free_of_fallback(1.2, nan), Error);
}

}  // namespace
}  // namespace excavplan
