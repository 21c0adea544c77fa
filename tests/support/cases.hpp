// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

/// With EXCAVPLAN_TESTS=all in the environment, as the scripts of scripts/check.d have it.
bool are_all_tried();

/// As many of the cases as are tried: all, or a tenth.
int tried_of(int all);

inline const int many = tried_of(10000);

/// Calls `body` with the random numbers of each case until one fails, and names that case.
template <typename Body>
void for_cases(const Body& body, int count = many) {
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    Random random(15, static_cast<std::uint64_t>(i));
    body(random);
  }
}

int drawn_int(Random& random, int least, int most);

Eigen::VectorXd drawn_vector(Random& random, Eigen::Index size, double low, double high);

/// Standard normal in each axis, the last drawn first.
Eigen::Vector3d drawn_normals(Random& random);

/// A finite number of any magnitude, and now and then a special one.
double drawn_number(Random& random);

/// Any bytes, often those that mean something.
std::string drawn_bytes(Random& random, int most);

}  // namespace excavplan::test
