// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_site/estimate.hpp"

#include <algorithm>
#include <utility>

#include <excavplan/base/data_files.hpp>
#include <excavplan/design/cut_and_fill.hpp>
#include <excavplan/estimating/job_estimate.hpp>
#include <excavplan/job/job_order.hpp>
#include <excavplan/watch/job_view.hpp>

#include "base/text.hpp"
#include "design/design_walls.hpp"
#include "job/job_learning.hpp"
#include "plan_site/job_lines.hpp"
#include "report/job_report.hpp"
#include "results/plan_results.hpp"
#include "soil/density_doubt.hpp"

namespace excavplan::tools {
namespace {

constexpr double told_sd = 10.0;  // of a density that is told [points]; ours
const char* const usual_fuel = "zx120";

/// What is left of the job of a folder.
PlannedCut cut_in(const JobInputs& inputs) {
  const OrderInputs& order = inputs.order;
  if (order.site || order.trench || order.design || inputs.scan.scan) {
    usage_error("FOLDER excludes --site, --trench, --design and --scan: its job says them");
  }
  const JobView job(inputs.folder, load_order(inputs.folder));
  const JobSettings& settings = job.settings();
  CutOptions options;
  options.errors = errors_of_scan();
  PlannedCut cut;
  cut.site = settings.site;
  cut.truck = settings.design.truck;
  cut.density = GroundDensity{settings.density_percent, JobOutline{}.density.sd_percent};
  cut.shape =
      shape_of(settings.surface, cut_and_fill(settings.surface, job.ground().surface(), options));
  return cut;
}

/// Of a trench in words, whose ground is not known but as told.
void add_walls(const PlannedCut& cut, const GroundDensity& density, Outcome& outcome) {
  if (!cut.words) return;
  const WallSoil bank = wall_soil(cut.site.soil, density.percent);
  if (const auto wall = weak_wall(bank, *cut.words->depth, cut.words->batter))
    outcome.warnings.push_back(warning_of(*wall));
}

GroundDensity density_of(const JobInputs& inputs, const PlannedCut& cut) {
  GroundDensity density = cut.density.value_or(JobOutline{}.density);
  if (inputs.order.density) density = {*inputs.order.density, told_sd};
  if (inputs.estimate.density_sd) density.sd_percent = *inputs.estimate.density_sd;
  return density;
}

/// "Trench 10x0.7x1.2m"
std::string design_words(const JobInputs& inputs) {
  if (inputs.order.trench) return "Trench " + *inputs.order.trench;
  const auto& file = inputs.order.design ? inputs.order.design : inputs.order.site;
  return file ? "Design " + *file : "Job " + inputs.folder;
}

}  // namespace

Outcome work_estimate(const JobInputs& inputs, Console& console) {
  console.progress(0.0, "searching the best digs");
  const PlannedCut cut = inputs.folder.empty() ? cut_of(inputs.order, inputs.scan) : cut_in(inputs);
  JobOutline job;
  job.shape = cut.shape;
  job.density = density_of(inputs, cut);
  if (cut.truck) job.truck_mass = cut.truck->target_mass;
  if (inputs.estimate.truck_mass) job.truck_mass = *inputs.estimate.truck_mass;
  EstimateBasis basis = shipped_basis(cut.site.machine);
  if (inputs.estimate.fuel != usual_fuel) {
    basis.fuel = load_fuel_model(shipped_or_file("engines", inputs.estimate.fuel));
  }
  const JobEstimate estimate = estimate_job(cut.site.machine, cut.site.soil, job, basis);
  Outcome outcome;
  const std::optional<JobCost> cost = cost_of(estimate, inputs.estimate.prices);
  outcome.json = job_estimate_json(estimate, job, cost);
  outcome.json["soil"] = cut.site.soil.name;
  outcome.json["machine"] = cut.site.machine.name;
  outcome.json["fuel_model"] = basis.fuel.name;
  outcome.lines = estimate_lines(estimate, job, cost);
  outcome.trustworthy = estimate.trustworthy();
  add_walls(cut, job.density, outcome);
  if (auto doubt = doubt_of_density(job.density.percent))
    outcome.warnings.push_back(std::move(*doubt));
  if (inputs.report) {
    outcome.page =
        page_of(estimate_report(estimate, cost,
                                {design_words(inputs), cut.site.soil.name, cut.site.machine.name}),
                *inputs.report);
  }
  return outcome;
}

}  // namespace excavplan::tools
