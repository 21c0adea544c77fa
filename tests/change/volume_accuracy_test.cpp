// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <excavplan/change/bulking.hpp>
#include "base/random.hpp"

#include "base/non_finite.hpp"
#include "support/measured_scene.hpp"

namespace excavplan::scenes {
namespace {

/// Errors of k over some surveys of one dig, and how often its 95 % interval held the truth.
struct Score {
  int surveys = 0;
  int covered = 0;
  double squares = 0.0;

  void add(const Survey& survey) {
    const Measured k = bulking_factor(survey.measured()).value_or(Measured{nan, nan});
    const double error = k.value - survey.dig.bulking;
    ++surveys;
    covered += std::abs(error) <= 1.96 * k.sd ? 1 : 0;
    squares += std::pow(error / survey.dig.bulking, 2);
  }
  double rms() const { return std::sqrt(squares / surveys); }
};

/// A variant and the bar for the rms error of k at one million points.
struct Bar {
  const char* variant;
  double rms;
};

class AccuracyOfBulking : public testing::TestWithParam<Bar> {};

TEST_P(AccuracyOfBulking, MeetsItsBarWithinItsInterval) {
  const Bar& bar = GetParam();
  Score score;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    score.add({Dig{}, errors_of(bar.variant), 1000000, seed, seed % 2 == 0});
  }
  EXPECT_LT(score.rms(), 1.5 * bar.rms) << "the rms of four errors scatters by a third";
  EXPECT_GE(score.covered, 3);
}

INSTANTIATE_TEST_SUITE_P(Scans, AccuracyOfBulking,
                         testing::Values(Bar{"noise", 0.001}, Bar{"noise20", 0.003},
                                         Bar{"outliers", 0.003}, Bar{"tilt", 0.003},
                                         Bar{"rough", 0.003}, Bar{"moved", 0.004},
                                         Bar{"correlated", 0.010}, Bar{"unseen", 0.012},
                                         Bar{"all", 0.016}),
                         [](const auto& bar) { return std::string(bar.param.variant); });

TEST(AccuracyOfBulking, IntervalsHoldTheTruthOverRandomDigs) {
  const std::vector<Variant> kinds = variants();
  Score score;
  for (std::uint64_t i = 0; i < 36; ++i) {
    const Variant& kind = kinds[1 + i % (kinds.size() - 1)];
    score.add({random_dig(i), kind.errors, 150000, i, i % 2 == 1});
  }
  EXPECT_GE(score.covered, 31);
}

TEST(AccuracyOfBulking, BudgetAddsUpAndNamesTheSource) {
  const auto largest = [](const char* variant) -> std::string {
    const VolumeChange change = Survey{Dig{}, errors_of(variant), 400000, 1}.measured();
    const BulkingErrors by = bulking_errors(change);
    const double sd = bulking_factor(change).value_or(Measured{}).sd;
    EXPECT_NEAR(
        std::sqrt(by.noise * by.noise + by.correlated * by.correlated + by.datum * by.datum +
                  by.holes * by.holes + by.faces * by.faces + by.thin * by.thin),
        sd, 1e-9);
    if (by.correlated > 0.7 * sd) return "correlated";
    if (by.holes > 0.7 * sd) return "holes";
    return by.noise > 0.7 * sd ? "noise" : "none";
  };
  EXPECT_EQ(largest("noise20"), "noise");
  EXPECT_EQ(largest("correlated"), "correlated");
  EXPECT_EQ(largest("unseen"), "holes");
}

TEST(AccuracyOfBulking, OlderHolesAndHeapsUnderTheDigAreNoError) {
  // A second bite beside the first, its spoil on the first heap, on even ground.
  Dig first;
  Dig second;
  second.pit_x += 0.4;
  second.heap_x += 0.3;
  const auto surface = [&](Part part, int bites, std::uint64_t seed) {
    Random random(seed);
    Surface shown;
    shown.height = flat_ground(extent_of(part), 0.05);
    for (Eigen::Index col = 0; col < shown.height.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < shown.height.z.rows(); ++row) {
        const double x = shown.height.x(col);
        const double y = shown.height.y(row);
        shown.height.z(row, col) = change_at(first, part, x, y) +
                                   (bites > 1 ? change_at(second, part, x, y) : 0.0) +
                                   0.002 * random.normal();
      }
    }
    return shown;
  };
  const auto pair = [&](Part part) {
    return SurfacePair{surface(part, 1, 1), surface(part, 2, 2), {}};
  };
  const VolumeChange change = measure_change(pair(Part::dig), pair(Part::dump));
  EXPECT_NEAR(change.excavated.value, second.pit_volume(), 0.01 * second.pit_volume());
  EXPECT_NEAR(change.dumped.value, second.heap_volume(), 0.01 * second.heap_volume());
}

