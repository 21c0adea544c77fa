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
/// What to expect: in 0.3 of digs there is such soil, in 0.95 of those that left layers, normal
/// with a deviation of 1 % of what rose and 0.3 of the layers; else there is none. The posterior
/// mean is counted, the posterior variance is in the covariance, under the sources of the sum's
/// error and `thin`. Soil on ground that is taken for stable raises the datum: what hole and heap
/// lack by it is added to them in proportion. All numbers are ours.
void add_strewn_soil(const std::vector<Area>& areas, VolumeChange& change);

}  // namespace excavplan
