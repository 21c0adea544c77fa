// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

/// @file The ground in one cell, from its points. Private to the library.

namespace excavplan {

/// A point in its cell.
struct CellPoint {
  std::uint16_t x;  ///< from the corner of the cell [cell / 65536]
  std::uint16_t y;
  float z;  ///< above a height near all points [m]

  double from_centre_x() const { return from_centre(x); }
  double from_centre_y() const { return from_centre(y); }  ///< [cell]

 private:
  static double from_centre(std::uint16_t v) { return (v + 0.5) / 65536.0 - 0.5; }
};

/// Of a point above a slope [m/cell] through the centre of its cell.
inline double height_above(const CellPoint& point, const Eigen::Vector2d& slope) {
  return static_cast<double>(point.z) - slope.x() * point.from_centre_x() -
         slope.y() * point.from_centre_y();
}

/// The points of one cell.
struct CellRange {
  const CellPoint* first;
  const CellPoint* last;
  const CellPoint* begin() const { return first; }
  const CellPoint* end() const { return last; }
  std::size_t size() const { return static_cast<std::size_t>(last - first); }
};

/// Two separate levels among the points of one cell.
struct Split {
  Eigen::Index cell = 0;
  double low = 0.0;     ///< median of the lower level
  double valley = 0.0;  ///< between the two
  bool among = false;   ///< the upper points lie among the lower in plan, not beside them
};

/// The lowest gap of at least `gap` in the heights, with a fiftieth of the points at most inside it
/// and a tenth, but three points, on either side (all ours).
std::optional<Split> two_levels(CellRange points, double level, double gap,
                                std::vector<float>& heights);

/// Two surfaces in one cell, one above the other.
struct Overlay {
  double apart = 0.0;        ///< their distance in height [m]
  double share_above = 0.0;  ///< of the points [-]
  double low = 0.0;          ///< mean of the lower, at the centre of the cell [m]
  double valley = 0.0;       ///< between them, likewise
};

/// The best partition of the heights into two, by least squares (Otsu 1979), where each part holds
/// a tenth of the points and three, the upper lie among the lower in plan, and the means of the
/// parts are 3 cm apart, no part scatters by over 0.6 of that, as outliers do, and either more than
/// noise makes them, or explain 0.85 of the variance of twenty points or more: all ours. Soil and
/// dust over it, or a scan that holds the ground of two times.
///
/// @param slope of the ground [m/cell]
/// @param by_noise that noise may set them apart [m]
std::optional<Overlay> overlay_in(CellRange points, const Eigen::Vector2d& slope, double by_noise,
                                  std::vector<float>& heights);

/// Heights that ground may have in a cell: between two levels, and about a plane.
struct Band {
  double low;
  double high;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();         ///< of the ground around [m/cell]
  double plane = 0.0;                                      ///< at the centre of the cell [m]
  Eigen::Vector2d plane_slope = Eigen::Vector2d::Zero();   ///< [m/cell]
  double reach = std::numeric_limits<double>::infinity();  ///< from the plane [m]

  bool contains(const CellPoint& point) const {
    const auto z = static_cast<double>(point.z);
    return z >= low && z <= high && std::abs(from_plane(point)) <= reach;
  }
  double from_plane(const CellPoint& point) const {
    return height_above(point, plane_slope) - plane;
  }
  double farthest() const { return std::min(reach, 0.5 * (high - low)); }  ///< from the ground [m]
};

/// A mean height and the data behind it.
struct CellHeight {
  double height = std::numeric_limits<double>::quiet_NaN();
  double variance = std::numeric_limits<double>::quiet_NaN();
  double lowest = std::numeric_limits<double>::quiet_NaN();  ///< of the points of the band
  int points = 0;
};

/// Levels of the 3 x 3 cells around.
struct CellsAround {
  double low = 0.0;  ///< extreme levels, but for the farthest on each side where
                     ///< five are known
  double high = 0.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< of the plane through those levels [m/cell]
  double plane = 0.0;                               ///< that plane at the centre [m]
  double off_plane = std::numeric_limits<double>::infinity();  ///< of these levels, at most [m]
  double off_plane_all = off_plane;                            ///< of all levels
};

CellsAround surroundings_of(const Eigen::ArrayXXd& levels, Eigen::Index row, Eigen::Index column);

/// The mean height of the ground at the centre of a cell, above the reference, from points that
/// need not be spread evenly.
///
/// A plane through the points of the band moves their mean to the centre of the cell; where they
/// are too few or not spread over the cell, the slope is that of the surroundings. Where they are
/// far from a plane, as at a wall, which may have more points on one side than on the other, each
/// counts by the area of the cell that is nearest to it.
///
/// @param noise of a point on level ground [m]
CellHeight mean_height(CellRange points, const Band& band, double reference, double noise);

}  // namespace excavplan
