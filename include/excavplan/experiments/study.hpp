// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <excavplan/experiments/study_condition.hpp>
#include <excavplan/experiments/study_result.hpp>
#include <excavplan/machine/machine.hpp>

/// @file
/// What the paper could not vary: its experiment under many conditions, one factor at a time, many
/// runs each (docs/formats.md).

namespace excavplan {

inline constexpr double most_study_runs = 1e4;  ///< of StudyOptions::runs

/// Settings of run_study().
struct StudyOptions {
  std::uint64_t seed = 1;  ///< of soils, grounds, scans and searches
  unsigned threads = 0;    ///< 0: one per core; the result is the same for any number
  double runs = 1.0;       ///< factor on the number of runs of each condition, above 0
  int draws = 200;         ///< digs behind the scatter of each law, CalibrationOptions::draws
  /// Called from any thread after each run with the share that is done; true goes on.
  std::function<bool(double done, const std::string& condition)> progress = {};
};

/// Runs a study. Run i of every condition has the same density, if its condition does not set one,
/// the same soil and the same ground: conditions are compared run by run.
///
/// @throws Error (bad_input) if a name is unknown or a number is out of range; what one run cannot
/// do, a stall on the fixed path for instance, is in its `failure` or `plan_failure`
std::vector<StudyResult> run_study(const Machine& machine,
                                   const std::vector<StudyCondition>& conditions,
                                   const StudyOptions& options = {});

}  // namespace excavplan
