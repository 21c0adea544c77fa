// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/cases.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>

#include <Eigen/Core>

namespace excavplan::test {

bool are_all_tried() {
  const char* const asked = std::getenv("EXCAVPLAN_TESTS");
  return asked != nullptr && std::string(asked) == "all";
}

int tried_of(int all) { return are_all_tried() ? all : all / 10; }

int drawn_int(Random& random, int least, int most) {
  return least + static_cast<int>(random.index(static_cast<std::uint64_t>(most - least + 1)));
}

Eigen::VectorXd drawn_vector(Random& random, Eigen::Index size, double low, double high) {
  Eigen::VectorXd vector(size);
  for (double& number : vector) number = random.uniform(low, high);
  return vector;
}

Eigen::Vector3d drawn_normals(Random& random) {
  Eigen::Vector3d normals;
  for (int axis = 2; axis >= 0; --axis) normals(axis) = random.normal();
  return normals;
}

double drawn_number(Random& random) {
  constexpr double special[] = {
      0.0, -0.0, 1.0, 0.1, 9007199254740993.0, 5e-324, std::numeric_limits<double>::max()};
  if (random.uniform() < 0.05) return special[random.index(7)];
  const double size = std::exp(random.uniform(-60.0, 60.0));
  return random.uniform() < 0.5 ? -size : size;
}

std::string drawn_bytes(Random& random, int most) {
  const std::string often = "\"\\{}[]:,#' \n\t\x1b\x7f/-.e0aé";
  std::string bytes(static_cast<std::size_t>(drawn_int(random, 0, most)), ' ');
  for (char& byte : bytes) {
    byte = random.uniform() < 0.5 ? often[random.index(often.size())]
                                  : static_cast<char>(random.index(256));
  }
  return bytes;
}

}  // namespace excavplan::test
