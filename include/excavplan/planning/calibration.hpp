// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// Where dug soil goes unless said otherwise: beside the dig, clear of its windrows, within the
/// swing of a machine that does not move (x, y) [m]; ours.
Eigen::Vector2d default_dump_point();

/// Ground that holds the digs of a machine and a heap at `dump_at`.
Rectangle scene_extent(const Machine& machine, const Eigen::Vector2d& dump_at);

struct CalibrationOptions {
  std::vector<double> densities_percent;  ///< empty: 0, 5 .. 100, as the paper does
  DigParameters path = paper_fixed_path();
  double cell = 0.05;  ///< [m]
};

/// Digs the built-in simulator at every density, measures the bulking factor from its height maps
/// as the paper does (section 3.1), and fits line and closed form to it: once as measured, once
/// freed of the soil that fell back into the cut. The as-measured closed form is the one to use
/// with scans, which cannot see what lies under fallen soil.
///
/// @throws Error (bad_input) if the path cannot be driven, the machine stalls, or fewer than 4
/// densities are given
DensityCalibration calibrate_density(const Machine& machine, const SoilKind& soil,
                                     const CalibrationOptions& options = {});

}  // namespace excavplan
