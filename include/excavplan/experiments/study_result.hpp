// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <excavplan/experiments/study_condition.hpp>

/// @file
/// What the runs of a study tell.

namespace excavplan {

/// Of the planned over the fixed dig, or of the sums over a row of digs; not a number where there
/// is none.
struct StudyGain {
  double gain = std::numeric_limits<double>::quiet_NaN();     ///< in the goal planned for [%]
  double of_path = std::numeric_limits<double>::quiet_NaN();  ///< both begun by one rule [%]
  double payload = std::numeric_limits<double>::quiet_NaN();  ///< planned over fixed [-]
};

/// One run of a condition.
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
  StudyGain energy = {};     ///< planned for mass per energy of the dig, the paper's f
  StudyGain equal = {};      ///< planned for the same at no less payload than the fixed dig's
  StudyGain cycle = {};      ///< planned for mass per energy of the whole cycle, at no less payload
  std::string failure = {};  ///< why the fixed path gives no estimate; empty if it does
  std::string plan_failure = {};  ///< why the first goal that fails cannot be planned or dug
};

/// Mean with its 95 % interval.
struct StudyMean {
  double mean = 0.0;                            ///< of the values
  std::array<double, 2> interval = {0.0, 0.0};  ///< by bootstrap over the runs
  int values = 0;                               ///< number of them
};

/// Mean of these with the percentile interval of 2000 bootstrap samples (Efron and Tibshirani 1993,
/// chapter 13). The same seed gives the same interval. NaN without values.
StudyMean bootstrap_mean(const std::vector<double>& values, std::uint64_t seed);

/// Of the runs that tell a gain.
struct StudyGains {
  StudyMean gain = {};     ///< [%]
  StudyMean of_path = {};  ///< [%]
  StudyMean payload = {};  ///< [-]
  /// Of the gain over that of the same run of the first condition [points]; without values where
  /// the condition sets the density.
  StudyMean over_first = {};
};

/// A condition with its runs.
struct StudyResult {
  StudyCondition condition;    ///< that was run
  std::vector<StudyRun> runs;  ///< in order
  int failed = 0;              ///< runs whose fixed path gives no estimate
  int untrusted = 0;           ///< of the others, those whose estimate is not trustworthy
  int compared = 0;            ///< runs that planned and dug
  int held_down = 0;           ///< of them, those that tell no gain
  int unplanned = 0;           ///< of the rest, those with a goal that cannot be planned or dug
  double rms = 0.0;            ///< error of the estimated density, failed runs aside [points]
  double bias = 0.0;           ///< likewise [points]
  double inside = 0.0;         ///< share of the runs whose 95 % interval holds the density [-]
  std::array<double, 2> densities = {0.0, 0.0};  ///< least and most of the runs that tell a gain
  StudyGains energy = {};                        ///< as of a run
  StudyGains equal = {};                         ///< likewise
  StudyGains cycle = {};                         ///< likewise
};

}  // namespace excavplan
