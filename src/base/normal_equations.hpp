// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <Eigen/Core>

/// @file
/// Linear least squares by normal equations, which take no more memory for more rows. The
/// decompositions are compiled once, for 2, 3, 6 and a dynamic number of terms. Private to the
/// project.

namespace excavplan {

template <int terms>
class NormalEquations {
 public:
  using Vector = Eigen::Matrix<double, terms, 1>;
  using Matrix = Eigen::Matrix<double, terms, terms>;

  /// @param count  of terms, where it is dynamic
  explicit NormalEquations(Eigen::Index count = terms)
      : matrix_(Matrix::Zero(count, count)), right_(Vector::Zero(count)) {}
  /// Those that are summed up elsewhere; their squares are not known, 0.
  NormalEquations(Matrix matrix, Vector right)
      : matrix_(std::move(matrix)), right_(std::move(right)) {}

  /// Takes in that the terms times the unknowns are `value`.
  void add(const Vector& row, double value, double weight = 1.0) {
    matrix_ += weight * row * row.transpose();
    right_ += weight * value * row;
    squares_ += weight * value * value;
  }

  const Matrix& matrix() const { return matrix_; }
  const Vector& right() const { return right_; }
  double squares() const { return squares_; }  ///< weighted, of the values

  /// The unknowns.
  Vector solution() const;
  /// Weighted squares of what the solution leaves of the values; rounding may take them below 0.
  double squares_about(const Vector& solution) const { return squares_ - solution.dot(right_); }
  /// Of the unknowns, for values of variance 1.
  Matrix covariance() const;
  /// Variance of one of them.
  double variance(Eigen::Index unknown) const;
  /// Of the matrix, an estimate: 0 where the rows do not tell the unknowns apart.
  double reciprocal_condition() const;

 private:
  Matrix matrix_;
  Vector right_;
  double squares_ = 0.0;
};

extern template class NormalEquations<2>;
extern template class NormalEquations<3>;
extern template class NormalEquations<6>;
extern template class NormalEquations<Eigen::Dynamic>;

/// v' C^-1 v, for instance the squared length of a vector in standard deviations.
double squared_by(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& v);

}  // namespace excavplan
