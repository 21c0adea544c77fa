// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// A controller without knowledge of its soil: it plans a dig, digs, scans, estimates the density
/// and plans the next dig on the ground as it is left. The simulator and its camera replace
/// the machine here: substitute your own in their two lines.

#include <cstdio>
#include <memory>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/density/density_estimate.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/simulation/dig_ground.hpp>

using namespace excavplan;

namespace {

constexpr double true_density = 60.0;  ///< known to the simulator only [%]
constexpr int digs = 3;

Scan scan_of(std::vector<Eigen::Vector3d> points) {
  Cloud cloud;
  cloud.width = points.size();
  cloud.points = std::move(points);
  Scan scan;
  scan.clouds = {std::make_shared<const Cloud>(std::move(cloud))};
  return scan;
}

void print(const char* about, const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings) {
    std::printf("  %s: %s\n", about, warning.message.c_str());
  }
}

}  // namespace

int main() {
  const Machine machine = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const DensityLaw law = load_density_law(find_data_file("laws/zx120-loam.json"));
  const Rectangle scene_area = scene_extent(machine, default_dump_point());

  Terrain ground = undisturbed(flat_ground(scene_area, 0.05));  // as it is
  Terrain seen = level_planning_ground(machine);                // as the last scan shows it
  GroundDensity density(50.0, 25.0);
  PlanOptions options;
  options.method = PlanMethod::search;
  for (int dig = 1; dig <= digs; ++dig) {
    const DigPlan plan = plan_dig(machine, loam, density, seen, options);
    if (!plan.dig) {
      std::printf("%s\n", plan.reason.c_str());
      return 1;
    }
    // A machine on site should stop here; the simulator cannot come to harm.
    if (!plan.trustworthy) print("doubt about the plan", plan.warnings);

    SceneOptions driven;  // the machine follows plan.trajectory
    driven.path = plan.dig->parameters;
    driven.start_x = plan.dig->start_x;
    const DigScene scene = run_scene(machine, loam, true_density, ground, driven);
    SceneScans scans = scan_scene(scene, DepthCamera(), static_cast<std::uint64_t>(dig));

    const DigScans pair = {scan_of(std::move(scans.before)), scan_of(std::move(scans.after)), {}};
    const DensityEstimate estimate = estimate_density(pair, law);
    std::printf("dig %d: planned for %.1f +- %.1f %%, lifted %.0f kg for %.1f kJ\n", dig,
                density.percent, density.sd_percent, scene.dig.payload_mass,
                scene.dig.energy.total / 1000.0);
    if (estimate.trustworthy) {
      density = *estimate.ground_density();
    } else {
      print("density not used", estimate.warnings);
    }
    seen = terrain_from_scan(pair.after, planning_extent(machine), 0.05).terrain;
    ground = scene.after;
  }
  std::printf("density %.1f +- %.1f %%\n", density.percent, density.sd_percent);
}