// ---------------------------------------------------------------------------------------------

Surface exact(bool after) {
  const Dig dig;
  Surface surface;
  surface.height = flat_ground(whole_extent, 0.05);
  if (!after) return surface;
  for (Eigen::Index col = 0; col < surface.height.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < surface.height.z.rows(); ++row) {
      surface.height.z(row, col) =
          change_at(dig, Part::whole, surface.height.x(col), surface.height.y(row));
    }
  }
  return surface;
}

void put(Surface& surface, const Rectangle& place, double top) {
  for (Eigen::Index col = 0; col < surface.height.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < surface.height.z.rows(); ++row) {
      if (place.contains(surface.height.x(col), surface.height.y(row))) {
        surface.height.z(row, col) = top;
      }
    }
  }
}

int count_of(const VolumeChange& change, const std::string& code) {
  return static_cast<int>(
      std::count_if(change.warnings.begin(), change.warnings.end(),
                    [&](const Warning& warning) { return code_text(warning.code) == code; }));
}

struct Visit {
  const char* what;
  Rectangle place;
  double top;
  bool after;
};

class Visitor : public testing::TestWithParam<Visit> {};

TEST_P(Visitor, IsTakenOutOfTheVolumes) {
  const Visit& visit = GetParam();
  Surface before = exact(false);
  Surface after = exact(true);
  const VolumeChange alone = measure_change({before, after, {}});
  put(visit.after ? after : before, visit.place, visit.top);
  const VolumeChange change = measure_change({before, after, {}});
  EXPECT_EQ(count_of(change, "object_taken_out"), 1);
  EXPECT_NEAR(change.excavated.value, alone.excavated.value, 0.03 * alone.excavated.value);
  EXPECT_NEAR(change.after.value, alone.after.value, 0.03 * alone.after.value);
  EXPECT_NEAR(change.excavated.value, alone.excavated.value,
              3.0 * change.excavated.sd + 0.001 * alone.excavated.value);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Visitor,
    testing::Values(Visit{"PersonOnStableGround", {2.2, 1.7, 2.6, 2.1}, 1.75, true},
                    Visit{"PersonWhoLeft", {2.2, 1.7, 2.6, 2.1}, 1.75, false},
                    Visit{"CarOnStableGround", {1.6, -2.2, 5.2, -1.4}, 1.5, true},
                    Visit{"TruckThatLeft", {-2.6, 1.15, 1.0, 2.4}, 3.0, false},
                    Visit{"CarThatLeft", {-2.8, -2.4, -1.2, 2.2}, 1.4, false},
                    Visit{"PersonOnTheHeap", {5.3, 0.2, 5.7, 0.6}, 2.2, true},
                    Visit{"BucketOverTheHole", {-0.4, -0.5, 0.2, 0.0}, 0.9, true},
                    Visit{"BucketAtTheRim", {0.9, -0.4, 1.4, 0.2}, 0.9, true}),
    [](const auto& visit) { return std::string(visit.param.what); });

TEST(VolumesOfSurfaces, TheExtentOfAZoneAndOfAnObjectIsThatOfTheirWholeCells) {
  Surface after = exact(true);
  put(after, {2.2, 1.7, 2.6, 2.1}, 1.75);
  const VolumeChange change = measure_change({exact(false), after, {}});
  ASSERT_EQ(count_of(change, "object_taken_out"), 1);
  const AreaChange& area = change.areas.front();
  const double half = 0.5 * area.difference.cell_size;
  std::vector<Eigen::AlignedBox2d> boxes(change.zones.size());
  for (Eigen::Index col = 0; col < area.zone.cols(); ++col) {
    for (Eigen::Index row = 0; row < area.zone.rows(); ++row) {
      if (area.zone(row, col) < 0) continue;
      const Eigen::Vector2d centre(area.difference.x(col), area.difference.y(row));
      Eigen::AlignedBox2d& box = boxes[static_cast<std::size_t>(area.zone(row, col))];
      box.extend(Eigen::Vector2d(centre.array() - half));
      box.extend(Eigen::Vector2d(centre.array() + half));
    }
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Rectangle& extent = change.zones[i].extent;
    const Eigen::Vector2d low(extent.x_min, extent.y_min);
    const Eigen::Vector2d high(extent.x_max, extent.y_max);
    EXPECT_LT((boxes[i].min() - low).norm() + (boxes[i].max() - high).norm(), 1e-9) << i;
  }
}

