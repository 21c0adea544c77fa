// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/cover.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <excavplan/change/bulking.hpp>

#include "base/statistics.hpp"
#include "base/text.hpp"
#include "change/attribution.hpp"
#include "ground/grid_cells.hpp"
#include "ground/plane_fit.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

ZoneKind kind_of(const VolumeChange& change, int zone) {
  return change.zones[static_cast<std::size_t>(zone)].kind;
}

bool tells_scatter(const SurfacePair& pair) {
  const auto size = pair.before.height.z.size();
  return pair.before.variance.size() == size && pair.after.variance.size() == size &&
         pair.before.points.size() == size && pair.after.points.size() == size;
}

// ---- Grass --------------------------------------------------------------------------------------

/// Variance of the height of a return about the plane of its cell; NaN for few returns.
Eigen::ArrayXXd scatter_of(const Surface& surface) {
  constexpr int enough = 4;  // ours
  const Eigen::ArrayXXd points = surface.points.cast<double>();
  return (points >= enough).select(points * surface.variance, std::nan(""));
}

/// Scatter of returns in the kinds of zones: after the dig over that before, by the same on ground
/// that did not change.
struct Scatter {
  std::vector<double> in_hole;
  std::vector<double> on_heap;
  std::vector<double> stable;  ///< after [m^2]
  std::vector<double> fresh;   ///< in the hole, after [m^2]

  void add(const SurfacePair& pair, const VolumeChange& change, const AreaChange& area) {
    constexpr double steep = 1.0;  // cells of steeper faces are no planes
    const Eigen::ArrayXXd before = scatter_of(pair.before);
    const Eigen::ArrayXXd after = scatter_of(pair.after);
    const Gradient gradient = gradient_of(pair.after.height);
    std::vector<double> then;
    std::vector<double> now;
    const auto visit = [&](const auto& with) {
      for_each_cell(area.zone, [&](Cell at) {
        const double slope = std::hypot(gradient.x(at.row, at.col), gradient.y(at.row, at.col));
        const double by_slope = 1.0 + slope * slope;  // of equal noise in every direction
        const double ratio = after(at.row, at.col) / before(at.row, at.col) / by_slope;
        if (!std::isnan(ratio) && slope < steep) with(at, ratio);
      });
    };
    visit([&](Cell at, double) {
      if (area.zone(at.row, at.col) >= 0) return;
      then.push_back(before(at.row, at.col));
      now.push_back(after(at.row, at.col));
    });
    if (then.empty()) return;
    const double usual = median(now) / median(then);
    stable.insert(stable.end(), now.begin(), now.end());
    visit([&](Cell at, double ratio) {
      const int zone = area.zone(at.row, at.col);
      if (zone < 0) return;
      const ZoneKind kind = kind_of(change, zone);
      if (kind == ZoneKind::dump) on_heap.push_back(ratio / usual);
      if (kind != ZoneKind::dig) return;
      in_hole.push_back(ratio / usual);
      fresh.push_back(after(at.row, at.col));
    });
  }
};

std::optional<Warning> grass(const std::vector<const SurfacePair*>& pairs,
                             const VolumeChange& change) {
  constexpr std::size_t enough = 100;     // cells, ours: a ratio of so few returns is off by 2
  constexpr double much_less = 0.75;      // ours: of the variance, in all fresh soil
  constexpr double less = 0.9;            // ours: likewise, in the hole and on the heap
  constexpr double least_scatter = 1e-3;  // ours [m]
  Scatter scatter;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (tells_scatter(*pairs[i])) scatter.add(*pairs[i], change, change.areas[i]);
  }
  if (std::min(scatter.in_hole.size(), scatter.on_heap.size()) < enough) return std::nullopt;
  if (std::max(median(scatter.in_hole), median(scatter.on_heap)) > less) return std::nullopt;
  std::vector<double> of_both = scatter.in_hole;
  of_both.insert(of_both.end(), scatter.on_heap.begin(), scatter.on_heap.end());
  if (median(of_both) > much_less) return std::nullopt;
  const double excess = median(scatter.stable) - median(scatter.fresh);
  if (!(excess > least_scatter * least_scatter)) return std::nullopt;
  const double cover = std::sqrt(3.0 * excess);
  double area = 0.0;
  for (const ChangeZone& zone : change.zones) {
    if (zone.kind != ZoneKind::other) area += zone.area;
  }
  return Warning{
      WarningCode::grass,
      "returns of the ground that did not change scatter by " +
          readable(1000.0 * std::sqrt(excess), 2) +
          " mm more than those of dug and dumped soil, as on grass: the ground may lie up to " +
          readable(1000.0 * cover, 2) +
          " mm below what was seen of it, which over hole, spill and "
          "heap is " +
          readable(cover * area, 2) +
          " m^3; mow or clear the ground, or scan a place without grass"};
}

