// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/registration.hpp>
#include <excavplan/job/job_step.hpp>
#include <excavplan/planning/planned_dig.hpp>

/// @file
/// What a job learns of soil and machine from what was foretold and what came. Private to the
/// project.

namespace excavplan {

/// A number that is learnt from readings with errors, by the scalar Kalman filter.
struct LearntNumber {
  double mean = 0.0;
  double variance = 0.0;

  void learn(double reading, double reading_variance);
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

/// Learnt from step to step; deviations before any are ours.
struct JobLearning {
  ScanDatum datum;
  LearntNumber height_bias = {0.0, 0.015 * 0.015};  ///< of the edge over where it should be [m]
  LearntNumber floor = {-0.009, 0.006 * 0.006};  ///< of what passes leave over where they aim [m]
  LearntNumber payload = {0.0, 0.06 * 0.06};     ///< ln(payload by the scale / simulated)
  LearntNumber energy = {0.0, 0.25 * 0.25};      ///< ln(energy of the dig / simulated)
  double payload_scatter = 0.05 * 0.05;          ///< variance from dig to dig of that logarithm
  double energy_scatter = 0.08 * 0.08;           ///< likewise
  LearntNumber strength = {0.0, 0.35 * 0.35};    ///< ln of the factor on the soil's strength

  ForetoldStep foretell(const PlannedDig& dig) const;
  /// @param strength_share  StepDig::strength_share
  void learn(const PlannedDig& dig, double strength_share, const StepReport& report);

  double strength_factor() const;  ///< that is expected
  double hard_factor() const;      ///< that a dig should not stall at
};

}  // namespace excavplan
