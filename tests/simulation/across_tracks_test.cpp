// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/across_tracks.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angles.hpp"
#include "support/machine_file.hpp"

namespace excavplan::test {
namespace {

TEST(AcrossTracks, AFrontLooksAlongOrAcrossThem) {
  for (const double swung : {0.0, 0.7, -0.7, 2.5, pi}) EXPECT_FALSE(is_across(swung)) << swung;
  for (const double swung : {0.9, 0.5 * pi, -1.5, 2.3}) EXPECT_TRUE(is_across(swung)) << swung;
}

TEST(AcrossTracks, UndercarriageAndEdgesAreThoseAheadOfTheFront) {
  const Machine& machine = zx120();
  for (const double swung : {0.5 * pi, -0.5 * pi}) {
    const Machine turned = looking(machine, swung);
    EXPECT_EQ(turned.track_front, 0.5 * machine.undercarriage_width());
    EXPECT_EQ(turned.undercarriage_width(), 2.0 * machine.track_front);
    ASSERT_TRUE(turned.body);
    EXPECT_EQ(turned.body->front_edge, side_edge * machine.body->front_edge);
    EXPECT_EQ(turned.body->rear_edge, -turned.body->front_edge);
    EXPECT_LT(turned.body->front_edge, turned.track_front) << "it tips over its rollers";
  }
  Machine without_radius = machine;
  without_radius.tail_radius.reset();
  EXPECT_EQ(looking(without_radius, 0.5 * pi).tail_swing_radius(),
            without_radius.tail_swing_radius())
      << "its tail is what it was";
  const Machine along = looking(machine, 0.5);
  EXPECT_EQ(along.track_front, machine.track_front);
  EXPECT_EQ(along.body->rear_edge, machine.body->rear_edge);
}

TEST(AcrossTracks, OnASlopeTheFrontLooksUpOrDownAsItDidAside) {
  const Machine machine = with_attitude(zx120(), {0.12, -0.07});
  for (const double swung : {0.5 * pi, -0.5 * pi}) {
    const Machine turned = looking(machine, swung);
    for (const double more : {0.0, 0.4, -1.0})
      EXPECT_LT((turned.up(more) - machine.up(swung + more)).norm(), 1e-12) << swung << " " << more;
  }
}

TEST(AcrossTracks, TheSwingEndsWhereItDid) {
  Machine machine = zx120();
  machine.swing->lower = -2.0;
  machine.swing->upper = 2.5;
  const Machine turned = looking(machine, 0.5 * pi);
  EXPECT_NEAR(turned.swing->lower, -2.0 - 0.5 * pi, 1e-12);
  EXPECT_NEAR(turned.swing->upper, 2.5 - 0.5 * pi, 1e-12);
}

}  // namespace
}  // namespace excavplan::test
