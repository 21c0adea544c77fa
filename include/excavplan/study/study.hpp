// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <excavplan/machine/machine.hpp>
#include <excavplan/study/study_condition.hpp>

/// @file
/// What the paper could not vary: its experiment under many conditions, one factor at a time, many
/// runs each (docs/formats.md).

namespace excavplan {

/// One run of a condition. Gains are those of the planned over the fixed dig, or of the sums over a
/// row of digs [%].
struct StudyRun {
  double density_percent = 0.0;                   ///< the true one
  double estimate_percent = 0.0;                  ///< estimated
  double estimate_sd = 0.0;                       ///< its standard deviation [%]
  std::array<double, 2> interval = {0.0, 100.0};  ///< 95 %
  bool trustworthy = true;                        ///< the estimate
  bool compared = true;                           ///< planned and dug, not only estimated
  /// The fixed path would lift or drag the machine, which is held down in all digs of the run: no
  /// gain can be told from it.
  bool held_down = false;
  double energy_gain = 0.0;     ///< planned for mass per energy of the dig, the paper's f
  double path_gain = 0.0;       ///< its part that is the path's, both begun by one rule
  double energy_payload = 0.0;  ///< payload of that dig over that of the fixed one [-]
  double equal_gain = 0.0;      ///< planned for the same at no less payload than the fixed dig's
  double equal_payload = 0.0;   ///< payload of that dig over that of the fixed one [-]
  double cycle_gain = 0.0;  ///< planned for mass per energy of the whole cycle, at no less payload
  double cycle_payload = 0.0;  ///< payload of that dig over that of the fixed one [-]
  std::string failure = {};    ///< why there is no result; empty if there is
};

/// Mean with its 95 % interval.
struct StudyMean {
  double mean = 0.0;                            ///< of the values
  std::array<double, 2> interval = {0.0, 0.0};  ///< by bootstrap over the runs
};

/// Mean of these with the percentile interval of 2000 bootstrap samples (Efron and Tibshirani 1993,
/// chapter 13). The same seed gives the same interval. NaN without values.
StudyMean bootstrap_mean(const std::vector<double>& values, std::uint64_t seed);

/// A condition with its runs.
struct StudyResult {
  StudyCondition condition;       ///< that was run
  std::vector<StudyRun> runs;     ///< in order
  int failed = 0;                 ///< runs without a result
  int compared = 0;               ///< runs without failure that planned and dug
  int held_down = 0;              ///< of them, those that tell no gain
  int untrusted = 0;              ///< runs whose estimate is not trustworthy, failed ones aside
  double rms = 0.0;               ///< error of the estimated density, failed runs aside [points]
  double bias = 0.0;              ///< likewise [points]
  double inside = 0.0;            ///< share of the runs whose 95 % interval holds the density [-]
  StudyMean energy_gain = {};     ///< [%]
  StudyMean path_gain = {};       ///< [%]
  StudyMean equal_gain = {};      ///< [%]
  StudyMean equal_payload = {};   ///< [-]
  StudyMean cycle_gain = {};      ///< [%]
  StudyMean energy_payload = {};  ///< [-]
  StudyMean cycle_payload = {};   ///< [-]
};

/// Settings of run_study().
struct StudyOptions {
  std::uint64_t seed = 1;  ///< of soils, grounds, scans and searches
  unsigned threads = 0;    ///< 0: one per core; the result is the same for any number
  double runs = 1.0;       ///< factor on the number of runs of each condition
  int draws = 200;         ///< digs behind the scatter of each law, CalibrationOptions::draws
  /// Called from any thread after each run with the share that is done; true goes on.
  std::function<bool(double done, const std::string& condition)> progress = {};
};

/// Runs a study. Run i of every condition has the same density, if its condition does not set one,
/// the same soil and the same ground: conditions are compared run by run.
///
/// @throws Error (bad_input) if a name is unknown or a number is out of range; what one run cannot
/// do, a stall on the fixed path for instance, is in its `failure`
std::vector<StudyResult> run_study(const Machine& machine,
                                   const std::vector<StudyCondition>& conditions,
                                   const StudyOptions& options = {});

}  // namespace excavplan
