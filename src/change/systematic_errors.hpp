// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "change/change_zones.hpp"

/// @file
/// Errors that all points of a scan line or of a lens share. Private to the project.

namespace excavplan {

/// Errors that all points of a scan line share run in stripes over the ground, through the zones
/// as well. They are found on stable ground as the direction in which means over strips of one
/// cell's width differ more than in most others, and subtracted, each by its best linear
/// prediction. Two scans may have two directions.
///
/// @return what is left of them: variance of the sum of the cells of each zone [m^2]; 0 without
std::vector<double> take_stripes_off(ChangedGround& ground);

/// Surfaces from lenses or mirrors that are not calibrated well are bent as a dome or a bowl (James
/// and Robson 2014, Earth Surf. Process. Landforms 39:1413). A quadratic surface through the
/// residuals of the stable ground is subtracted, in the zones as well, where it explains nearly all
/// by which patches of that ground differ.
///
/// @return what is left of it: covariance of the sums of the cells of the zones [m^2]; 0 without
Eigen::MatrixXd take_doming_off(ChangedGround& ground, double cell_size);

/// Errors that run through stable ground and zones alike.
struct Systematic {
  Eigen::MatrixXd left;  // covariance of the sums of the cells of the zones [m^2]
  double rms = 0.0;      // of what was taken off stable ground [m]
};

/// Takes both off: stripes from what a dome leaves.
Systematic take_systematic_off(ChangedGround& ground, double cell_size);

}  // namespace excavplan
