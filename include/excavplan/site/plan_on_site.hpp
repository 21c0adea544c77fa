// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/site/site.hpp>

/// @file
/// The next dig on ground that is remembered (docs/guide/site.md).

namespace excavplan {

/// What a plan on a site needs beside the site.
struct SitePlanOptions {
  BasePose base;     ///< where the machine stands
  PlanOptions plan;  ///< as of plan_dig()
  /// That the dig is for as long as no dig told the site one; nothing: that of the site, whose
  /// belief is then wide and not trustworthy.
  std::optional<GroundDensity> density = {};
  /// planning_extent() as a scan shows it now, in the machine's frame: what stands on it is kept
  /// clear of. On the cells of the plan.
  std::optional<Terrain> present = {};
};

/// The next dig on a site.
struct SitePlan {
  DigPlan plan;                ///< in the machine's frame
  GroundDensity density{0.0};  ///< that it is for
  Terrain ground;              ///< that it is on, in the machine's frame
};

/// plan_dig() for machine and soil of the site, on its ground seen from the machine, for the
/// density that it believes in where the bucket reaches; planned once more if that where the plan
/// digs is another by more than a point (ours).
/// @throws Error as plan_dig(), Site::ground_for() and Site::density_at(); (bad_input) if `present`
/// has other cells
SitePlan plan_on_site(const Site& site, const SitePlanOptions& options);

}  // namespace excavplan
