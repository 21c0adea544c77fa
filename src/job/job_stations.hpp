// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <excavplan/ground/terrain.hpp>

#include "job/job_map.hpp"

/// @file
/// Where the machine stands one after the other, and what it digs from there. Private to the
/// project.

namespace excavplan {

/// A place of the machine: along its line of work, and beside it.
struct JobStation {
  double along = 0.0;               ///< [m]
  double beside = 0.0;              ///< [m]
  std::vector<double> lanes = {};   ///< that it digs from there, beside the line of work [m]
  double turned = 0.0;              ///< from the line of work [rad]
  std::vector<double> passes = {};  ///< lanes of its finishing passes; empty: as `lanes` [m]
  bool is_wide = false;             ///< of a design that is wider than one place's lanes
  bool has_others_beside = false;   ///< whose lanes take up what leaves its own
  bool is_beyond = false;           ///< the far end: all of it is along the reversed() line
  bool is_across = false;           ///< all of it is along the line of places_beside()
  bool is_again = false;            ///< only if the shape of what it reaches is not right
  bool leaves_passes = false;       ///< to the places after it
  bool leaves_floor = false;        ///< likewise all but passes along faces
  double shapes_from = -1e9;        ///< along the line; what is nearer, later places shape [m]
  double shapes_to = 1e9;           ///< likewise; what is farther, a place beyond the end does [m]

  bool is_lookout() const { return lanes.empty(); }  ///< it only scans from there
};

/// The line along which a station is told: the line of work, or the same from its other end.
inline JobFrame line_of(const JobFrame& frame, const JobStation& station) {
  return station.is_beyond ? reversed(frame) : frame;
}

/// The line of work that the faces of a design ask for: a bucket's edge is level across, so that a
/// drag along a face leaves steps. Along the heading of the start, or at right angles to it if that
/// makes most of the faces and the machine can stand and dump everywhere.
JobFrame work_frame(const JobSettings& settings, const JobMap& map, const Terrain& first);

/// Whether a line of work has so much fewer faces across it than another one that these are worth
/// it.
bool leaves_fewer_faces(const JobFrame& turned, const JobFrame& straight);

/// The places of a job in their order, from the far end of the design to beyond its near end. From
/// each one all that is within reach ahead is dug; where the design is wider than the lanes of one
/// place, the machine moves aside before it goes back.
/// @param swept  swept_from() places beside the design: to them passes are left
std::vector<JobStation> stations_of(const JobFrame& frame, const JobSettings& settings,
                                    const std::vector<double>& swept = {});

/// Those beside a design with faces, from where the line of work ends, of which a bucket sweeps
/// down one face, along the floor and up the other one. @param across  is_beside()
std::vector<JobStation> stations_beside(const JobFrame& across, const JobSettings& settings);

/// Whether the front reaches all across from one of them, but for what sweeps need not reach.
bool reaches_across(const JobFrame& across, const JobStation& place, const Machine& machine);

/// Where along a line of work their passes run, in rising order [m].
std::vector<double> swept_from(const std::vector<JobStation>& places, const JobFrame& across,
                               const JobFrame& frame);

/// The places beyond the far end, from which it can be dug as the near end is from the last ones: a
/// bucket that comes up along a wall leaves it steep in soil of any strength, one that goes down
/// only where the machine is heavy enough.
std::vector<JobStation> stations_beyond(const JobFrame& frame, const JobSettings& settings);

/// The tracks of a machine at a station, and so far around them.
struct TrackArea {
  const JobFrame& frame;
  const JobStation& station;
  const Machine& machine;
  double around = 0.0;  ///< [m]
};

/// The cells of a grid there, or nothing of a place beside the grid.
template <typename Visit>
void for_each_under(const TrackArea& tracks, const HeightMap& grid, Visit visit) {
  constexpr double standing_step = 0.2;  // of what is looked at; ours [m]
  const JobStation& station = tracks.station;
  const double front = tracks.machine.track_front + tracks.around;
  const double half = 0.5 * tracks.machine.undercarriage_width() + tracks.around;
  const Eigen::Rotation2Dd turn(station.turned);
  const double rows = std::ceil(front / standing_step), cols = std::ceil(half / standing_step);
  for (double i = -rows; i <= rows; ++i) {
    for (double k = -cols; k <= cols; ++k) {
      const Eigen::Vector2d off = turn * Eigen::Vector2d(front * i / rows, half * k / cols);
      const Eigen::Vector2d at =
          tracks.frame.place(station.along + off.x(), station.beside + off.y());
      visit(cell_at(grid, at.x(), at.y()));
    }
  }
}

/// Whether the machine has ground under its tracks there, not too near to the design and off the
/// places for soil and what must not be touched.
bool can_stand(const JobFrame& frame, const JobStation& station, const Machine& machine,
               const JobMap& map);

/// The part of the design that is worked on from so far along the line, from the swing axis [m].
struct WorkRange {
  double near = 0.0;
  double far = 0.0;
  bool ends_at_wall = false;  ///< `far` is the end of a design that is not battered
};
WorkRange work_range(const JobFrame& frame, const Machine& machine, double along,
                     bool is_wide = false);

/// A vertical plane to dig in: to the left of the machine's view and beside the swing axis.
struct WorkLine {
  double turned = 0.0;        ///< [rad]
  double lane = 0.0;          ///< [m]
  double near = 0.0;          ///< from the swing axis to the nearest part of the work [m]
  double far = 0.0;           ///< to the farthest [m]
  bool ends_at_wall = false;  ///< there, the design ends
};

/// The lanes of a station from where the machine stands, and for its digs for volume a fan of
/// planes through the swing axis over the lanes that are too far beside it.
/// @param at  along the line of work and beside it [m]
std::vector<WorkLine> work_lines(const JobFrame& frame, const JobStation& station,
                                 const Machine& machine, const Eigen::Vector2d& at, bool finishing);

/// With lanes along walls that lean back, over what of the design lies below a bench.
JobStation on_bench(JobStation station, const JobFrame& frame, const AcrossLine& below,
                    const Machine& machine);

/// Between lanes for volume that run along faces of the design, so that they leave steps; 0 where
/// none do [m].
double volume_lane_step(const JobFrame& frame);

/// The same place, with the front along a line of work.
BasePose ahead_of(BasePose base, const JobFrame& frame);

/// A machine at a station, on the mean height of the ground under its tracks.
BasePose base_at(const JobFrame& frame, const JobStation& station, const Terrain& ground,
                 const Machine& machine);

}  // namespace excavplan
