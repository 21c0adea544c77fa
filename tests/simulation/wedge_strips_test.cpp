// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The strips of a wedge, many at once, beside each one alone.
#include "simulation/wedge_strips.hpp"

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/soil/soil.hpp>

#include "base/random.hpp"

namespace excavplan {
namespace {

FaceTerms terms_of(const SoilState& soil, double rake) {
  const CuttingWedge wedge = {rake, soil.friction_angle, soil.tool_friction_angle, 0.05};
  return {RestingSoil(soil), earthmoving_factors(wedge, 0.5).value(), false};
}

/// Rows with loose soil on some, piles on some, and one that the tip does not reach.
struct Rows {
  explicit Rows(Random& random) {
    for (std::size_t i = 0; i < count; ++i) {
      bank.push_back(i == 3 ? -0.6 : random.uniform(-0.05, 0.05));
      lay.push_back(i % 2 == 0 ? random.uniform(0.0, 0.2) : 0.0);
      lies.push_back(lay.back() + random.uniform(0.0, 0.1));
      cover.push_back(i == 0 ? 0.4 : 1.0);
    }
    lay[3] = lies[3] = 0.0;
  }
  StripColumn column() const {
    return {-0.3, 0.3, -0.25, bank.data(), lay.data(), lies.data(), cover.data()};
  }
  static constexpr std::size_t count = 21;
  std::vector<double> bank, lay, lies, cover;
};

class Wedge : public testing::Test {
 protected:
  StripSums pushed(std::size_t at_once) {
    WedgeStrips strips(Rows::count);
    strips.find_piles(rows.column());
    strips.find(rows.column(), cell);
    EXPECT_TRUE(strips.is_empty(3));
    EXPECT_FALSE(strips.is_empty(4));
    StripSums sums;
    for (std::size_t i = 0; i < Rows::count; i += at_once) {
      const std::size_t count = std::min(at_once, Rows::count - i);
      strips.begin(i, count, layers, cell);
    }
    strips.add({Rows::count, rows.lies.data(), rows.lay.data(), 0, 0}, 3);
    for (std::size_t i = 0; i < Rows::count; i += at_once) {
      const std::size_t count = std::min(at_once, Rows::count - i);
      strips.push(i, count, layers, wedge, sums);
    }
    return sums;
  }

  Random random{5};
  Rows rows{random};
  SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  double cell = 0.05;
  LayerTerms layers = {terms_of(bank_state(loam, 40.0), 0.8), terms_of(loose_state(loam), 0.8)};
  WedgeTerms wedge = {0.7, 0.4, cell, terms_of(loose_state(loam), 0.8)};
};

TEST_F(Wedge, IsTheSameHoweverManyStripsAreTakenAtOnce) {
  const StripSums one = pushed(1);
  for (const std::size_t at_once : {2U, 8U, 9U, 21U}) {
    const StripSums sums = pushed(at_once);
    EXPECT_EQ(sums.along, one.along);
    EXPECT_EQ(sums.across, one.across);
    EXPECT_EQ(sums.on_face, one.on_face);
    EXPECT_EQ(sums.bank_depth, one.bank_depth);
    EXPECT_EQ(sums.loose_depth, one.loose_depth);
  }
}

/// McKyes 1985 (earthmoving.hpp), by hand for even ground without loose soil.
TEST_F(Wedge, OfEvenGroundIsTheEquationOfEarthmoving) {
  const double depth = 0.3;
  for (std::size_t i = 0; i < Rows::count; ++i) {
    rows.bank[i] = 0.0;
    rows.lay[i] = rows.lies[i] = 0.0;
    rows.cover[i] = 1.0;
  }
  wedge.fade = 1.0;
  WedgeStrips strips(Rows::count);
  strips.find_piles(rows.column());
  strips.find(rows.column(), cell);
  strips.begin(0, Rows::count, layers, cell);
  StripSums sums;
  strips.push(0, Rows::count, layers, wedge, sums);
  const FaceTerms& t = layers.bank;
  const double width = static_cast<double>(Rows::count) * cell;
  const double force = width * (t.soil.unit_weight * depth * depth * t.n.gamma +
                                t.soil.cohesion * depth * t.n.c + t.soil.adhesion * depth * t.n.ca);
  const double stuck = width * t.soil.adhesion * depth;
  const double rounding = 1e-12 * force;
  EXPECT_NEAR(sums.along, force * t.n.sin_face + stuck * t.n.cot_rake, rounding);
  EXPECT_NEAR(sums.across, force * t.n.cos_face - stuck, rounding);
  EXPECT_NEAR(sums.bank_depth, width * depth, 1e-12);
  EXPECT_EQ(sums.loose_depth, 0.0);
  const double over_face = 0.5 * depth * depth * t.n.cot_rake;
  EXPECT_NEAR(sums.on_face, width * t.soil.unit_weight * over_face, rounding);
}

}  // namespace
}  // namespace excavplan
