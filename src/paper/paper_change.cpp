// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/paper/paper_change.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <optional>
#include <vector>

#include "paper/paper_method.hpp"

#include "base/statistics.hpp"
#include "scans/scan_reading.hpp"

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

double median_height(const Cloud& cloud) {
  std::vector<double> z;
  for (const Eigen::Vector3d& p : cloud.points) {
    if (p.allFinite()) z.push_back(p.z());
  }
  return median(z);
}

/// Whether a point belongs to an area.
using Inside = std::function<bool(const Eigen::Vector3d&)>;

/// Points inside, with the ground's median height at z = 0 as the method expects it.
Cloud levelled(const Cloud& cloud, const Inside& inside, double ground) {
  Cloud result;
  for (const Eigen::Vector3d& p : cloud.points) {
    if (!p.allFinite() || !inside(p)) continue;
    result.points.emplace_back(p.x(), p.y(), p.z() - ground);
  }
  result.width = result.points.size();
  return result;
}

/// Both clouds of a pair, above the ground of the first.
CloudPair levelled(const ScanPair& scans, const Inside& inside) {
  const Cloud before = gathered(scans.before);
  const double ground = median_height(before);
  return {levelled(before, inside, ground), levelled(gathered(scans.after), inside, ground)};
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

/// The zone that a point lies in; null on stable ground and off the map.
const ChangeZone* zone_at(const VolumeChange& surface, const Eigen::Vector3d& point) {
  const AreaChange& area = surface.areas.front();
  const Eigen::Vector2d cell =
      (point.head<2>() - area.difference.origin) / area.difference.cell_size;
  const auto col = static_cast<Eigen::Index>(std::floor(cell.x()));
  const auto row = static_cast<Eigen::Index>(std::floor(cell.y()));
  if (row < 0 || col < 0 || row >= area.zone.rows() || col >= area.zone.cols()) return nullptr;
  const int zone = area.zone(row, col);
  return zone < 0 ? nullptr : &surface.zones[static_cast<std::size_t>(zone)];
}

Inside inside_of(const std::optional<Rectangle>& area) {
  return [area](const Eigen::Vector3d& p) { return !area || area->contains(p.x(), p.y()); };
}

/// Points of an area of the whole scene that lie in no zone of the other one.
Inside inside_but(const std::optional<Rectangle>& area, const VolumeChange& surface, bool heap) {
  return [=, &surface](const Eigen::Vector3d& p) {
    if (area && !area->contains(p.x(), p.y())) return false;
    const ChangeZone* zone = zone_at(surface, p);
    if (!zone || zone->kind == ZoneKind::other) return true;
    return (zone->kind == ZoneKind::dump) == heap;
  };
}

VolumeChange measured(const SurveyedDig& dig, const PaperOptions& options) {
  const Areas areas = areas_of(dig.surface, dig.options, !dig.dump);
  CloudPair hole;
  CloudPair heap;
  if (dig.dump) {
    hole = levelled(dig.scans, inside_of(areas.dig));
    heap = levelled(*dig.dump, inside_of(areas.dump));
  } else {
    hole = levelled(dig.scans, inside_but(areas.dig, dig.surface, false));
    heap = areas.dump ? levelled(dig.scans, inside_but(areas.dump, dig.surface, true))
                      : CloudPair{hole.before, hole.before};  // nothing rises in it
  }
  VolumeChange change = paper_volumes(hole, heap, dig.cell_size, options);
  change.zones = dig.surface.zones;
  change.areas = dig.surface.areas;
  change.warnings = dig.surface.warnings;
  return change;
}

}  // namespace

OtherVolumes paper_change(const PaperOptions& options) {
  return [options](const SurveyedDig& dig) { return measured(dig, options); };
}

}  // namespace excavplan
