// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// The loops beside plain ones that take one element after another: the same bits, whatever the
// processor at hand takes at once.
#include "earth/dig_kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/random.hpp"

namespace excavplan {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();
constexpr int lines = 200;

std::vector<double> numbers(Random& random, std::size_t count, double low, double high) {
  std::vector<double> drawn(count);
  for (double& number : drawn) number = random.uniform(low, high);
  return drawn;
}

double base_of(const PileLine& line, std::size_t i) {
  const double across = line.across[i];
  const double away = std::sqrt(line.along * line.along + across * across);
  const double level = line.height[i] + line.slope * away;
  return away <= line.reach && level < line.seen_to ? level : none;
}

TEST(DigKernels, BasesOfAPileAreThoseOfEachCellAlone) {
  Random random(7);
  for (int n = 0; n < lines; ++n) {
    const std::size_t count = 1 + random.index(most_cells_of_a_line);
    std::vector<double> height = numbers(random, count, -0.3, 0.3);
    if (n % 3 == 0) height[random.index(count)] = std::nan("");  // unknown
    std::vector<double> across = numbers(random, count, -0.5, 0.8);
    for (double& away : across) away = std::max(0.0, away);
    PileLine line;
    line.along = n % 4 == 0 ? 0.0 : random.uniform(0.0, 0.7);
    line.reach = random.uniform(0.1, 1.0);
    line.slope = 0.7;
    line.seen_to = random.uniform(-0.2, 0.8);
    line.count = count;
    line.height = height.data();
    line.across = across.data();
    std::vector<double> base(count);
    const CoveredCells covered = find_bases(line, base.data());
    std::size_t first = count;
    std::size_t end = 0;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(base[i], base_of(line, i));
      if (base[i] == none) continue;
      first = std::min(first, i);
      end = i + 1;
    }
    EXPECT_EQ(covered.first, end > 0 ? first : 0U);
    EXPECT_EQ(covered.end, end);
  }
}

TEST(DigKernels, APileRaisesTheCellsThatItCoversAlone) {
  Random random(8);
  for (int n = 0; n < lines; ++n) {
    const std::size_t count = 1 + random.index(40);
    const std::vector<double> bank = numbers(random, count, -1.0, 1.0);
    const std::vector<double> before = numbers(random, count, 0.0, 0.4);
    std::vector<double> base = numbers(random, count, -0.5, 0.5);
    base[random.index(count)] = none;
    std::vector<double> loose = before;
    std::vector<double> height(count);
    const PileShare pile = {random.uniform(-0.3, 0.6), random.uniform(0.1, 1.0)};
    raise_to(pile, base.data(), {count, bank.data(), loose.data(), height.data()});
    for (std::size_t i = 0; i < count; ++i) {
      const bool covers = pile.top > base[i];
      EXPECT_EQ(loose[i], covers ? before[i] + pile.part * (pile.top - base[i]) : before[i]);
      EXPECT_EQ(height[i], bank[i] + loose[i]);
    }
  }
}

TEST(DigKernels, PilesOfAllColumnsAreAddedInTheirOrder) {
  Random random(9);
  for (int n = 0; n < lines; ++n) {
    const std::size_t rows = 1 + random.index(30);
    const std::size_t columns = random.index(12);
    const std::vector<double> loose = numbers(random, rows * 12, 0.0, 0.3);
    const std::vector<double> lay = numbers(random, rows * 12, 0.0, 0.3);
    const std::vector<double> cells = numbers(random, rows, -1.0, 10.0);
    std::vector<double> left = cells;
    std::vector<double> sum(rows, 0.25);
    const auto step = -static_cast<std::ptrdiff_t>(rows);
    add_piles({rows, &loose[11 * rows], &lay[11 * rows], step, step}, columns, left.data(),
              sum.data());
    for (std::size_t i = 0; i < rows; ++i) {
      double expected = 0.25;
      double rest = cells[i];
      for (std::size_t col = 0; col < columns; ++col) {
        rest -= 1.0;
        const std::size_t cell = (11 - col) * rows + i;
        expected += std::clamp(rest, 0.0, 1.0) * std::max(0.0, loose[cell] - lay[cell]);
      }
      EXPECT_EQ(sum[i], expected);
      EXPECT_EQ(left[i], rest);
    }
  }
}

}  // namespace
}  // namespace excavplan
