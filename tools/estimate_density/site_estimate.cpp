// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/site_estimate.hpp"

#include <excavplan/results/stated_dig.hpp>

#include "base/text.hpp"
#include "inputs/named_kinds.hpp"

namespace excavplan::tools {
namespace {

std::string counted(const excavplan::Site& site) {
  return std::to_string(site.updates()) + " scans, " + std::to_string(site.digs()) +
         " digs with a density";
}

/// Figures of the ground as it is known.
nlohmann::ordered_json ground_json(const GroundState& ground) {
  const Terrain& terrain = ground.terrain;
  const HeightMap& bank = terrain.bank;
  const Rectangle extent = bank.extent();
  const double area = bank.cell_size * bank.cell_size;
  const auto known = !bank.z.isNaN();
  return {{"frame", ground.frame},
          {"soil", ground.soil},
          {"cells", {bank.z.rows(), bank.z.cols()}},
          {"extent_m", {extent.x_min, extent.y_min, extent.x_max, extent.y_max}},
          {"seen_m2", area * static_cast<double>(known.count())},
          {"loose_m3", area * known.select(terrain.loose, 0.0).sum()}};
}

void add_told_dig(const SiteEstimateInputs& inputs, const Machine& machine, SiteEvent& event) {
  event.base = base_of(inputs.at);
  event.dug = !inputs.no_dig;
  event.stalled = inputs.stalled;
  if (inputs.dump_at && !inputs.dug) usage_error("--dump-at needs --dug");
  if (!inputs.dug) return;
  if (event.options.dug_path) usage_error("--dug and --dug-path both tell the path: give one");
  const StatedDig told = stated_dig(*inputs.dug);
  event.options.dug_path =
      DugPath{machine, told.path, told.start_x, {}, inputs.dump_at ? inputs.dump_at : told.dump_at};
  event.stalled = event.stalled || told.stalled;
  if (told.is_plan && told.joint_work > 0.0) {
    event.foretold = ForetoldDig{told.density_percent, told.joint_work};
  }
}

void add_site(const excavplan::Site& site, const SiteUpdate& update, Outcome& outcome) {
  if (!update.estimate) {
    outcome.json = {{"volume", nullptr}, {"bulking_factor", nullptr}, {"density_percent", nullptr}};
  }
  add_new(update.warnings, outcome.warnings);
  outcome.trustworthy = outcome.trustworthy && update.trustworthy;
  outcome.json["trustworthy"] = outcome.trustworthy;
  outcome.json["site"] = site_json(site, update.density);
  outcome.json["site"]["digs"] = update.digs;
  outcome.json["site"]["taken"] = update.taken;
  outcome.json["site"]["ground"] =
      site.is_empty() ? nlohmann::ordered_json() : ground_json(site.ground());
  outcome.lines.push_back(
      "site         " + counted(site) +
      (update.density ? "; density where it dug " +
                            readable(update.density->percent, update.density->sd_percent) + " %"
                      : ""));
}

Outcome site_outcome(const SiteEstimateInputs& inputs) {
  excavplan::Site site(*inputs.at.folder, {});  // is there
  if (inputs.undo) {
    site = excavplan::Site(*inputs.at.folder, {}, SiteAccess::write);
    site.undo();
  }
  Outcome outcome;
  outcome.lines.push_back((inputs.undo ? "undone       " : "site         ") + counted(site));
  outcome.json["site"] = site_json(site, std::nullopt);
  if (site.is_empty()) return outcome;
  const nlohmann::ordered_json ground = ground_json(site.ground());
  outcome.json["site"]["ground"] = ground;
  outcome.lines.push_back("ground       " + readable(ground["seen_m2"].get<double>()) +
                          " m2 seen, " + readable(ground["loose_m3"].get<double>()) +
                          " m3 of loose soil");
  return outcome;
}

void check_site(const EstimateInputs& inputs) {
  const auto refuse_if = [](bool is_given, const char* what) {
    if (is_given) usage_error(std::string("--site excludes ") + what);
  };
  refuse_if(inputs.method.uses("paper"), "--method paper: the ground is known by its surface");
  refuse_if(inputs.dump_before || inputs.dump_after,
            "--dump-before and --dump-after: a site is one scene");
  refuse_if(inputs.second.prior.has_value(), "--prior: the site knows the digs before");
  refuse_if(inputs.soil.soil == "unknown", "--soil unknown: a site is of one soil");
}

}  // namespace

Outcome work_on_site(const EstimateInputs& inputs) {
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
  if (!dig.options.soil.kind) usage_error("--site with a --law of an unknown soil needs --soil");
  event.options = dig.options;
  event.time = time_of(inputs.site.time, report);
  add_told_dig(inputs.site, dig.machine, event);
  inputs.second.apply_to(dig.law, event.options);
  const SiteSettings settings = {
      *dig.options.soil.kind, dig.machine, dig.law, inputs.options.cell_size, {}};
  excavplan::Site site(*inputs.site.at.folder, settings,
                       inputs.site.no_update ? SiteAccess::read : SiteAccess::write);
  const SiteUpdate update = naming_options(estimate_options, [&] {
    return with_frame_hint("--after-frame transforms it into the frame of the site", [&] {
      return inputs.site.no_update ? site.look(event) : site.update(event);
    });
  });
  Outcome outcome;
  if (update.estimate) {
    outcome = shown_estimate(inputs, dig, *update.estimate, {event.scan.unit, report.in_counts});
  }
  add_site(site, update, outcome);
  report.add_to(outcome);
  return outcome;
}

}  // namespace excavplan::tools
