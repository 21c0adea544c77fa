// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace excavplan {

/// The search space: a box in n dimensions.
struct SearchBox {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

/// Fitness of one point, larger is better; nothing where the point is infeasible. NaN and infinity
/// count as infeasible. Must return the same for the same point and may be called from several
/// threads.
using Objective = std::function<std::optional<double>(const Eigen::VectorXd&)>;

/// How far a search has come.
struct SearchProgress {
  int generation = 0;
  int generations = 0;
  int evaluations = 0;
  double best = 0.0;  ///< fitness; NaN while nothing feasible was found
  double mean = 0.0;  ///< of the feasible individuals of this generation; NaN if there are none
};

/// Settings of the paper's genetic algorithm (section 2.3.3). The paper's Table 2 is not published
/// as text: the numbers are ours, after docs/methods.md#planning.
struct GeneticOptions {
  int population = 50;     ///< individuals, >= 2
  int generations = 20;    ///< including the first, >= 1
  int tournament = 3;      ///< individuals drawn for one parent, >= 1
  double crossover = 0.9;  ///< probability that two parents exchange a segment [0, 1]
  double mutation = 0.3;   ///< probability that a gene is drawn anew [0, 1]
  std::uint64_t seed = 1;
  unsigned threads = 0;                ///< 0: one per core. The result does not depend on it.
  std::vector<Eigen::VectorXd> start;  ///< put into the first generation, clipped to the box
  std::function<bool(const SearchProgress&)> progress;  ///< after each generation; false stops
};

struct SearchResult {
  Eigen::VectorXd best;
  double fitness = 0.0;
  int evaluations = 0;   ///< calls of the objective; points seen before are not evaluated again
  int infeasible = 0;    ///< of these
  bool stopped = false;  ///< by the progress callback
  std::vector<SearchProgress> history;
};

/// The paper's genetic algorithm: the best individual is kept, parents are chosen by tournament
/// among the rest, segments of two parents are exchanged between two points, genes are drawn anew
/// within their limits.
///
/// Every draw is keyed by seed, generation and individual: the same bytes for any number of
/// threads.
///
/// @return nothing if no feasible point was found
/// @throws Error (bad_input) if an option or the box is out of range; what the objective throws
std::optional<SearchResult> search_genetic(const SearchBox& box, const Objective& objective,
                                           const GeneticOptions& options = {});

/// Bounded Nelder-Mead search (NLopt) from a feasible point; never returns a worse one.
///
/// @throws Error (bad_input) if `start` is outside the box; what the objective throws
SearchResult polish(const SearchBox& box, const Objective& objective, const Eigen::VectorXd& start,
                    int max_evaluations);

}  // namespace excavplan
