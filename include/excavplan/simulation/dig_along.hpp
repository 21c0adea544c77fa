// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/machine/base_pose.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// Digs along any line of a site (docs/methods.md#lines). The ground stays in the cells of the
/// site: a simulator digs a view of them along the line, and what it changed there enters the
/// cells.

namespace excavplan {

/// The line of a dig in plan: the x axis of its path, whose y = 0 is the middle of the bucket.
struct DigLine {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< of the path's x, in the site [m]
  double z = 0.0;                                    ///< of the path's z = 0, in the site [m]
  double heading = 0.0;                              ///< of the path's x axis in the site [rad]

  Eigen::Vector2d place(double x, double y) const;  ///< of a point beside the line, in the site [m]
};

/// The line of a machine that has swung to the left by `swung` [rad], or of a lane: parallel to
/// that line, so far to its left [m]. In a lane the tooth is `x` along the line, the machine swings
/// on by atan2(lane, x) and the front reaches out to hypot(x, lane).
DigLine dig_line(const BasePose& base, double swung = 0.0, double lane = 0.0);

/// How much of a soil is grains.
struct SoilVoids {
  double bank = 0.0;           ///< void ratio where a terrain states none [-]
  double loose = 0.0;          ///< of soil just dug, and where a terrain states none [-]
  double grain_density = 0.0;  ///< [kg/m^3]
};
/// @throws Error (bad_input) as bank_state()
SoilVoids soil_voids(const SoilKind& soil, double density_percent);

/// The ground of a site along a line.
class GroundAlong {
 public:
  /// Looks at the ground around the line: a cell is the mean of nine places in it, unknown unless
  /// most of them are known.
  /// @param extent  along the line and across it [m]
  /// @param cell_size  of the view [m]
  /// @throws Error (bad_input) as require_terrain() and flat_ground()
  GroundAlong(const Terrain& site, DigLine line, const Rectangle& extent, double cell_size);

  const Terrain& terrain() const { return along_; }  ///< to dig on: x along the line, z of the path
  const DigLine& line() const { return line_; }      ///< along which it lies

  /// Makes a dig of terrain() one of the site: its patch is of the site's cells. What happened to a
  /// cell of the view happens to those cells of the site whose centre is in it: they are lowered to
  /// the level of the cut, not by its depth, and gain what came to lie. Since that is not quite the
  /// soil that the view lost, payload and soil that came to lie are scaled by the ratio: solids are
  /// kept to rounding.
  /// @param site  on which the object was made
  /// @throws Error (bad_input) as require_terrain(), or if the dig has no patch of terrain()
  void enter(const Terrain& site, const SoilVoids& voids, DigResult& dig) const;

 private:
  DigLine line_;
  Terrain along_;
};

/// Room around a path that its dig may change, along the line and across it [m].
Rectangle extent_along(const Machine& machine, const DigPath& path);

/// A dig of a site.
struct LineDig {
  DigLine line;     ///< in which the path lies
  SoilVoids voids;  ///< of the soil that is dug
  DigPath path;     ///< in the frame of the line
};

/// One dig on the ground of a site: GroundAlong around the path, `simulator` on it, enter().
/// @throws Error (bad_input) as SoilSimulator::dig()
DigResult dig_along(const SoilSimulator& simulator, const Machine& machine, const Terrain& site,
                    const LineDig& dig, const DigOptions& options = {});

/// Heaps loose soil on the ground, a cone that slides until it is at rest.
/// @param volume  as it lies loose [m^3], 0 .. 1e6
/// @throws Error (bad_input) if the place is unknown ground or off the map, or the volume out of
///         range
void heap_soil(Terrain& site, const SoilKind& soil, double density_percent,
               const Eigen::Vector2d& place, double volume);

}  // namespace excavplan
