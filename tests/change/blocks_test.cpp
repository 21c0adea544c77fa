// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/change/blocks.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/non_finite.hpp"
#include "base/random.hpp"
#include "ground/grid_cells.hpp"

#include "support/block_heap.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

using test::Heap;

/// A survey of one area and what changed in it.
struct Survey {
  std::vector<HeightMap> after;
  VolumeChange change;
};

/// A heap as a scan shows it: cells, noise of one cell; all of it one dump.
Survey survey_of(const Heap& heap, double cell, double noise, std::uint64_t seed) {
  const HeightMap clean = test::surveyed(heap.fine, cell);
  HeightMap after = clean;
  Random random(seed, 9);
  for (Eigen::Index i = 0; i < after.z.size(); ++i) after.z.data()[i] += noise * random.normal();
  AreaChange area;
  area.difference = after;
  area.zone = (clean.z > 0.02).select(Eigen::ArrayXXi::Zero(clean.z.rows(), clean.z.cols()), -1);
  area.noise_sd = noise * std::sqrt(2.0);
  ChangeZone zone;
  zone.kind = ZoneKind::dump;
  Survey survey;
  survey.after = {after};
  survey.change.areas = {area};
  survey.change.zones = {zone};
  survey.change.after = {heap.envelope(), 0.0};
  return survey;
}

BlockReport assess(const Survey& survey, const BlockOptions& options = {}) {
  return assess_blocks(survey.after, survey.change, options);
}

/// A heap of blocks of random size, number, crumbs and cover, and how it was scanned.
struct RandomCase {
  test::BlockHeapOptions blocks;
  double cell_size;
  double noise;
  explicit RandomCase(std::uint64_t seed) {
    Random random(seed, 4);
    blocks.size = std::exp(random.uniform(std::log(0.09), std::log(0.30)));
    blocks.solids = blocks.size < 0.12 ? 0.25 : random.uniform(0.25, 0.55);
    blocks.crumbs = random.uniform(0.1, 0.5);
    blocks.cover = random.uniform() < 0.5 ? 0.0 : random.uniform(0.05, 0.20);
    cell_size = 0.03 + 0.01 * static_cast<double>(random.index(3));
    noise = random.uniform(0.005, 0.020);
  }
};

struct RandomOutcome {
  RandomCase random;
  double voids;
  double envelope;
  BlockReport report;
};

const std::vector<RandomOutcome>& random_outcomes() {
  static const std::vector<RandomOutcome> outcomes = [] {
    std::vector<RandomOutcome> list;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      const RandomCase random(seed);
      const Heap heap = test::block_heap(random.blocks, seed);
      list.push_back({random, heap.voids(), heap.envelope(),
                      assess(survey_of(heap, random.cell_size, random.noise, seed))});
    }
    return list;
  }();
  return outcomes;
}

TEST(Blocks, AreFoundInEveryHeapOfThem) {
  for (const RandomOutcome& outcome : random_outcomes()) {
    const BlockReport& report = outcome.report;
    EXPECT_TRUE(report.blocks) << outcome.random.blocks.size << " m: score " << report.score;
    EXPECT_GE(report.score, 0.6) << outcome.random.blocks.size;
    ASSERT_GE(report.reasons.size(), 2u);
    EXPECT_NE(report.reasons[0].find("the heap is rough by"), std::string::npos);
    EXPECT_NE(report.reasons[1].find("are steeper than 45.5 deg"), std::string::npos);
  }
}

TEST(Blocks, LooseSoilIsNeverTakenForThem) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed, 8);
    test::LooseHeapOptions soil;
    soil.volume = random.uniform(0.15, 0.8);
    soil.repose = random.uniform(0.50, 0.66);
    soil.roughness = random.uniform(0.0, 0.015);
    soil.clod = std::exp(random.uniform(std::log(0.05), std::log(0.40)));
    soil.cones = 1 + static_cast<int>(random.index(4));
    const double cell = 0.03 + 0.01 * static_cast<double>(random.index(3));
    const BlockReport report =
        assess(survey_of(test::loose_heap(soil, seed), cell, random.uniform(0.005, 0.020), seed));
    EXPECT_FALSE(report.blocks) << seed;
    EXPECT_LT(report.score, 0.4) << seed;
    EXPECT_FALSE(report.voids.has_value());
  }
}

