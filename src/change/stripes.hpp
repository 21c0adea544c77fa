// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "change/change_zones.hpp"

namespace excavplan {

/// Errors that all points of a scan line share run in stripes over the ground, through the zones
/// as well. They are found on stable ground as the direction in which means over strips of one
/// cell's width differ more than in most others, and subtracted, each by its best linear
/// prediction. Two scans may have two directions.
///
/// @return what is left of them: variance of the sum of the cells of each zone [m^2]; 0 without
std::vector<double> take_stripes_off(ChangedGround& ground);

}  // namespace excavplan
