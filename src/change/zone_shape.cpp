// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/zone_shape.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "base/statistics.hpp"

namespace excavplan {
namespace {

double slope_at(const Eigen::ArrayXXd& d, Cell at, double cell_size) {
  const auto along = [&](Eigen::Index dr, Eigen::Index dc) {
    const Eigen::Index r0 = std::max<Eigen::Index>(at.row - dr, 0);
    const Eigen::Index c0 = std::max<Eigen::Index>(at.col - dc, 0);
    const Eigen::Index r1 = std::min(at.row + dr, d.rows() - 1);
    const Eigen::Index c1 = std::min(at.col + dc, d.cols() - 1);
    const double rise = (d(r1, c1) - d(r0, c0)) / (2.0 * cell_size);
    return std::isnan(rise) ? 0.0 : rise;
  };
  return std::hypot(along(1, 0), along(0, 1));
}

}  // namespace

bool ZoneShape::is_track_wide() const {
  constexpr double highest = 0.10, widest = 1.0, shortest = 0.8;  // [m]; ours
  return height < highest && width < widest && length > shortest;
}

bool ZoneShape::is_twin_of(const ZoneShape& other) const {
  constexpr double alike = 1.7, parallel = 0.94, longish = 1.5;  // 20 degrees; ours
  const auto similar = [](double a, double b) { return a < alike * b && b < alike * a; };
  return is_track_wide() && other.is_track_wide() && length > longish * width &&
         other.length > longish * other.width && similar(height, other.height) &&
         similar(width, other.width) && std::abs(axis.dot(other.axis)) > parallel;
}

ZoneShape shape_of(const Eigen::ArrayXXd& difference, const std::vector<Cell>& cells,
                   double cell_size) {
  ZoneShape shape;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double sum = 0.0;
  double squares = 0.0;
  std::vector<double> slopes;
  std::vector<double> heights;
  const auto place = [](Cell at) {
    return Eigen::Vector2d(static_cast<double>(at.col), static_cast<double>(at.row));
  };
  for (const Cell at : cells) {
    const double d = std::abs(difference(at.row, at.col));
    sum += d;
    squares += d * d;
    centre += d * place(at);
    slopes.push_back(slope_at(difference, at, cell_size));
    heights.push_back(d);
  }
  if (!(sum > 0.0)) return shape;
  centre /= sum;
  shape.height = squares / sum;
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
  for (const Cell at : cells) {
    const Eigen::Vector2d off = place(at) - centre;
    products += std::abs(difference(at.row, at.col)) / sum * off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(products);
  const auto extent = [&](int i) {
    return cell_size * std::sqrt(12.0 * std::max(axes.eigenvalues()(i), 0.0));
  };
  shape.axis = axes.eigenvectors().col(1);
  shape.width = extent(0);
  shape.length = extent(1);
  shape.steepest = upper_quantile(slopes, 0.9);
  shape.fullness = shape.height / upper_quantile(heights, 0.95);
  return shape;
}

}  // namespace excavplan
