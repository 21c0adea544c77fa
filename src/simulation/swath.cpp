// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/swath.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"

namespace excavplan {

using Eigen::Index;

namespace {

/// Edges of the bucket, in rows of the map.
struct Edges {
  double first;
  double last;
};

Edges edges(const HeightMap& map, double width) {
  const double half = 0.5 * width;
  return {(-half - map.origin.y()) / map.cell_size, (half - map.origin.y()) / map.cell_size};
}

}  // namespace

bool Swath::fits(const HeightMap& map, double width, double least_cover) {
  const auto [first, last] = edges(map, width);
  return first >= -least_cover && last <= static_cast<double>(map.z.rows()) + least_cover;
}

Swath::Swath(const HeightMap& map, double width, double least_cover) : map_(map) {
  if (!fits(map, width, least_cover)) {
    throw Error(ErrorKind::bad_input, "dig: the bucket, y = " + number_text(-0.5 * width) + " .. " +
                                          number_text(0.5 * width) + " m, must lie on the map");
  }
  const auto [first, last] = edges(map, width);
  first_row_ = static_cast<Index>(std::floor(first + least_cover));
  const auto end = std::min(map.z.rows(), static_cast<Index>(std::ceil(last - least_cover)));
  cover_.resize(end - first_row_);
  for (Index i = 0; i < cover_.size(); ++i) {
    const auto row = static_cast<double>(first_row_ + i);
    cover_(i) = std::min(last, row + 1.0) - std::max(first, row);
  }
  covered_ = cover_.sum();
}

Index Swath::column(double x) const {
  const double col = std::floor((x - map_.origin.x()) / map_.cell_size);
  if (!(col >= 0.0 && col < static_cast<double>(map_.z.cols()))) {
    const Rectangle extent = map_.extent();
    throw Error(ErrorKind::bad_input, "dig: the path leaves the map at x = " + number_text(x) +
                                          " m; the map covers x = " + number_text(extent.x_min) +
                                          " .. " + number_text(extent.x_max) + " m");
  }
  return static_cast<Index>(col);
}

Index Swath::nearest_column(double x) const {
  const double col = std::floor((x - map_.origin.x()) / map_.cell_size);
  return static_cast<Index>(std::clamp(col, 0.0, static_cast<double>(map_.z.cols() - 1)));
}

bool Swath::is_known(Index col) const {
  return !map_.z.col(col).segment(first_row_, rows()).isNaN().any();
}

}  // namespace excavplan
