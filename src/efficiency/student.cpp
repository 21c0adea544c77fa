// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "efficiency/student.hpp"

#include <cmath>

namespace excavplan {
namespace {

/// By the method of Lentz; converges fast for x < (a + 1) / (a + b + 2).
double continued_fraction(double x, double a, double b) {
  constexpr int most_terms = 10000;
  constexpr double tiny = 1e-300;
  constexpr double exact = 1e-15;
  const auto kept_off_zero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1.0;
  double d = 1.0 / kept_off_zero(1.0 - (a + b) * x / (a + 1.0));
  double value = d;
  for (int m = 1; m <= most_terms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    d = 1.0 / kept_off_zero(1.0 + even * d);
    c = kept_off_zero(1.0 + even / c);
    value *= c * d;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    d = 1.0 / kept_off_zero(1.0 + odd * d);
    c = kept_off_zero(1.0 + odd / c);
    value *= c * d;
    if (std::abs(c * d - 1.0) < exact) break;
  }
  return value;
}

}  // namespace

double incomplete_beta(double x, double a, double b) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * continued_fraction(x, a, b) / a;
  return 1.0 - front * continued_fraction(1.0 - x, b, a) / b;
}

double student_two_sided(double t, double degrees_of_freedom) {
  const double n = degrees_of_freedom;
  return incomplete_beta(n / (n + t * t), 0.5 * n, 0.5);
}

double student_quantile(double confidence, double degrees_of_freedom) {
  double low = 0.0;
  double high = 1.0;
  while (student_two_sided(high, degrees_of_freedom) > 1.0 - confidence) high *= 2.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (student_two_sided(middle, degrees_of_freedom) > 1.0 - confidence ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace excavplan
