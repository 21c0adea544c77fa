// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <excavplan/scans/scan_surface.hpp>

#include "clouds/cloud_formats.hpp"

/// @file The points of a scan, wherever they are. Private to the library.

namespace excavplan {

/// What visit_scan() passed on.
struct VisitedScan {
  CloudShape shape;  ///< but for the sensor; organised if it is all of one file or cloud
  std::uint64_t machine_points = 0;  ///< not passed on
};

/// Passes on the points of a scan in the site frame, without those outside its area or of the
/// machine; those that are not finite may be among them. The same on every call.
/// @throws Error (bad_file)
VisitedScan visit_scan(const Scan& scan, const PointVisitor& visit);

/// Calls `visit` with the points of a cloud, some thousand at a time.
void visit_parts(const std::vector<Eigen::Vector3d>& points, const PointVisitor& visit);

/// What a scan has from one place of the sensor.
struct Standpoint {
  Eigen::Vector3d place;  ///< in the site frame
  Scan scan;
};

/// The scan by the places where the sensor stood, in the order of its files and clouds; empty where
/// a place is unknown, or of more than four, which are those of a sensor that moved.
std::vector<Standpoint> standpoints_of(const Scan& scan);

/// All these points at once, for methods that need them.
/// @throws Error (bad_file) as read_cloud()
Cloud gathered(const Scan& scan);

/// Its files, for messages.
std::string name_of(const Scan& scan);

/// A pair of scans and their outlines.
struct OutlinedPair {
  ScanPair scans;
  ScanOutline before;
  ScanOutline after;

  /// Of the survey: no larger than points allow, as walls and narrow zones are lost in large ones.
  double cell_size() const { return survey_cell({before, after}); }
  double registration_cell() const { return cell_for({before, after}); }
  std::uint64_t machine_points() const { return before.machine_points + after.machine_points; }
  std::string names() const { return name_of(scans.before) + ", " + name_of(scans.after); }
};

/// @throws Error (bad_file) if one cannot be read or holds fewer than 100 finite points
OutlinedPair outlined(const ScanPair& scans, unsigned threads);

/// How far a correction moves the middle of the ground, and by what angle it turns it.
struct Displacement {
  double shift = 0.0;  ///< [m]
  double turn = 0.0;   ///< [rad]

  /// Beyond three standard deviations of the priors of align().
  bool is_beyond_prior() const;
};
Displacement displacement_by(const Eigen::Matrix4d& correction, const Eigen::Vector3d& centre);

/// True if the ground that did not change differs by over 10 mm, and by three times what the
/// scatter of the points explains.
bool leaves_difference(const SurfacePair& pair);

/// Both on one grid over the ground that both see. If they are to be registered, the one after is
/// registered to the one before on the ground that did not change, as far as the motion is
/// significant; else only their relative height is undetermined.
/// @throws FrameError if they do not overlap
RegisteredPair survey_pair(const OutlinedPair& pair, double cell_size, bool registered,
                           unsigned threads);

}  // namespace excavplan
