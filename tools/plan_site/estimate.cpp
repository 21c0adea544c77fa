// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_site/estimate.hpp"

#include <algorithm>

#include <excavplan/base/data_files.hpp>
#include <excavplan/design/cut_and_fill.hpp>
#include <excavplan/job/job_estimate.hpp>
#include <excavplan/job/site_job.hpp>

#include "base/text.hpp"
#include "plan_site/job_lines.hpp"
#include "results/plan_results.hpp"

namespace excavplan::tools {
namespace {

constexpr double told_sd = 10.0;     // of a density that is told [points]; ours
constexpr double joint_share = 0.9;  // of an engine's rated power that a machine file states; ours
const char* const usual_fuel = "zx120";

/// What is left of the job of a folder.
PlannedCut cut_in(const JobInputs& inputs) {
  const OrderInputs& order = inputs.order;
  if (order.site || order.trench || order.design || inputs.scan.scan) {
    usage_error("FOLDER excludes --site, --trench, --design and --scan: its job says them");
  }
  const JobSettings settings = load_order(inputs.folder);
  const SiteJob job = SiteJob::resume(inputs.folder, settings);
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

GroundDensity density_of(const JobInputs& inputs, const PlannedCut& cut) {
  GroundDensity density = cut.density.value_or(JobOutline{}.density);
  if (inputs.order.density) density = {*inputs.order.density, told_sd};
  if (inputs.estimate.density_sd) density.sd_percent = *inputs.estimate.density_sd;
  return density;
}

/// The fuel model that is told; the usual one is scaled to the engine of another machine.
FuelModel fuel_of(const std::string& word, const Machine& machine) {
  FuelModel fuel = load_fuel_model(shipped_or_file("engines", word));
  if (word != usual_fuel || machine.name == usual_fuel || !machine.engine) return fuel;
  const double size = machine.engine->power / joint_share / fuel.rated_power;
  fuel.rated_power *= size;
  fuel.rated_flow *= size;
  fuel.idle_flow *= size;
  return fuel;
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
  EstimateBasis basis;
  basis.fuel = fuel_of(inputs.estimate.fuel, cut.site.machine);
  basis.played = load_played_jobs(find_data_file("jobs/played.json"));
  const JobEstimate estimate = estimate_job(cut.site.machine, cut.site.soil, job, basis);
  Outcome outcome;
  outcome.json = job_estimate_json(estimate, job);
  outcome.json["soil"] = cut.site.soil.name;
  outcome.json["machine"] = cut.site.machine.name;
  outcome.json["fuel_model"] = basis.fuel.name;
  outcome.lines = estimate_lines(estimate, job);
  outcome.trustworthy = estimate.trustworthy();
  return outcome;
}

}  // namespace excavplan::tools
