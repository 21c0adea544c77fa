// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ground/change_zones.hpp"

/// @file Private to the project.

namespace excavplan {

/// Surfaces from lenses or mirrors that are not calibrated well are bent as a dome or a bowl (James
/// and Robson 2014, Earth Surf. Process. Landforms 39:1413). A quadratic surface through the
/// residuals of the stable ground is subtracted, in the zones as well, where it explains nearly all
/// by which patches of that ground differ.
///
/// @return what is left of it: variance of the sum of the cells of each zone [m^2]; 0 without
std::vector<double> take_doming_off(ChangedGround& ground, double cell_size);

}  // namespace excavplan
