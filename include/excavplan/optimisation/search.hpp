// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

/// @file
/// The best point of a box under any objective, with few evaluations (docs/methods.md#search).

namespace excavplan {

/// The search space: a box in n dimensions.
struct SearchBox {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

/// What the objective says of one point.
struct Evaluation {
  enum class Status { ok, infeasible, failed, timed_out };

  Status status = Status::failed;
  double fitness = std::numeric_limits<double>::quiet_NaN();  ///< larger is better; if ok
  double violation = 0.0;  ///< if infeasible: >= 0, smaller is nearer to feasible
  std::string reason;      ///< for people, if not ok

  Evaluation() = default;
  /// ok; NaN and infinity: failed
  Evaluation(double value);                 // NOLINT: an objective may return a bare number
  Evaluation(std::optional<double> value);  // NOLINT: nothing is infeasible
  static Evaluation infeasible(double violation, std::string reason = {});
  static Evaluation failed(std::string reason);
  static Evaluation timed_out(std::string reason);

  bool ok() const { return status == Status::ok; }
};

const char* name(Evaluation::Status status);

/// Feasible before infeasible before failed or timed out; then less violation, then more fitness.
bool better(const Evaluation& a, const Evaluation& b);

/// Must say the same of the same point, and may be called from several threads. What it throws is a
/// failed evaluation, with the text of a std::exception; the search goes on. So is an outcome that
/// the constructors of Evaluation would not make, such as a violation that is not finite.
using Objective = std::function<Evaluation(const Eigen::VectorXd&)>;

/// A point made fit to evaluate, or why it cannot be: infeasible without an evaluation.
using Repair =
    std::function<std::variant<Eigen::VectorXd, Evaluation>(const Eigen::VectorXd& point)>;

struct SearchProblem {
  SearchBox box;
  Objective objective;
  Repair repair = nullptr;  ///< optional; its points are clipped to the box
  /// Optional: points are moved to multiples of this above the lower bounds before the repair.
  Eigen::VectorXd step = {};
  std::string fingerprint = {};  ///< all that decides the objective; checkpoints need it
};

/// The paper's genetic algorithm (section 2.3.3): the best individual is kept, parents are chosen
/// by tournament among the rest, segments of two parents are exchanged between two points, genes
/// are drawn anew within their limits. The paper's Table 2 is not published as text: the numbers
/// are ours, after docs/methods.md#planning. Given points are the first of the first generation,
/// which is as large as it must be to hold all of them.
struct GeneticAlgorithm {
  int population = 50;     ///< individuals, >= 2
  int generations = 20;    ///< including the first, >= 1
  int tournament = 3;      ///< individuals drawn for one parent, >= 1
  double crossover = 0.9;  ///< probability that two parents exchange a segment [0, 1]
  double mutation = 0.3;   ///< probability that a gene is drawn anew [0, 1]
};

/// Given points are polished first (bounded Nelder-Mead); then a space-filling first generation,
/// polish of its best separate basins and once more of the best; then generations of mutants of the
/// best and fresh space-filling immigrants, with a polish wherever a new basin looks good.
struct MemeticSearch {
  int first_generation = 16;    ///< points, >= 0; 0 only with given points
  int generations = 4;          ///< after the polish, >= 0; some 50 evaluations each
  int generation_size = 12;     ///< points, >= 1
  double immigrants = 0.25;     ///< share of a generation [0, 1]
  int basins = 3;               ///< polished of the first generation, >= 0
  int polish_evaluations = 45;  ///< of one polish, >= 0; 15 for each dimension do well
  double basin_radius = 0.2;    ///< two basins are farther apart than this share of the box, > 0
};

/// The search ends at the first that is seen to hold. 0: no such rule. `evaluations` is never
/// exceeded, and none begins once one has ended after `seconds`. `stall` and `target` are looked at
/// after each batch of points and each round of polishes, for any number of threads; a polish that
/// reaches the target ends at once.
struct StopRules {
  int evaluations = 0;
  int stall = 0;                      ///< evaluations without a better point
  double seconds = 0.0;               ///< the only rule whose result depends on the clock
  std::optional<double> target = {};  ///< fitness
};

struct SearchProgress {
  int generation = 0;  ///< 0: the first
  int evaluations = 0;
  int planned = 0;    ///< evaluations in all, at most; an estimate
  double best = 0.0;  ///< fitness; NaN while nothing feasible was found
  double mean = 0.0;  ///< of the feasible of the last generation; NaN before and if there are none
  double seconds = 0.0;
  double seconds_left = 0.0;  ///< estimated from the pace and the stop rules; NaN if unknown
};

/// How to search, whatever is searched.
struct SearchSettings {
  std::variant<MemeticSearch, GeneticAlgorithm> method = MemeticSearch{};
  std::uint64_t seed = 1;
  StopRules stop = {};
  unsigned threads = 0;  ///< 0: one per core. The result does not depend on it.
  /// After every evaluation and, with the mean of a batch of points, after the batch; one call at a
  /// time, from any thread; false cancels.
  std::function<bool(const SearchProgress&)> progress = nullptr;
  /// File that holds the evaluations made, for a search that was cancelled or killed; empty: none.
  std::string checkpoint = {};
  double checkpoint_interval = 1.0;  ///< at least this long between two writes of it [s]
  bool resume = false;               ///< go on from the checkpoint if the file exists

  SearchSettings() {}  // NOLINT: of an aggregate, GCC 12 wrongly calls temporaries uninitialized
};

struct SearchOptions : SearchSettings {
  std::vector<Eigen::VectorXd> start = {};  ///< points to begin with, clipped to the box
};

/// One point the search asked for.
struct SearchRecord {
  enum class Origin { given, space_filling, random, polish, crossover, mutation, immigrant };
  enum class Source { simulated, cached, repair };

  Eigen::VectorXd point;  ///< as evaluated
  Evaluation outcome;
  Origin origin = Origin::given;
  Source source = Source::simulated;  ///< cached: seen before; repair: refused by the repair
  int generation = 0;
  int polish = 0;            ///< number of the polish that asked for it, from 1; 0: none
  std::vector<int> parents;  ///< places in the history
};

enum class StopReason { generations, evaluations, stall, seconds, target, cancelled };
const char* name(StopReason reason);

struct SearchResult {
  Eigen::VectorXd best;  ///< if nothing is feasible: the point of least violation
  Evaluation outcome;    ///< of it
  StopReason stopped_by = StopReason::generations;
  int asked = 0;
  int evaluations = 0;                ///< calls of the objective
  int cached = 0;                     ///< asked, but seen before
  int repair = 0;                     ///< asked, but refused by the repair
  int infeasible = 0;                 ///< of the evaluations
  int failed = 0;                     ///< of the evaluations, time-outs included
  std::vector<SearchRecord> history;  ///< in the order asked: enough to redraw the search

  bool feasible() const { return outcome.ok(); }
};

/// Maximises the objective.
///
/// The same bytes for any number of threads and any order in which evaluations end, and for a
/// search that was interrupted and resumed any number of times (a stop by `seconds` excepted):
/// the draws are keyed by seed, generation and individual, and a resumed search is replayed with
/// the outcomes of the checkpoint. Stop rules, threads and given points may be other ones when it
/// is resumed.
///
/// @throws Error (bad_input) if an option or the box is out of range, or if the first 20
///         evaluations all failed, or all of a search that ends with fewer without being cancelled
///         or out of time (the first reason is quoted)
/// @throws Error (bad_file) if a checkpoint is of another search, truncated or altered
SearchResult search(const SearchProblem& problem, const SearchOptions& options = {});

}  // namespace excavplan
