// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/belief/belief_settings.hpp>
#include <excavplan/belief/dig_evidence.hpp>

/// @file
/// Spread and lengths of a field by the readings of digs. Private to the project.

namespace excavplan {

/// The settings with the spread and the lengths of the largest posterior probability density.
/// @param digs  their banks condensed()
BeliefSettings refitted(const BeliefSettings& settings, const std::vector<DigEvidence>& digs);

}  // namespace excavplan
