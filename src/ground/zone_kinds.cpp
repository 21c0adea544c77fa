// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/zone_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace excavplan {
namespace {

bool any(const Chosen& chosen) {
  return std::find(chosen.begin(), chosen.end(), true) != chosen.end();
}

/// The zones that changed in the direction of `sign` and that `wanted` accepts.
template <typename Wanted>
Chosen choose(const Area& area, double sign, Wanted wanted) {
  Chosen chosen(area.zones.size(), false);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    chosen[i] = sign * area.zones[i].volume > 0.0 && wanted(i);
  }
  return chosen;
}

Chosen near(const Area& area, const Chosen& chosen, const ChangeOptions& options) {
  return zones_near(area.ground.zone, chosen, options.spill_distance / area.grid.cell_size);
}

/// The given area's zones, or else the largest candidate and the candidates near to it.
Chosen main_zones(const Area& area, double sign, const Chosen& candidates,
                  const std::optional<Rectangle>& place, const ChangeOptions& options) {
  if (place) {
    return choose(area, sign, [&](std::size_t i) {
      return candidates[i] && place->contains(area.zones[i].centre.x(), area.zones[i].centre.y());
    });
  }
  std::size_t largest = candidates.size();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i]) continue;
    if (largest == candidates.size() ||
        sign * area.zones[i].volume > sign * area.zones[largest].volume) {
      largest = i;
    }
  }
  Chosen chosen(candidates.size(), false);
  if (largest == candidates.size()) return chosen;
  chosen[largest] = true;
  const Chosen beside = near(area, chosen, options);
  return choose(area, sign, [&](std::size_t i) { return candidates[i] && beside[i]; });
}

double volume_of(const Area& area, const Chosen& chosen) {
  double volume = 0.0;
  for (std::size_t i = 0; i < chosen.size(); ++i) volume += chosen[i] ? area.zones[i].volume : 0.0;
  return volume;
}

void set_kind(Area& area, const Chosen& chosen, ZoneKind kind) {
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i]) area.kinds[i] = kind;
  }
}

}  // namespace

Chosen classify_hole(Area& area, const ChangeOptions& options) {
  const auto all = [](std::size_t) { return true; };
  Chosen hole = main_zones(area, -1.0, choose(area, -1.0, all), options.dig_area, options);
  if (!any(hole)) return hole;
  Chosen beside = near(area, hole, options);
  set_kind(area, choose(area, 1.0, [&](std::size_t i) { return beside[i]; }), ZoneKind::spill);
  set_kind(area, hole, ZoneKind::dig);
  return beside;
}

void classify_scene(Area& area, const ChangeOptions& options) {
  const Chosen beside = classify_hole(area, options);
  if (!any(beside)) return;
  const Chosen away =
      choose(area, 1.0, [&](std::size_t i) { return options.dump_area || !beside[i]; });
  Chosen heap = main_zones(area, 1.0, away, options.dump_area, options);
  if (!any(heap) && !options.dump_area) {
    ChangeOptions alone = options;
    alone.spill_distance = 0.0;
    const Chosen risen_beside = choose(area, 1.0, [&](std::size_t i) { return beside[i]; });
    heap = main_zones(area, 1.0, risen_beside, std::nullopt, alone);
    const Chosen hole =
        choose(area, -1.0, [&](std::size_t i) { return area.kinds[i] == ZoneKind::dig; });
    if (volume_of(area, heap) < -least_after_share * volume_of(area, hole)) return;
  }
  set_kind(area, heap, ZoneKind::dump);
}

void classify_heap(Area& area, const ChangeOptions& options) {
  const Chosen risen = choose(area, 1.0, [](std::size_t) { return true; });
  set_kind(area, main_zones(area, 1.0, risen, options.dump_area, options), ZoneKind::dump);
}

}  // namespace excavplan
