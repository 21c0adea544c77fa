// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/optimisation/search_problem.hpp>

/// @file
/// Points of a search's box, as keys and as shares of it.

namespace excavplan {

/// A point that can be looked up.
using PointKey = std::vector<double>;

inline PointKey key_of(const Eigen::VectorXd& point) {
  return {point.data(), point.data() + point.size()};
}

inline Eigen::VectorXd point_of(const PointKey& key) {
  return Eigen::Map<const Eigen::VectorXd>(key.data(), static_cast<Eigen::Index>(key.size()));
}

/// A box seen as the unit cube, where all distances of the search are measured.
class UnitCube {
 public:
  explicit UnitCube(const SearchBox& box) : lower_(box.lower), range_(box.upper - box.lower) {}

  Eigen::Index dimensions() const { return lower_.size(); }
  bool is_flat(Eigen::Index i) const { return range_(i) == 0.0; }
  Eigen::VectorXd point(const Eigen::VectorXd& u) const { return lower_ + u.cwiseProduct(range_); }
  Eigen::VectorXd inside(const Eigen::VectorXd& point) const { return share(point - lower_); }
  /// A difference of two points, as a share of the box.
  Eigen::VectorXd share(const Eigen::VectorXd& difference) const {
    return difference.cwiseQuotient((range_.array() > 0.0).select(range_, 1.0));
  }
  /// Largest difference of a coordinate.
  double distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return (inside(a) - inside(b)).cwiseAbs().maxCoeff();
  }

 private:
  Eigen::VectorXd lower_;
  Eigen::VectorXd range_;
};

}  // namespace excavplan
