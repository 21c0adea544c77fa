// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/data_files.hpp>
#include <excavplan/machine/motion.hpp>
#include <excavplan/planning/cycle_motion.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include <gtest/gtest.h>

#include "support/cases.hpp"
#include "support/errors.hpp"
#include "support/motion_check.hpp"

namespace excavplan::test {
namespace {

const Machine& zx120() {
  static const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  return machine;
}

const Terrain& level() {
  static const Terrain ground = level_planning_ground(zx120());
  return ground;
}

void expect_kept(const UsedLimits& used) {
  EXPECT_LE(used.most(), 1.0 + 1e-6);
  EXPECT_LE(used.rate, 1.0 + 1e-6);
  EXPECT_LE(used.acceleration, 1.0 + 1e-6);
  EXPECT_LE(used.jerk, 1.0 + 1e-6);
  EXPECT_LE(used.cylinder_speed, 1.0 + 1e-6);
  EXPECT_LE(used.flow, 1.0 + 1e-6);
  EXPECT_LE(used.power, 1.0 + 1e-6);
  EXPECT_LE(used.beyond, 1e-9);
}

TEST(Motion, KeepsEveryLimitBetweenItsPointsOverRandomDigs) {
  int timed = 0;
  for_cases(
      [&](Random& random) {
        const auto made = any_motion(zx120(), level(), random);
        if (!made) return;
        ++timed;
        const Trajectory motion = time_way(made->machine, made->way, made->options);
        expect_kept(used_between(*made, motion, cubic));
        expect_kept(used_between(*made, motion, quintic));
      },
      300);
  EXPECT_GT(timed, 50);
  std::cout << "  " << timed << " motions\n";
}

}  // namespace
}  // namespace excavplan::test