TEST(VolumesOfSurfaces, BlocksOfAHeapAreNoObjects) {
  Surface after = exact(true);
  const VolumeChange smooth = measure_change({exact(false), after, {}});
  put(after, {5.4, 0.3, 5.6, 0.5}, 1.35);
  put(after, {5.0, -0.3, 5.2, -0.1}, 1.1);
  put(after, {5.8, -0.2, 6.0, 0.0}, 1.1);
  const VolumeChange rough = measure_change({exact(false), after, {}});
  EXPECT_EQ(count_of(rough, "object_taken_out"), 0);
  EXPECT_GT(rough.dumped.value, smooth.dumped.value + 0.02);
}

TEST(VolumesOfSurfaces, RowsOfPointsPlaceSteepFacesWorseThanPointsByChance) {
  const auto faces = [](bool by_chance) {
    SurfacePair pair{exact(false), exact(true), {}};
    Random random(1);
    for (Surface* surface : {&pair.before, &pair.after}) {
      surface->points = Eigen::ArrayXXi::Zero(surface->height.z.rows(), surface->height.z.cols());
      // By chance: of 400 points near a cell each is in it with a probability of 3 %.
      for (int& count : surface->points.reshaped()) {
        for (int i = 0; i < 400; ++i) count += random.uniform() < 0.03 ? 1 : 0;
        if (!by_chance) count = 12;
      }
    }
    const VolumeChange change = measure_change(pair);
    return std::sqrt(change.errors.faces(0, 0)) / change.excavated.value;
  };
  EXPECT_GT(faces(false), 0.001);
  EXPECT_LT(faces(true), 0.3 * faces(false));
}

TEST(VolumesOfSurfaces, WhatMayLieBeyondTheEdgeOfAScanWidensTheInterval) {
  SurfacePair pair{exact(false), exact(true), {}};
  const VolumeChange whole = measure_change(pair);
  for (Surface* surface : {&pair.before, &pair.after}) put(*surface, {-9.0, -9.0, -0.95, 9.0}, nan);
  const VolumeChange cut = measure_change(pair);
  EXPECT_EQ(count_of(cut, "zone_at_border") > 0, true);
  const double missing = whole.excavated.value - cut.excavated.value;
  EXPECT_GT(missing, 0.005);
  EXPECT_GT(cut.excavated.sd, 0.3 * missing);
  EXPECT_GT(cut.excavated.sd, 5.0 * whole.excavated.sd);
}

TEST(VolumesOfSurfaces, AShadowJoinsTheHoleOnlyWhereTheHoleIsNearest) {
  // Between the hole and the foot of a wall that the scans place differently, as in a corner.
  Surface after = exact(true);
  for (int i = 0; i < 12; ++i) {
    put(after, {-2.8, -1.2 + 0.2 * i, -2.6, -1.0 + 0.2 * i}, i % 2 == 0 ? 0.2 : -0.2);
  }
  const VolumeChange seen = measure_change({exact(false), after, {}});
  put(after, {-2.6, -1.2, -1.0, 1.2}, nan);
  const VolumeChange shaded = measure_change({exact(false), after, {}});
  EXPECT_NEAR(shaded.excavated.value, seen.excavated.value, 0.25 * seen.excavated.value);
  EXPECT_LT(shaded.excavated.sd, 0.35 * seen.excavated.value);
}

TEST(VolumesOfSurfaces, MostlyUnseenZonesAreRefused) {
  Surface after = exact(true);
  put(after, {-1.0, -0.55, 1.0, 0.15}, nan);
  ChangeOptions options;
  options.refused_unknown_share = 0.3;
  const VolumeChange refused = measure_change({exact(false), after, {}}, options);
  EXPECT_EQ(count_of(refused, "zone_unseen"), 1);
  EXPECT_FALSE(bulking_factor(refused));
  const VolumeChange warned = measure_change({exact(false), after, {}});
  EXPECT_EQ(count_of(warned, "zone_partly_unseen"), 1);
  EXPECT_TRUE(bulking_factor(warned));
}

}  // namespace
}  // namespace excavplan::scenes
