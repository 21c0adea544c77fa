// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_progress.hpp>
#include <excavplan/job/job_settings.hpp>

#include "ground/grid_cells.hpp"

/// @file
/// A job on the cells of its ground, and along its longest side. Private to the project.

namespace excavplan {

/// What is asked for in each cell.
struct JobMap {
  HeightMap target;        ///< design height; NaN where it does not lie below the ground [m]
  Eigen::ArrayXXd before;  ///< height of the ground before the job; NaN where it was not seen [m]
  Mask counts;             ///< whether the cell counts for the deviation (CutOptions)
  Mask dump;               ///< whether soil may be laid there
  Mask untouched;          ///< a keep-out of any depth, or an obstacle: no soil may fall there
  Eigen::ArrayXXd forbidden;  ///< nothing is cut below [m]; -infinity: all may be, +infinity: none
  double beyond = 0.0;        ///< cells of the design that lie beyond the ground, unseen
};

/// Height of a ground, with the soil that lies on it; NaN where it is not known [m].
double surface_of(const Terrain& ground, Cell at);

/// Of a ground over the design; NaN beside it, or where either is not known [m].
double above_design(const JobMap& map, const Terrain& ground, Cell at);

/// @param ground  before the job
JobMap map_of(const JobSettings& settings, const HeightMap& ground);

/// Of a finished design beyond twice the tolerance; ours.
inline constexpr double most_beyond_twice = 0.01;

/// Of a cell and its neighbours that count, since a single one is as much noise [m].
std::vector<double> above_design_around(const JobMap& map, const Terrain& ground, Cell cell);

/// The ground as it is known.
struct MeasuredGround {
  const Terrain& terrain;
  const Eigen::ArrayXXd& seen;  ///< when each cell was; NaN: never, or dug since
};
/// With what is measured set. @param tolerance  of the design [m]
JobProgress measured(JobProgress progress, const JobMap& map, const MeasuredGround& now,
                     double tolerance);

/// A design as high as told, in the frame of ground that lies elsewhere.
/// @param design  heights on the cells of `grid`
/// @param over  height of that ground at the origin [m], its rise along x and y [-]
Eigen::ArrayXXd raised(const Eigen::ArrayXXd& design, const HeightMap& grid,
                       const Eigen::Vector3d& over);

/// How far beside a line a part of the design reaches [m].
struct AcrossLine {
  double right = 0.0;
  double left = 0.0;
};

/// Where the design lies along the machine's line of work.
struct JobFrame {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< of the line [m]
  double heading = 0.0;       ///< of the line, away from where the job ends [rad]
  double near = 0.0;          ///< of the design along the line [m]
  double far = 0.0;           ///< likewise [m]
  double right = 0.0;         ///< of its lanes beside the line, mostly below 0 [m]
  double left = 0.0;          ///< likewise [m]
  bool is_battered = false;   ///< some of the design is neither floor nor wall
  double faces_across = 0.0;  ///< share of what counts of the design that rises across the line
  AcrossLine floor;           ///< of what counts and is no face
  double tracks = 0.0;        ///< heading of the machine's tracks from the line [rad]

  /// So many that they are to be cut along their fall line.
  bool has_faces_across() const;
  /// The machine stands beside the design with its tracks along it, and digs across.
  bool is_beside() const { return tracks != 0.0; }
  Eigen::Vector2d place(double along, double beside) const;
  Eigen::Vector2d of(const Eigen::Vector2d& place) const;  ///< along and beside
};

/// Along the heading in which the machine starts, or turned from it [rad]: it works backwards.
JobFrame frame_of(const JobSettings& settings, const JobMap& map, double turned = 0.0);
/// Of the part that lies below a height of the site [m].
AcrossLine across_below(const JobMap& map, const JobFrame& frame, double height);
/// The same line from its other end.
JobFrame reversed(const JobFrame& frame);

}  // namespace excavplan
