// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Searches the best dig on the ground as a scan shows it, shows how far it is, and stops at ctrl-C
/// with the best dig until then: 03_search_scanned_terrain [CLOUD]

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/simulation/dig_ground.hpp>

using namespace excavplan;

namespace {

std::atomic<bool> interrupted = false;

}  // namespace

int main(int count, char** words) {
  std::signal(SIGINT, [](int) { interrupted = true; });
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));

  Scan scan;  // the pit that the dig of the quick start has left
  scan.files = {count > 1 ? words[1] : find_data_file("quickstart/after.pcd")};
  const ScannedTerrain ground = terrain_from_scan(scan, planning_extent(machine), 0.05);

  PlanOptions options;
  options.method = PlanMethod::search;
  options.search.stop.evaluations = 60;  // digs in the simulator
  options.search.progress = [](const SearchProgress& progress) {
    std::printf("\r%3d of %d digs", progress.evaluations, progress.planned);
    if (!std::isnan(progress.best)) std::printf(", best %.1f kg/kJ ", 1000.0 * progress.best);
    std::fflush(stdout);
    return !interrupted;  // false ends the search
  };
  const DigPlan plan = plan_dig(machine, loam, GroundDensity(40.0), ground.terrain, options);

  std::printf("%s\n", plan.stopped ? "stopped" : "");
  for (const Warning& warning : plan.warnings) std::printf("%s\n", warning.message.c_str());
  if (!plan.dig) {
    std::printf("%s\n", plan.reason.c_str());
    return 1;
  }
  std::printf("from x = %.2f m: lifts %.0f kg for %.1f kJ\n", plan.dig->start_x,
              plan.dig->payload_mass, plan.dig->energy / 1000.0);
}
