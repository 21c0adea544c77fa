// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "survey/paper_change.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <vector>

#include "survey/paper_method.hpp"

#include "survey/scan_reading.hpp"

namespace excavplan {
namespace {

/// Extent of the zones of some kinds, with room around it.
std::optional<Rectangle> extent_of(const VolumeChange& change,
                                   std::initializer_list<ZoneKind> kinds) {
  std::optional<Rectangle> extent;
  for (const ChangeZone& zone : change.zones) {
    if (std::find(kinds.begin(), kinds.end(), zone.kind) == kinds.end()) continue;
    const Rectangle& r = zone.extent;
    const Rectangle e = extent.value_or(r);
    extent = Rectangle{std::min(e.x_min, r.x_min), std::min(e.y_min, r.y_min),
                       std::max(e.x_max, r.x_max), std::max(e.y_max, r.y_max)};
  }
  if (!extent) return extent;
  constexpr double room = 0.3;  // [m], ours
  return Rectangle{extent->x_min - room, extent->y_min - room, extent->x_max + room,
                   extent->y_max + room};
}

/// Points inside, with the ground's median height at z = 0 as the method expects it.
Cloud levelled(const Cloud& cloud, const std::optional<Rectangle>& area, double ground) {
  Cloud result;
  for (const Eigen::Vector3d& p : cloud.points) {
    if (!p.allFinite() || (area && !area->contains(p.x(), p.y()))) continue;
    result.points.emplace_back(p.x(), p.y(), p.z() - ground);
  }
  result.width = result.points.size();
  return result;
}

double median_height(const Cloud& cloud) {
  std::vector<double> z;
  for (const Eigen::Vector3d& p : cloud.points) {
    if (p.allFinite()) z.push_back(p.z());
  }
  const auto middle = z.begin() + static_cast<std::ptrdiff_t>(z.size() / 2);
  std::nth_element(z.begin(), middle, z.end());
  return *middle;
}

/// Where hole and heap are searched; nothing: everywhere.
struct Areas {
  std::optional<Rectangle> dig;
  std::optional<Rectangle> dump;
};

Areas areas_of(const VolumeChange& surface, const ChangeOptions& given, bool whole_scene) {
  Areas areas{given.dig_area, given.dump_area};
  if (!whole_scene) return areas;
  if (!areas.dig) areas.dig = extent_of(surface, {ZoneKind::dig, ZoneKind::spill});
  if (!areas.dump) areas.dump = extent_of(surface, {ZoneKind::dump});
  return areas;
}

}  // namespace

VolumeChange paper_change(const PaperScans& scans, const VolumeChange& surface,
                          const ChangeOptions& given, double leaf) {
  PaperMethodOptions options;
  options.leaf = leaf;
  const Areas areas = areas_of(surface, given, !scans.dump);
  const Cloud before = gathered(scans.dig.before);
  const Cloud after = gathered(scans.dig.after);
  const double ground = median_height(before);
  const Cloud still = levelled(before, areas.dig, ground);  // nothing rises in it
  const Cloud dug = levelled(after, areas.dig, ground);
  Cloud dump_before = still;
  Cloud dump_after = still;
  if (scans.dump) {
    const Cloud empty = gathered(scans.dump->before);
    const double dump_ground = median_height(empty);
    dump_before = levelled(empty, areas.dump, dump_ground);
    dump_after = levelled(gathered(scans.dump->after), areas.dump, dump_ground);
  } else if (areas.dump) {
    dump_before = levelled(before, areas.dump, ground);
    dump_after = levelled(after, areas.dump, ground);
  }
  VolumeChange change = paper_volumes(still, dug, dump_before, dump_after, options);
  change.zones = surface.zones;
  change.areas = surface.areas;
  change.warnings = surface.warnings;
  return change;
}

}  // namespace excavplan
