// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <excavplan/base/error.hpp>
#include <excavplan/change/volume_change.hpp>

#include "fuzz/fuzz_target.hpp"

namespace excavplan::test {
namespace {

/// Heights of a cell: those of a plane, a bump, a hole or none, with a little noise.
HeightMap map_of(Eigen::Index rows, Eigen::Index cols, double cell, NumbersOfBytes& numbers) {
  HeightMap map;
  map.cell_size = cell;
  map.origin = {numbers.between(-5.0, 5.0), 0.0};
  map.z.resize(rows, cols);
  const double slope = numbers.between(-1.0, 1.0);
  const double noise = numbers.between(0.0, 0.05);
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index col = 0; col < cols; ++col) {
      const auto sign = static_cast<double>((row * 7 + col * 13) % 5 - 2);
      map.z(row, col) = slope * cell * static_cast<double>(col) + noise * sign;
    }
  }
  for (std::size_t blocks = map.z.size() == 0 ? 0 : numbers.index(8); blocks > 0; --blocks) {
    const auto row = static_cast<Eigen::Index>(numbers.index(static_cast<std::size_t>(rows)));
    const auto col = static_cast<Eigen::Index>(numbers.index(static_cast<std::size_t>(cols)));
    const auto high = 1 + static_cast<Eigen::Index>(numbers.index(12));
    const auto wide = 1 + static_cast<Eigen::Index>(numbers.index(12));
    map.z.block(row, col, std::min(high, rows - row), std::min(wide, cols - col)) +=
        numbers.odd(-1.0, 1.0);
  }
  return map;
}

}  // namespace

void fuzz_volume_change(std::string_view bytes) {
  NumbersOfBytes numbers(bytes);
  const auto rows = static_cast<Eigen::Index>(numbers.index(40));
  const auto cols = static_cast<Eigen::Index>(numbers.index(40));
  const double cell = numbers.odd(0.02, 0.5);
  ChangeOptions options;
  options.detection = numbers.odd(4.0, 6.0);
  options.growth = numbers.odd(2.0, 4.0);
  options.spill_distance = numbers.odd(0.0, 1.0);
  options.margin = numbers.between(0.0, 0.2);
  const HeightMap before = map_of(rows, cols, cell, numbers);
  HeightMap after = map_of(rows, cols, cell, numbers);
  after.origin = before.origin;
  try {
    const VolumeChange change = measure_change(before, after, options);
    for (const Measured& volume :
         {change.excavated, change.spilled, change.dumped, change.before, change.after}) {
      require_that(
          std::isfinite(volume.value) && std::isfinite(volume.sd) && volume.sd >= 0.0,
          "a volume of " + std::to_string(volume.value) + " +- " + std::to_string(volume.sd));
    }
    require_that(change.errors.total().allFinite(), "an error that is not finite");
  } catch (const Error&) {
    // refused
  }
}

}  // namespace excavplan::test
