// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/calibration.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <excavplan/ground/bulking.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/scene.hpp>

namespace excavplan {
namespace {

/// Volumes do not depend on what the machine can hold: no soil is too hard to calibrate for.
Machine that_never_stalls(Machine machine) {
  machine.body.reset();
  for (JointLimits& limits : machine.limits) {
    limits.torque = std::numeric_limits<double>::infinity();
  }
  return machine;
}

DensityCalibration::Sample measure(const Machine& machine, const SoilKind& soil, double density,
                                   const CalibrationOptions& options) {
  SceneOptions dig;
  dig.path = options.path;
  dig.simulator = options.simulator;
  const Terrain ground =
      undisturbed(flat_ground(scene_extent(machine, dig.dump_at), options.cell_size));
  const DigScene scene = run_scene(that_never_stalls(machine), soil, density, ground, dig);

  DensityCalibration::Sample sample;
  sample.density_percent = density;
  sample.bulking_factor_measured = scene.volumes.bulking_factor;
  sample.fallback_fraction = scene.dig.soil.fallback_fraction;
  sample.bulking_factor =
      free_of_fallback(sample.bulking_factor_measured, sample.fallback_fraction);
  sample.bulking_factor_true = scene.bulking_factor_true;
  return sample;
}

std::vector<BulkingSample> pairs(const std::vector<DensityCalibration::Sample>& samples,
                                 double DensityCalibration::Sample::*factor) {
  std::vector<BulkingSample> pairs;
  pairs.reserve(samples.size());
  for (const auto& sample : samples) pairs.push_back({sample.*factor, sample.density_percent});
  return pairs;
}

}  // namespace

DensityCalibration calibrate_density(const Machine& machine, const SoilKind& soil,
                                     const CalibrationOptions& options) {
  DensityCalibration calibration;
  std::vector<double> densities = options.densities_percent;
  if (densities.empty()) {
    for (int i = 0; i <= 20; ++i) densities.push_back(5.0 * i);
  }
  for (const double density : densities) {
    calibration.samples.push_back(measure(machine, soil, density, options));
  }
  using Sample = DensityCalibration::Sample;
  const auto freed = pairs(calibration.samples, &Sample::bulking_factor);
  const auto measured = pairs(calibration.samples, &Sample::bulking_factor_measured);
  calibration.name = machine.name + "-" + soil.name;
  calibration.source =
      "digs of the simulator " + options.simulator.name + ", " + machine.name + " in " + soil.name;
  calibration.soil = soil.name;
  calibration.use = std::string("closed_form") + as_measured;
  calibration.forms = fit_density_forms(freed);
  for (DensityFit& fit : fit_density_forms(measured, as_measured)) {
    calibration.forms.push_back(std::move(fit));
  }
  return calibration;
}

DensityCalibration calibrate_density(const std::vector<BulkingSample>& samples) {
  DensityCalibration calibration;
  calibration.name = "samples";
  calibration.source = std::to_string(samples.size()) + " measured samples";
  calibration.use = "closed_form";
  calibration.forms = fit_density_forms(samples);
  for (const BulkingSample& measured : samples) {
    DensityCalibration::Sample sample;
    sample.density_percent = measured.density_percent;
    sample.bulking_factor = measured.bulking_factor;
    calibration.samples.push_back(sample);
  }
  return calibration;
}

std::optional<BulkingDifference> bulking_difference(const DensityCalibration& calibration) {
  using Sample = DensityCalibration::Sample;
  const auto& samples = calibration.samples;
  const auto known = [](const Sample& s) {
    return s.bulking_factor_true > 0.0 && s.bulking_factor_measured > 0.0;
  };
  if (samples.empty() || !std::all_of(samples.begin(), samples.end(), known)) return std::nullopt;
  const auto apart = [](const Sample& s) {
    return std::abs(s.bulking_factor_measured - s.bulking_factor_true);
  };
  BulkingDifference difference;
  difference.largest =
      *std::max_element(samples.begin(), samples.end(),
                        [&](const Sample& a, const Sample& b) { return apart(a) < apart(b); });
  const DensityForm& law = calibration.form("closed_form");
  const auto density = [&](double k) { return density_of_bulking(law, k); };
  difference.density_points = density(difference.largest.bulking_factor_measured) -
                              density(difference.largest.bulking_factor_true);
  for (const Sample& s : samples) {
    difference.unexplained =
        std::max(difference.unexplained, std::abs(s.bulking_factor - s.bulking_factor_true));
  }
  return difference;
}

}  // namespace excavplan
