// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/experiments/experiment_options.hpp>

/// @file
/// The paper's simulation experiment (section 3): a fixed path against the path planned for the
/// density that the first dig shows.

namespace excavplan {

/// One soil, dug along both paths.
struct ExperimentResult {
  double density_percent = 0.0;  ///< the true one
  HeightMapVolumes volumes;      ///< of the dig along the fixed path, if it is surveyed
  RelativeDensity estimate;      ///< from that bulking factor, or by the survey
  PlannedDig fixed;              ///< begins with the largest margin
  PlannedDig planned;            ///< for the estimate, dug in the true soil
  DigPath fixed_path;            ///< of `fixed`
  DigPath planned_path;          ///< of `planned`
  StartRule start_rule;          ///< that puts the start of the planned dig nearest to where it is
  /// The fixed path, its start by that rule; nothing if it stalls there.
  std::optional<PlannedDig> fixed_moved;
  DigObjective objective;  ///< that the dig was planned for
  /// Why the fixed path would lift or drag the machine: then it is held down in all digs here, as
  /// if only its joints could stall. Empty if it need not be.
  std::string held_because;

  /// Of the planned over the fixed dig in worth, by default the efficiency [%]. Its parts, of the
  /// path and of the start: (1 + gain / 100) = (1 + path_gain / 100) (1 + start_gain / 100).
  /// @throws Error (bad_input) if the dig compared with is worth nothing, as in no result of ours
  double gain_percent() const;
  /// The same by another objective: what a dig planned for one is worth by the other.
  double gain_percent(const DigObjective& by) const;
  /// Of the planned path over the fixed one, both begun by start_rule [%]; NaN if that one stalls.
  double path_gain_percent() const;
  /// Of the fixed path begun by start_rule over its own start [%]; NaN if it stalls.
  double start_gain_percent() const;
};

/// Digs once along the fixed path in soil of this density, estimates the density from the bulking
/// factor of the height maps, plans a path for the estimate and digs along it in the true soil.
///
/// @throws Error (bad_input) if the density is outside 0 .. 100, the fixed path cannot be dug, or
/// no dig is feasible at the estimate
/// @throws Error as plan_dig()
ExperimentResult run_experiment(const Machine& machine, const SoilKind& soil, const DensityLaw& law,
                                double density_percent, const ExperimentOptions& options = {});

/// The dig along the fixed path that run_experiment() begins with.
/// @throws Error (bad_input) as run_experiment()
DigScene first_dig(const Machine& machine, const SoilKind& soil, double density_percent,
                   const ExperimentOptions& options = {});

}  // namespace excavplan
