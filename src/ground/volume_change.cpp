// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/volume_change.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ground/change_zones.hpp"
#include "ground/grid_cells.hpp"
#include "json_file.hpp"

namespace excavplan {
namespace {

constexpr Eigen::Index fewest_known_cells = 100;
// Ours: error of the mean height of a filled hole, in units of hole radius times rim slope. A
// membrane over a step that crosses the hole at random is off by 0.12 of the step.
/// A scan samples steep faces more or less densely than the ground beside them, which moves the
/// heights of the cells they cross: 0.2 to 0.4 % of a pit with upright walls seen from above, as
/// measured in the tests of rasterise(); ours.
constexpr double steep_face_error = 0.004;   // of the volume
constexpr double least_warned_share = 0.01;  // of its kind's volume: a speck at the border is none
constexpr double fill_error = 0.2;
constexpr double least_stable_share = 0.4;  // ours
constexpr double largest_noise = 0.1;       // ours: of a cell; coarser than any range sensor [m]
constexpr double least_after_share = 0.5;   // ours: with less, the heap is not in the scans
constexpr double least_dumped_share = 0.2;  // ours: a smaller rise away from the hole is no heap
constexpr double least_bulking = 0.97;      // loosest soil keeps its volume; ours: 3 % below that
constexpr double largest_bulking = 3.0;     // ours: blocks give about 2

/// A zone with what the sums over zones need.
struct ZoneSum {
  double volume = 0.0;    // [m^3]
  double area = 0.0;      // [m^2]
  double variance = 0.0;  // of the volume, without the datum's [m^6]
  double unknown = 0.0;   // area that was filled [m^2]
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Rectangle extent;
  bool is_cut = false;
};

/// One surveyed area, its zones and what they are.
struct Area {
  HeightMap grid;  // without heights
  ChangedGround ground;
  std::vector<ZoneSum> zones;
  std::vector<ZoneKind> kinds;
};

void require(bool holds, const std::string& option, double value, const std::string& rule) {
  if (!holds) {
    throw Error(ErrorKind::bad_input, option + " is " + number_text(value) + ", must be " + rule);
  }
}

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
  require(options.detection > 0.0, "detection", options.detection, "positive");
  require(options.growth > 0.0 && options.growth <= options.detection, "growth", options.growth,
          "positive and not above detection (" + number_text(options.detection) + ")");
  require(options.min_zone_area >= 0.0, "min_zone_area", options.min_zone_area, "0 or more");
  require(options.margin >= 0.0, "margin", options.margin, "0 or more");
  require(options.spill_distance >= 0.0, "spill_distance", options.spill_distance, "0 or more");
  require(options.max_unknown_share >= 0.0 && options.max_unknown_share <= 1.0, "max_unknown_share",
          options.max_unknown_share, "in 0 .. 1");
}

/// Sums the difference over each zone: area, volume, place.
std::vector<ZoneSum> sum_zones(const HeightMap& grid, const ChangedGround& ground) {
  std::vector<ZoneSum> zones(ground.zone_is_cut.size());
  const double cell_area = grid.cell * grid.cell;
  for_each_cell(ground.zone, [&](Cell cell) {
    const int index = ground.zone(cell.row, cell.col);
    if (index < 0) return;
    ZoneSum& zone = zones[static_cast<std::size_t>(index)];
    const Eigen::Vector2d place(grid.x(cell.col), grid.y(cell.row));
    const double half = 0.5 * grid.cell;
    if (zone.area == 0.0) zone.extent = {place.x(), place.y(), place.x(), place.y()};
    zone.extent = {std::min(zone.extent.x_min, place.x() - half),
                   std::min(zone.extent.y_min, place.y() - half),
                   std::max(zone.extent.x_max, place.x() + half),
                   std::max(zone.extent.y_max, place.y() + half)};
    zone.volume += cell_area * ground.difference(cell.row, cell.col);
    zone.area += cell_area;
    zone.centre += cell_area * place;
    if (ground.filled.hole(cell.row, cell.col) >= 0) zone.unknown += cell_area;
  });
  for (std::size_t i = 0; i < zones.size(); ++i) {
    zones[i].centre /= zones[i].area;
    zones[i].is_cut = ground.zone_is_cut[i];
  }
  return zones;
}

/// Variance of a zone's volume: noise of its cells with their correlation (an upper bound, for the
/// zone is taken to be larger than the reach of the correlation), and the error of filled holes.
void find_variances(const ChangedGround& ground, double cell, std::vector<ZoneSum>& zones) {
  const double cell_area = cell * cell;
  const double cell_variance = ground.noise_sd * ground.noise_sd;
  for (ZoneSum& zone : zones) {
    zone.variance = cell_variance * ground.correlation * zone.area * cell_area +
                    std::pow(steep_face_error * zone.volume, 2);
  }
  std::vector<std::vector<double>> filled_cells(
      zones.size(), std::vector<double>(ground.filled.holes.size(), 0.0));
  for_each_cell(ground.zone, [&](Cell at) {
    const int zone = ground.zone(at.row, at.col);
    const int hole = ground.filled.hole(at.row, at.col);
    if (zone < 0 || hole < 0) return;
    filled_cells[static_cast<std::size_t>(zone)][static_cast<std::size_t>(hole)] += 1.0;
  });
  for (std::size_t i = 0; i < zones.size(); ++i) {
    for (std::size_t h = 0; h < filled_cells[i].size(); ++h) {
      const Hole& hole = ground.filled.holes[h];
      const double radius_cells = std::sqrt(static_cast<double>(hole.cells) / 3.141592653589793);
      const double rim_step = 2.0 * std::max(0.0, hole.squared_rim_step - 2.0 * cell_variance);
      const double sd = fill_error * radius_cells * std::sqrt(rim_step) * filled_cells[i][h];
      zones[i].variance += sd * sd * cell_area * cell_area;
    }
  }
}

Area survey(const HeightMap& before, const HeightMap& after, const ChangeOptions& options) {
  if (!same_grid(before, after)) {
    throw Error(ErrorKind::bad_input,
                "the maps before and after must be on one grid: same origin, cell and size");
  }
  Eigen::ArrayXXd difference = after.z - before.z;
  const Eigen::Index known = difference.size() - difference.isNaN().count();
  if (known < fewest_known_cells) {
    throw Error(ErrorKind::bad_input, "the maps before and after share " + std::to_string(known) +
                                          " known cells, at least " +
                                          std::to_string(fewest_known_cells) +
                                          " are needed: do the scans overlap?");
  }
  Area area;
  area.grid.origin = before.origin;
  area.grid.cell = before.cell;
  area.ground = find_change(std::move(difference), before.cell, options);
  area.zones = sum_zones(area.grid, area.ground);
  find_variances(area.ground, before.cell, area.zones);
  area.kinds.assign(area.zones.size(), ZoneKind::other);
  return area;
}

using Chosen = std::vector<bool>;  // by index of the zone

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
  return zones_near(area.ground.zone, chosen, options.spill_distance / area.grid.cell);
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

/// Marks the hole; what rose beside it is spill. Returns the zones beside the hole.
Chosen classify_hole(Area& area, const ChangeOptions& options) {
  const auto all = [](std::size_t) { return true; };
  const Chosen hole = main_zones(area, -1.0, choose(area, -1.0, all), options.dig_area, options);
  if (!any(hole)) return hole;
  const Chosen beside = near(area, hole, options);
  set_kind(area, choose(area, 1.0, [&](std::size_t i) { return beside[i]; }), ZoneKind::spill);
  set_kind(area, hole, ZoneKind::dig);
  return beside;
}

/// The heap is what rose away from the hole. Where nothing did, but the largest rise beside the
/// hole could hold the dug soil, that is the heap.
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

/// A sum of zones over all areas. Zones of one area share the error of its datum.
struct Total {
  double volume = 0.0;
  double variance = 0.0;
  std::vector<double> area;  // by surveyed area [m^2]
};

template <typename Wanted>
Total total(const std::vector<Area>& areas, Wanted wanted) {
  Total sum;
  for (const Area& area : areas) {
    double ground = 0.0;
    for (std::size_t i = 0; i < area.zones.size(); ++i) {
      if (!wanted(area.kinds[i])) continue;
      sum.volume += area.zones[i].volume;
      sum.variance += area.zones[i].variance;
      ground += area.zones[i].area;
    }
    sum.variance += std::pow(ground * area.ground.datum_sd, 2);
    sum.area.push_back(ground);
  }
  return sum;
}

Measured measured(const Total& sum, double sign) {
  return {sum.volume == 0.0 ? 0.0 : sign * sum.volume, std::sqrt(sum.variance)};
}

void sum_volumes(const std::vector<Area>& areas, VolumeChange& change) {
  const auto of = [&](ZoneKind kind) {
    return total(areas, [kind](ZoneKind other) { return other == kind; });
  };
  const Total fallen = of(ZoneKind::dig);
  const Total risen =
      total(areas, [](ZoneKind kind) { return kind == ZoneKind::spill || kind == ZoneKind::dump; });
  change.excavated = measured(fallen, -1.0);
  change.spilled = measured(of(ZoneKind::spill), 1.0);
  change.dumped = measured(of(ZoneKind::dump), 1.0);
  change.before = change.excavated;
  change.after = measured(risen, 1.0);
  // A datum that is too high makes the hole deeper and the heap lower.
  for (std::size_t i = 0; i < areas.size(); ++i) {
    change.covariance_before_after -=
        fallen.area[i] * risen.area[i] * std::pow(areas[i].ground.datum_sd, 2);
  }
}

std::string litres_as_m3(double volume) {
  return number_text(std::round(volume * 1000.0) / 1000.0) + " m^3";
}

std::string hundredths(double value) { return number_text(std::round(value * 100.0) / 100.0); }

std::string place_of(const ZoneSum& zone) {
  return "(" + hundredths(zone.centre.x()) + ", " + hundredths(zone.centre.y()) + ") m";
}

std::string text_of(const ZoneSum& zone) {
  return std::string("ground that ") + (zone.volume > 0.0 ? "rose" : "fell") + " by " +
         litres_as_m3(std::abs(zone.volume)) + " over " + hundredths(zone.area) + " m^2 around " +
         place_of(zone);
}

/// One warning however many there are: a scene full of leaves must not bury what matters.
void warn_of_others(const std::vector<Area>& areas, std::vector<Warning>& warnings) {
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
  if (count == 0) return;
  std::string message =
      text_of(*largest) + " is neither hole, spill nor heap: left out of every volume";
  if (count > 1) {
    message += ", like what changed at " + std::to_string(count - 1) + " more places, " +
               litres_as_m3(sum) + " in all";
  }
  warnings.push_back({"other_change", message});
}

void warn_of_zone(const ZoneSum& zone, const ChangeOptions& options,
                  std::vector<Warning>& warnings) {
  const std::string what = text_of(zone);
  if (zone.is_cut) {
    warnings.push_back({"zone_at_border", what + " reaches the edge of the surveyed ground: part "
                                                 "of it may be missing from its volume"});
  }
  const double share = zone.unknown / zone.area;
  if (share > options.max_unknown_share) {
    warnings.push_back({"zone_partly_unseen",
                        what + " was seen by no scan in " + hundredths(100.0 * share) +
                            " % of its cells, which were filled; more than " +
                            hundredths(100.0 * options.max_unknown_share) + " % is uncertain"});
  }
}

void warn_of_ground(const ChangedGround& ground, std::vector<Warning>& warnings) {
  if (ground.stable_share < least_stable_share) {
    warnings.push_back(
        {"little_stable_ground", "only " + hundredths(100.0 * ground.stable_share) +
                                     " % of the surveyed ground did not change, under " +
                                     hundredths(100.0 * least_stable_share) +
                                     " %: a part that rose or fell evenly could pass for it"});
  }
  if (ground.noise_sd > largest_noise) {
    warnings.push_back({"scans_do_not_fit",
                        "ground that did not change differs by " + hundredths(ground.noise_sd) +
                            " m from scan to scan (one standard deviation), more than " +
                            hundredths(largest_noise) + " m: are both scans in one frame?"});
  }
}

void warn_of_balance(VolumeChange& change) {
  const double before = change.before.value;
  const double after = change.after.value;
  if (!(before > 0.0)) {
    change.warnings.push_back({"no_hole_found",
                               "no ground fell by more than the noise of the scans: no hole was "
                               "found, all volumes of it are 0"});
    return;
  }
  const double dumped = change.dumped.value;
  if (dumped < least_dumped_share * before || after < least_after_share * before) {
    change.warnings.push_back(
        {"no_dumped_soil", "the hole is " + litres_as_m3(before) + ", but only " +
                               litres_as_m3(dumped) + " rose away from it and " +
                               litres_as_m3(after - dumped) +
                               " beside it: the dumped soil is not in the scans, so the bulking "
                               "factor is unknown"});
    return;
  }
  const double error =
      std::sqrt(std::max(0.0, std::pow(change.before.sd, 2) + std::pow(change.after.sd, 2) -
                                  2.0 * change.covariance_before_after));
  const double ratio = after / before;
  const bool shrank = ratio < least_bulking && before - after > 2.0 * error;
  if (shrank || ratio > largest_bulking) {
    change.warnings.push_back(
        {"looks_swapped", "before and after look swapped: " + litres_as_m3(before) +
                              " were dug and " + litres_as_m3(after) + " lie beside it, a factor " +
                              hundredths(ratio) + "; dug soil has " + hundredths(least_bulking) +
                              " to " + hundredths(largest_bulking) + " times its volume"});
  }
}

/// Volume of all zones of a kind; infinite for those that do not count.
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

/// Hands one area's zones over to the result.
void report(Area& area, const ChangeOptions& options, VolumeChange& change) {
  const int first = static_cast<int>(change.zones.size());
  for (std::size_t i = 0; i < area.zones.size(); ++i) {
    const ZoneSum& sum = area.zones[i];
    ChangeZone zone;
    zone.kind = area.kinds[i];
    zone.volume = {sum.volume,
                   std::sqrt(sum.variance + std::pow(sum.area * area.ground.datum_sd, 2))};
    zone.area = sum.area;
    zone.unknown_share = sum.unknown / sum.area;
    zone.extent = sum.extent;
    change.zones.push_back(zone);
    if (std::abs(sum.volume) > least_warned_share * total_of(change, zone.kind)) {
      warn_of_zone(sum, options, change.warnings);
    }
  }
  warn_of_ground(area.ground, change.warnings);
  AreaChange result;
  result.difference = std::move(area.grid);
  result.difference.z =
      (area.ground.filled.hole >= 0)
          .select(std::numeric_limits<double>::quiet_NaN(), area.ground.difference);
  result.zone = (area.ground.zone >= 0).select(area.ground.zone + first, -1);
  result.noise_sd = area.ground.noise_sd;
  result.datum = area.ground.datum;
  change.areas.push_back(std::move(result));
}

VolumeChange result_of(std::vector<Area> areas, const ChangeOptions& options) {
  VolumeChange change;
  sum_volumes(areas, change);
  warn_of_balance(change);
  warn_of_others(areas, change.warnings);
  for (Area& area : areas) report(area, options, change);
  return change;
}

}  // namespace

const char* name(ZoneKind kind) {
  switch (kind) {
    case ZoneKind::dig:
      return "dig";
    case ZoneKind::spill:
      return "spill";
    case ZoneKind::dump:
      return "dump";
    case ZoneKind::other:
      break;
  }
  return "other";
}

VolumeChange measure_change(const HeightMap& before, const HeightMap& after,
                            const ChangeOptions& options) {
  check(options);
  std::vector<Area> areas(1);
  areas[0] = survey(before, after, options);
  classify_scene(areas[0], options);
  return result_of(std::move(areas), options);
}

VolumeChange measure_change(const SurfacePair& dig, const SurfacePair& dump,
                            const ChangeOptions& options) {
  check(options);
  std::vector<Area> areas(2);
  areas[0] = survey(dig.before, dig.after, options);
  areas[1] = survey(dump.before, dump.after, options);
  classify_hole(areas[0], options);
  classify_heap(areas[1], options);
  return result_of(std::move(areas), options);
}

}  // namespace excavplan
