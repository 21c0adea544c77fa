// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/optimisation/search.hpp>

/// @file
/// Analysis of a search beyond its best point.

namespace excavplan {

/// The name of the enumerator, for files.
const char* name(SearchRecord::Origin origin);
/// The name of the enumerator, for files.
const char* name(SearchRecord::Source source);

/// Every requested point, one line each: place, generation, origin, polish, parents (joined by
/// ';'), source, status, fitness, violation, reason, coordinates.
std::string to_csv(const SearchResult& result);

/// Values of one parameter.
struct ParameterRange {
  double low = 0.0;   ///< smallest
  double high = 0.0;  ///< largest
};

/// Uncertainty of the best point.
struct SearchInsight {
  /// Place in the history of the best point of another basin: farther from the best than the
  /// radius, and no better point within the radius around it.
  std::optional<int> second_basin;
  /// Per parameter: from the lowest to the highest value among the evaluated points that are worth
  /// the share and are linked to the best by others of the kind, no step longer than half the
  /// radius. The true range is at least that wide.
  std::vector<ParameterRange> seen;
  /// Per parameter: the range worth the share if all others follow, by a quadratic fitted to the
  /// points around the best; clipped to the box. Empty if the points are too few or lie on no hill
  /// (a cliff, steps).
  std::vector<ParameterRange> fitted;
};

/// @param share  of the best fitness; for a negative best, 1 - share of its amount below it
/// @param radius  of a basin, as a share of the box
/// @throws Error (bad_input) if share or radius are out of range, or points do not fit the box
SearchInsight explain(const SearchBox& box, const SearchResult& result, double share = 0.98,
                      double radius = 0.2);

/// An objective with noise; deterministic for a given point and repeat.
using NoisyObjective = std::function<Evaluation(const Eigen::VectorXd& point, int repeat)>;

/// A point evaluated several times.
struct RepeatedEvaluation {
  Eigen::VectorXd point;  ///< in the box
  double first = 0.0;     ///< fitness in the search; biased upwards by the selection
  double mean = 0.0;      ///< of the repeats that were ok; NaN if none was
  double sd = 0.0;        ///< of one evaluation; NaN for fewer than two
  int ok = 0;             ///< repeats that gave a fitness
  int repeats = 0;        ///< evaluations made
};

/// Evaluates the best few points of a search again, all points and repeats in parallel; best mean
/// first. Exceptions count as repeats that are not ok.
///
/// @throws Error (bad_input) if `best` or `repeats` is < 1, `repeats` is above a million, or the
///         objective is empty
std::vector<RepeatedEvaluation> evaluate_again(const SearchResult& result,
                                               const NoisyObjective& objective, int best = 5,
                                               int repeats = 8, unsigned threads = 0);

}  // namespace excavplan
