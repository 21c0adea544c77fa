// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

/// @file
/// Whether one set of runs is more efficient than another, as plan against operator.

namespace excavplan {

/// Efficiencies of a set of runs.
struct RunSet {
  std::size_t runs = 0;         ///< how many
  double mean = 0.0;            ///< arithmetic
  double sd = 0.0;              ///< of one run
  double geometric_mean = 0.0;  ///< which the gain is of
};

/// Welch's t-test of the means of the logarithms (Welch 1947, Biometrika 34, 28-35).
struct WelchTest {
  double t = 0.0;                   ///< statistic; infinite if no set scatters
  double degrees_of_freedom = 0.0;  ///< by Satterthwaite; NaN if no set scatters
  double p_value = 1.0;             ///< two-sided
};

/// Permutation test of the same t (Ernst 2004, Statistical Science 19, 676-685; of t, so that the
/// sets may scatter differently: Janssen 1997, Statistics & Probability Letters 36, 9-21): how
/// often a division of all runs into sets of these sizes differs as much or more.
struct PermutationTest {
  double p_value = 1.0;       ///< two-sided
  bool is_exact = true;       ///< all divisions; else that many random ones
  std::size_t divisions = 0;  ///< looked at
};

/// Two sets compared.
struct SetComparison {
  RunSet first;                    ///< the set that the other is compared with
  RunSet second;                   ///< the set whose gain it is
  double gain_percent = 0.0;       ///< of the second over the first, of geometric means
  double gain_low_percent = 0.0;   ///< of its 95 % interval, by Welch's t
  double gain_high_percent = 0.0;  ///< likewise
  WelchTest welch;                 ///< of the logarithms
  PermutationTest permutation;     ///< of the logarithms
  /// Below 10 runs in a set the permutation test decides, which needs no normal scatter; ours.
  bool by_permutation = false;
  /// Of the test that decides.
  double p_value() const { return by_permutation ? permutation.p_value : welch.p_value; }
};

/// Compares the efficiencies of runs, whose ratios count. The same for the same numbers.
/// @throws Error (bad_input) unless both have 2 runs or more, all positive and finite
SetComparison compare_runs(const std::vector<double>& first, const std::vector<double>& second);

}  // namespace excavplan
