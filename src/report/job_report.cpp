// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/job_report.hpp"

#include <utility>

#include "base/text.hpp"
#include "drawing/plot.hpp"
#include "figures/job_estimate_figure.hpp"

namespace excavplan {

std::string title_of(const JobDesign& design) {
  return design.name.empty() ? "Job" : "Job " + design.name;
}

Report trial_report(const JobTrial& trial, ReportJob job) {
  Report report;
  report.title = title_of(job.history.design) + ", played";
  report.headline = {
      "rms_m",           "p95_m",         "beyond_twice_percent",    "seen_percent", "left_percent",
      "overdig_percent", "spill_percent", "energy_kj_per_design_m3", "time_min"};
  report.note = "Ground and volumes are the true ones, which the planner does not see.";
  report.is_done = trial.score.finished;
  if (trial.score.finished) {
    report.state = "Finished.";
  } else {
    report.fault = "Not finished by the score. The planner's end: " + trial.reason + ".";
  }
  report.job = std::move(job);
  return report;
}

Report estimate_report(const JobEstimate& estimate, const std::optional<JobCost>& cost,
                       const EstimatedJob& job) {
  Report report;
  report.title = (job.design.empty() ? "Job" : job.design) + " in " + job.soil + ", " +
                 job.machine + ": estimate";
  report.headline = {"digs", "time_min", "fuel_l", "truckloads", "cost"};
  set_plot(report, job_estimate_figure(estimate, cost));
  report.plot_always = true;
  for (const std::string& each : estimate.unlike) {
    report.fault += (report.fault.empty() ? "Not trustworthy: " : "; ") + each;
  }
  report.note =
      "Intervals are of 95 %. Digs and truckloads are whole, rounded up; truckloads as if all soil "
      "went by truck; time with moves and scans.";
  return report;
}

Report progress_report(const JobProgress& progress, ReportJob job) {
  Report report;
  report.title = title_of(job.history.design);
  report.headline = {"progress.left_m3", "progress.rms_m", "progress.p95_m",
                     "progress.seen",    "progress.digs",  "progress.stalls"};
  report.note = "The ground is that of the last scan, and what was dug since as foretold.";
  report.is_done = progress.is_finished;
  report.state = progress.is_finished ? "Finished."
                                      : "Not finished: " + readable(progress.left_volume) + " of " +
                                            readable(progress.design_volume) + " m³ left.";
  report.job = std::move(job);
  return report;
}

}  // namespace excavplan
