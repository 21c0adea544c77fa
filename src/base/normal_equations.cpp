// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/normal_equations.hpp"

#include <Eigen/Cholesky>

namespace excavplan {

template <int terms>
typename NormalEquations<terms>::Vector NormalEquations<terms>::solution() const {
  return matrix_.ldlt().solve(right_);
}

template <int terms>
typename NormalEquations<terms>::Matrix NormalEquations<terms>::covariance() const {
  return matrix_.ldlt().solve(Matrix::Identity(matrix_.rows(), matrix_.cols()));
}

template <int terms>
double NormalEquations<terms>::variance(Eigen::Index unknown) const {
  const Vector column = matrix_.ldlt().solve(Vector::Unit(matrix_.rows(), unknown));
  return column(unknown);
}

template <int terms>
double NormalEquations<terms>::reciprocal_condition() const {
  return matrix_.ldlt().rcond();
}

template class NormalEquations<2>;
template class NormalEquations<3>;
template class NormalEquations<6>;
template class NormalEquations<Eigen::Dynamic>;

double squared_by(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& v) {
  return v.dot(covariance.ldlt().solve(v));
}

}  // namespace excavplan
