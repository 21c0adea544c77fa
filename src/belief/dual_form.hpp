// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/belief/belief_settings.hpp>
#include <excavplan/belief/believed_density.hpp>
#include <excavplan/belief/dig_evidence.hpp>

#include "belief/density_field.hpp"

/// @file
/// A belief by its readings alone: the Cholesky factor of their covariance and what follows from
/// it, grown row by row (docs/methods.md#belief). Private to the project.

namespace excavplan {

/// Law's error, payload's error, ln(factor on the strength).
using StateVector = Eigen::Vector3d;

/// A reading that is linear in the density of its dig's bank and in the common states:
/// value = density_gain * d + states . (b, c, s) + error.
struct LinearReading {
  double value = 0.0;
  double density_gain = 1.0;
  StateVector states = StateVector::Zero();
  double variance = 0.0;              ///< of the error but that of the scans
  std::vector<ScanError> scans = {};  ///< the effects in the unit of the value
};

class DualForm {
 public:
  explicit DualForm(const BeliefSettings& settings);

  /// The readings of one dig. @param bank  condensed()
  void add(const DigEvidence& dig);

  /// Means and, if asked, deviations at points.
  BelievedDensity at(const FieldPoints& points) const;
  BelievedMeans means_of(const std::vector<FieldPart>& parts) const;
  CommonStates common_states() const;
  bool is_empty() const { return rows_.empty(); }
  std::vector<double> innovations() const;
  double log_likelihood() const;

 private:
  struct Row {
    LinearReading reading;
    Eigen::Index dig = 0;
    bool is_limit = false;
  };
  /// A reading of the last dig before it is learnt.
  struct Foretold {
    Eigen::VectorXd factor;  ///< its row of the Cholesky factor
    double mean = 0.0;
    double variance = 0.0;  ///< without its own error
  };
  Foretold foretold(const LinearReading& reading) const;
  void append(const LinearReading& reading, bool is_limit = false);
  void append(const LimitReading& limit);
  void extend_triangle(Eigen::VectorXd row);
  void reserve(Eigen::Index rows, Eigen::Index digs);

  BeliefSettings settings_;
  DensityField field_;
  StateVector state_variances_;
  FieldParts parts_;  ///< of the digs with readings
  std::vector<Row> rows_;
  std::vector<Eigen::Index> first_rows_;  ///< of each of these digs
  Eigen::MatrixXd part_covariance_;  ///< prior, of the digs, upper; with room to grow, as all below
  Eigen::MatrixXd factor_;           ///< L, lower: L L^T is the covariance of the readings
  Eigen::MatrixXd gains_;            ///< V = L^-1 G, rows x digs
  Eigen::MatrixXd triangle_;         ///< T, lower, digs x digs: T^T T = V^T V
  Eigen::MatrixXd state_gains_ = Eigen::MatrixXd(0, 3);  ///< U = L^-1 H, rows x states
  Eigen::VectorXd innovations_;                          ///< L^-1 (values - prior means)
};

}  // namespace excavplan
