// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/optimisation/search_problem.hpp>

#include <cmath>
#include <string>
#include <utility>

#include "base/text.hpp"

namespace excavplan {
namespace {

/// Rank of a status: feasible before infeasible before unknown.
int rank(const Evaluation& outcome) {
  using Status = Evaluation::Status;
  return outcome.ok() ? 0 : outcome.status == Status::infeasible ? 1 : 2;
}

}  // namespace

Evaluation::Evaluation(double value) {
  if (std::isfinite(value)) {
    status = Status::ok;
    fitness = value;
  } else {
    reason = "the fitness is " + number_text(value);
  }
}

Evaluation::Evaluation(std::optional<double> value)
    : Evaluation(value ? Evaluation(*value) : infeasible(0.0)) {}

Evaluation Evaluation::infeasible(double violation, std::string reason) {
  if (!std::isfinite(violation)) {
    return failed("the violation is " + number_text(violation));
  }
  Evaluation outcome;
  outcome.status = Status::infeasible;
  outcome.violation = std::fmax(violation, 0.0);
  outcome.reason = std::move(reason);
  return outcome;
}

Evaluation Evaluation::failed(std::string reason) {
  Evaluation outcome;
  outcome.reason = std::move(reason);
  return outcome;
}

Evaluation Evaluation::timed_out(std::string reason) {
  Evaluation outcome = failed(std::move(reason));
  outcome.status = Status::timed_out;
  return outcome;
}

const char* name(Evaluation::Status status) {
  switch (status) {
    case Evaluation::Status::ok:
      return "ok";
    case Evaluation::Status::infeasible:
      return "infeasible";
    case Evaluation::Status::failed:
      return "failed";
    case Evaluation::Status::timed_out:
      return "timed out";
  }
  return "";
}

bool better(const Evaluation& a, const Evaluation& b) {
  if (rank(a) != rank(b)) return rank(a) < rank(b);
  if (a.ok()) return a.fitness > b.fitness;
  return a.violation < b.violation;
}

}  // namespace excavplan
