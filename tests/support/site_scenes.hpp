// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "support/site_ground.hpp"
#include "support/site_sensing.hpp"

/// @file
/// All families of scenes of what a site brings.

namespace excavplan::scenes {

/// A family of scenes and how one of them is made.
struct Family {
  std::string name;
  void (*shape)(Draft&);
};

inline const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"clean", [](Draft&) {}},
      {"second-heap", second_heap},
      {"second-scrape", second_scrape},
      {"two-pits", two_pits},
      {"two-pits-two-heaps", two_pits_two_heaps},
      {"two-heaps-alike", two_heaps_alike},
      {"ruts-joined", ruts_joined},
      {"rut-shallow", rut_shallow},
      {"ruts-apart", ruts_apart},
      {"berms-joined", berms_joined},
      {"churned", churned},
      {"crate-on-heap", crate_on_heap},
      {"crate-in-pit", crate_in_pit},
      {"clods", clods},
      {"water", water},
      {"water-even", water_even},
      {"lawn", lawn},
      {"grass", grass},
      {"pressed", pressed},
      {"heap-at-wall", heap_at_wall},
      {"lidar-one", lidar_one},
      {"lidar-untold", lidar_untold},
      {"lidar-untold-low", lidar_untold_low},
      {"lidar-untold-two", lidar_untold_two},
      {"lidar-untold-thinned", lidar_untold_thinned},
      {"lidar-one-low", lidar_one_low},
      {"lidar-two", lidar_two},
      {"rings32", rings32},
      {"rings64", rings64},
      {"rings128", rings128},
      {"sparse", sparse},
      {"lattice", lattice},
      {"stripes", stripes},
      {"units-mm", units_mm},
      {"units-cm", units_cm},
      {"one-scan-mm", one_scan_mm},
      {"tilted", tilted},
      {"camera-frame", camera_frame},
      {"moved", moved_far},
      {"swapped", swapped},
      {"swapped-areas", swapped_areas},
      {"offsets", offsets},
      {"crate-apart", crate_apart},
      {"steep-ground", steep_ground},
      {"heap-spread", heap_spread},
      {"thin-dig", thin_dig},
      {"dug-again", dug_again},
  };
  return all;
}

/// A scene of the family: another for every seed, and for equal seeds another in every family.
/// @param points in a cloud, where the family leaves them open
inline SiteScene site_scene(const Family& family, std::uint64_t seed, std::size_t points) {
  std::uint64_t of_name = 14695981039346656037ULL;  // FNV-1a
  for (const char letter : family.name) {
    of_name = (of_name ^ static_cast<unsigned char>(letter)) * 1099511628211ULL;
  }
  Draft draft(of_name ^ seed);
  draft.scene.sampling.points = points;
  family.shape(draft);
  return draft.scene;
}

}  // namespace excavplan::scenes
