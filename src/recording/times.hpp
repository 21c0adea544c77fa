// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

/// @file Times of messages [ns]. Those of a hostile file or sender may be any, so that sums and
/// differences stop at the ends of the range. Private to the library.

namespace excavplan {

constexpr std::int64_t earliest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t latest = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t one_second = 1000000000;

inline std::int64_t later(std::int64_t time, std::int64_t by) {
  std::int64_t sum = 0;
  return __builtin_add_overflow(time, by, &sum) ? (by > 0 ? latest : earliest) : sum;
}

/// At least -latest: it has a magnitude.
inline std::int64_t time_between(std::int64_t from, std::int64_t to) {
  std::int64_t result = 0;
  if (__builtin_sub_overflow(to, from, &result)) return to > from ? latest : -latest;
  return std::max(result, -latest);
}

}  // namespace excavplan
