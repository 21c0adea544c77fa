// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>

/// @file
/// How to search, whatever is searched: methods, stop rules, progress, checkpoints
/// (docs/methods.md#search).

namespace excavplan {

/// The paper's genetic algorithm (section 2.3.3): the first generation is random, the best
/// individual is kept, parents are chosen by tournament among the rest, segments of two parents are
/// exchanged between two points, genes are redrawn within their limits. The paper's Table 2 is not
/// published as text: the numbers are ours, all of them here (docs/methods.md#planning). Given
/// points, which the paper has none of, are the first of the first generation, which is as large as
/// it must be to hold all of them.
struct GeneticAlgorithm {
  int population = 50;     ///< individuals, >= 2
  int generations = 20;    ///< including the first, >= 1
  int tournament = 3;      ///< individuals drawn for one parent, >= 1
  double crossover = 0.9;  ///< probability that two parents exchange a segment [0, 1]
  double mutation = 0.3;   ///< probability that a gene is redrawn [0, 1]
  int elites = 1;          ///< best individuals that are kept, 0 .. population - 1; 1 in the paper
};

/// How a point is improved step by step.
enum class Polishing {
  simplex,    ///< bounded Nelder-Mead: few evaluations where the objective is smooth
  evolution,  ///< (1+1)-CMA-ES with constraints: goes along the edge of what is feasible
};

/// Given points are polished first; then a space-filling first generation,
/// polish of its best separate basins and once more of the best (`restarts`); then generations of
/// mutants of the best and fresh space-filling immigrants, with a polish of every promising new
/// basin.
struct MemeticSearch {
  int first_generation = 16;    ///< points, >= 0; 0 only with given points
  int generations = 4;          ///< after the polish, >= 0; some 50 evaluations each
  int generation_size = 12;     ///< points, >= 1
  double immigrants = 0.25;     ///< share of a generation [0, 1]
  int basins = 3;               ///< polished of the first generation, >= 0
  int polish_evaluations = 45;  ///< of one polish, >= 0; 15 per dimension suffice
  double basin_radius = 0.2;    ///< two basins are farther apart than this share of the box, > 0
  Polishing polishing = Polishing::simplex;  ///< of all polishes
  int restarts = 1;                          ///< best points polished once more, >= 0
};

/// The search ends at the first that is seen to hold. 0: no such rule. `evaluations` is never
/// exceeded, and none begins once one has ended after `seconds`. `stall` and `target` are checked
/// after each batch of points and each round of polishes, for any number of threads; a polish that
/// reaches the target ends at once.
struct StopRules {
  int evaluations = 0;                ///< of the objective, at most
  int stall = 0;                      ///< evaluations without a better point
  double seconds = 0.0;               ///< the only rule whose result depends on the clock
  std::optional<double> target = {};  ///< fitness
};

/// What ended a search.
enum class StopReason { generations, evaluations, stall, seconds, target, cancelled };
/// The name of the enumerator, for files and messages.
const char* name(StopReason reason);

/// How far a search is.
struct SearchProgress {
  int generation = 0;   ///< 0: the first
  int evaluations = 0;  ///< made so far
  int planned = 0;      ///< evaluations in all, at most; an estimate
  double best = 0.0;    ///< fitness; NaN while nothing feasible was found
  double mean = 0.0;  ///< of the feasible of the last generation; NaN before and if there are none
  double seconds = 0.0;       ///< since the search began
  double seconds_left = 0.0;  ///< estimated from the pace and the stop rules; NaN if unknown
};

/// How to search, whatever is searched.
struct SearchSettings {
  std::variant<MemeticSearch, GeneticAlgorithm> method = MemeticSearch{};  ///< and its numbers
  std::uint64_t seed = 1;  ///< same seed, same result
  StopRules stop = {};     ///< when the search ends
  unsigned threads = 0;    ///< 0: one per core. The result does not depend on it.
  /// After every evaluation and, with the mean of a batch of points, after the batch; one call at a
  /// time, from any thread; false cancels.
  std::function<bool(const SearchProgress&)> progress = nullptr;
  /// File that holds the evaluations made, for a search that was cancelled or killed; empty: none.
  std::string checkpoint = {};
  double checkpoint_interval = 1.0;  ///< at least this long between two writes of it [s]
  bool resume = false;               ///< continue from the checkpoint if the file exists

  SearchSettings() {}  // NOLINT: of an aggregate, GCC 12 wrongly calls temporaries uninitialized
};

}  // namespace excavplan
