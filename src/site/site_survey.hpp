// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/ground/ground_state.hpp>
#include <excavplan/site/site_event.hpp>
#include <excavplan/site/site_settings.hpp>

#include "ground/grid_cells.hpp"

/// @file
/// What a scan says of a site: its ground after, and the density of the dig.

namespace excavplan {

/// Cells of a grid that a scan has points in. @throws Error as visit_scan()
Mask returns_in(const Scan& scan, const HeightMap& grid);

/// Ground that a site did not know, undisturbed as the first scan shows it, on the site's grid.
/// @throws Error as terrain_from_scan() and unseen_ground()
GroundState first_ground(const Scan& scan, double time, const SiteSettings& settings,
                         std::vector<Warning>& warnings);

struct SurveyedEvent {
  std::optional<DensityEstimate> estimate;
  GroundState ground;                  ///< after, on a grid that covers the one before
  std::optional<Alignment> alignment;  ///< of the scan to the ground before
  Eigen::Matrix4d correction = Eigen::Matrix4d::Identity();  ///< likewise, of its points
  std::vector<Warning> warnings;  ///< of the estimate or of the scan's ground
  bool fits = true;               ///< the scan is of this ground, and not of another place or frame
};

/// @param before  ground of the site
/// @throws Error as estimate_density()
SurveyedEvent surveyed(const SiteEvent& event, const SiteSettings& settings,
                       const GroundState& before);

}  // namespace excavplan
