// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// Student's t distribution. Private to the project.

namespace excavplan {

/// Regularised incomplete beta function I_x(a, b), by its continued fraction (DLMF 8.17.22).
double incomplete_beta(double x, double a, double b);

/// Probability of a |t| of at least this with so many degrees of freedom, which need not be whole.
double student_two_sided(double t, double degrees_of_freedom);
/// The t above which half of 1 - `confidence` lies; `confidence` in 0 .. 1.
double student_quantile(double confidence, double degrees_of_freedom);

}  // namespace excavplan