TEST(Blocks, TextureIsFreeOfNoiseAndOfTheShapeOfTheHeap) {
  test::LooseHeapOptions smooth;
  smooth.roughness = 0.0;
  smooth.volume = 0.06;  // a cone of 0.43 m radius: a plane lies 20 mm off its top
  const GroundTexture clean = assess(survey_of(test::loose_heap(smooth, 1), 0.03, 0.0, 1)).heap;
  EXPECT_LT(clean.coarse_roughness, 0.008);
  smooth.volume = 0.60;
  const GroundTexture noisy = assess(survey_of(test::loose_heap(smooth, 1), 0.04, 0.020, 2)).heap;
  EXPECT_LT(noisy.fine_roughness, 0.007);
  EXPECT_LT(noisy.coarse_roughness, 0.007);
  EXPECT_LT(noisy.steep_share, 0.05);
  EXPECT_LT(noisy.normal_dispersion, 0.09);
}

TEST(Blocks, NoiseAThirdWorseThanStatedIsNotTakenForThem) {
  const Survey survey = survey_of(test::loose_heap({}, 1), 0.04, 0.020, 3);
  BlockOptions options;
  options.noise_sd = 0.015;
  EXPECT_LT(assess(survey, options).score, 0.3);
  options.noise_sd.reset();
  EXPECT_LT(assess(survey, options).score, 0.1);
}

TEST(Blocks, SizeIsToldToAFifth) {
  double squares = 0.0;
  int told = 0;
  for (const RandomOutcome& outcome : random_outcomes()) {
    if (!outcome.report.block_size) continue;
    squares += std::pow(std::log(*outcome.report.block_size / outcome.random.blocks.size), 2);
    ++told;
  }
  EXPECT_GE(told, 45);
  EXPECT_LT(std::sqrt(squares / told), 0.20);
}

/// Packing is unknown: crumbs fill 10 to 50 % of the voids between the blocks.
TEST(Blocks, VoidsAreEstimatedWithinTheirStandardDeviation) {
  double bias = 0.0;
  double squares = 0.0;
  double scaled = 0.0;
  int count = 0;
  for (const auto& [random, voids, envelope, report] : random_outcomes()) {
    if (!report.voids) continue;
    const double error = (report.voids->value - voids) / envelope;
    bias += error;
    squares += error * error;
    scaled += std::pow(error * envelope / report.voids->sd, 2);
    ++count;
  }
  ASSERT_GE(count, 40);
  EXPECT_LT(std::abs(bias / count), 0.03);
  EXPECT_LT(std::sqrt(squares / count), 0.07);  // of the heap's volume
  EXPECT_GT(std::sqrt(scaled / count), 0.5);
  EXPECT_LT(std::sqrt(scaled / count), 1.2);
}

TEST(Blocks, SizeThatCannotBeToldLeavesVoidsUnknown) {
  test::BlockHeapOptions small;
  small.size = 0.08;
  small.solids = 0.20;
  const BlockReport fine = assess(survey_of(test::block_heap(small, 3), 0.05, 0.005, 1));
  EXPECT_TRUE(fine.blocks);
  EXPECT_FALSE(fine.voids.has_value());
  EXPECT_NE(fine.reasons.back().find("too small for the cells"), std::string::npos);

  test::BlockHeapOptions large;
  large.size = 0.60;
  large.solids = 0.50;
  const BlockReport coarse = assess(survey_of(test::block_heap(large, 2), 0.05, 0.005, 1));
  EXPECT_TRUE(coarse.blocks);
  EXPECT_FALSE(coarse.voids.has_value());
  EXPECT_NE(coarse.reasons.back().find("cannot be estimated"), std::string::npos);
}

