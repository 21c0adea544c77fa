// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/change/dig_volumes.hpp>

#include "change/surveyed_area.hpp"

/// @file
/// Soil that lies too thin for a zone. Private to the project.

namespace excavplan {

/// States the sum of the change over stable ground near hole, spill and heap, without a threshold,
/// with its deviation by noise, correlated errors and datum (VolumeChange::outside), and counts as
/// spill what of it is expected to be soil. The sum is that above a plane through the stable ground
/// farther away, so that no offset or tilt between the scans counts.
///
/// What to expect: in 0.3 of digs there is such soil, normal with a deviation of 1 % of what rose;
/// else there is none. The posterior mean is counted, the posterior variance is in the covariance,
/// under the sources of the sum's error and `thin`, with a tenth of the layers that were found as
/// zones, for what their edges miss. All numbers are ours.
void add_strewn_soil(const std::vector<Area>& areas, VolumeChange& change);

}  // namespace excavplan
