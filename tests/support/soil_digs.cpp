// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/soil_digs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace excavplan::test {

VolumeChange measured(const HeightMapVolumes& truth, double error, Random& random) {
  VolumeChange change;
  int i = 0;
  const auto measure = [&](double volume) {
    const double sd = error * volume;
    change.errors.noise(i, i) = sd * sd;
    ++i;
    return Measured{volume + sd * random.normal(), sd};
  };
  change.excavated = change.before = measure(truth.excavated);
  change.spilled = measure(truth.spilled);
  change.dumped = measure(truth.dumped);
  change.after = {change.spilled.value + change.dumped.value,
                  std::hypot(change.spilled.sd, change.dumped.sd)};
  return change;
}

DigParameters random_path(bool outside, Random& random) {
  const double angle = outside ? random.uniform(0.3, 1.3) : random.uniform(0.5, 1.1);
  const double penetration = outside ? random.uniform(0.1, 0.8) : random.uniform(0.2, 0.6);
  const double drag = outside ? random.uniform(0.3, 3.2) : random.uniform(0.8, 2.5);
  const bool inside = angle > 0.5 && angle < 1.1 && penetration > 0.2 && penetration < 0.6 &&
                      drag > 0.8 && drag < 2.5;
  return outside && inside ? random_path(outside, random) : DigParameters{angle, penetration, drag};
}

SoilDig random_dig(const Machine& machine, const SoilKind& kind, std::uint64_t seed,
                   const SoilDigOptions& options) {
  Random random(seed, 77);
  SoilDig dig;
  dig.soil = drawn_soil(kind, options.scatter, random.bits());
  dig.soil.water_content = std::max(0.0, dig.soil.water_content + options.more_water);
  dig.soil.specific_gravity += options.more_particle_density;
  dig.density_percent = options.density_percent.value_or(random.uniform(0.0, 100.0));
  const Eigen::Vector2d dump_at = default_dump_point();
  const Terrain ground = undisturbed(flat_ground(scene_extent(machine, dump_at), 0.05));
  while (true) {
    dig.path = options.path ? *options.path : random_path(options.path_outside, random);
    SceneOptions scene;
    scene.simulator = options.simulator;
    scene.path = dig.path;
    try {
      const DigScene dug =
          run_scene(that_never_stalls(machine), dig.soil, dig.density_percent, ground, scene);
      dig.change = measured(dug.volumes, options.volume_error, random);
      const double sd = options.mass_error * dug.dig.payload_mass;
      dig.payload_mass = {dug.dig.payload_mass + sd * random.normal(), sd};
      return dig;
    } catch (const Error&) {
      if (options.path) throw;
    }
  }
}

DensityEstimate estimate_of(DensityEstimate known, const DensityLaw& law,
                            const DensityOptions& options) {
  known.bulking = bulking_factor(known.change);
  const LawsForDig laws = laws_for_dig(law, options, known.fallback);
  set_density(known, laws, options);
  return known;
}

DensityEstimate estimate_of(const VolumeChange& change, const DensityLaw& law,
                            const DensityOptions& options) {
  DensityEstimate known;
  known.change = change;
  return estimate_of(std::move(known), law, options);
}

}  // namespace excavplan::test
