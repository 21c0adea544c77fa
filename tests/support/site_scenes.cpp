// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/site_scenes.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace excavplan::scenes {

const std::vector<Family>& families() {
  using K = ChangeKind;
  using Codes = std::vector<std::string>;
  const Codes open = {"attribution_open"};
  const Codes unseen = {"zone_partly_unseen", "zone_unseen"};
  const Codes things = {"object_on_soil", "object_taken_out", "zone_partly_unseen",
                        "attribution_open"};
  const Codes meaning = {"units", "frame", "tilted", "refused"};
  const std::vector<K> tracks = {K::ruts, K::berms, K::edge, K::settled};
  static const std::vector<Family> all = {
      {"clean", [](Draft&) {}},
      {"second-heap", second_heap, open, {K::second_heap}},
      {"second-scrape", second_scrape, open, {K::second_hole, K::ruts, K::settled}},
      {"two-pits", two_pits, open, {K::hole, K::second_hole, K::spill}},
      {"two-pits-two-heaps", two_pits_two_heaps, open, {K::hole, K::second_hole, K::second_heap}},
      {"two-heaps-alike", two_heaps_alike, open, {K::second_heap}},
      {"ruts-joined", ruts_joined, open, tracks},
      {"rut-shallow", rut_shallow, open, tracks},
      {"ruts-apart", ruts_apart, open, tracks},
      {"berms-joined", berms_joined, open, tracks},
      {"churned", churned, {"stirred_ground"}, {K::stirred}},
      {"crate-on-heap", crate_on_heap, things, {K::thing, K::lump}},
      {"crate-in-pit", crate_in_pit, things, {K::thing, K::lump}},
      {"clods", clods, open, {K::clods, K::lump, K::thing, K::small_rises}},
      {"water", water, {"flat_water"}, {K::water}},
      {"water-even", water_even, {"flat_water"}, {K::water}},
      {"lawn", lawn, {"grass"}},
      {"grass", grass, {"grass"}},
      {"pressed", pressed, {}, {K::pressed}},
      {"heap-at-wall", heap_at_wall, unseen},
      {"lidar-one", lidar_one, unseen},
      {"lidar-untold", lidar_untold, unseen},
      {"lidar-untold-low", lidar_untold_low, unseen},
      {"lidar-untold-two", lidar_untold_two, unseen},
      {"lidar-untold-thinned", lidar_untold_thinned, unseen},
      {"lidar-one-low", lidar_one_low, unseen},
      {"lidar-two", lidar_two, unseen},
      {"rings32", rings32, unseen},
      {"rings64", rings64, unseen},
      {"rings128", rings128, unseen},
      {"rings16", rings16, unseen},
      {"rings16-two", rings16_two, unseen},
      {"rings32-two", rings32_two, unseen},
      {"rings128-two", rings128_two, unseen},
      {"outliers", outliers},
      {"outliers-rough", outliers_rough},
      {"outliers-lidars", outliers_lidars, unseen},
      {"flying", flying},
      {"multipath", multipath},
      {"no-data", no_data},
      {"strewn-none", strewn_none},
      {"strewn-layer", strewn_layer},
      {"strewn-crumbs", strewn_crumbs},
      {"strewn-by-wheels", strewn_by_wheels},
      {"level-floor", level_floor, {}, {K::water}},
      {"back-over-rim", back_over_rim},
      {"foreign-berm", foreign_berm, open, {K::second_heap, K::spill}},
      {"bucket-rests", bucket_rests, things, {K::thing, K::lump}},
      {"crate-before", crate_before, things, {K::thing, K::lump}},
      {"sparse", sparse},
      {"lattice", lattice},
      {"stripes", stripes},
      {"units-mm", units_mm, meaning},
      {"units-cm", units_cm, meaning},
      {"one-scan-mm", one_scan_mm, meaning},
      {"tilted", tilted, meaning},
      {"camera-frame", camera_frame, meaning},
      {"moved", moved_far, {"registration_beyond_prior"}},
      {"swapped", swapped, {"looks_swapped", "refused"}},
      {"swapped-areas", swapped_areas, {"looks_swapped", "refused"}},
      {"offsets", offsets},
      {"crate-apart", crate_apart, things, {K::thing, K::lump, K::small_rises, K::clods}},
      {"steep-ground", steep_ground},
      {"heap-spread", heap_spread},
      {"thin-dig", thin_dig},
      {"dug-again", dug_again},
      {"scrape-like-rut", scrape_like_rut, open, {K::ruts, K::second_hole, K::settled}},
      {"lump", lump, open, {K::lump, K::thing, K::clods, K::small_rises}},
      {"steep-heap", steep_heap, open, {K::lump, K::thing, K::second_heap}},
      {"hard-second-heap",
       hard_second_heap,
       {"attribution_open", "density_above_range"},
       {K::second_heap}},
      {"over-old-spill", over_old_spill, {"earlier_soil"}, {K::earlier_soil}},
  };
  return all;
}

SiteScene site_scene(const Family& family, std::uint64_t seed, std::size_t points) {
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
