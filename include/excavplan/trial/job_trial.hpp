// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>

#include <excavplan/trial/job_score.hpp>
#include <excavplan/trial/true_site.hpp>

/// @file
/// A whole job against hidden truth.

namespace excavplan {

/// One step of a trial.
struct TrialStep {
  JobStep step;                    ///< as planned
  TrueStep done;                   ///< as it went
  double planning_time = 0.0;      ///< that the planner took for it, by the clock [s]
  const TrueSite* site = nullptr;  ///< after it, for as long as TrialOptions::each is told
};

/// How a trial is run.
struct TrialOptions {
  TruthOptions truth = {};  ///< of the true site
  /// Of a job that does not come to its end: ours.
  long long most_steps = 3000;
  double most_time = 12.0 * 3600.0;                 ///< [s]; ours
  int most_waits = 5;                               ///< in a row; ours
  std::function<void(const TrialStep&)> each = {};  ///< told of every step
};

/// What became of a job.
struct JobTrial {
  JobScore score;                ///< of the ground at the end
  std::string reason;            ///< of its end
  bool stopped = false;          ///< by the planner, not by a bound of TrialOptions
  int digs = 0;                  ///< with those that finish
  int finishing = 0;             ///< digs for shape
  int moves = 0;                 ///< of the machine
  int scans = 0;                 ///< that were taken
  int stalls = 0;                ///< among the digs
  int untrusted = 0;             ///< steps done though JobStep::trustworthy is false
  double energy = 0.0;           ///< of cycles and moves [J]
  double time = 0.0;             ///< of cycles, moves, scans and waits [s]
  double planning_time = 0.0;    ///< by the clock [s]
  double hauled = 0.0;           ///< true, into trucks [kg]
  std::map<int, double> trucks;  ///< true mass of each load by its number [kg]
  SolidsLedger solids;           ///< from begin to end
  Terrain after;                 ///< the ground at the end

  /// Energy over the volume of the design that was taken out [J/m^3]; NaN if none was.
  double energy_per_design() const;
};

/// Asks the planner for its steps and does them until it stops.
/// @throws Error (bad_input) as TrueSite::execute(), and what the planner throws
JobTrial run_trial(const HiddenSite& site, const Machine& machine, JobPlanner& planner,
                   const TrialOptions& options = {});

}  // namespace excavplan
