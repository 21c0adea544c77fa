// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/change/volume_change.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "base/check.hpp"
#include "base/text.hpp"
#include "change/attribution.hpp"
#include "change/change_warnings.hpp"
#include "change/earlier_soil.hpp"
#include "change/open_changes.hpp"
#include "change/strewn_soil.hpp"
#include "change/surveyed_area.hpp"
#include "ground/map_check.hpp"
#include "ground/registration.hpp"

namespace excavplan {
namespace {

void check(const std::optional<Rectangle>& area, const std::string& name) {
  if (area && !(area->x_max > area->x_min && area->y_max > area->y_min)) {
    throw Error(ErrorKind::bad_input, name + " is empty: x from " + number_text(area->x_min) +
                                          " to " + number_text(area->x_max) + ", y from " +
                                          number_text(area->y_min) + " to " +
                                          number_text(area->y_max) + "; each must grow");
  }
}

void check(const ChangeOptions& options) {
  check(options.dig_area, "dig_area");
  check(options.dump_area, "dump_area");
  check(options.heap_near, "heap_near");
  constexpr double farthest = 1e6;  // [m]
  require(options.detection > 0.0, "detection", options.detection, "positive");
  require(options.growth > 0.0 && options.growth <= options.detection, "growth", options.growth,
          "positive and not above detection (" + number_text(options.detection) + ")");
  require(options.min_zone_area >= 0.0, "min_zone_area", options.min_zone_area, "0 or more");
  for (const auto& [name, value] :
       {std::pair("margin", options.margin), std::pair("spill_distance", options.spill_distance),
        std::pair("sensor_pattern_sd", options.sensor_pattern_sd)}) {
    require(value >= 0.0, name, value, "0 or more");
    require(value <= farthest, name, value, "at most " + number_text(farthest) + " m");
  }
  require(options.max_unknown_share >= 0.0 && options.max_unknown_share <= 1.0, "max_unknown_share",
          options.max_unknown_share, "in 0 .. 1");
  require(options.refused_unknown_share >= options.max_unknown_share, "refused_unknown_share",
          options.refused_unknown_share,
          "not below max_unknown_share (" + number_text(options.max_unknown_share) + ")");
}

/// Sums excavated, spilled and dumped over all areas. Outliers are the same in all of them; their
/// other errors are independent.
void sum_volumes(const std::vector<Area>& areas, VolumeChange& change) {
  Eigen::Vector3d volume = Eigen::Vector3d::Zero();
  Eigen::Vector3d of_outliers = Eigen::Vector3d::Zero();
  for (const Area& area : areas) {
    const auto count = static_cast<Eigen::Index>(area.zones.size());
    Eigen::MatrixXd part = Eigen::MatrixXd::Zero(3, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const ZoneSum& zone = area.zones[static_cast<std::size_t>(i)];
      const ZoneKind kind = area.kinds[static_cast<std::size_t>(i)];
      if (kind == ZoneKind::dig) part(0, i) = -1.0;
      if (kind == ZoneKind::spill) part(1, i) = 1.0;
      if (kind == ZoneKind::dump) part(2, i) = 1.0;
      volume += part.col(i) * zone.volume;
      change.shared += zone.before * part.col(i) * part.col(i).transpose();
      change.errors.noise += zone.noise * part.col(i) * part.col(i).transpose();
      change.errors.holes += zone.holes * part.col(i) * part.col(i).transpose();
      change.errors.faces += zone.faces * part.col(i) * part.col(i).transpose();
      change.errors.thin += zone.thin * part.col(i) * part.col(i).transpose();
    }
    change.errors.correlated += part * area.errors.correlated * part.transpose();
    const Eigen::Vector3d here = part * area.outliers;
    change.errors.correlated += here * of_outliers.transpose() + of_outliers * here.transpose();
    of_outliers += here;
    change.errors.datum += part * area.errors.datum * part.transpose();
  }
  change.excavated.value = volume(0);
  change.spilled.value = volume(1);
  change.dumped.value = volume(2);
  change.before.value = volume(0);
  change.after.value = volume(1) + volume(2);
}

/// What the scan before made of the errors: what both scans share alike counts by half; ours.
void set_shared(VolumeChange& change) {
  constexpr double half = 0.5;
  const VolumeErrors& errors = change.errors;
  change.shared += half * (errors.correlated + errors.datum + errors.faces);
}

/// Deviations of the volumes from the covariance by all sources.
void set_deviations(VolumeChange& change) {
  const Eigen::Matrix3d covariance = change.errors.total();
  const Eigen::Vector3d after(0.0, 1.0, 1.0);
  change.excavated.sd = change.before.sd = std::sqrt(covariance(0, 0));
  change.spilled.sd = std::sqrt(covariance(1, 1));
  change.dumped.sd = std::sqrt(covariance(2, 2));
  change.after.sd = std::sqrt(after.dot(covariance * after));
  change.covariance_before_after = covariance.row(0).dot(after);
}

/// Objects, low or high ones, are reported as zones of kind `other`.
void report_objects(const Area& area, bool are_low, VolumeChange& change, AreaChange& result) {
  const double half = 0.5 * area.grid.cell_size;
  std::size_t count = 0;
  std::optional<ChangeZone> largest;
  bool are_sure = true;
  Object of_largest;
  for (const Object& object : area.objects) {
    if (object.is_blunder || object.is_low != are_low) continue;
    ChangeZone zone;
    zone.volume.value = object.volume;
    zone.area =
        area.grid.cell_size * area.grid.cell_size * static_cast<double>(object.cells.size());
    zone.unknown_share = 1.0;
    Eigen::AlignedBox2d box;
    for (const Cell at : object.cells) {
      box.extend(Eigen::Vector2d(area.grid.x(at.col), area.grid.y(at.row)));
      result.zone(at.row, at.col) = static_cast<int>(change.zones.size());
    }
    zone.extent = {box.min().x() - half, box.min().y() - half, box.max().x() + half,
                   box.max().y() + half};
    if (!largest || zone.area > largest->area) {
      largest = zone;
      of_largest = object;
    }
    are_sure = are_sure && object.is_sure;
    change.zones.push_back(zone);
    ++count;
  }
  if (!largest) return;
  of_largest.is_sure = are_sure;
  change.warnings.push_back(object_warning(*largest, of_largest, count));
}

/// Enters the zones of one area into the result.
void report(Area& area, const ChangeOptions& options, VolumeChange& change) {
  const int first = static_cast<int>(change.zones.size());
  for (std::size_t i = 0; i < area.zones.size(); ++i) {
    const ZoneSum& sum = area.zones[i];
    ChangeZone zone;
    zone.kind = area.kinds[i];
    const auto at = static_cast<Eigen::Index>(i);
    zone.volume = {sum.volume, std::sqrt(sum.variance() + area.errors.correlated(at, at) +
                                         area.errors.datum(at, at))};
    zone.area = sum.area;
    zone.unknown_share = sum.unknown / sum.area;
    zone.extent = sum.extent;
    change.zones.push_back(zone);
  }
  warn_of_scans(area, options, change.warnings);
  AreaChange result;
  result.difference = std::move(area.grid);
  result.difference.z =
      (area.unknown != 0).select(std::numeric_limits<double>::quiet_NaN(), area.ground.difference);
  result.filled = (area.unknown != 0 && area.ground.zone >= 0)
                      .select(area.ground.difference, std::numeric_limits<double>::quiet_NaN());
  result.sd =
      (area.unknown != 0).select(std::numeric_limits<double>::quiet_NaN(), area.variance.sqrt());
  result.zone = (area.ground.zone >= 0).select(area.ground.zone + first, -1);
  for (const bool low : {false, true}) report_objects(area, low, change, result);
  result.noise_sd = area.ground.noise_sd;
  result.datum = area.ground.datum;
  change.areas.push_back(std::move(result));
}

/// @param known  of the first area; null: not known
VolumeChange result_of(const std::vector<const SurfacePair*>& pairs, const ChangeOptions& options,
                       const KnownGround* known = nullptr) {
  check(options);
  for (const SurfacePair* pair : pairs) {
    require_surface(pair->before, "surface before");
    require_surface(pair->after, "surface after");
    require_alignment(pair->alignment, "change of the ground");
  }
  if (known != nullptr) require_known_ground(*known, pairs.front()->before.height);
  std::vector<Area> areas;
  std::vector<const HeightMap*> before;
  for (const SurfacePair* pair : pairs) {
    const bool is_known = known != nullptr && areas.empty();
    areas.push_back(survey(*pair, options, is_known ? known : nullptr));
    before.push_back(&pair->before.height);
  }
  if (known != nullptr) {
    find_loose_soil(*known, areas.front());
  }
  const Attribution attribution = attribute(areas, options);
  VolumeChange change;
  sum_volumes(areas, change);
  set_shared(change);
  add_strewn_soil(areas, change);
  set_deviations(change);
  warn_of_balance(change);
  if (known != nullptr) {
    take_loose_soil(*known, areas.front(), change);
    set_deviations(change);
    warn_of_missing_soil(change);
  }
  state_open_changes(areas, attribution, change);
  if (known == nullptr) state_earlier_soil(before, areas, change);
  set_deviations(change);
  if (change.cut) change.cut->bank = change.before;
  warn_of_zones(areas, options, change);
  for (Area& area : areas) report(area, options, change);
  return change;
}

}  // namespace

VolumeChange measure_change(const SurfacePair& scene, const ChangeOptions& options) {
  return result_of({&scene}, options);
}

VolumeChange measure_change(const SurfacePair& dig, const SurfacePair& dump,
                            const ChangeOptions& options) {
  return result_of({&dig, &dump}, options);
}

VolumeChange measure_change(const SurfacePair& scene, const KnownGround& known,
                            const ChangeOptions& options) {
  return result_of({&scene}, options, &known);
}

VolumeChange measure_change(const SurfacePair& dig, const SurfacePair& dump,
                            const KnownGround& known, const ChangeOptions& options) {
  return result_of({&dig, &dump}, options, &known);
}

VolumeChange measure_change(const HeightMap& before, const HeightMap& after,
                            const ChangeOptions& options) {
  return measure_change(SurfacePair{{before, {}, {}}, {after, {}, {}}, {}}, options);
}

VolumeChange measure_change(const HeightMapPair& dig, const HeightMapPair& dump,
                            const ChangeOptions& options) {
  return measure_change(SurfacePair{{dig.before, {}, {}}, {dig.after, {}, {}}, {}},
                        SurfacePair{{dump.before, {}, {}}, {dump.after, {}, {}}, {}}, options);
}

}  // namespace excavplan
