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

/// True of the height of a point, in the frame and unit of its file, that stands for none of
/// `no_data`; the heights may have been moved and moved back.
bool is_no_data(double height, const std::vector<double>& no_data);

/// Passes on the points of a scan in the site frame, without those outside its area, of
/// the machine or without data; those that are not finite may be among them. The same on every
/// call.
/// @throws Error (bad_file)
VisitedScan visit_scan(const Scan& scan, const PointVisitor& visit);

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

}  // namespace excavplan
