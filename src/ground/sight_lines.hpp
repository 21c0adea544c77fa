// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/surface.hpp>

#include "ground/grid_cells.hpp"

/// @file
/// What the rays of a sensor tell about ground that it did not see. Private to the project.

namespace excavplan {

/// The rays from one sensor to the known cells of a map: all space that they passed is empty.
///
/// The tangent of the lowest ray over a cell is that of the known cells behind it. It is handed
/// from cell to cell towards the sensor, between two cells by linear interpolation, as viewsheds
/// are computed outwards (Franklin and Ray 1994): linear in the cells but for sorting them.
class SightLines {
 public:
  SightLines(const HeightMap& map, const Eigen::Vector3d& sensor);
  /// @param seen  heights of what this sensor saw of the map, NaN elsewhere
  SightLines(const HeightMap& map, const Eigen::Vector3d& sensor, const Eigen::ArrayXXd& seen);

  /// Height of the lowest ray that passed over the centre of a cell; infinite where none did [m].
  double ceiling(Cell at) const;
  /// Away from the sensor in plan, of length 1; (column, row).
  Eigen::Vector2d outward(Cell at) const;
  /// True if nothing is known next to the cell on the side away from the sensor.
  bool faces_unseen(Cell at) const;
  /// How far beyond the centre of a known cell the lowest ray over it would meet level ground: 1 on
  /// level ground, the way to the rim where the cell hides ground, infinite without such a ray.
  double cells_to_rim(Cell at) const;
  /// True if the cell hides the unseen ground that it faces.
  bool hides(Cell at) const;

 private:
  struct Behind {
    Cell one;
    Cell two;
    double share;  ///< of the second
  };
  Behind behind(Cell at) const;
  double range(Cell at) const { return range_(at.row, at.col); }
  bool is_inside(Cell at) const;
  double tangent_at(Cell at, const Eigen::ArrayXXd& seen) const;

  const HeightMap& map_;
  Eigen::Vector3d sensor_;
  Eigen::ArrayXXd range_;    ///< of each cell in plan [m]
  Eigen::ArrayXXd tangent_;  ///< of the lowest ray over a cell; infinite where there is none
};

/// The rays from all places where the sensor of one scan stood.
class AllSightLines {
 public:
  /// @param places  sensors and the cells that they saw, of the surface whose heights the map holds
  AllSightLines(const HeightMap& map, const Surface& places);

  bool are_several() const { return lines_.size() > 1; }
  /// Height of the lowest ray that passed over the centre of a cell; infinite where none did [m].
  double ceiling(Cell at) const;
  /// True if nothing is known next to the cell on the side away from a place that saw the cell.
  bool faces_unseen(Cell at) const;
  /// Those from which the cell hides the unseen ground that it faces; null if there are none.
  const SightLines* hidden_by(Cell at) const;

 private:
  bool sees(std::size_t place, Cell at) const;

  const Eigen::ArrayXXi& seen_from_;
  std::vector<SightLines> lines_;
};

/// Of a surface seen from one place: makes cells unknown that hold less than half of the points of
/// level ground and are grazed by the rays behind them, or stand among unknown ones: returns mixed
/// from the rim of a shadow and what lies behind it, and cells that are seen in part. What is left
/// ends, on average, where the shadow begins. @return 1 for each of them
Eigen::ArrayXXi drop_mixed_returns(Surface& surface);

}  // namespace excavplan
