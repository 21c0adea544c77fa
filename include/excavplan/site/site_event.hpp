// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/density/density_estimate.hpp>
#include <excavplan/machine/base_pose.hpp>

/// @file
/// What a site is told, and what it answers.

namespace excavplan {

/// What a plan foretold of the dig that was then driven: plan_dig(), or a result of plan-path.
struct ForetoldDig {
  double density_percent = 0.0;  ///< that it was planned for
  double joint_work = 0.0;       ///< of the joints in the dig [J]
};

/// A scan of the site, after one dig or after none.
struct SiteEvent {
  Scan scan;                   ///< of the ground now, in the site's frame
  std::optional<Scan> before;  ///< of it before the dig; not needed once the site knows its ground
  bool dug = true;             ///< false: the scan tells the ground, and no density is sought
  double time = 0.0;           ///< when it was scanned, since 1970-01-01 UTC [s]
  BasePose base;               ///< of the machine during the dig
  /// What is known of the dig: path (in the machine's frame), areas (in the site's), payload, work
  /// and more. Kind, law, cell and prior are those of the site.
  DensityOptions options;
  std::optional<ForetoldDig> foretold;  ///< by its plan
  bool stalled = false;                 ///< the dig was given up, which its plan did not foretell
};

/// What became of an event.
struct SiteUpdate {
  std::optional<DensityEstimate> estimate;  ///< of this dig, as estimate_density(); none of no dig
  std::optional<RelativeDensity> density;   ///< that the site believes in where it dug
  long long digs = 0;                       ///< of the site that taught it a density
  bool taken = false;                       ///< the site is changed; else it is as before
  /// Of the estimate, and scan_not_taken (ends trust), undug_change.
  std::vector<Warning> warnings;
  std::optional<Alignment> alignment;  ///< of the scan to the ground; none of the first
  /// Takes its points onto the ground; identity of the first [m].
  Eigen::Matrix4d correction = Eigen::Matrix4d::Identity();
  bool trustworthy = true;  ///< false after a warning that ends trust
};

}  // namespace excavplan
