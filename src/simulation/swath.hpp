// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// The rows of a map that the bucket covers while it digs in the boom plane, y = 0.
class Swath {
 public:
  /// Keeps a reference to the map.
  ///
  /// @param width of the bucket [m]
  /// @param least_cover rows of which less is covered are left out: rounding of an edge that lies
  ///        between two rows [-]
  /// @throws Error (bad_input) if the map does not hold the bucket's width
  Swath(const HeightMap& map, double width, double least_cover = 0.0);

  /// True if the map holds the bucket's width.
  static bool fits(const HeightMap& map, double width, double least_cover = 0.0);

  Eigen::Index first_row() const { return first_row_; }
  Eigen::Index rows() const { return cover_.size(); }
  Eigen::Index end_row() const { return first_row_ + cover_.size(); }
  double cover(Eigen::Index i) const { return cover_(i); }  ///< of row first_row() + i, 0 .. 1

  const double* covers() const { return cover_.data(); }  ///< of all rows

  /// @throws Error (bad_input) if x is off the map
  Eigen::Index column(double x) const;
  /// The same, but the column at the edge of the map if x is off it.
  Eigen::Index nearest_column(double x) const;

  /// True if the column is known in every row.
  bool is_known(Eigen::Index col) const;

  /// Mean over the width of what a function gives for each row.
  template <typename OfRow>
  double mean(OfRow&& of_row) const {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < cover_.size(); ++i) sum += cover_(i) * of_row(first_row_ + i);
    return sum / covered_;
  }

 private:
  const HeightMap& map_;
  Eigen::Index first_row_ = 0;
  Eigen::ArrayXd cover_;
  double covered_ = 0.0;  ///< sum of them
};

}  // namespace excavplan
