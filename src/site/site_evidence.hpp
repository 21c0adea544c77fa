// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/belief/dig_evidence.hpp>
#include <excavplan/ground/ground_state.hpp>
#include <excavplan/site/site_event.hpp>

/// @file
/// What a dig on a site says of the density, as the belief takes it.

namespace excavplan {

/// The ground about a dig, on one grid.
struct GroundAtDig {
  const GroundState& first;   ///< when it was first seen, on a smaller grid
  const GroundState& before;  ///< the dig, likewise
  const GroundState& after;   ///< the dig
};

/// Undisturbed soil that was cut: cell by cell, where the bank became lower by more than a scan
/// errs.
std::vector<BankPart> bank_cut(const GroundAtDig& ground);

/// The scans of a dig: those of one number are one scan.
struct ScanNumbers {
  int before = 0;
  int after = 0;
};

/// Of one dig. Densities of an estimate that is not to be trusted are left out.
DigEvidence evidence_of(const SiteEvent& event, const DensityEstimate& estimate,
                        const std::vector<BankPart>& bank, ScanNumbers scans);

/// Undisturbed soil in an area down to a depth, in the site's frame.
/// @param area  in the machine's frame
std::vector<BankPart> bank_below(const GroundState& first, const GroundState& ground,
                                 const BasePose& base, const Rectangle& area, double depth);

}  // namespace excavplan
