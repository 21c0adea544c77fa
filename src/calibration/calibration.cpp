// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/calibration/calibration.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"

namespace excavplan {
namespace {

DigParameters path_of(const Machine& machine, const CalibrationOptions& options) {
  if (options.path) return *options.path;
  DigParameters path = paper_fixed_path();
  path.penetration_length *= dig_size(machine);
  path.drag_length *= dig_size(machine);
  return path;
}

/// A dig on level ground as of a calibration.
struct CalibrationDig {
  explicit CalibrationDig(const Machine& machine, const CalibrationOptions& options)
      : ground(undisturbed(flat_ground(scene_extent(machine, scene.dump_at),
                                       options.cell_size.value_or(usual_cell(machine))))) {
    scene.path = path_of(machine, options);
    scene.simulator = options.simulator;
  }

  SceneOptions scene;
  Terrain ground;
};

/// @param machine  that never stalls
DensityCalibration::Sample measure(const Machine& machine, const SoilKind& soil, double density,
                                   const CalibrationOptions& options) {
  const CalibrationDig dig(machine, options);
  const DigScene scene = run_scene(machine, soil, density, dig.ground, dig.scene);

  DensityCalibration::Sample sample;
  sample.density_percent = density;
  sample.bulking_factor_measured = scene.volumes.bulking_factor;
  sample.fallback_fraction = scene.dig.soil.fallback_fraction;
  sample.bulking_factor =
      free_of_fallback(sample.bulking_factor_measured, sample.fallback_fraction);
  sample.bulking_factor_true = scene.bulking_factor_true;
  return sample;
}

/// Paths that fill the box evenly whatever their number (the additive recurrence of Roberts 2018
/// with the powers of 1 / 1.22074, the root of x^4 = x + 1).
DigParameters drawn_path(std::size_t index, double size) {
  const auto in = [&](double low, double high, double step) {
    const double turns = 0.5 + static_cast<double>(index) * step;
    return low + (high - low) * (turns - std::floor(turns));
  };
  return {in(0.5, 1.1, 0.8191725134), size * in(0.2, 0.6, 0.6710436067),
          size * in(0.8, 2.5, 0.5497004779)};
}

/// A dig of a density even over the range, in drawn soil and along a drawn path.
DensityCalibration::Sample measure_draw(const Machine& machine, const SoilKind& soil,
                                        std::size_t draw, CalibrationOptions options) {
  constexpr std::size_t most_paths = 100;
  const auto draws = static_cast<std::size_t>(options.draws);
  const double density = 100.0 * (static_cast<double>(draw) + 0.5) / options.draws;
  const SoilKind drawn = drawn_soil(soil, options.scatter, Random(draw, 1).bits());
  const bool any_path = !options.path;
  options.cell_size = usual_cell(machine);
  const auto can_be_dug = [&] {
    const CalibrationDig dig(machine, options);
    try {
      scene_path(machine, drawn, dig.ground, dig.scene);
    } catch (const Error&) {
      return false;
    }
    return true;
  };
  for (std::size_t i = 0; any_path && i < most_paths; ++i) {
    options.path = drawn_path(draw + i * draws, dig_size(machine));
    if (can_be_dug()) break;
  }
  return measure(machine, drawn, density, options);
}

std::vector<BulkingSample> pairs(const std::vector<DensityCalibration::Sample>& samples,
                                 double DensityCalibration::Sample::*factor) {
  std::vector<BulkingSample> pairs;
  pairs.reserve(samples.size());
  for (const auto& sample : samples) pairs.push_back({sample.*factor, sample.density_percent});
  return pairs;
}

/// All but forms and samples.
DensityCalibration origin_of(const Machine& machine, const SoilKind& soil,
                             const CalibrationOptions& options) {
  DensityCalibration calibration;
  calibration.name = machine.name + "-" + soil.name;
  calibration.source =
      "digs of the simulator " + options.simulator.name + ", " + machine.name + " in " + soil.name;
  calibration.soil = soil.name;
  calibration.machine = machine.name;
  calibration.simulator = options.simulator.name;
  const DigParameters path = path_of(machine, options);
  calibration.path = {path.penetration_angle, path.penetration_length, path.drag_length};
  calibration.any_path = !options.path && options.draws > 0;
  calibration.scatter = {options.draws, options.scatter};
  calibration.use = std::string("closed_form") + as_measured;
  return calibration;
}

}  // namespace

Machine that_never_stalls(Machine machine) {
  machine.body.reset();
  for (JointLimits& limits : machine.limits) {
    limits.torque = std::numeric_limits<double>::infinity();
  }
  return machine;
}

DensityCalibration calibrate_density(const Machine& machine, const SoilKind& soil,
                                     const CalibrationOptions& options) {
  require_machine(machine);
  require_soil(soil);
  require(options.draws >= 0 && options.draws <= most_draws, "the number of draws", options.draws,
          "in 0 .. " + std::to_string(most_draws));
  if (options.cell_size) require_simulated_cell(*options.cell_size);
  std::vector<double> densities = options.densities_percent;
  if (densities.empty()) {
    for (int i = 0; i <= 20; ++i) densities.push_back(5.0 * i);
  }
  const Machine digger = that_never_stalls(machine);
  DensityCalibration calibration = origin_of(machine, soil, options);
  calibration.samples.resize(densities.size());
  std::vector<DensityCalibration::Sample> draws(static_cast<std::size_t>(options.draws));
  parallel_for(densities.size() + draws.size(), options.threads, [&](std::size_t i) {
    if (i < densities.size()) {
      calibration.samples[i] = measure(digger, soil, densities[i], options);
    } else {
      const std::size_t draw = i - densities.size();
      draws[draw] = measure_draw(digger, soil, draw, options);
    }
  });
  using Sample = DensityCalibration::Sample;
  const auto add_forms = [&](double Sample::*factor, const std::string& ending) {
    for (DensityFit& fit : fit_density_forms(pairs(calibration.samples, factor), ending)) {
      if (!draws.empty()) set_scatter(fit.form, pairs(draws, factor));
      calibration.forms.push_back(std::move(fit));
    }
  };
  add_forms(&Sample::bulking_factor, "");
  add_forms(&Sample::bulking_factor_measured, as_measured);
  return calibration;
}

DensityCalibration calibrate_path(const Machine& machine, const SoilKind& soil,
                                  const DigParameters& path, unsigned threads) {
  CalibrationOptions options;
  for (int i = 0; i <= 10; ++i) options.densities_percent.push_back(10.0 * i);
  options.path = path;
  options.draws = 100;
  options.threads = threads;
  DensityCalibration calibration = calibrate_density(machine, soil, options);
  calibration.name += "-path";
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

DensityLaw usual_law(const Machine& machine, const SoilKind& soil,
                     const std::vector<SoilLaw>& known) {
  const auto same = std::find_if(known.begin(), known.end(), [&](const SoilLaw& each) {
    return each.soil.name == soil.name && fingerprint(each.soil) == fingerprint(soil);
  });
  return same != known.end() ? same->law : law_of(calibrate_density(machine, soil));
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
