// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <excavplan/experiments/study.hpp>
#include <excavplan/machine/fuel_model.hpp>

/// @file
/// The paper's field experiment (section 4), simulated: a dig along the field path, surveyed by
/// depth cameras, and one along the path chosen for the density that they show
/// (docs/efficiency.md#the-field-experiment-simulated).

namespace excavplan {

/// What the paper measured in its soft soil (section 4.3, Table 6), by its unit.
struct FieldFigures {
  double fixed = 0.166;        ///< efficiency of the fixed path [m^3/mL]
  double planned = 0.212;      ///< of the planned one [m^3/mL]
  double gain_percent = 27.7;  ///< of the planned over the fixed one [%]
};

/// A dig with the fuel of its duration.
struct FuelledDig {
  PlannedDig dig;          ///< penetrate, drag and scoop
  double idle_fuel = 0.0;  ///< what idling takes in that time [mL]
  double work_fuel = 0.0;  ///< what the joints take beyond that [mL]

  double fuel() const { return idle_fuel + work_fuel; }  ///< [mL]
  /// The paper's efficiency in the field: loose volume in the bucket per fuel [m^3/mL].
  double efficiency() const { return dig.payload_volume / fuel(); }
};

/// By the mean power of the dig.
FuelledDig fuelled(const PlannedDig& dig, const FuelModel& fuel);

/// One repetition, with a soil of the kind and scans of its own.
struct FieldRun {
  double bulking_factor = 0.0;  ///< as the scans give it [-]
  double density_raw = 0.0;     ///< by the law, also outside 0 .. 100 [%]
  RelativeDensity estimate;     ///< planned for; the paper digs again only where it is trusted
  FuelledDig fixed;             ///< along the fixed path
  FuelledDig planned;           ///< along the path planned for the estimate
  FuelledDig equal;             ///< along the one planned for no less payload than the fixed dig's
  bool held_down = false;       ///< the fixed path would lift or drag the machine
  double energy_gain = 0.0;     ///< of the planned dig by the objective, mass per energy [%]
  double equal_energy_gain = 0.0;  ///< of the one at no less payload [%]
  /// Its part that is the path's: both digs begun by one rule [%].
  double equal_path_gain = 0.0;
  std::vector<Warning> warnings = {};  ///< of the estimate
  std::string failure = {};            ///< why there is no result; empty if there is
};

/// Efficiency of the planned over the fixed dig in volume per fuel [%].
double fuel_gain_percent(const FuelledDig& planned, const FuelledDig& fixed);

/// All runs in one soil. Means are over those with a result whose fixed path does not lift or drag
/// the machine.
struct FieldResult {
  double density_percent = 0.0;       ///< true one
  std::vector<FieldRun> runs;         ///< in order
  int failed = 0;                     ///< runs without a result
  int held_down = 0;                  ///< runs that tell no gain
  int trusted = 0;                    ///< runs whose estimate is trustworthy
  StudyMean energy_gain = {};         ///< FieldRun::energy_gain [%]
  StudyMean equal_energy_gain = {};   ///< FieldRun::equal_energy_gain [%]
  StudyMean equal_path_gain = {};     ///< FieldRun::equal_path_gain [%]
  StudyMean gain = {};                ///< of the planned path, fuel_gain_percent() [%]
  StudyMean volume_ratio = {};        ///< its volume in the bucket over that of the fixed path [-]
  StudyMean equal_gain = {};          ///< the same at no less payload [%]
  StudyMean equal_volume_ratio = {};  ///< [-]
};

/// Settings of run_field_experiment().
struct FieldOptions {
  ExperimentOptions experiment;  ///< plan and second ground; the fixed path is the paper's
  FuelModel fuel;                ///< of the engine
  int digs = 10;                 ///< repetitions in each soil, >= 1
  std::uint64_t seed = 1;        ///< of soils, blocks and scans
  unsigned threads = 0;          ///< 0: one per core; the result is the same for any number
  /// Called from any thread after each repetition with the share that is done; true goes on.
  std::function<bool(double done)> progress = {};

  FieldOptions() { experiment.fixed_path = paper_field_path(); }
};

/// Digs in soils of these densities as section 4 of the paper does. Soil of 80 % and more falls as
/// blocks with voids between (BlockSettings), as the paper's hard soil did. Each second dig is on
/// fresh level ground of the same soil, the paper's adjacent area. Empty if `progress` ends it.
///
/// @throws Error (bad_input) if an option is out of range; what one repetition cannot do is in its
/// `failure`
std::vector<FieldResult> run_field_experiment(const Machine& machine, const SoilKind& soil,
                                              const DensityLaw& law,
                                              const std::vector<double>& densities_percent,
                                              const FieldOptions& options);

}  // namespace excavplan
