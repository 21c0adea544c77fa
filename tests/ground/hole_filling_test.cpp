// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/hole_filling.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/angles.hpp"
#include "base/non_finite.hpp"

namespace excavplan {
namespace {

constexpr Eigen::Index edge = 41;
constexpr Eigen::Index middle = 20;

/// Heights by (u, v) from the middle [cell].
template <typename Shape>
Eigen::ArrayXXd heights_of(Shape shape) {
  Eigen::ArrayXXd z(edge, edge);
  for_each_cell(z, [&](Cell at) {
    z(at.row, at.col) =
        shape(static_cast<double>(at.col - middle), static_cast<double>(at.row - middle));
  });
  return z;
}

std::vector<Cell> known_cells(const Eigen::ArrayXXd& z) {
  std::vector<Cell> known;
  for_each_cell(z, [&](Cell at) {
    if (!std::isnan(z(at.row, at.col))) known.push_back(at);
  });
  return known;
}

/// Takes a disc out of the middle, and returns its cells.
std::vector<Cell> disc_taken_out(Eigen::ArrayXXd& z, double radius) {
  for_each_cell(z, [&](Cell at) {
    const auto u = static_cast<double>(at.col - middle);
    const auto v = static_cast<double>(at.row - middle);
    if (std::hypot(u, v) < radius) z(at.row, at.col) = nan;
  });
  return find_holes(z).cells.front();
}

/// A membrane over a disc of radius R in the bowl c r^2 is level at the height of its rim, in all
/// c pi R^4 / 2 above the bowl, and a plate is the bowl itself but for the little slope in its
/// energy: less than a tenth. The cells of the rim lie up to one beyond R.
TEST(HoleFilling, AStandingDifferenceOfMembraneAndPlateIsPartOfTheError) {
  constexpr double c = 0.01;
  const auto apart = [](double radius) { return 0.5 * c * pi * std::pow(radius, 4); };
  for (const double radius : {3.0, 5.0}) {
    Eigen::ArrayXXd z = heights_of([](double u, double v) { return c * (u * u + v * v); });
    const std::vector<Cell> hole = disc_taken_out(z, radius);
    for (const auto& tried : {std::vector<Cell>{}, known_cells(z)}) {
      const double sd = std::sqrt(error_of_filling(z, hole, hole, tried));
      EXPECT_GT(sd, 0.9 * apart(radius)) << radius;
      EXPECT_LT(sd, apart(radius + 1.0)) << radius;
    }
  }
}

/// On the saddle h u v every filling of one cell is right, and the 12 cells of its rim, four of
/// them at +-h and eight at 0, lie h / sqrt(3) about their best plane.
TEST(HoleFilling, WithFewerThanEightPlacesToTryTheErrorIsHalfTheReliefOfTheRim) {
  constexpr double h = 0.02;
  Eigen::ArrayXXd z = heights_of([](double u, double v) { return h * u * v; });
  const std::vector<Cell> hole = disc_taken_out(z, 0.5);
  const auto sd_by = [&](Eigen::Index count) {
    std::vector<Cell> places;
    for (Eigen::Index i = 0; i < count; ++i) places.push_back({5 + i, 5});
    return std::sqrt(error_of_filling(z, hole, hole, places));
  };
  EXPECT_NEAR(sd_by(0), 0.5 * h / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(sd_by(7), 0.5 * h / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(sd_by(8), 0.0, 1e-9);
}

}  // namespace
}  // namespace excavplan
