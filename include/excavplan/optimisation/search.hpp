// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <excavplan/optimisation/search_settings.hpp>

/// @file
/// The best point of a box under any objective, with few evaluations (docs/methods.md#search).

namespace excavplan {

/// The search space: a box in n dimensions.
struct SearchBox {
  Eigen::VectorXd lower;  ///< smallest value of each dimension
  Eigen::VectorXd upper;  ///< largest value of each dimension
};

/// Outcome of the objective at one point.
struct Evaluation {
  /// Whether the point counts, breaks a rule, or could not be judged.
  enum class Status { ok, infeasible, failed, timed_out };

  Status status = Status::failed;                             ///< how the point was judged
  double fitness = std::numeric_limits<double>::quiet_NaN();  ///< larger is better; if ok
  double violation = 0.0;  ///< if infeasible: >= 0, smaller is nearer to feasible
  std::string reason;      ///< human-readable, if not ok

  Evaluation() = default;
  /// ok; NaN and infinity: failed
  Evaluation(double value);  // NOLINT: an objective may return a bare number
  /// ok; nothing: infeasible
  Evaluation(std::optional<double> value);  // NOLINT: nothing is infeasible
  /// breaks a rule by `violation`
  static Evaluation infeasible(double violation, std::string reason = {});
  /// could not be judged
  static Evaluation failed(std::string reason);
  /// was not judged in time
  static Evaluation timed_out(std::string reason);

  bool ok() const { return status == Status::ok; }  ///< the fitness counts
};

/// The name of the enumerator, for files and messages.
const char* name(Evaluation::Status status);

/// Feasible before infeasible before failed or timed out; then less violation, then more fitness.
bool better(const Evaluation& a, const Evaluation& b);

/// Must be deterministic, and may be called from several threads. An exception is a failed
/// evaluation, with the text of a std::exception; the search continues. So is an outcome that
/// the constructors of Evaluation would not make, such as a violation that is not finite.
using Objective = std::function<Evaluation(const Eigen::VectorXd&)>;

/// A point made fit to evaluate, or why it cannot be: infeasible without an evaluation.
using Repair =
    std::function<std::variant<Eigen::VectorXd, Evaluation>(const Eigen::VectorXd& point)>;

/// What is searched.
struct SearchProblem {
  SearchBox box;            ///< every requested point is inside
  Objective objective;      ///< to maximise
  Repair repair = nullptr;  ///< optional; its points are clipped to the box
  /// Optional: points are moved to multiples of this above the lower bounds before the repair.
  Eigen::VectorXd step = {};
  std::string fingerprint = {};  ///< all that decides the objective; checkpoints need it
};

/// How it is searched.
struct SearchOptions : SearchSettings {
  std::vector<Eigen::VectorXd> start = {};  ///< points to begin with, clipped to the box
};

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

/// Maximises the objective.
///
/// The same bytes for any number of threads and any order in which evaluations end, and for a
/// search that was interrupted and resumed any number of times (a stop by `seconds` excepted):
/// the draws are keyed by seed, generation and individual, and a resumed search is replayed with
/// the outcomes of the checkpoint, of which it evaluates the best again. Stop rules, threads and
/// given points may be other ones when it is resumed.
///
/// @throws Error (bad_input) if an option or the box is out of range, or if the first 20
///         evaluations all failed, or all of a search that ends with fewer without being cancelled
///         or out of time (the first reason is quoted)
/// @throws Error (bad_file) if a checkpoint is of another search, truncated or altered, or its best
///         outcome is another one now
SearchResult search(const SearchProblem& problem, const SearchOptions& options = {});

}  // namespace excavplan
