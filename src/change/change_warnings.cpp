// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/change_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/angles.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "change/attribution.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

constexpr double least_warned_share = 0.01;  // of what was dug or laid down; less is ignored
constexpr double least_noted_share = 0.001;  // likewise, beyond the edge of the survey; ours
constexpr double least_cut_share = 0.002;    // likewise, of a rise at the edge; ours
constexpr double least_refused_share = 0.1;  // likewise
constexpr double most_in_shadow = 0.35;      // ours: unseen cells whose error holds in shadows
constexpr double least_stable_share = 0.4;   // ours
constexpr double largest_noise = 0.1;        // ours: of a cell; coarser than any range sensor [m]
constexpr double largest_bulking = 3.0;      // ours: blocks give about 2

std::string litres_as_m3(double volume) {
  return number_text(std::round(volume * 1000.0) / 1000.0) + " m^3";
}

std::string millimetres(double metres) { return readable(1000.0 * metres, 2) + " mm"; }

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
      " is neither hole, spill nor heap: excluded from all volumes; `dig_area` and `dump_area` "
      "take it in, if it belongs to them";
  if (count > 1) {
    message += "; with " + std::to_string(count - 1) + " more such zones " + litres_as_m3(sum) +
               " in total";
  }
  change.warnings.emplace_back(WarningCode::other_change, message);
}