// ---- Water --------------------------------------------------------------------------------------

/// The level about which most cells lie within `reach`.
double commonest(std::vector<double> heights, double reach) {
  std::sort(heights.begin(), heights.end());
  std::size_t first = 0;
  std::size_t most = 0;
  double level = heights.front();
  for (std::size_t last = 0; last < heights.size(); ++last) {
    while (heights[last] - heights[first] > 2.0 * reach) ++first;
    if (last - first + 1 <= most) continue;
    most = last - first + 1;
    level = heights[(first + last) / 2];
  }
  return level;
}

/// Root mean square of heights about a plane [m].
double roughness(const HeightMap& map, const std::vector<Cell>& cells) {
  PlaneFit fit;
  const double base = map.z(cells.front().row, cells.front().col);
  for (const Cell at : cells) {
    const double z = map.z(at.row, at.col) - base;
    if (std::isnan(z)) continue;
    fit.add(static_cast<double>(at.col), static_cast<double>(at.row), z);
  }
  if (fit.count() < 4.0) return 0.0;
  return std::sqrt(fit.squares_about(fit.plane()) / fit.count());
}

/// The lowest part of a hole, where that is as level and smooth as water.
struct LevelFloor {
  std::vector<Cell> inner;  ///< cells with all their neighbours in it
  double area = 0.0;        ///< of all its cells, and of half a cell of wall around them [m^2]
  double share = 0.0;       ///< of the cells of the hole
  double depth = 0.0;       ///< mean fall of the ground there [m]
  double seen = 0.0;        ///< roughness after [m]
  double before = 0.0;      ///< roughness of the ground before [m]
  double sd = 0.0;          ///< of the height of a cell [m]
  double inner_area = 0.0;  ///< [m^2]

  bool was_rough() const {
    constexpr double rougher = 3.0;  // ours
    return before >= rougher * std::max(seen, sd);
  }
};

/// The level patch that is the lowest part of the hole.
std::optional<LevelFloor> level_patch(const HeightMap& after, const std::vector<Cell>& hole,
                                      double reach) {
  constexpr double least_share = 0.15;  // ours, of the hole
  constexpr double most_below = 0.02;   // ours, likewise
  constexpr double least_inner = 0.5;   // ours, of the patch
  std::vector<double> heights;
  heights.reserve(hole.size());
  for (const Cell at : hole) heights.push_back(after.z(at.row, at.col));
  const double level = commonest(heights, reach);
  const auto in_patch = [&](Cell at) { return std::abs(after.z(at.row, at.col) - level) < reach; };
  LevelFloor patch;
  double patch_cells = 0.0;
  double below = 0.0;
  for (const Cell at : hole) {
    below += after.z(at.row, at.col) < level - 2.0 * reach ? 1.0 : 0.0;
    if (!in_patch(at)) continue;
    patch_cells += 1.0;
    bool is_inner = true;
    for_each_neighbour(after.z, at, [&](Cell n) { is_inner = is_inner && in_patch(n); });
    if (is_inner) patch.inner.push_back(at);
  }
  const auto cells = static_cast<double>(hole.size());
  const auto inner = static_cast<double>(patch.inner.size());
  const double cell_area = after.cell_size * after.cell_size;
  patch.share = patch_cells / cells;
  patch.inner_area = inner * cell_area;
  patch.area = (patch_cells + 0.5 * (patch_cells - inner)) * cell_area;
  if (patch.share <= least_share || below >= most_below * cells) return std::nullopt;
  if (inner <= least_inner * patch_cells) return std::nullopt;
  return patch;
}

