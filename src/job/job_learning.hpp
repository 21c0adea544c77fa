// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/registration.hpp>
#include <excavplan/job/job_step.hpp>
#include <excavplan/planning/planned_dig.hpp>

#include "design/design_walls.hpp"

/// @file
/// What a job learns of soil and machine from what was foretold and what came. Private to the
/// project.

namespace excavplan {

/// A number that is learnt from readings with errors, by the scalar Kalman filter.
struct LearntNumber {
  double mean = 0.0;
  double variance = 0.0;

  void learn(double reading, double reading_variance);
  /// That it lies above a bound that itself has a normal error, or below (by moments of the
  /// posterior of a probit: Rasmussen and Williams, Gaussian Processes, 2006, 3.9).
  /// @param chance_of_else  that what tells it has another cause and says nothing, in 0 .. 1
  void learn_bound(double bound, bool is_above, double bound_variance, double chance_of_else = 0.0);
  double sd() const;
};

/// The ground lies where its first scan showed it. Each scan is off by itself, so that the mean of
/// all tells by how much the first one was.
struct ScanDatum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< of planes of scans over the ground
  int scans = 1;                                  ///< with the first

  void learn(const Alignment& scan);
  /// Of the ground over where scans show it in the mean: at the origin [m], its rise along x and y.
  Eigen::Vector3d plane() const { return -sum / scans; }
};

/// What a planned dig will tell.
struct DigSigns {
  double energy_share = 0.0;  ///< of ln of its energy in ln of the strength [-]
  double stalls_at = 0.0;     ///< least factor on the strength at which it stalls [-]; 0: not known
  double strength = 1.0;      ///< factor on the strength that it was simulated with [-]
  double layer = 0.0;         ///< loose soil under its drag, per thickness [kg/m]
};

/// Learnt from step to step; deviations before any are ours.
struct JobLearning {
  ScanDatum datum;
  LearntNumber height_bias = {0.0, 0.015 * 0.015};  ///< of the edge over where it should be [m]
  LearntNumber floor = {-0.009, 0.008 * 0.008};  ///< of what passes leave over where they aim [m]
  LearntNumber payload = {0.0, 0.06 * 0.06};     ///< ln(payload by the scale / simulated)
  LearntNumber energy = {0.0, 0.25 * 0.25};      ///< ln(energy of the dig / simulated)
  double payload_scatter = 0.05 * 0.05;          ///< variance from dig to dig of that logarithm
  double energy_scatter = 0.08 * 0.08;           ///< likewise
  double layer_variance =
      0.008 * 0.008;  ///< of the layer that a dig takes beyond the one foretold [m^2]
  double cycle_variance = 0.1 * 0.1;  ///< of the energy of a cycle over the one foretold
  /// ln of the factor on the soil's strength: of soil of one density, and of the density, which is
  /// told to 25 % and of which 100 % multiply the cohesion of loam or clay by e^2.2.
  LearntNumber strength = {0.0, 0.35 * 0.35 + 0.54 * 0.54};

  ForetoldStep foretell(const PlannedDig& dig, const DigSigns& signs) const;
  void learn(const PlannedDig& dig, const DigSigns& signs, const StepReport& report);
  /// To other ground.
  void move() { strength.variance += place_variance; }

  static constexpr double place_variance = 0.15 * 0.15;  ///< of strength, from place to place

  /// So many deviations above what is expected.
  double strength_factor(int deviations = 0) const;
  double hard_factor() const;  ///< that a dig should not stall at

 private:
  double beyond_planned(const DigSigns& signs) const;
  void learn_spread(const PlannedDig& dig, const DigSigns& signs, const StepReport& report);
};

/// The same soil, so many times as strong.
SoilKind with_strength(SoilKind soil, double factor);
/// Undisturbed soil of a density as told: as believed, and as strong as it surely is, a deviation
/// below that.
WallSoil wall_soil(const SoilKind& soil, double density_percent, const JobLearning& learnt = {});

}  // namespace excavplan