/// Volume of all zones of a kind; infinite for the kind `other`.
double total_of(const VolumeChange& change, ZoneKind kind) {
  switch (kind) {
    case ZoneKind::dig:
      return change.excavated.value;
    case ZoneKind::spill:
    case ZoneKind::dump:
      return change.spilled.value + change.dumped.value;
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

/// Zones that were not seen, of all areas.
struct DoubtfulZones {
  SuchZones unseen;
  SuchZones partly_unseen;

  /// @param total  of all zones of its kind [m^3]
  void add(const ZoneSum& zone, double total, const ChangeOptions& options) {
    const double volume = std::abs(zone.volume);
    const bool matters = volume > least_refused_share * total;
    const double unseen_share = zone.unknown / zone.area;
    const double share = unseen_share - zone.swept / zone.area;
    const double guessed =
        zone.volume > 0.0 || share > most_in_shadow ? share : share - zone.shadow / zone.area;
    if (unseen_share > options.refused_unknown_share && matters) {
      unseen.add(zone);
    } else if (guessed > options.max_unknown_share &&
               guessed * volume > least_warned_share * total) {
      partly_unseen.add(zone);
    }
  }
};

/// Zones that the edge of the survey cuts off, of all areas.
struct CutZones {
  SuchZones zones;
  bool has_hole = false;
  double beyond = 0.0;  ///< what of the rises may lie beyond the edge [m^3]

  /// @param total  of all zones of its kind [m^3]
  void add(const ZoneSum& zone, double total) {
    const bool is_rise = zone.volume > 0.0;
    const double least = is_rise ? least_cut_share : least_warned_share;
    if (!zone.is_cut || !(std::abs(zone.volume) > least * total)) return;
    zones.add(zone);
    if (is_rise) {
      beyond += zone.beyond_edge;
    } else {
      has_hole = true;
    }
  }
};

CutZones cut_zones(const std::vector<Area>& areas, const VolumeChange& change) {
  CutZones cut;
  for (const Area& area : areas) {
    for (std::size_t i = 0; i < area.zones.size(); ++i) {
      cut.add(area.zones[i], total_of(change, area.kinds[i]));
    }
  }
  return cut;
}

void warn_of_cut(const CutZones& cut, VolumeChange& change) {
  if (cut.zones.count == 0) return;
  const double rose = total_of(change, ZoneKind::dump);
  const bool is_whole = !cut.has_hole && cut.beyond < least_warned_share * rose;
  if (is_whole && cut.beyond < least_noted_share * rose) return;
  const std::string told =
      is_whole ? " thins out at the edge of the surveyed ground: up to " +
                     litres_as_m3(cut.beyond) + " may lie beyond, which the error counts"
               : " reaches the edge of the surveyed ground: its volume may be incomplete; scan "
                 "farther around it, or widen `area`";
  change.warnings.emplace_back(WarningCode::zone_at_border,
                               text_of(*cut.zones.largest) + told + cut.zones.rest(), !is_whole);
}

DoubtfulZones doubtful_zones(const std::vector<Area>& areas, const ChangeOptions& options,
                             const VolumeChange& change) {
  DoubtfulZones doubtful;
  for (const Area& area : areas) {
    for (std::size_t i = 0; i < area.zones.size(); ++i) {
      const double total = total_of(change, area.kinds[i]);
      const double volume = std::abs(area.zones[i].volume);
      if (!(volume > least_warned_share * total)) continue;
      doubtful.add(area.zones[i], total, options);
    }
  }
  return doubtful;
}

void warn_of_doubtful(const DoubtfulZones& zones, const ChangeOptions& options,
                      std::vector<Warning>& warnings) {
  const auto limit = [](double share) { return hundredths(100.0 * share) + " %"; };
  if (const SuchZones& unseen = zones.unseen; unseen.count > 0) {
    warnings.emplace_back(WarningCode::zone_unseen,
                          text_of(*unseen.largest) + " was seen by no scan in " +
                              unseen.unseen_share() + " of its cells, more than " +
                              limit(options.refused_unknown_share) +
                              ": its volume is not trustworthy, so the bulking factor is unknown; "
                              "scan it from a second standpoint" +
                              unseen.rest());
  }
  if (const SuchZones& partly = zones.partly_unseen; partly.count > 0) {
    warnings.emplace_back(WarningCode::zone_partly_unseen,
                          text_of(*partly.largest) + " was seen by no scan in " +
                              partly.unseen_share() +
                              " of its cells, which were interpolated; the limit is " +
                              limit(options.max_unknown_share) +
                              ": scan it from a second standpoint" + partly.rest());
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
  warnings.emplace_back(
      WarningCode::sensor_place_doubtful,
      "the sensor of the scan " + which + " is said to have stood at " + text_of(doubt->told) +
          (doubt->inferred ? ", but by the number of its points on slopes it was at about " +
                                 text_of(*doubt->inferred)
                           : ", which is below the ground") +
          ": ground that it did not see is filled wrongly; check `sensor_origin`, its frame and "
          "unit, or the VIEWPOINT of the file");
}

/// Of a place that no one told.
void warn_of_place(const Area& area, std::vector<Warning>& warnings) {
  const bool has_shadow = std::any_of(area.zones.begin(), area.zones.end(),
                                      [](const ZoneSum& zone) { return zone.shadow > 0.0; });
  if (area.inferred && has_shadow) {
    warnings.emplace_back(
        WarningCode::sensor_place_inferred,
        "nothing says where the sensor of the scan after stood: by the number of its points on "
        "slopes it was at about " +
            text_of(area.inferred->place()) +
            ", from where ground was filled that it did not see; give the place by "
            "`sensor_origin`");
  }
}

/// Of errors that neighbouring ground shares.
void warn_of_bends(const Area& area, double pattern_sd, std::vector<Warning>& warnings) {
  constexpr double noted = 0.010;  // ours: of errors that were taken off [m]
  constexpr double most = 0.010;   // ours: of those left; below it volumes hardly suffer [m]
  constexpr double most_of_mean = 0.0025;  // ours: of the mean of 1 m^2, as 10 mm over 0.1 m [m]
  if (area.systematic_rms > noted) {
    warnings.emplace_back(WarningCode::systematic_errors,
                          "stripes or a dome of " + millimetres(area.systematic_rms) +
                              " (rms) run through ground that did not change and were taken off: "
                              "check the calibration of the sensor and how the scans were put "
                              "together");
  }
  constexpr double explained = 3.0;  // ours: deviations of what one scan is stated to err by
  const double left = std::sqrt(area.noise.correlated);
  if (left <= explained * pattern_sd) return;
  const double of_mean = left * std::min(1.0, std::sqrt(2.0 * pi) * area.noise.length);
  if (left > most && of_mean > most_of_mean) {
    warnings.emplace_back(
        WarningCode::scans_do_not_fit,
        "ground that did not change rose and fell by " + millimetres(left) +
            " between the scans over " + readable(area.noise.length, 2) +
            " m, which is not noise of single points: one of the scans is bent, or "
            "the ground was driven on; scan again from one place, or leave out by "
            "`area` what changed");
  }
}

void warn_of_ground(const Area& area, double pattern_sd, std::vector<Warning>& warnings) {
  const ChangedGround& ground = area.ground;
  if (ground.stable_share < least_stable_share) {
    warnings.emplace_back(WarningCode::little_stable_ground,
                          "only " + hundredths(100.0 * ground.stable_share) +
                              " % of the surveyed ground did not change, less than " +
                              hundredths(100.0 * least_stable_share) +
                              " %: an area that rose or fell evenly could be "
                              "mistaken for stable ground; scan more of the ground around "
                              "hole and heap");
  }
  const double differs = std::hypot(ground.noise_sd, area.systematic_rms);
  if (differs > largest_noise) {
    warnings.emplace_back(WarningCode::scans_do_not_fit,
                          "ground that did not change differs by " + hundredths(differs) +
                              " m between the scans (one standard deviation), more than " +
                              hundredths(largest_noise) +
                              " m: bring both scans into one frame by `before_frame` and "
                              "`after_frame`, or leave out by `area` what moved between them");
    return;
  }
  warn_of_bends(area, pattern_sd, warnings);
}

// ---- Soil that slid back ------------------------------------------------------------------------

/// Where a heap runs on into the hole: its slope goes down from above the ground to the floor.
class SlideBack {
 public:
  explicit SlideBack(const Area& area) : area_(area) {
    std::vector<double> depths;
    for_each_cell(area.ground.zone, [&](Cell at) {
      if (kind_at(at) == ZoneKind::dig) depths.push_back(-area.ground.difference(at.row, at.col));
    });
    depth_ = depths.empty() ? 0.0 : upper_quantile(depths, 0.9);
  }

  /// What of the hole its soil may hide, if the wall there was upright [m^3]; 0 where the cells do
  /// not tell a slope from a wall.
  double most_hidden() const {
    constexpr double fewest_steps = 4.0;  // ours: cells that a slope goes down
    const double cell = area_.grid.cell_size;
    if (depth_ < fewest_steps * cell) return 0.0;
    double hidden = 0.0;
    for_each_cell(area_.ground.zone, [&](Cell at) {
      if (kind_at(at) != ZoneKind::dump || !(area_.ground.difference(at.row, at.col) > 0.0)) return;
      double wedge = 0.0;
      int ways = 0;
      for (const Cell d : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
        const Cell next = {at.row + d.row, at.col + d.col};
        if (!(change_at(next) <= 0.0)) continue;
        wedge += wedge_along(at, d);
        ++ways;
      }
      if (ways > 0) hidden += cell * wedge / ways;
    });
    return hidden;
  }

 private:
  bool is_inside(Cell at) const {
    const auto& zone = area_.ground.zone;
    return at.row >= 0 && at.col >= 0 && at.row < zone.rows() && at.col < zone.cols();
  }
  ZoneKind kind_at(Cell at) const {
    const int zone = area_.ground.zone(at.row, at.col);
    return zone < 0 ? ZoneKind::other : area_.kinds[static_cast<std::size_t>(zone)];
  }
  double change_at(Cell at) const {
    return is_inside(at) ? area_.ground.difference(at.row, at.col)
                         : std::numeric_limits<double>::quiet_NaN();
  }

  /// Section of the soil under a slope that goes down from `foot` to the floor as loose soil lies
  /// [m^2]; 0 of another.
  double wedge_along(Cell foot, Cell d) const {
    constexpr double steepest = 1.1;   // ours: loose soil stands at 28 to 45 degrees [-]
    constexpr double gentlest = 0.35;  // ours
    constexpr double floor = 0.8;      // ours, of the depth
    const double cell = area_.grid.cell_size;
    const auto most = static_cast<Eigen::Index>(depth_ / gentlest / cell) + 1;
    double section = 0.0;
    for (Eigen::Index i = 1; i <= most; ++i) {
      const double change = change_at({foot.row + i * d.row, foot.col + i * d.col});
      if (std::isnan(change)) return 0.0;
      section += cell * (depth_ + change);
      if (change > -floor * depth_) continue;
      const double slope = -change / (cell * static_cast<double>(i));
      return slope < steepest && slope > gentlest ? section : 0.0;
    }
    return 0.0;
  }

  const Area& area_;
  double depth_ = 0.0;
};

/// Of a heap whose soil slid back over the rim of the hole.
void warn_of_slide(const Area& area, VolumeChange& change) {
  constexpr double noted = 0.03;  // ours, of the bulking factor
  if (area.is_cut_told) return;   // nothing is hidden
  const double before = change.before.value;
  const double after = change.after.value;
  if (!(before > 0.0 && after > 0.0)) return;
  const double hidden = SlideBack(area).most_hidden();
  const double k = after / before;
  const double off = std::abs((after + hidden) / (before + hidden) / k - 1.0);
  if (off < noted) return;
  change.warnings.emplace_back(
      WarningCode::attribution_open,
      "the heap runs on into the hole at the slope of loose soil: what slid back may hide up to " +
          litres_as_m3(hidden) + " of the hole, which changes the bulking factor by " +
          readable(100.0 * off, 2) + " %; dump farther away from the hole",
      true);
}

/// Of what rose less what fell.
double error_of_rise(const VolumeChange& change) {
  return std::sqrt(std::max(0.0, std::pow(change.before.sd, 2) + std::pow(change.after.sd, 2) -
                                     2.0 * change.covariance_before_after));
}

}  // namespace

void warn_of_balance(VolumeChange& change) {
  const double before = change.before.value;
  const double after = change.after.value;
  if (!(before > 0.0)) {
    change.warnings.emplace_back(WarningCode::no_hole_found,
                                 "no ground fell by more than the noise of the scans: no hole was "
                                 "found, its volumes are 0; check that AFTER shows the dig");
    return;
  }
  const double dumped = change.dumped.value;
  if (dumped < least_dumped_share * before || after < least_after_share * before) {
    change.warnings.emplace_back(
        WarningCode::no_dumped_soil,
        "the hole is " + litres_as_m3(before) + ", but only " + litres_as_m3(dumped) +
            " rose away from it and " + litres_as_m3(after - dumped) +
            " beside it: the dumped soil is not in the scans, so the bulking "
            "factor is unknown; give scans that show it, or those of the dump "
            "area by `dump_before` and `dump_after`");
    return;
  }
  const double error = error_of_rise(change);
  const double ratio = after / before;
  const bool shrank = ratio < least_bulking && before - after > 2.0 * error;
  if (shrank || ratio > largest_bulking) {
    change.warnings.emplace_back(
        WarningCode::looks_swapped,
        "before and after are probably swapped: " + litres_as_m3(before) + " were dug, " +
            litres_as_m3(after) + " were deposited, a factor of " + hundredths(ratio) +
            "; the volume of dug soil is " + hundredths(least_bulking) + " to " +
            hundredths(largest_bulking) +
            " times that of the hole; exchange BEFORE and AFTER; or leave out what "
            "is no soil, a vehicle, by `dig_area` and `dump_area`; or, if z "
            "points down, give frames with z up");
  }
}

void warn_of_missing_soil(VolumeChange& change) {
  for (Warning& warning : change.warnings) {
    if (warning.code == WarningCode::no_hole_found)
      warning.ends_trust = true;  // of a dig that is told
  }
  const double missing = change.before.value - change.after.value;
  const bool is_said = std::any_of(
      change.warnings.begin(), change.warnings.end(),
      [](const Warning& warning) { return warning.code == WarningCode::no_dumped_soil; });
  if (is_said || !(missing > (1.0 - least_bulking) * change.before.value) ||
      !(missing > 2.0 * error_of_rise(change))) {
    return;
  }
  change.warnings.emplace_back(
      WarningCode::no_dumped_soil,
      "of " + litres_as_m3(change.before.value) + " of bank that were cut " +
          litres_as_m3(missing) +
          " did not rise anywhere: soil went out of sight, so the bulking factor is unknown; give "
          "scans that show it, or its mass");
}

void warn_of_zones(const std::vector<Area>& areas, const ChangeOptions& options,
                   VolumeChange& change) {
  warn_of_others(areas, change);
  warn_of_slide(areas.front(), change);
  warn_of_cut(cut_zones(areas, change), change);
  warn_of_doubtful(doubtful_zones(areas, options, change), options, change.warnings);
}

void warn_of_scans(const Area& area, const ChangeOptions& options, std::vector<Warning>& warnings) {
  warn_of_ground(area, options.sensor_pattern_sd, warnings);
  warn_of_place(area, warnings);
  warn_of_doubt(area.place_before, "before", warnings);
  warn_of_doubt(area.place_after, "after", warnings);
}

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
  return {object.is_low ? WarningCode::object_on_soil : WarningCode::object_taken_out,
          std::move(message), !object.is_sure};
}

}  // namespace excavplan