std::optional<LevelFloor> level_floor(const SurfacePair& pair, const VolumeChange& change,
                                      const AreaChange& area) {
  constexpr double reach_in_sd = 3.0;
  constexpr double least_sd = 0.001;     // ours: mapping and waves [m]
  constexpr double largest_noise = 2.0;  // ours, in sd
  constexpr double least_area = 0.05;    // ours [m^2]
  if (!tells_scatter(pair)) return std::nullopt;
  const HeightMap& after = pair.after.height;
  std::vector<Cell> hole;
  std::vector<double> variances;
  for_each_cell(area.zone, [&](Cell at) {
    const int zone = area.zone(at.row, at.col);
    if (zone < 0 || kind_of(change, zone) != ZoneKind::dig) return;
    const double variance = pair.after.variance(at.row, at.col);
    if (std::isnan(after.z(at.row, at.col)) || std::isnan(variance)) return;
    hole.push_back(at);
    variances.push_back(variance);
  });
  if (hole.empty()) return std::nullopt;
  const double sd = std::max(std::sqrt(median(variances)), least_sd);
  std::optional<LevelFloor> floor = level_patch(after, hole, reach_in_sd * sd);
  if (!floor || floor->inner_area < least_area) return std::nullopt;
  floor->sd = sd;
  floor->seen = roughness(after, floor->inner);
  floor->before = roughness(pair.before.height, floor->inner);
  std::vector<double> falls;
  for (const Cell at : floor->inner) {
    const double change_there = area.difference.z(at.row, at.col);
    if (!std::isnan(change_there)) falls.push_back(-change_there);
  }
  if (falls.empty() || floor->seen > largest_noise * sd) return std::nullopt;
  floor->depth = median(falls);
  return floor;
}

/// Volume of the hole below a level floor, if water hides this share of its depth: the area of the
/// hole goes on shrinking with depth as above the floor, to nothing.
double hidden_volume(const LevelFloor& floor, double hole, double share) {
  const double flare =
      2.0 * std::max(0.0, hole - floor.area * floor.depth) / std::pow(floor.depth, 2);
  const double bottom = flare > 0.0 ? floor.area / flare : std::numeric_limits<double>::infinity();
  const double deeper = std::min(floor.depth * share / (1.0 - share), bottom);
  return floor.area * deeper - 0.5 * flare * deeper * deeper;
}

/// What water over a level floor would make of the bulking factor.
struct HiddenFloor {
  double least = 0.0;        ///< volume under the water [m^3]
  double most = 0.0;         ///< likewise
  double highest = 0.0;      ///< bulking factor with the least [-]
  double lowest = 0.0;       ///< with the most
  double prior = 0.0;        ///< that it is water, by the ground around
  double probability = 0.0;  ///< likewise, with the balance of the soil
};

/// Nothing where there is no bulking factor, or the floor is too small to hide much.
std::optional<HiddenFloor> hidden_floor(const LevelFloor& floor, const VolumeChange& change) {
  constexpr double least_share = 0.2;  // ours: of the hole; less hides little
  constexpr double on_even = 0.03;     // ours: where the ground was as level
  constexpr double on_rough = 0.15;    // ours: where it was not; a bucket that drags levels too
  constexpr double shallowest = 0.05;  // ours: share of the depth of the hole
  constexpr double deepest = 0.60;     // ours, likewise
  constexpr int depths = 8;
  const auto k = bulking_factor(change);
  if (!k || floor.share < least_share || !(floor.depth > 0.0)) return std::nullopt;
  const double hole = change.before.value;
  const auto bulking_under = [&](double share) {
    return k->value * hole / (hole + hidden_volume(floor, hole, share));
  };
  HiddenFloor hidden{hidden_volume(floor, hole, shallowest),
                     hidden_volume(floor, hole, deepest),
                     bulking_under(shallowest),
                     bulking_under(deepest),
                     floor.was_rough() ? on_rough : on_even,
                     0.0};
  double likelihood = 0.0;
  for (int i = 0; i < depths; ++i) {
    const double share = shallowest + (i + 0.5) / depths * (deepest - shallowest);
    likelihood += likelihood_of_bulking(bulking_under(share)) / depths;
  }
  const double water = hidden.prior * likelihood;
  hidden.probability = water / (water + (1.0 - hidden.prior) * likelihood_of_bulking(k->value));
  return hidden;
}

