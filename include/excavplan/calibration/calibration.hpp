// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/machine/dig_parameters.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/soil/density_fit.hpp>
#include <excavplan/soil/soil.hpp>
#include <excavplan/soil/soil_scatter.hpp>

namespace excavplan {

/// Digs of a calibration.
struct CalibrationOptions {
  std::vector<double> densities_percent = {};  ///< empty: 0, 5 .. 100, as the paper does
  /// Of every dig, for a law of digs along it. Nothing: the paper's, its lengths times dig_size(),
  /// for a law that is used where the path is not known: the digs in drawn soils are then along
  /// drawn paths, angle from 0.5 to 1.1 rad, penetration from 0.2 to 0.6 m, drag from 0.8 to 2.5 m,
  /// even, times dig_size(); ours, digs of a third of a bucket to two buckets.
  std::optional<DigParameters> path = {};
  std::optional<double> cell_size = {};           ///< nothing: usual_cell() [m]
  SimulatorKind simulator = default_simulator();  ///< that digs
  /// Digs in drawn soils of all densities, in cells of usual_cell(), for the scatter of the law; 0:
  /// none.
  int draws = 200;
  SoilScatter scatter = {};  ///< of the drawn soils
  unsigned threads = 0;      ///< 0: one per core; the result is the same for any number
};

/// The machine without body and torque limits. Volumes do not depend on what it can hold: no soil
/// is too hard to calibrate for.
Machine that_never_stalls(Machine machine);

/// Digs the simulator at every density, measures the bulking factor from its height maps as the
/// paper does (section 3.1), and fits the forms of a law to it: once as measured, once corrected
/// for the soil that fell back into the cut. The as-measured closed form is the one to use with
/// scans, which cannot see what lies under fallen soil. The scatter of each form is the rms error
/// of the densities that it gives for the digs in drawn soils.
///
/// @throws Error (bad_input) if the path cannot be driven, fewer than 4 densities are given or the
///         number of draws is below 0
DensityCalibration calibrate_density(const Machine& machine, const SoilKind& soil,
                                     const CalibrationOptions& options = {});

/// The law of the built-in simulator for digs along one path, from 11 digs at 0, 10 .. 100 % and
/// 100 for its scatter.
/// @throws Error (bad_input) if the path cannot be driven
DensityCalibration calibrate_path(const Machine& machine, const SoilKind& soil,
                                  const DigParameters& path, unsigned threads = 0);

/// The law for digs in a kind of soil: of `known` that of the very same soil, else one that is
/// calibrated for the machine. @throws Error (bad_input) as calibrate_density()
DensityLaw usual_law(const Machine& machine, const SoilKind& soil,
                     const std::vector<SoilLaw>& known);

/// Fits the forms of a law to measured digs of known density; the closed form is the one to use.
/// @throws Error (bad_input) as fit_density_forms()
DensityCalibration calibrate_density(const std::vector<BulkingSample>& samples);

/// Difference between the bulking factor of the height maps and the true one.
///
/// Soil that fell back lies in the hole: it is missing from both volumes, and k_measured =
/// (k - f) / (1 - f) with f the fallback fraction (docs/methods.md#density-law).
struct BulkingDifference {
  DensityCalibration::Sample largest;  ///< the sample with the largest difference
  double density_points = 0.0;         ///< error of its density if k were used as the true one [%]
  double unexplained = 0.0;  ///< largest |k - k_true| once corrected for fallback, any sample
};

/// Nothing if the true factor of some sample is not known, as in measured samples.
std::optional<BulkingDifference> bulking_difference(const DensityCalibration& calibration);

}  // namespace excavplan
