// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/site_estimate.hpp"

#include <algorithm>
#include <chrono>

#include <excavplan/results/stated_dig.hpp>

#include "base/text.hpp"

namespace excavplan::tools {
namespace {

double now() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since_1970).count();
}

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

}  // namespace

void declare_site(Arguments& arguments, SiteEstimateInputs& inputs) {
  declare_site_folder(arguments, inputs.at,
                      "remember ground and density in this folder, which is made if it is not "
                      "there: BEFORE is then not needed after the first scan; alone: show what "
                      "it holds");
  const Arguments::Use used = {[&inputs] { return inputs.is_used(); }, "it is of --site"};
  arguments.only_if(used, [&] {
    arguments.file("dug", inputs.dug,
                   "the dig between the scans: a result of plan-path or simulate-dig --json, "
                   "for its path, start, foretold work and stall");
    arguments.flag("no-dig", inputs.no_dig, "nothing was dug: the scan shows the ground alone");
    arguments.flag("stalled", inputs.stalled, "the dig was given up: the ground is strong");
    arguments.flag("no-update", inputs.no_update, "leave the site as it is");
    arguments.flag("undo", inputs.undo, "take the last update of the site back; without scans");
    arguments.option("time", inputs.time, Quantity::time,
                     "when AFTER was scanned, since 1970-01-01 UTC (default: now)");
  });
  arguments.exclude("undo", {"no-update", "dug", "no-dig", "stalled", "time"});
  arguments.exclude("no-dig", {"dug", "stalled"});
}

void add_told_dig(const SiteEstimateInputs& inputs, const Machine& machine, SiteEvent& event) {
  event.base = base_of(inputs.at);
  event.dug = !inputs.no_dig;
  event.time = inputs.time ? *inputs.time : now();
  event.stalled = inputs.stalled;
  if (!inputs.dug) return;
  if (event.options.dug_path) usage_error("--dug and --dug-path both tell the path: give one");
  const StatedDig told = stated_dig(*inputs.dug);
  event.options.dug_path = DugPath{machine, told.path, told.start_x};
  event.stalled = event.stalled || told.stalled;
  if (told.is_plan && told.joint_work > 0.0) {
    event.foretold = ForetoldDig{told.density_percent, told.joint_work};
  }
}

SiteAccess access_of(const SiteEstimateInputs& inputs) {
  return inputs.no_update ? SiteAccess::read : SiteAccess::write;
}

SiteUpdate told_site(const SiteEstimateInputs& inputs, excavplan::Site& site,
                     const SiteEvent& event) {
  return inputs.no_update ? site.look(event) : site.update(event);
}

void add_site(const excavplan::Site& site, const SiteUpdate& update, Outcome& outcome) {
  if (!update.estimate) {
    outcome.json = {{"volume", nullptr}, {"bulking_factor", nullptr}, {"density_percent", nullptr}};
  }
  for (const Warning& each : update.warnings) {
    const auto same = [&](const Warning& known) { return known.message == each.message; };
    const auto& known = outcome.warnings;
    if (std::none_of(known.begin(), known.end(), same)) outcome.warnings.push_back(each);
  }
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

}  // namespace excavplan::tools
