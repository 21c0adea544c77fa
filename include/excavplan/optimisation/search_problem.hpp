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
/// What is searched, how, and what an objective answers (docs/methods.md#search).

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

}  // namespace excavplan
