// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/report/report_pages.hpp>

#include <utility>

#include "base/json.hpp"
#include "report/dig_report.hpp"
#include "report/job_report.hpp"
#include "results/density_results.hpp"
#include "results/plan_results.hpp"
#include "results/scene_results.hpp"
#include "trial/trial_json.hpp"

namespace excavplan {
namespace {

/// A result of the library, which has no options.
ReportedRun run_of(const Json& json, std::vector<Warning> warnings) {
  ReportedRun run;
  run.tool = "library";
  run.version = EXCAVPLAN_VERSION;
  run.json = json_text(json);
  run.warnings = std::move(warnings);
  return run;
}

ReportedRun judged(ReportedRun run, bool trustworthy) {
  run.judged = true;
  run.trustworthy = trustworthy;
  return run;
}

}  // namespace

std::string report_page(const DensityEstimate& estimate) {
  Json json = estimate_json(estimate);
  json.update(survey_json(estimate));
  return html_page(survey_report({estimate.change, estimate.before, {}, {}}),
                   judged(run_of(json, estimate.warnings), estimate.trustworthy));
}

std::string report_page(const Machine& machine, const DigScene& scene) {
  return html_page(scene_report(machine, scene),
                   run_of(scene_json(machine, scene), scene.warnings));
}

std::string report_page(const Machine& machine, const DigPlan& plan, const PlanSite& site,
                        const GroundDensity& density, const DigObjective& objective) {
  std::optional<DigResult> dig;
  if (plan.dig) dig = rehearse(machine, plan, site);
  return html_page(
      plan_report(machine, plan, site, dig),
      judged(run_of(plan_json(plan, density, objective), plan.warnings), plan.trustworthy));
}

std::string report_page(const JobEstimate& estimate, const JobOutline& job,
                        const std::optional<JobCost>& cost, const EstimatedJob& about) {
  return html_page(
      estimate_report(estimate, cost, about),
      judged(run_of(job_estimate_json(estimate, job, cost), {}), estimate.trustworthy()));
}

std::string report_page(const JobProgress& progress, const JobHistory& history,
                        const Machine& machine) {
  return html_page(progress_report(progress, {history, machine}),
                   run_of({{"progress", progress_json(progress)}}, {}));
}

std::string report_page(const JobTrial& trial, const JobHistory& history, const Machine& machine) {
  return html_page(trial_report(trial, {history, machine}), run_of(trial_json(trial), {}));
}

}  // namespace excavplan
