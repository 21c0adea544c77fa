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
/// with its deviation by noise, correlated errors and the motion that may be left
/// (VolumeChange::outside), and counts as spill what of it is expected to be soil. The sum is that
/// above the mean of the stable ground farther away, so that no offset between the scans counts.
///
/// What to expect: in 0.3 of digs there is such soil, normal with a deviation of 2 % of what rose;
/// else there is none. The posterior mean is counted, the posterior variance is in the covariance
/// (errors.thin). Both numbers are ours.
void add_strewn_soil(const std::vector<Area>& areas, VolumeChange& change);

}  // namespace excavplan