/// The reading that a level floor is water, of any depth.
void add_water(const HiddenFloor& hidden, VolumeChange& change) {
  if (change.readings.empty()) return;
  const std::string what =
      "water over the lowest 5 to 60 % of the hole, as level as its floor: no scan tells";
  const double weight = hidden.prior;
  change.attribution.push_back(
      {ChangeKind::water,
       what,
       {-0.5 * (hidden.least + hidden.most), 0.25 * (hidden.most - hidden.least)},
       false,
       weight});
  for (Reading& reading : change.readings) reading.weight *= 1.0 - weight;
  const double spread = 0.25 * (hidden.highest - hidden.lowest);
  change.readings.push_back(
      {{ChangeKind::water},
       "with " + what,
       weight,
       {0.5 * (hidden.lowest + hidden.highest), std::hypot(bulking_errors(change).scans, spread)}});
}

Warning flat_water(const LevelFloor& floor, const VolumeChange& change) {
  constexpr double as_likely = 0.35;  // ours, of water: ends trust
  const auto hidden = hidden_floor(floor, change);
  const bool is_likely = hidden && hidden->probability > as_likely;
  return {WarningCode::flat_water,
          "the lowest part of the hole, " + readable(floor.inner_area, 2) + " m^2, is level to " +
              readable(1000.0 * floor.seen, 2) + " mm where the ground before was uneven by " +
              readable(1000.0 * floor.before, 2) +
              " mm, as a bucket leaves it that drags level, or as water is" +
              (is_likely ? ", which the large bulking factor speaks for" : "") +
              ": each centimetre of water would hide " + readable(0.01 * floor.inner_area, 2) +
              " m^3 of the hole; if there was water, scan the hole without it",
          is_likely};
}

// ---- Shadows ------------------------------------------------------------------------------------

/// Cells of the hole between points, interpolated as those of a sparse scan, are as many before the
/// dig as after; shadows of its walls are there after alone (sign test of McNemar 1947).
std::optional<Warning> shadowed(const SurfacePair& pair, const VolumeChange& change,
                                const AreaChange& area) {
  constexpr double significant = 3.0;   // sd, ours
  constexpr double least_share = 0.01;  // ours, of the hole's cells
  const bool is_placed = std::any_of(
      change.warnings.begin(), change.warnings.end(),
      [](const Warning& warning) { return warning.code == WarningCode::sensor_place_inferred; });
  if (is_placed || !pair.after.sensors.empty() || !tells_scatter(pair)) return std::nullopt;
  const auto is_between = [](const Surface& surface, Cell at) {
    return surface.points(at.row, at.col) == 0 && !std::isnan(surface.height.z(at.row, at.col));
  };
  double cells = 0.0;
  double only_after = 0.0;
  double only_before = 0.0;
  for_each_cell(area.zone, [&](Cell at) {
    const int zone = area.zone(at.row, at.col);
    if (zone < 0 || kind_of(change, zone) != ZoneKind::dig) return;
    cells += 1.0;
    const bool now = is_between(pair.after, at);
    const bool then = is_between(pair.before, at);
    only_after += now && !then ? 1.0 : 0.0;
    only_before += then && !now ? 1.0 : 0.0;
  });
  const double more = only_after - only_before;
  if (!(more > least_share * cells) ||
      !(more > significant * std::sqrt(only_after + only_before))) {
    return std::nullopt;
  }
  return Warning{
      WarningCode::hole_in_shadow,
      readable(100.0 * more / cells, 2) +
          " % of the hole's cells hold no point after the dig, but did before: its walls "
          "hide part of it; tell where the sensor stood by `sensor_origin`, or scan it "
          "from a second standpoint"};
}

}  // namespace

std::vector<Warning> check_cover(const std::vector<const SurfacePair*>& pairs,
                                 const VolumeChange& change) {
  std::vector<Warning> found;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (auto warning = shadowed(*pairs[i], change, change.areas[i])) {
      found.push_back(std::move(*warning));
    }
  }
  if (auto warning = grass(pairs, change)) found.push_back(std::move(*warning));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto floor = level_floor(*pairs[i], change, change.areas[i]);
    if (floor && floor->was_rough()) found.push_back(flat_water(*floor, change));
  }
  return found;
}

void state_water(const std::vector<const SurfacePair*>& pairs, VolumeChange& change) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto floor = level_floor(*pairs[i], change, change.areas[i]);
    if (!floor) continue;
    if (const auto hidden = hidden_floor(*floor, change)) add_water(*hidden, change);
  }
}

}  // namespace excavplan
