// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/attribution.hpp"

#include "change/change_zones.hpp"

namespace excavplan {
namespace {

using Chosen = std::vector<bool>;

Chosen zones_of_kind(const Area& area, ZoneKind kind) {
  Chosen chosen(area.zones.size());
  for (std::size_t z = 0; z < chosen.size(); ++z) chosen[z] = area.kinds[z] == kind;
  return chosen;
}

double volume_of_kind(const Area& area, ZoneKind kind) {
  double volume = 0.0;
  for (std::size_t z = 0; z < area.zones.size(); ++z) {
    if (area.kinds[z] == kind) volume += area.zones[z].volume;
  }
  return volume;
}

/// Where nothing rose away from the hole, but the largest rise beside it could hold the dug soil,
/// that is the heap.
void find_heap_beside(Area& area) {
  if (volume_of_kind(area, ZoneKind::dump) > 0.0) return;
  std::size_t largest = area.zones.size();
  for (std::size_t z = 0; z < area.zones.size(); ++z) {
    if (area.kinds[z] != ZoneKind::spill) continue;
    if (largest == area.zones.size() || area.zones[z].volume > area.zones[largest].volume) {
      largest = z;
    }
  }
  if (largest == area.zones.size()) return;
  const double hole = -volume_of_kind(area, ZoneKind::dig);
  if (area.zones[largest].volume >= least_after_share * hole) area.kinds[largest] = ZoneKind::dump;
}

void set_kinds(std::vector<Area>& areas, const Attribution& attribution,
               const ChangeOptions& options) {
  if (attribution.combinations.empty()) return;
  const std::vector<bool>& counted = attribution.combinations.front().counted;
  const auto for_each_counted = [&](auto visit) {
    for (std::size_t i = 0; i < counted.size(); ++i) {
      if (!counted[i]) continue;
      for (const Change::Place& p : attribution.changes[i].zones) visit(areas[p.area], p.zone);
    }
  };
  for_each_counted([&](Area& area, std::size_t z) {
    if (area.zones[z].volume < 0.0) area.kinds[z] = ZoneKind::dig;
  });
  const Chosen beside = zones_near(areas[0].ground.zone, zones_of_kind(areas[0], ZoneKind::dig),
                                   options.spill_distance / areas[0].grid.cell_size);
  for_each_counted([&](Area& area, std::size_t z) {
    if (area.zones[z].volume < 0.0) return;
    const Eigen::Vector2d& at = area.zones[z].centre;
    const bool is_dumped = &area != areas.data() || !beside[z] ||
                           (options.dump_area && options.dump_area->contains(at.x(), at.y()));
    area.kinds[z] = is_dumped ? ZoneKind::dump : ZoneKind::spill;
  });
  if (areas.size() == 1 && !options.dump_area) find_heap_beside(areas[0]);
}

}  // namespace

Attribution attribute(std::vector<Area>& areas, const ChangeOptions& options) {
  Attribution attribution;
  attribution.changes = read_changes(areas, options);
  attribution.combinations = combinations_of(attribution.changes);
  set_probabilities(attribution.combinations, attribution.changes);
  set_kinds(areas, attribution, options);
  return attribution;
}

}  // namespace excavplan
