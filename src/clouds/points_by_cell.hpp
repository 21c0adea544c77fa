// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>
#include "clouds/cloud_cell.hpp"
#include "clouds/point_stream.hpp"

/// @file The points of a scan in the cells of a map. Private to the library.

namespace excavplan {

/// Points of a cell that its height and variance are of, at most; ours.
constexpr int most_points_of_cell = 256;

/// The points of a scan by cell, and by group of cells where cells hold few points; both are
/// counted as Eigen stores a map, column by column. Of a cell with many points an even random
/// choice is kept. What does not fit into memory at a time is read in bands of cells, each from
/// the source.
class PointsByCell {
 public:
  /// @param memory for points held at a time [byte]
  /// @throws Error (bad_file) here and later if the source changes
  PointsByCell(const PointSource& source, const HeightMap& map, std::uint64_t memory);

  double base() const { return base_; }        ///< that heights of points are counted from [m]
  Eigen::Index side() const { return side_; }  ///< of a group [cell]; 1: each cell is a group
  Eigen::Index rows() const { return rows_; }
  Eigen::Index columns() const { return columns_; }
  Eigen::Index group_rows() const { return (rows_ + side_ - 1) / side_; }
  Eigen::Index group_columns() const { return (columns_ + side_ - 1) / side_; }
  Eigen::Index group_of(Eigen::Index cell) const {
    return (cell % rows_) / side_ + group_rows() * (cell / rows_ / side_);
  }
  /// The centre of a cell from that of its group [cell]: x by columns, y by rows.
  Eigen::Vector2d from_centre_of_group(Eigen::Index cell) const {
    const double centre = 0.5 * static_cast<double>(side_ - 1);
    return {static_cast<double>(cell / rows_ % side_) - centre,
            static_cast<double>(cell % rows_ % side_) - centre};
  }
  /// All points of a cell over those that are kept of it.
  double per_kept(Eigen::Index cell) const {
    const auto i = static_cast<std::size_t>(cell);
    return static_cast<double>(counts_[i]) / static_cast<double>(kept(i));
  }
  /// Points kept in a group.
  std::size_t in_group(Eigen::Index group) const;

  /// Calls `visit(cell, points)` for every cell with points.
  template <typename Visit>
  void for_each_cell(const Visit& visit) {
    for_each_band([&](std::size_t first, std::size_t last) {
      for (std::size_t cell = first; cell < last; ++cell) {
        if (counts_[cell] > 0) visit(static_cast<Eigen::Index>(cell), points_of(cell));
      }
    });
  }

  /// Calls `visit(group, points)` for every group with points, in the units of the group.
  template <typename Visit>
  void for_each_group(const Visit& visit) {
    if (side_ == 1) return for_each_cell(visit);
    for_each_band([&](std::size_t first, std::size_t last) {
      const auto rows = static_cast<std::size_t>(group_rows());
      const auto in_columns = static_cast<std::size_t>(rows_ * side_);
      for (std::size_t column = first / in_columns; column * in_columns < last; ++column) {
        for (std::size_t row = 0; row < rows; ++row) {
          const std::size_t group = row + rows * column;
          gather(static_cast<Eigen::Index>(group));
          if (!gathered_.empty()) {
            visit(static_cast<Eigen::Index>(group),
                  CellRange{gathered_.data(), gathered_.data() + gathered_.size()});
          }
        }
      }
    });
  }

 private:
  static constexpr std::size_t outside = std::numeric_limits<std::size_t>::max();

  struct Place {
    std::size_t cell = outside;
    double column = 0.0;
    double row = 0.0;
  };

  /// Forwards and backwards in turn, so that the band at hand is not read again.
  template <typename Visit>
  void for_each_band(const Visit& visit) {
    const std::size_t bands = bands_.size() - 1;
    for (std::size_t i = 0; i < bands; ++i) {
      const std::size_t band = backwards_ ? bands - 1 - i : i;
      if (band != loaded_) load(band);
      visit(bands_[band], bands_[band + 1]);
    }
    backwards_ = !backwards_;
  }

  Place locate(const Eigen::Vector3d& point) const {
    Place place;
    place.column = (point.x() - origin_.x()) * per_cell_;
    place.row = (point.y() - origin_.y()) * per_cell_;
    const bool inside = place.column >= 0.0 && place.column < static_cast<double>(columns_) &&
                        place.row >= 0.0 && place.row < static_cast<double>(rows_) &&
                        std::isfinite(point.z());
    if (inside) {
      place.cell = static_cast<std::size_t>(place.row) +
                   static_cast<std::size_t>(rows_) * static_cast<std::size_t>(place.column);
    }
    return place;
  }
  void count();
  void choose_groups();
  void part(std::uint64_t most_points);
  void load(std::size_t band);
  void gather(Eigen::Index group);
  std::size_t kept(std::size_t cell) const;
  CellRange points_of(std::size_t cell) const {
    const std::size_t i = cell - bands_[loaded_];
    return {points_.get() + begin_[i], points_.get() + begin_[i + 1]};
  }

  const PointSource& source_;
  Eigen::Vector2d origin_;
  double per_cell_;
  Eigen::Index rows_;
  Eigen::Index columns_;
  Eigen::Index side_ = 1;
  std::vector<std::uint32_t> counts_;
  std::vector<std::size_t> bands_;  ///< first cells, and the end
  double base_ = 0.0;
  std::size_t loaded_ = outside;
  bool backwards_ = false;
  std::vector<std::uint64_t> begin_;  ///< of the points of every cell of the band, and the end
  std::unique_ptr<CellPoint[]> points_;
  std::vector<CellPoint> gathered_;
};

}  // namespace excavplan
