// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <Eigen/Core>

#include <excavplan/simulation/dig_along.hpp>

#include "job/job_map.hpp"

/// @file
/// Ground and design along one line of digs. Private to the project.

namespace excavplan {

/// Where a dig begins: beside the swing axis and before it, along a line to the left of the view.
struct DigStart {
  double lane = 0.0;     ///< [m]
  double along = 0.0;    ///< [m]
  double turned = 0.0;   ///< [rad]
  bool is_pass = false;  ///< along the floor or a face
};

/// How the surface of a view changed.
struct ShapeChange {
  double shaped = 0.0;    ///< less that is out of shape, of what counts under the bucket [m^3]
  double cleared = 0.0;   ///< of what lies above the design there [m^3]
  double pushed = 0.0;    ///< risen above it beside the bucket [m^3]
  double finished = 0.0;  ///< brought within the tolerance, less what left it, there [m^2]
  double gained = 0.0;    ///< of what lies above the design [m^3]
  double at_end = 0.0;    ///< of that, at the end of the work [m^3]
  double too_deep = 0.0;  ///< newly below it, or beside it below the ground [m^3]
  double spilled = 0.0;   ///< risen beside the design and the dump areas [m^3]
  double touched = 0.0;   ///< changed where nothing may (JobMap::untouched) [m^3]
};

/// What counts in a change.
struct ShapeRules {
  double slack = 0.0;      ///< so far from the design ground is not too deep or out of shape [m]
  double tolerance = 0.0;  ///< of the design [m]
  double end = 0.0;        ///< from here on the work ends, along the line [m]
  /// What the design lies deeper below the floor of the lane is of lanes that come later [m].
  double deepest = std::numeric_limits<double>::infinity();
};

/// What a machine sees along a line: heights are those of its path.
class LaneView {
 public:
  LaneView(const Terrain& ground, const JobMap& job, const DigLine& line, const Rectangle& extent,
           double bucket_width);

  const GroundAlong& ground() const { return ground_; }
  const HeightMap& surface() const { return surface_; }

  /// Nothing is cut below that level, as if the design were no deeper [m].
  void keep_above(double level);
  /// Of the design under the bucket, from its highest to its lowest cell [m]; NaN beside it.
  double fall(Eigen::Index col) const { return fall_(col); }
  /// The highest of the design under the bucket; beside the design the ground. So much higher [m].
  GroundProfile floor(double allowance) const;
  /// Of the ground under the bucket, without the strips at its edges, which it may miss: its
  /// highest quarter, which the bucket meets first, and all of it.
  GroundProfile top() const;
  GroundProfile mean() const;

  Eigen::Index columns() const { return surface_.z.cols(); }
  double x(Eigen::Index col) const { return surface_.x(col); }
  double ground_at(Eigen::Index col) const { return ground_at_(col); }  ///< [m]; NaN: not known
  /// Whether all ground is known under the bucket and a cell around it, from one place of the lane
  /// to another: what simulates a dig asks for it.
  bool is_known(double from, double to) const;
  /// Mean thickness of what is above the floor under the bucket, of each column [m].
  Eigen::ArrayXd excess(double allowance) const;

  ShapeChange change(const TerrainPatch& patch, const ShapeRules& rules) const;

 private:
  void look_under_bucket(double bucket_width);
  bool is_edge(Eigen::Index row) const;
  /// Under a column of the bucket, of such targets [m].
  double floor_of(const Eigen::ArrayXXd& target, Eigen::Index col) const;

  GroundAlong ground_;
  HeightMap surface_;
  Eigen::ArrayXXd target_;  ///< of the cells that are seen, NaN beside the design
  Eigen::ArrayXXd exact_;   ///< between them, where a path along it goes
  Mask dump_;
  Mask counts_;
  Mask untouched_;
  Eigen::ArrayXXd forbidden_;
  Eigen::Index first_row_ = 0, end_row_ = 0;  ///< under the bucket
  Eigen::Index inner_ = 0;                    ///< rows of its edges, which may be beside the design
  Eigen::ArrayXd floor_, exact_floor_, ground_at_, top_, fall_;
};

}  // namespace excavplan
