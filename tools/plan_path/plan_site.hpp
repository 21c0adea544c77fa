// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/site/plan_on_site.hpp>

#include "inputs/site_folder.hpp"

/// @file
/// A site that is remembered, as a plan needs it.

namespace excavplan::tools {

/// What a site knows of the ground about a machine.
class SiteToPlanOn {
 public:
  /// @throws Error as excavplan::Site() and base_of()
  SiteToPlanOn(const SiteFolderInputs& inputs, const Machine& machine, const SoilKind& soil);

  bool has_density() const { return !site_.belief().digs().empty(); }
  /// In the machine's frame.
  Terrain ground(const Rectangle& extent, double cell_size) const;
  /// @param density  that it is for as long as no dig of the site told one
  SitePlan plan(const PlanOptions& options, const std::optional<GroundDensity>& density) const;
  /// Adds key `site`, with the density that the dig is planned for.
  void describe(const GroundDensity& density, Outcome& outcome) const;

 private:
  BasePose base_;
  excavplan::Site site_;
};

}  // namespace excavplan::tools
