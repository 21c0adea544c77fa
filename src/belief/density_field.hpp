// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <excavplan/belief/belief_settings.hpp>
#include <excavplan/belief/dig_evidence.hpp>

/// @file
/// Prior covariance of mean densities of parts of the ground. Private to the project.

namespace excavplan {

/// A part of the ground, as places in columns, with weights of sum 1.
struct FieldPart {
  struct Place {
    GroundPlace at;
    double weight = 0.0;
  };
  std::vector<Place> places;  ///< those of one column follow each other
  double depth = 0.0;         ///< mean of them
};

/// Of a bank that was condensed().
FieldPart field_part(const std::vector<BankPart>& bank);

/// Points of the ground for many covariances.
struct FieldPoints {
  explicit FieldPoints(const std::vector<GroundPlace>& places);

  Eigen::ArrayXd x;
  Eigen::ArrayXd y;
  std::vector<double> depths;      ///< each once
  std::vector<std::size_t> layer;  ///< of each point, in depths
};

/// The places of many parts for covariances with all of them.
class FieldParts {
 public:
  void add(FieldPart part);
  Eigen::Index size() const { return static_cast<Eigen::Index>(parts_.size()); }
  const std::vector<FieldPart>& all() const { return parts_; }

 private:
  friend class DensityField;
  std::vector<FieldPart> parts_;
  std::vector<double> x_;  ///< of all places of all parts
  std::vector<double> y_;
  std::vector<double> depth_;
};

/// The Gaussian process of a belief: level, trend over depth and Matern field.
class DensityField {
 public:
  explicit DensityField(const BeliefSettings& settings);

  double variance(double depth) const;  ///< of a point
  double covariance(const FieldPart& a, const FieldPart& b) const;
  Eigen::VectorXd covariances(const FieldPart& part, const FieldParts& parts) const;
  /// With points `first` .. `first` + size of the result.
  void covariances(const FieldPart& part, const FieldPoints& points, Eigen::Index first,
                   Eigen::Ref<Eigen::ArrayXd> result) const;

 private:
  double level_variance_ = 0.0;
  double trend_variance_ = 0.0;
  double spread_variance_ = 0.0;
  double scale_ = 0.0;  ///< of distances in plan
  double depth_scale_ = 0.0;
};

}  // namespace excavplan