TEST(Blocks, HalfAHeapOfThemHasHalfTheVoids) {
  test::BlockHeapOptions options;
  options.solids = 0.5;
  const Heap whole = test::block_heap(options, 7);
  Heap half = whole;
  const Heap soil = test::loose_heap({}, 7);
  for (Eigen::Index col = 0; col < half.fine.z.cols() / 2; ++col) {
    half.fine.z.col(col) = soil.fine.z.col(col);
  }
  const BlockReport all = assess(survey_of(whole, 0.04, 0.005, 1));
  const BlockReport mixed = assess(survey_of(half, 0.04, 0.005, 1));
  EXPECT_GT(all.heap.rough_share, 0.9);
  EXPECT_GT(mixed.heap.rough_share, 0.3);
  EXPECT_LT(mixed.heap.rough_share, 0.7);
  EXPECT_GT(mixed.heap.steep_share, 0.1);
}

/// A pit with upright walls, and what lies on its floor.
Survey pit_survey(const Eigen::ArrayXXd& on_floor, double noise) {
  Heap heap;
  heap.fine = flat_ground(test::heap_ground, test::fine_cell);
  for (Eigen::Index col = 0; col < heap.fine.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < heap.fine.z.rows(); ++row) {
      const bool inside =
          std::abs(heap.fine.x(col) - 2.25) < 1.1 && std::abs(heap.fine.y(row) - 2.25) < 0.5;
      if (inside) heap.fine.z(row, col) = -0.4 + on_floor(row, col);
    }
  }
  Survey survey = survey_of(heap, 0.04, noise, 2);
  survey.change.zones[0].kind = ZoneKind::dig;
  const HeightMap clean = test::surveyed(heap.fine, 0.04);
  survey.change.areas[0].zone =
      (clean.z < -0.02).select(Eigen::ArrayXXi::Zero(clean.z.rows(), clean.z.cols()), -1);
  return survey;
}

TEST(Blocks, PitIsJudgedByItsFloorNotByItsWalls) {
  const HeightMap ground = flat_ground(test::heap_ground, test::fine_cell);
  const Eigen::ArrayXXd clods = 0.01 * test::random_heights(ground, 0.12, Random(4));
  const BlockReport smooth = assess(pit_survey(clods, 0.005));
  EXPECT_FALSE(smooth.blocks) << smooth.pit.coarse_roughness;
  EXPECT_EQ(smooth.heap.cells, 0);
  test::BlockHeapOptions left;
  left.size = 0.15;
  left.solids = 0.25;
  left.repose = 0.1;
  const BlockReport rough = assess(pit_survey(test::block_heap(left, 5).fine.z, 0.005));
  EXPECT_TRUE(rough.blocks);
  EXPECT_GT(rough.pit.score, 0.9);
  EXPECT_FALSE(rough.voids.has_value());
  EXPECT_NE(rough.reasons.front().find("the pit is rough by"), std::string::npos);
}

TEST(Blocks, UnseenCellsOfTheHeapAreCountedAgainstThoseAround) {
  Survey survey = survey_of(test::block_heap({}, 6), 0.04, 0.005, 1);
  Random random(2);
  const Eigen::ArrayXXi& zone = survey.change.areas[0].zone;
  for (Eigen::Index i = 0; i < zone.size(); ++i) {
    if (random.uniform() < (zone.data()[i] >= 0 ? 0.25 : 0.05)) {
      survey.after[0].z.data()[i] = nan;
      survey.change.areas[0].difference.z.data()[i] = nan;
    }
  }
  const BlockReport report = assess(survey);
  EXPECT_TRUE(report.blocks);
  EXPECT_NEAR(report.heap.hole_share, 0.20, 0.03);
  EXPECT_TRUE(report.voids.has_value());
}

TEST(Blocks, VolumeWithoutVoidsIsNearerToTheTruth) {
  test::BlockHeapOptions options;
  options.size = 0.16;
  options.solids = 0.50;
  options.crumbs = 0.3;
  const Heap heap = test::block_heap(options, 11);
  Survey survey = survey_of(heap, 0.04, 0.010, 1);
  survey.change.after = {heap.envelope(), 0.010};
  const BlockReport report = assess(survey);
  ASSERT_TRUE(report.voids.has_value());
  const double corrected = heap.envelope() - report.voids->value;
  EXPECT_LT(std::abs(corrected - heap.solids), 0.35 * heap.voids());
  EXPECT_LT(std::abs(corrected - heap.solids), 2.0 * report.voids->sd);
}

