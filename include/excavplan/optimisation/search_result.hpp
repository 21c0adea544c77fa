// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/optimisation/search_problem.hpp>

/// @file
/// What a search found, and every point on its way there.

namespace excavplan {

/// One point that the search requested.
struct SearchRecord {
  /// Which step of the search requested the point.
  enum class Origin { given, space_filling, random, polish, crossover, mutation, immigrant };
  /// Source of its outcome.
  enum class Source { simulated, cached, repair };

  Eigen::VectorXd point;              ///< as evaluated
  Evaluation outcome;                 ///< of the objective or the repair
  Origin origin = Origin::given;      ///< step that requested it
  Source source = Source::simulated;  ///< cached: seen before; repair: refused by the repair
  int generation = 0;                 ///< 0: the first
  int polish = 0;                     ///< number of the polish that requested it, from 1; 0: none
  std::vector<int> parents;           ///< places in the history
};

/// The best point and how it was found.
struct SearchResult {
  Eigen::VectorXd best;  ///< if nothing is feasible: the point of least violation
  Evaluation outcome;    ///< of it
  StopReason stopped_by = StopReason::generations;  ///< what ended the search
  int asked = 0;                                    ///< points, repeated ones included
  int evaluations = 0;                              ///< calls of the objective
  int cached = 0;                                   ///< requested, but seen before
  int repair = 0;                                   ///< requested, but refused by the repair
  int infeasible = 0;                               ///< of the evaluations
  int failed = 0;                                   ///< of the evaluations, time-outs included
  std::vector<SearchRecord> history;                ///< in the order requested

  bool feasible() const { return outcome.ok(); }  ///< the best point is
};

}  // namespace excavplan
