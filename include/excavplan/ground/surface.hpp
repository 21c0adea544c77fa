// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// A surveyed surface: heights of the ground and their error by the points.
struct Surface {
  HeightMap height;  ///< NaN where no point was accepted
  /// Of each cell's height, from the scatter of its own points, independent from cell to cell
  /// [m^2]; NaN where unknown.
  Eigen::ArrayXXd variance;
  Eigen::ArrayXXi points;  ///< accepted in each cell
  /// Where the sensor stood, in the frame of the heights [m]: every place of it; empty where one is
  /// unknown.
  std::vector<Eigen::Vector3d> sensors = {};
  /// Of several sensors, those that saw a cell: bit i is that of `sensors[i]`. Empty of one.
  Eigen::ArrayXXi seen_from = {};
  /// By how much a height may be wrong because the points of its cell lie on two surfaces, one
  /// above the other [m]: 0 where they lie on one. Empty where the points are not known.
  Eigen::ArrayXXf doubt = {};
  /// Mean offset that outliers leave in a height [m], if they are as many as on even ground, where
  /// they are told from it. Empty where the points are not known.
  Eigen::ArrayXXf outlier_bias = {};
  /// By how much the lowest accepted point of each cell lies below its height [m]. Empty where the
  /// points are not known.
  Eigen::ArrayXXf below = {};
};

}  // namespace excavplan