TEST(Blocks, GroundThatDidNotChangeHasNoScore) {
  Survey survey = survey_of(test::block_heap({}, 6), 0.05, 0.005, 1);
  survey.change.zones[0].kind = ZoneKind::other;
  const BlockReport report = assess(survey);
  EXPECT_EQ(report.score, 0.0);
  EXPECT_EQ(report.heap.cells, 0);
  EXPECT_TRUE(report.reasons.empty());
}

TEST(Blocks, AreNotLookedForWithCellsLargerThanTheyAre) {
  Survey survey = survey_of(test::block_heap({}, 6), 0.05, 0.005, 1);
  ASSERT_TRUE(assess(survey).blocks);
  for (HeightMap& map : survey.after) map.cell_size = 0.25;
  for (AreaChange& area : survey.change.areas) area.difference.cell_size = 0.25;
  const BlockReport report = assess(survey);
  EXPECT_EQ(report.score, 0.0);
  EXPECT_EQ(report.reasons, std::vector<std::string>{
                                "cells of 0.25 m are too large to detect blocks, at most 0.2 m"});
}

/// Every cell of a survey as many small ones of its height.
Survey split(const Survey& survey, Eigen::Index parts) {
  const auto fine = [&](const auto& layer) {
    auto cells = layer;
    cells.resize(layer.rows() * parts, layer.cols() * parts);
    for_each_cell(cells,
                  [&](Cell at) { cells(at.row, at.col) = layer(at.row / parts, at.col / parts); });
    return cells;
  };
  Survey result = survey;
  for (HeightMap* map : {&result.after[0], &result.change.areas[0].difference}) {
    map->cell_size /= static_cast<double>(parts);
    map->z = fine(map->z);
  }
  result.change.areas[0].zone = fine(survey.change.areas[0].zone);
  return result;
}

/// A window of each cell would hold the more of them the smaller they are.
TEST(Blocks, CellsTooSmallToTellMoreAreThinned) {
  test::BlockHeapOptions small;
  small.size = 0.08;
  small.solids = 0.05;
  const Survey survey = survey_of(test::block_heap(small, 6), 0.01, 0.005, 1);
  const BlockReport coarse = assess(survey);
  EXPECT_TRUE(coarse.blocks);
  const BlockReport fine = assess(split(survey, 3));
  EXPECT_EQ(fine.heap.cells, coarse.heap.cells);
  EXPECT_EQ(fine.heap.fine_roughness, coarse.heap.fine_roughness);
  EXPECT_EQ(fine.score, coarse.score);
  EXPECT_EQ(fine.reasons, coarse.reasons);
}

TEST(Blocks, RefusesWhatBreaksARule) {
  Survey survey = survey_of(test::loose_heap({}, 1), 0.05, 0.005, 1);
  const auto error = [&](const BlockOptions& options) {
    return test::error_of([&] { assess(survey, options); });
  };
  BlockOptions options;
  options.angle_of_repose = 1.5;
  EXPECT_EQ(error(options), "blocks: angle of repose is 1.5, must be in 0 .. 1.2 rad");
  options = {};
  options.packed_voids = 1.0;
  EXPECT_EQ(error(options), "blocks: packed voids is 1, must be in 0 .. 1");
  options = {};
  options.noise_sd = -0.01;
  EXPECT_EQ(error(options), "blocks: noise is -0.01, must be >= 0 m");
  survey.after[0].origin.x() += 0.01;
  EXPECT_NE(error({}).find("must be on the grid of its area"), std::string::npos);
  survey.after.clear();
  EXPECT_NE(error({}).find("one map for each of the 1 areas"), std::string::npos);
}

}  // namespace
}  // namespace excavplan
