// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "base/random.hpp"

/// @file
/// Properties: what must hold for every case, tried on many random ones.
///
/// Not by the packaged rapidcheck: it draws no real numbers from a range, takes its seed from the
/// environment and scales its numbers with the case, so that each of our generators would have to
/// be written anyway. The cases here are the same on every machine.

namespace excavplan::test {

constexpr int many = 10000;

/// Calls `body` with the random numbers of each case until one fails, and names that case.
template <typename Body>
void for_cases(const Body& body, int count = many) {
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    Random random(15, static_cast<std::uint64_t>(i));
    body(random);
  }
}

inline int drawn_int(Random& random, int least, int most) {
  return least + static_cast<int>(random.index(static_cast<std::uint64_t>(most - least + 1)));
}

inline Eigen::VectorXd drawn_vector(Random& random, Eigen::Index size, double low, double high) {
  Eigen::VectorXd vector(size);
  for (double& number : vector) number = random.uniform(low, high);
  return vector;
}

/// A finite number of any magnitude, and now and then a special one.
inline double drawn_number(Random& random) {
  constexpr double special[] = {
      0.0, -0.0, 1.0, 0.1, 9007199254740993.0, 5e-324, std::numeric_limits<double>::max()};
  if (random.uniform() < 0.05) return special[random.index(7)];
  const double size = std::exp(random.uniform(-60.0, 60.0));
  return random.uniform() < 0.5 ? -size : size;
}

/// Any bytes, often those that mean something.
inline std::string drawn_bytes(Random& random, int most) {
  const std::string often = "\"\\{}[]:,#' \n\t\x1b\x7f/-.e0aé";
  std::string bytes(static_cast<std::size_t>(drawn_int(random, 0, most)), ' ');
  for (char& byte : bytes) {
    byte = random.uniform() < 0.5 ? often[random.index(often.size())]
                                  : static_cast<char>(random.index(256));
  }
  return bytes;
}

}  // namespace excavplan::test
