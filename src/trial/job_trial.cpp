// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/job_trial.hpp>

#include <chrono>
#include <limits>

namespace excavplan {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void count(const TrialStep& at, JobTrial& trial) {
  const bool finishes = at.step.what == JobAction::finish;
  trial.digs += at.step.digs() ? 1 : 0;
  trial.finishing += finishes ? 1 : 0;
  trial.moves += at.step.what == JobAction::move ? 1 : 0;
  trial.scans += at.done.report.scan ? 1 : 0;
  trial.stalls += at.done.stall ? 1 : 0;
  trial.untrusted += at.step.trustworthy ? 0 : 1;
  trial.energy += at.done.energy;
  trial.time += at.done.time;
  trial.planning_time += at.planning_time;
  if (!at.step.digs() || !at.step.truck) return;
  trial.trucks[*at.step.truck] += at.done.payload_mass;
  trial.hauled += at.done.payload_mass;
}

}  // namespace

double JobTrial::energy_per_design() const {
  const double taken = score.design_cut - score.left;
  return taken > 0.0 ? energy / taken : std::numeric_limits<double>::quiet_NaN();
}

JobTrial run_trial(const HiddenSite& site, const Machine& machine, JobPlanner& planner,
                   const TrialOptions& options) {
  TrueSite truth(site, machine, options.truth);
  JobTrial trial;
  int waits = 0;
  for (long long i = 0; trial.reason.empty(); ++i) {
    const auto begin = std::chrono::steady_clock::now();
    TrialStep at;
    at.step = planner.next();
    at.planning_time = seconds_since(begin);
    waits = at.step.what == JobAction::wait ? waits + 1 : 0;
    if (at.step.what == JobAction::stop) {
      trial.stopped = true;
      trial.reason = at.step.reason.empty() ? "stopped" : at.step.reason;
      trial.planning_time += at.planning_time;
      break;
    }
    at.done = truth.execute(at.step);
    const auto told = std::chrono::steady_clock::now();
    planner.done(at.step.id, at.done.report);
    at.planning_time += seconds_since(told);
    at.site = &truth;
    count(at, trial);
    if (options.each) options.each(at);
    if (i + 1 >= options.most_steps) trial.reason = "too many steps";
    if (trial.time >= options.most_time) trial.reason = "too long";
    if (waits > options.most_waits) trial.reason = "waits";
  }
  trial.solids = truth.solids();
  trial.after = truth.ground();
  trial.score = score_job(site, trial.after.surface(), truth.seen_share(footprint_of(site)));
  return trial;
}

}  // namespace excavplan
