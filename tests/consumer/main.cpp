// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <variant>

#include <excavplan/data_files.hpp>
#include <excavplan/error.hpp>
#include <excavplan/library/path_library.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

int main() {
  using namespace excavplan;
  try {
    const Machine machine = load_machine(find_data_file("machines/zx120.json"));
    const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
    const double density_percent = 40.0;  // from estimate-density, or measured otherwise

    // Look the dig up: the best one for this density on level ground.
    PlannedDig dig =
        look_up(load_path_library(find_data_file("libraries/zx120-loam.json")), density_percent);

    // Or search it on the ground as it is; undisturbed(height_map) makes a Terrain of your own map.
    const Terrain ground = level_planning_ground(machine);
    const HeightMapSimulator simulator(machine, loam, density_percent);
    DigSearchOptions options;
    options.start = {dig.parameters};
    options.stop.evaluations = 60;  // enough from a good start; some 100 from nothing
    if (const auto found = search_dig(machine, simulator, ground, options)) dig = found->dig;

    // What the joints have to do.
    const auto path =
        make_dig_path(machine, dig.parameters, dig.start_x, boom_plane_profile(ground.surface()));
    if (const auto* reason = std::get_if<Infeasible>(&path)) {
      std::printf("cannot be driven: %s\n", reason->message.c_str());
      return 1;
    }
    const Trajectory trajectory = time_dig_path(machine, std::get<DigPath>(path));
    std::printf("lifts %.0f kg for %.1f kJ in %.1f s\n", dig.payload_mass, dig.energy / 1000.0,
                trajectory.dig_duration());
    for (const TrajectoryPoint& point : trajectory.points) {
      std::printf("%.3f s: boom %.3f, arm %.3f, bucket %.3f rad\n", point.time, point.joints(0),
                  point.joints(1), point.joints(2));
    }
  } catch (const Error& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
