// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <new>

#include <excavplan/optimisation/search_problem.hpp>

#include "base/text.hpp"

/// @file
/// Outcomes of what users give to be called. Private to the project.

namespace excavplan {

/// An outcome as the constructors of Evaluation make it, whoever filled its fields, which a
/// checkpoint can hold: finite numbers, a violation only if infeasible, a reason only if not ok, in
/// UTF-8 of limited length.
inline Evaluation sound(const Evaluation& outcome) {
  using Status = Evaluation::Status;
  constexpr std::size_t longest_reason = 500;  // ours [byte]
  const auto reason = [&] { return safe_text(outcome.reason, longest_reason); };
  switch (outcome.status) {
    case Status::ok:
      return {outcome.fitness};
    case Status::infeasible:
      return Evaluation::infeasible(outcome.violation, reason());
    case Status::failed:
      return Evaluation::failed(reason());
    case Status::timed_out:
      return Evaluation::timed_out(reason());
  }
  return Evaluation::failed("the status is none");
}

/// The outcome of a call; an exception is a failed outcome, with the text of a std::exception.
/// Memory that is short is none: that would change what is found.
/// @throws std::bad_alloc
template <typename Call>
auto caught(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return Evaluation::failed(e.what());
  } catch (...) {
    return Evaluation::failed("an exception that is no std::exception");
  }
}

}  // namespace excavplan
