// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "clouds/cloud_cell.hpp"
#include "clouds/points_by_cell.hpp"

/// @file Which points of a scan may be ground. Private to the library.

namespace excavplan {

/// The level of every group of cells and how far points may be from it.
struct GroundLevels {
  Eigen::ArrayXXd height;  ///< above the base [m]; NaN without points
  double noise = 0.0;      ///< lower quartile of the cells' robust sd [m]
};

/// What lies above the ground in groups of cells.
struct Cover {
  /// Groups whose upper points are no ground, with the height above which those lie.
  std::unordered_map<Eigen::Index, double> ceilings;
  Eigen::ArrayXXd doubt;  ///< of the height, where points lie on two surfaces [m]
};

/// Where the ground may be in each cell: by the levels of the groups of cells around, and by those
/// of the cells alone where they have points enough.
class GroundBands {
 public:
  /// @param outlier_distance of points from the levels around, in units of the noise
  GroundBands(PointsByCell& points, double cell_size, double outlier_distance);

  double noise() const { return levels_.noise; }  ///< of a point on level ground [m]
  double gap() const { return gap_; }  ///< from even ground, within which points are ground [m]
  double level(Eigen::Index cell) const { return levels_.height(points_.group_of(cell)); }
  double doubt(Eigen::Index cell) const { return cover_.doubt(points_.group_of(cell)); }
  Band band(Eigen::Index cell) const;

 private:
  double reach_of(double off_plane) const;
  Band by_groups(Eigen::Index cell) const;
  CellsAround around_group(Eigen::Index group) const;
  void find_fine_levels();

  PointsByCell& points_;
  GroundLevels levels_;
  Cover cover_;
  double gap_;
  Eigen::ArrayXXd fine_;  ///< of the cells alone, at their centres; NaN where points are few
  /// Of one column of groups at a time, whose cells follow each other.
  mutable std::vector<std::optional<CellsAround>> around_;
  mutable Eigen::Index column_of_around_ = -1;
};

/// Distances from the ground in quarters of its gap, up to sixteen gaps.
class DistanceBins {
 public:
  static constexpr std::size_t count = 64;

  explicit DistanceBins(double gap);
  std::size_t of(double distance) const;  ///< `count` for all beyond

 private:
  double per_bin_;
};

/// The mean offset that outliers give to the heights of cells.
struct OutlierBias {
  DistanceBins bins;
  std::array<double, DistanceBins::count + 1> at = {};  ///< [m]

  /// Of cells that keep points up to `reach` from the ground [m].
  double within(double reach) const { return at[bins.of(reach)]; }
};

/// The points that are cut off the most even ground, and what like ones do where the ground is
/// uneven, so that they are not told from it.
class OutlierTally {
 public:
  explicit OutlierTally(double gap) : bins_(gap) {}

  void add(CellRange points, const Band& band);
  OutlierBias bias() const;

 private:
  /// Of cells that are about as even.
  struct Class {
    double points = 0.0;
    std::array<double, DistanceBins::count> off = {};  ///< sum of those cut off, by distance [m]
  };

  DistanceBins bins_;
  std::array<Class, DistanceBins::count> by_reach_ = {};
};

}  // namespace excavplan
