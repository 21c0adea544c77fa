// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/density_estimate.hpp>

#include "estimate_density/estimate_inputs.hpp"
#include "estimate_density/site_estimate.hpp"
#include "estimate_density/survey_planning.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "estimate-density",
    "estimates the relative density of soil from scans of the ground before and after one dig: "
    "volumes of hole, spill and heap, bulking factor, density, each with its standard deviation.",
    {{"estimate-density before.pcd after.pcd", "two scans that show dig and heap"},
     {"estimate-density dig0.ply dig1.ply --dump-before heap0.ply --dump-after heap1.ply",
      "separate scans of the dig area and of the dump area"},
     {"estimate-density before.pcd after.pcd --dug-path 45deg,0.35m,1.5m --dug-start 6.05",
      "known path: corrects for soil that fell back into the cut"},
     {"estimate-density before.pcd after.pcd --soil loam --dug-path 45deg,0.35m,1.5m --dug-start "
      "6.05 --loads loads.csv",
      "joins the density by the work of the joints; simulate-dig --history writes such a log"},
     {"estimate-density run.db3:/points@0s+2s run.db3:/points@95s+2s --tf-frame map",
      "scans out of a recording; inspect-cloud run.db3 lists what it holds"},
     {"estimate-density after.pcd --site pit --dug plan.json",
      "the next dig on a site that is remembered, planned by plan-path --site pit --json"},
     {"estimate-density --plan-survey height=2.5,offset=1.2,target=5",
      "without scans: expected density error of a D435i on a 2.5 m mast"}},
    true};

void declare(Arguments& arguments, EstimateInputs& inputs) {
  arguments.only_if(
      {[&inputs] { return !inputs.plan_survey; }, "a survey is planned by its keys alone"},
      [&] { declare_estimate(arguments, inputs); });
  declare_law(arguments, inputs.soil);
  arguments.text("plan-survey", "KEY=VALUE,..", inputs.plan_survey, survey_keys());
}

DigScans scans_of(const EstimateInputs& inputs, ScanReport& report) {
  const ScanPair whole = placed_pair(*inputs.before, *inputs.after, inputs.frames, report);
  DigScans scans{whole.before, whole.after};
  if (inputs.dump_before) {
    ScanFrames frames = inputs.frames;
    frames.before_also.clear();
    frames.after_also.clear();
    scans.dump = placed_pair(*inputs.dump_before, *inputs.dump_after, frames, report);
  }
  return scans;
}

Outcome work_on_scans(const EstimateInputs& inputs) {
  check_method(inputs.method);
  if (inputs.dump_before.has_value() != inputs.dump_after.has_value()) {
    usage_error("--dump-before and --dump-after must be given together");
  }
  ScanReport report;
  const DigScans scans = scans_of(inputs, report);
  KnownDig dig = known_dig(inputs);
  const DensityOptions& options = dig.options;
  inputs.second.apply_to(dig.law, dig.options);
  const auto by_method = [&] { return estimate(inputs.method, scans, dig.law, options); };
  const BothEstimates both =
      naming_options(estimate_options, [&] { return with_frame_hint(pair_frame_hint, by_method); });
  const DensityEstimate& counts = options.method == VolumeMethod::paper ? both.paper : both.surface;
  Outcome outcome = shown_estimate(inputs, dig, counts, {scans.before.unit, report.in_counts});
  report.add_to(outcome);
  if (inputs.method.compare) add_comparison(both, counts, outcome);
  return outcome;
}

Outcome work(const EstimateInputs& inputs) {
  if (inputs.plan_survey) {
    if (inputs.before || inputs.after) usage_error("--plan-survey takes no scans");
    return planned_survey(*inputs.plan_survey, law_named(inputs.soil.law));
  }
  if (inputs.site.is_used()) return work_on_site(inputs);
  if (!inputs.before || !inputs.after) {
    usage_error(std::string(inputs.before ? "AFTER" : "BEFORE") +
                " is missing: a cloud before the dig and one after it are needed");
  }
  return work_on_scans(inputs);
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
