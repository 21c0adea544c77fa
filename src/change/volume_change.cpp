// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/change/volume_change.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "base/check.hpp"
#include "base/text.hpp"
#include "change/attribution.hpp"
#include "change/earlier_soil.hpp"
#include "change/open_changes.hpp"
#include "change/surveyed_area.hpp"
#include "ground/map_check.hpp"
#include "ground/registration.hpp"

namespace excavplan {
namespace {

constexpr double least_warned_share = 0.01;  // of the volume of its kind; smaller ones are ignored
constexpr double least_refused_share = 0.1;  // likewise
constexpr double most_in_shadow = 0.35;      // ours: unseen cells whose error holds in shadows
constexpr double least_stable_share = 0.4;   // ours
constexpr double largest_noise = 0.1;        // ours: of a cell; coarser than any range sensor [m]
constexpr double least_dumped_share = 0.2;   // ours: a smaller rise away from the hole is no heap
constexpr double least_bulking = 0.97;       // loosest soil keeps its volume; ours: 3 % below that
constexpr double largest_bulking = 3.0;      // ours: blocks give about 2

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
  constexpr double farthest = 1e6;  // [m]
  require(options.detection > 0.0, "detection", options.detection, "positive");
  require(options.growth > 0.0 && options.growth <= options.detection, "growth", options.growth,
          "positive and not above detection (" + number_text(options.detection) + ")");
  require(options.min_zone_area >= 0.0, "min_zone_area", options.min_zone_area, "0 or more");
  for (const auto& [name, value] :
       {std::pair("margin", options.margin), std::pair("spill_distance", options.spill_distance)}) {
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

std::string litres_as_m3(double volume) {
  return number_text(std::round(volume * 1000.0) / 1000.0) + " m^3";
}

std::string millimetres(double metres) { return readable(1000.0 * metres, 2) + " mm"; }

std::string hundredths(double value) { return number_text(std::round(value * 100.0) / 100.0); }

std::string place_of(const ZoneSum& zone) {
  return "(" + hundredths(zone.centre.x()) + ", " + hundredths(zone.centre.y()) + ") m";
}

std::string text_of(const ZoneSum& zone) {
  return std::string("ground that ") + (zone.volume > 0.0 ? "rose" : "fell") + " by " +
         litres_as_m3(std::abs(zone.volume)) + " over " + hundredths(zone.area) + " m^2 around " +
         place_of(zone);
}

/// One warning for all of them, and none where their volume is negligible relative to the hole.
void warn_of_others(const std::vector<Area>& areas, VolumeChange& change) {
  const ZoneSum* largest = nullptr;
  int count = 0;
  double sum = 0.0;
  for (const Area& area : areas) {
    for (std::size_t i = 0; i < area.zones.size(); ++i) {
      if (area.kinds[i] != ZoneKind::other) continue;
      const ZoneSum& zone = area.zones[i];
      if (largest == nullptr || std::abs(zone.volume) > std::abs(largest->volume)) largest = &zone;
      sum += std::abs(zone.volume);
      ++count;
    }
  }
  if (!(sum > least_warned_share * change.excavated.value)) return;
  std::string message =
      text_of(*largest) +
      " is neither hole, spill nor heap: excluded from all volumes; --dig-area and --dump-area "
      "take it in, if it belongs to them";
  if (count > 1) {
    message += "; with " + std::to_string(count - 1) + " more such zones " + litres_as_m3(sum) +
               " in total";
  }
  change.warnings.push_back({"other_change", message});
}

/// Volume of all zones of a kind; infinite for the kind `other`.
double total_of(const VolumeChange& change, ZoneKind kind) {
  switch (kind) {
    case ZoneKind::dig:
      return change.excavated.value;
    case ZoneKind::spill:
      return change.spilled.value;
    case ZoneKind::dump:
      return change.dumped.value;
    case ZoneKind::other:
      break;
  }
  return std::numeric_limits<double>::infinity();
}

/// Zones of which the same is said.
struct SuchZones {
  const ZoneSum* largest = nullptr;
  int count = 0;
  double volume = 0.0;

  void add(const ZoneSum& zone) {
    if (largest == nullptr || std::abs(zone.volume) > std::abs(largest->volume)) largest = &zone;
    volume += std::abs(zone.volume);
    ++count;
  }
  std::string unseen_share() const {
    return hundredths(100.0 * largest->unknown / largest->area) + " %";
  }
  /// "; with 3 more such zones 0.4 m^3 in total"
  std::string rest() const {
    if (count == 1) return "";
    return "; with " + std::to_string(count - 1) + " more such zones " + litres_as_m3(volume) +
           " in total";
  }
};

/// Zones that are cut off or were not seen, of all areas.
struct DoubtfulZones {
  SuchZones cut;
  SuchZones unseen;
  SuchZones partly_unseen;

  void add(const ZoneSum& zone, bool matters, const ChangeOptions& options) {
    if (zone.is_cut) cut.add(zone);
    const double share = zone.unknown / zone.area;
    const double guessed = zone.volume > 0.0 || share > most_in_shadow
                               ? share
                               : (zone.unknown - zone.shadow) / zone.area;
    if (share > options.refused_unknown_share && matters) {
      unseen.add(zone);
    } else if (guessed > options.max_unknown_share) {
      partly_unseen.add(zone);
    }
  }
};

DoubtfulZones doubtful_zones(const std::vector<Area>& areas, const ChangeOptions& options,
                             const VolumeChange& change) {
  DoubtfulZones doubtful;
  for (const Area& area : areas) {
    for (std::size_t i = 0; i < area.zones.size(); ++i) {
      const double total = total_of(change, area.kinds[i]);
      const double volume = std::abs(area.zones[i].volume);
      if (!(volume > least_warned_share * total)) continue;
      doubtful.add(area.zones[i], volume > least_refused_share * total, options);
    }
  }
  return doubtful;
}

void warn_of_zones(const DoubtfulZones& zones, const ChangeOptions& options,
                   std::vector<Warning>& warnings) {
  const auto limit = [](double share) { return hundredths(100.0 * share) + " %"; };
  if (const SuchZones& cut = zones.cut; cut.count > 0) {
    warnings.push_back({"zone_at_border",
                        text_of(*cut.largest) +
                            " reaches the edge of the surveyed ground: its volume may be "
                            "incomplete; scan farther around it, or widen --area" +
                            cut.rest(),
                        true});
  }
  if (const SuchZones& unseen = zones.unseen; unseen.count > 0) {
    warnings.push_back(
        {"zone_unseen", text_of(*unseen.largest) + " was seen by no scan in " +
                            unseen.unseen_share() + " of its cells, more than " +
                            limit(options.refused_unknown_share) +
                            ": its volume is not trustworthy, so the bulking factor is unknown; "
                            "scan it from a second standpoint" +
                            unseen.rest()});
  }
  if (const SuchZones& partly = zones.partly_unseen; partly.count > 0) {
    warnings.push_back({"zone_partly_unseen",
                        text_of(*partly.largest) + " was seen by no scan in " +
                            partly.unseen_share() +
                            " of its cells, which were interpolated; the limit is " +
                            limit(options.max_unknown_share) +
                            ": scan it from a second standpoint" + partly.rest(),
                        true});
  }
}

std::string text_of(const Eigen::Vector3d& place) {
  return "(" + hundredths(place.x()) + ", " + hundredths(place.y()) + ", " + hundredths(place.z()) +
         ") m";
}

/// Of a place that the scan contradicts.
void warn_of_doubt(const std::optional<PlaceDoubt>& doubt, const std::string& which,
                   std::vector<Warning>& warnings) {
  if (!doubt) return;
  warnings.push_back(
      {"sensor_place_doubtful",
       "the sensor of the scan " + which + " is said to have stood at " + text_of(doubt->told) +
           (doubt->inferred ? ", but by the number of its points on slopes it was at about " +
                                  text_of(*doubt->inferred)
                            : ", which is below the ground") +
           ": ground that it did not see is filled wrongly; check --sensor-origin, its frame and "
           "unit, or the VIEWPOINT of the file",
       true});
}

/// Of a place that no one told.
void warn_of_place(const Area& area, std::vector<Warning>& warnings) {
  const bool has_shadow = std::any_of(area.zones.begin(), area.zones.end(),
                                      [](const ZoneSum& zone) { return zone.shadow > 0.0; });
  if (area.inferred && has_shadow) {
    warnings.push_back(
        {"sensor_place_inferred",
         "nothing says where the sensor of the scan after stood: by the number of its points on "
         "slopes it was at about " +
             text_of(area.inferred->place()) +
             ", from where ground was filled that it did not see; give the place by "
             "--sensor-origin"});
  }
}

/// Of errors that neighbouring ground shares.
void warn_of_bends(const Area& area, std::vector<Warning>& warnings) {
  constexpr double noted = 0.010;  // ours: of errors that were taken off [m]
  constexpr double most = 0.010;   // ours: of those left; below it volumes hardly suffer [m]
  if (area.systematic_rms > noted) {
    warnings.push_back({"systematic_errors",
                        "stripes or a dome of " + millimetres(area.systematic_rms) +
                            " (rms) run through ground that did not change and were taken off: "
                            "check the calibration of the sensor and how the scans were put "
                            "together"});
  }
  const double left = std::sqrt(area.noise.correlated);
  if (left > most && area.noise.length > area.grid.cell_size) {
    warnings.push_back({"scans_do_not_fit",
                        "ground that did not change rose and fell by " + millimetres(left) +
                            " between the scans over " + readable(area.noise.length, 2) +
                            " m, which is not noise of single points: one of the scans is bent, or "
                            "the ground was driven on; scan again from one place, or leave out by "
                            "--area what changed",
                        true});
  }
}

void warn_of_ground(const Area& area, std::vector<Warning>& warnings) {
  const ChangedGround& ground = area.ground;
  if (ground.stable_share < least_stable_share) {
    warnings.push_back(
        {"little_stable_ground", "only " + hundredths(100.0 * ground.stable_share) +
                                     " % of the surveyed ground did not change, less than " +
                                     hundredths(100.0 * least_stable_share) +
                                     " %: an area that rose or fell evenly could be "
                                     "mistaken for stable ground; scan more of the ground around "
                                     "hole and heap"});
  }
  if (ground.noise_sd > largest_noise) {
    warnings.push_back({"scans_do_not_fit",
                        "ground that did not change differs by " + hundredths(ground.noise_sd) +
                            " m between the scans (one standard deviation), more than " +
                            hundredths(largest_noise) +
                            " m: bring both scans into one frame by --before-frame and "
                            "--after-frame, or leave out by --area what moved between them",
                        true});
    return;
  }
  warn_of_bends(area, warnings);
}

void warn_of_balance(VolumeChange& change) {
  const double before = change.before.value;
  const double after = change.after.value;
  if (!(before > 0.0)) {
    change.warnings.push_back({"no_hole_found",
                               "no ground fell by more than the noise of the scans: no hole was "
                               "found, its volumes are 0; check that AFTER shows the dig"});
    return;
  }
  const double dumped = change.dumped.value;
  if (dumped < least_dumped_share * before || after < least_after_share * before) {
    change.warnings.push_back(
        {"no_dumped_soil", "the hole is " + litres_as_m3(before) + ", but only " +
                               litres_as_m3(dumped) + " rose away from it and " +
                               litres_as_m3(after - dumped) +
                               " beside it: the dumped soil is not in the scans, so the bulking "
                               "factor is unknown; give scans that show it, or those of the dump "
                               "area by --dump-before and --dump-after"});
    return;
  }
  const double error =
      std::sqrt(std::max(0.0, std::pow(change.before.sd, 2) + std::pow(change.after.sd, 2) -
                                  2.0 * change.covariance_before_after));
  const double ratio = after / before;
  const bool shrank = ratio < least_bulking && before - after > 2.0 * error;
  if (shrank || ratio > largest_bulking) {
    change.warnings.push_back(
        {"looks_swapped",
         "before and after are probably swapped: " + litres_as_m3(before) + " were dug, " +
             litres_as_m3(after) + " were deposited, a factor of " + hundredths(ratio) +
             "; the volume of dug soil is " + hundredths(least_bulking) + " to " +
             hundredths(largest_bulking) +
             " times that of the hole; exchange BEFORE and AFTER; or leave out what "
             "is no soil, a vehicle, by --dig-area and --dump-area; or, if z "
             "points down, give frames with z up"});
  }
}

/// The warning of the largest of some objects.
Warning object_warning(const ChangeZone& zone, const Object& object, std::size_t count) {
  const Eigen::Vector2d centre(0.5 * (zone.extent.x_min + zone.extent.x_max),
                               0.5 * (zone.extent.y_min + zone.extent.y_max));
  std::string message =
      std::string(object.is_low ? "a thing with a level top and steep sides lies on dug "
                                  "ground in the scan "
                                : "an object too steep for soil is in the scan ") +
      (object.is_before ? "before" : "after") + " around (" + hundredths(centre.x()) + ", " +
      hundredths(centre.y()) + ") m, over " + hundredths(zone.area) +
      " m^2: it was removed, and the ground under it counts as unseen";
  if (count > 1) message += "; so were " + std::to_string(count - 1) + " smaller ones";
  if (!object.is_sure) message += "; if it is soil that was left standing, the hole is smaller";
  return {object.is_low ? "object_on_soil" : "object_taken_out", std::move(message),
          !object.is_sure};
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
void report(Area& area, VolumeChange& change) {
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
  warn_of_ground(area, change.warnings);
  warn_of_place(area, change.warnings);
  warn_of_doubt(area.place_before, "before", change.warnings);
  warn_of_doubt(area.place_after, "after", change.warnings);
  AreaChange result;
  result.difference = std::move(area.grid);
  result.difference.z =
      (area.unknown != 0).select(std::numeric_limits<double>::quiet_NaN(), area.ground.difference);
  result.sd =
      (area.unknown != 0).select(std::numeric_limits<double>::quiet_NaN(), area.variance.sqrt());
  result.zone = (area.ground.zone >= 0).select(area.ground.zone + first, -1);
  for (const bool low : {false, true}) report_objects(area, low, change, result);
  result.noise_sd = area.ground.noise_sd;
  result.datum = area.ground.datum;
  change.areas.push_back(std::move(result));
}

VolumeChange result_of(const std::vector<const SurfacePair*>& pairs, const ChangeOptions& options) {
  check(options);
  for (const SurfacePair* pair : pairs) {
    require_surface(pair->before, "surface before");
    require_surface(pair->after, "surface after");
    require_alignment(pair->alignment, "change of the ground");
  }
  std::vector<Area> areas;
  std::vector<const HeightMap*> before;
  for (const SurfacePair* pair : pairs) {
    areas.push_back(survey(*pair, options));
    before.push_back(&pair->before.height);
  }
  const Attribution attribution = attribute(areas, options);
  VolumeChange change;
  sum_volumes(areas, change);
  set_deviations(change);
  warn_of_balance(change);
  state_open_changes(areas, attribution, change);
  state_earlier_soil(before, areas, change);
  set_deviations(change);
  warn_of_others(areas, change);
  warn_of_zones(doubtful_zones(areas, options, change), options, change.warnings);
  for (Area& area : areas) report(area, change);
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
