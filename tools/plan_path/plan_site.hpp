// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/plan_dig.hpp>

#include "inputs/site_folder.hpp"

/// @file
/// A site that is remembered, as a plan needs it.

namespace excavplan::tools {

/// What a site knows of the ground about a machine.
class SiteToPlanOn {
 public:
  /// @throws Error as excavplan::Site() and base_of()
  SiteToPlanOn(const SiteFolderInputs& inputs, const Machine& machine, const SoilKind& soil);

  bool has_density() const { return site_.digs() > 0; }
  /// In the machine's frame.
  Terrain ground(const Rectangle& extent, double cell_size) const;
  /// Of the strip that the bucket can reach.
  GroundDensity density_in_reach() const;
  /// Of the strip that a dig cuts; that in reach without a dig.
  GroundDensity density_under(const DigPlan& plan) const;
  /// Adds key `site`, with the density that the dig is planned for.
  void describe(const GroundDensity& density, Outcome& outcome) const;

 private:
  const Machine& machine_;
  BasePose base_;
  excavplan::Site site_;
};

}  // namespace excavplan::tools
