// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/objects.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace excavplan {
namespace {

constexpr double cell = 0.05;
constexpr double margin = 2.0;

/// Level ground with one block of cells higher or lower.
Eigen::ArrayXXd with_step(double height) {
  Eigen::ArrayXXd z = Eigen::ArrayXXd::Zero(60, 60);
  z.block(20, 20, 20, 20) = height;
  return z;
}

TEST(Objects, WhatStandsHigherThanSoilCanIsAnObjectInEitherScan) {
  for (const bool is_before : {false, true}) {
    Eigen::ArrayXXd before = with_step(is_before ? 1.2 : 0.0);
    Eigen::ArrayXXd after = with_step(is_before ? 0.0 : 1.2);
    const std::vector<Object> objects = take_out_objects(before, after, cell, margin);
    ASSERT_EQ(objects.size(), 1u);
    EXPECT_EQ(objects[0].is_before, is_before);
    EXPECT_NEAR(objects[0].volume, is_before ? -1.2 : 1.2, 1e-9);
    EXPECT_TRUE((is_before ? before : after).block(20, 20, 20, 20).isNaN().all());
  }
}

TEST(Objects, AMarginMayBeWiderThanTheGround) {
  Eigen::ArrayXXd before = with_step(0.0);
  Eigen::ArrayXXd after = with_step(1.2);
  const std::vector<Object> objects = take_out_objects(before, after, cell, 1e12);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].cells.size(), 3600u);
}

/// It stands 1.2 m above the floor beside it, and more than soil can in the change, but did not
/// rise; nor did it sink where such a pit was filled.
TEST(Objects, GroundAtTheRimOfAnUprightPitIsNoObject) {
  for (const bool was_filled : {false, true}) {
    Eigen::ArrayXXd before = with_step(was_filled ? -1.2 : 0.0);
    Eigen::ArrayXXd after = with_step(was_filled ? 0.0 : -1.2);
    const std::vector<Object> objects = take_out_objects(before, after, cell, margin);
    EXPECT_TRUE(objects.empty());
  }
}

}  // namespace
}  // namespace excavplan
