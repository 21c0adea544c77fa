// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/density_estimate.hpp>

#include "estimate_density/estimate_outcome.hpp"
#include "estimate_density/estimate_plots.hpp"
#include "estimate_density/method_inputs.hpp"
#include "estimate_density/second_densities.hpp"
#include "estimate_density/site_estimate.hpp"
#include "estimate_density/soil_inputs.hpp"
#include "estimate_density/survey_map_names.hpp"
#include "estimate_density/survey_planning.hpp"
#include "frame/tool.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/recordings.hpp"
#include "inputs/scans.hpp"

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

struct Inputs {
  std::optional<std::string> before, after;
  std::optional<std::string> dump_before;
  std::optional<std::string> dump_after;
  ScanFrames frames;
  DensityOptions options;
  MethodInputs method;
  bool still = false;
  std::optional<std::string> plan_survey;
  SoilInputs soil;
  SecondDensities second;
  SiteEstimateInputs site;
  Plots plots;
  Maps maps;
  std::optional<std::string> report;
};

void declare_estimate(Arguments& arguments, Inputs& inputs) {
  arguments.positional("BEFORE", inputs.before,
                       "cloud before the dig: PCD, PLY, LAS or XYZ, or " +
                           std::string(recording_form) +
                           "; one cloud alone is that after it, on a --site");
  arguments.positional("AFTER", inputs.after, "cloud after the dig");
  arguments.file("dump-before", inputs.dump_before,
                 "cloud of the dump area before; BEFORE and AFTER then show the dig area only");
  arguments.file("dump-after", inputs.dump_after, "cloud of the dump area after");
  arguments.option("area", inputs.frames.area,
                   "ignore points outside this area (default: where both scans have points)");
  arguments.option("dig-area", inputs.options.change.dig_area,
                   "area of the hole (default: detected)");
  arguments.option("dump-area", inputs.options.change.dump_area,
                   "area of the heap (default: detected)");
  declare_frames(arguments, inputs.frames);
  declare_units(arguments, inputs.frames);
  declare_method(arguments, inputs.method);
  arguments.flag("no-register", inputs.still,
                 "do not look for a motion of the sensor between the scans: there was none");
  arguments.option("cell", inputs.options.cell_size, Quantity::length,
                   "cell size of the height map, voxel size of --method paper (default: from the "
                   "point density, at least 0.05)");
  declare_soil(arguments, inputs.soil);
  arguments.only_if({[&inputs] { return inputs.method.uses("surface"); },
                     "--method paper has no error to weigh a second density by"},
                    [&] { inputs.second.declare(arguments); });
  declare_dug_path(arguments, inputs.method);
  declare_site(arguments, inputs.site);
  declare_machine_in_view(arguments, inputs.frames.view);
  declare_plots(arguments, inputs.plots, names_of(estimate_figures()));
  declare_maps(arguments, inputs.maps, survey_map_names(inputs.dump_before));
  arguments.report(inputs.report);
}

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.only_if(
      {[&inputs] { return !inputs.plan_survey; }, "a survey is planned by its keys alone"},
      [&] { declare_estimate(arguments, inputs); });
  declare_law(arguments, inputs.soil);
  arguments.text("plan-survey", "KEY=VALUE,..", inputs.plan_survey, survey_keys());
}

DigScans scans_of(const Inputs& inputs, ScanReport& report) {
  const ScanPair whole = placed_pair(*inputs.before, *inputs.after, inputs.frames, report);
  DigScans scans{whole.before, whole.after};
  if (inputs.dump_before) {
    scans.dump = placed_pair(*inputs.dump_before, *inputs.dump_after, inputs.frames, report);
  }
  return scans;
}

/// What is known of the dig beside its scans.
struct KnownDig {
  Machine machine;
  DensityOptions options;
  DensityLaw law;
};

KnownDig known_dig(const Inputs& inputs) {
  KnownDig dig{machine_named(inputs.frames.view.machine), inputs.options, {}};
  dig.options.registered = !inputs.still;
  apply_method(inputs.method, dig.machine, dig.options);
  dig.law = law_of(inputs.soil, inputs.frames.view.machine, dig.options);
  return dig;
}

/// A result with all that is asked to be shown of it.
Outcome shown_estimate(const Inputs& inputs, const KnownDig& dig, const DensityEstimate& counts,
                       const TakenUnits& units) {
  Outcome outcome = estimate_outcome(counts, dig.options.soil);
  add_machine_warnings(counts, dig.law, dig.machine, units, outcome);
  inputs.second.check(counts, outcome);
  draw_estimate(inputs.plots, inputs.report, counts, outcome);
  write_maps(
      inputs.maps, [&] { return survey_maps(counts.change, counts.before); }, outcome);
  return outcome;
}

Outcome work_on_scans(const Inputs& inputs) {
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

void check_site(const Inputs& inputs) {
  const auto refuse_if = [](bool is_given, const char* what) {
    if (is_given) usage_error(std::string("--site excludes ") + what);
  };
  refuse_if(inputs.method.uses("paper"), "--method paper: the ground is known by its surface");
  refuse_if(inputs.dump_before || inputs.dump_after,
            "--dump-before and --dump-after: a site is one scene");
  refuse_if(inputs.second.prior.has_value(), "--prior: the site knows the digs before");
  refuse_if(inputs.soil.soil == "unknown", "--soil unknown: a site is of one soil");
}

Outcome work_on_site(const Inputs& inputs) {
  check_site(inputs);
  if (!inputs.before && !inputs.after) return site_outcome(inputs.site);
  if (inputs.site.undo) usage_error("--undo takes no scans");
  ScanReport report;
  SiteEvent event;
  if (inputs.after) {
    ScanPair pair = placed_pair(*inputs.before, *inputs.after, inputs.frames, report);
    event.before = std::move(pair.before);
    event.scan = std::move(pair.after);
  } else {
    event.scan = placed_scan(*inputs.before, inputs.frames, report);
  }
  KnownDig dig = known_dig(inputs);
  event.options = dig.options;
  add_told_dig(inputs.site, dig.machine, event);
  inputs.second.apply_to(dig.law, event.options);
  const SiteSettings settings = {
      *dig.options.soil.kind, dig.machine, dig.law, inputs.options.cell_size, {}};
  excavplan::Site site(*inputs.site.at.folder, settings, access_of(inputs.site));
  const SiteUpdate update = naming_options(estimate_options, [&] {
    return with_frame_hint("--after-frame transforms it into the frame of the site",
                           [&] { return told_site(inputs.site, site, event); });
  });
  Outcome outcome;
  if (update.estimate) {
    outcome = shown_estimate(inputs, dig, *update.estimate, {event.scan.unit, report.in_counts});
  }
  add_site(site, update, outcome);
  report.add_to(outcome);
  return outcome;
}

Outcome work(const Inputs& inputs) {
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
