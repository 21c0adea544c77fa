// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// A controller without knowledge of its soil: it scans, plans, digs and scans again, while a site
/// remembers ground and density. The simulator and its camera replace the machine here: substitute
/// your own in scan() and dig().
///
///   05_dig_cycle [FOLDER]    of the site, which must be new; without one it is not kept

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <excavplan/base/data_files.hpp>
#include <excavplan/sensing/sensor_setup.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/site/plan_on_site.hpp>

using namespace excavplan;

namespace {

constexpr double true_density = 40.0;  ///< known to the simulator only [%]
constexpr int digs = 3;
const Eigen::Vector2d dump_at(3.5, 3.5);  ///< in sight of the camera [m]

/// What is told after a scan; the frame of the site is that of the machine where it stands.
SiteEvent scan(const Terrain& ground, int number) {
  SiteEvent event;
  const double dump = std::atan2(dump_at.y(), dump_at.x());
  for (PlacedScan& look :
       look_at(ground.surface(), sensor_setup_of_word("boom-camera"),
               {0.0, dump - 0.25, dump + 0.25}, static_cast<std::uint64_t>(number))) {
    auto cloud = std::make_shared<Cloud>();
    cloud->sensor_origin = look.place;
    cloud->width = look.points.size();
    cloud->points = std::move(look.points);
    event.scan.clouds.push_back(std::move(cloud));
  }
  event.scan.z_is_up = true;
  event.time = 60.0 * number;  // [s]; of the clock on site
  event.dug = false;
  return event;
}

/// The machine follows plan.trajectory; the simulator does so and leaves scene.after.
DigScene dig(const SiteSettings& site, const Terrain& ground, const PlannedDig& planned) {
  SceneOptions driven;
  driven.path = planned.parameters;
  driven.start_x = planned.start_x;
  driven.dump_at = dump_at;
  return run_scene(site.machine, site.soil, true_density, ground, driven);
}

void print(const char* about, const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings) {
    std::printf("  %s: %s\n", about, warning.message.c_str());
  }
}

int run(const std::string& folder) {
  const SiteSettings settings = {load_soil(find_data_file("soils/loam.json")),
                                 load_machine(find_data_file("machines/zx120.json")),
                                 load_density_law(find_data_file("laws/zx120-loam.json")),
                                 {},
                                 {}};
  Terrain ground = undisturbed(flat_ground({-2.0, -4.0, 12.0, 9.0}, 0.05));
  Site site(folder, settings, SiteAccess::write);
  site.update(scan(ground, 0));

  SitePlanOptions options;
  options.plan.method = PlanMethod::search;
  options.density = GroundDensity(50.0, 25.0);  // until a dig told one
  for (int number = 1; number <= digs; ++number) {
    const SitePlan next = plan_on_site(site, options);
    if (!next.plan.dig) {
      std::printf("%s\n", next.plan.reason.c_str());
      return 1;
    }
    // A machine on site should stop here; the simulator cannot come to harm.
    if (!next.plan.trustworthy) print("doubt about the plan", next.plan.warnings);
    const PlannedDig& planned = *next.plan.dig;
    const DigScene scene = dig(settings, ground, planned);
    ground = scene.after;
    std::printf("dig %d: planned for %.1f +- %.1f %%, lifted %.0f kg for %.1f kJ\n", number,
                next.density.percent, next.density.sd_percent, scene.dig.payload_mass,
                scene.dig.energy.total / 1000.0);

    SiteEvent event = scan(ground, number);
    event.dug = true;
    event.options.dug_path = {settings.machine, planned.parameters, planned.start_x};
    event.foretold = ForetoldDig{next.density.percent, planned.energy};
    event.stalled = scene.dig.stall.has_value();
    const SiteUpdate update = site.update(event);
    if (!update.trustworthy) print("survey not used", update.warnings);
    if (update.density) {
      std::printf("  density %.1f +- %.1f %%\n", update.density->percent,
                  update.density->sd_percent);
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) return run(argv[1]);
  std::string folder = (std::filesystem::temp_directory_path() / "excavplan-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return 1;
  const int ended = run(folder);
  std::filesystem::remove_all(folder);
  return ended;
}
