// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "change/change_zones.hpp"

/// @file Private to the project.

namespace excavplan {

/// Surfaces from lenses or mirrors that are not calibrated well are bent as a dome or a bowl (James
/// and Robson 2014, Earth Surf. Process. Landforms 39:1413). A quadratic surface through the
/// residuals of the stable ground is subtracted, in the zones as well, where it explains nearly all
/// by which patches of that ground differ.
///
/// @return what is left of it: covariance of the sums of the cells of the zones [m^2]; 0 without
Eigen::MatrixXd take_doming_off(ChangedGround& ground, double cell_size);

}  // namespace excavplan
