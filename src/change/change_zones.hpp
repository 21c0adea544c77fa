// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/change/change_options.hpp>

namespace excavplan {

/// Where two surveys of one area differ by more than their noise, and that noise.
struct ChangedGround {
  Eigen::ArrayXXd difference;     ///< after - before, less the datum, holes filled; NaN outside [m]
  Eigen::ArrayXXd residual;       ///< of stable cells, within 4 sd; NaN elsewhere [m]
  Eigen::ArrayXXi zone;           ///< -1 for stable ground
  std::vector<bool> zone_is_cut;  ///< the zone reaches the edge of what was surveyed
  std::vector<bool> zone_is_layer;  ///< strewn soil, too thin to be found cell by cell
  double noise_sd = 0.0;            ///< of one stable cell [m]
  double smooth_sd = 0.0;           ///< of the mean of 3 x 3 of them [m]
  double datum = 0.0;               ///< [m]
  double stable_share = 0.0;        ///< of the known cells [-]
};

/// @param difference after - before [m], NaN where unknown, at least 100 known cells
/// @param variance of each cell of it by the scatter of its points, NaN where unknown [m^2]
/// @param cell_size edge of a cell [m]
ChangedGround find_change(Eigen::ArrayXXd difference, const Eigen::ArrayXXd& variance,
                          double cell_size, const ChangeOptions& options);

/// By how far zones are widened [m]: an edge below the threshold of soil at 27 degrees or steeper;
/// at least one cell.
double zone_margin(const ChangeOptions& options, double cell_size, double smooth_sd);

/// The zones within `distance_cells` of the chosen ones, which count as near themselves.
std::vector<bool> zones_near(const Eigen::ArrayXXi& zone, const std::vector<bool>& chosen,
                             double distance_cells);

}  // namespace excavplan
