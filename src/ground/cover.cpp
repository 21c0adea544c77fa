// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/cover.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <Eigen/Cholesky>

#include "base/text.hpp"
#include "ground/error_field.hpp"
#include "ground/grid_cells.hpp"
#include "ground/robust.hpp"

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
  constexpr int enough = 6;
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
  constexpr std::size_t enough = 30;      // cells, ours
  constexpr double much_less = 0.75;      // ours: of the variance
  constexpr double least_scatter = 1e-3;  // ours [m]
  Scatter scatter;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (tells_scatter(*pairs[i])) scatter.add(*pairs[i], change, change.areas[i]);
  }
  if (std::min(scatter.in_hole.size(), scatter.on_heap.size()) < enough) return std::nullopt;
  if (std::max(median(scatter.in_hole), median(scatter.on_heap)) > much_less) return std::nullopt;
  const double excess = median(scatter.stable) - median(scatter.fresh);
  if (!(excess > least_scatter * least_scatter)) return std::nullopt;
  const double cover = std::sqrt(3.0 * excess);
  double area = 0.0;
  for (const ChangeZone& zone : change.zones) {
    if (zone.kind != ZoneKind::other) area += zone.area;
  }
  return Warning{
      "grass",
      "returns of the ground that did not change scatter by " +
          readable(1000.0 * std::sqrt(excess), 2) +
          " mm more than those of dug and dumped soil, as on grass: the ground may lie up to " +
          readable(1000.0 * cover, 2) +
          " mm below what was seen of it, which over hole, spill and "
          "heap is " +
          readable(cover * area, 2) +
          " m^3; mow or clear the ground, or scan a place without grass",
      true};
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
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0.0;
  double count = 0.0;
  const double base = map.z(cells.front().row, cells.front().col);
  for (const Cell at : cells) {
    const double z = map.z(at.row, at.col) - base;
    if (std::isnan(z)) continue;
    const Eigen::Vector3d terms(1.0, static_cast<double>(at.col), static_cast<double>(at.row));
    normal += terms * terms.transpose();
    right += z * terms;
    squares += z * z;
    count += 1.0;
  }
  if (count < 4.0) return 0.0;
  return std::sqrt(std::max(0.0, squares - right.dot(normal.ldlt().solve(right))) / count);
}

/// The inner cells of a level patch that is the lowest part of the hole.
std::vector<Cell> level_patch(const HeightMap& after, const std::vector<Cell>& hole, double reach) {
  constexpr double least_share = 0.15;  // ours, of the hole
  constexpr double most_below = 0.02;   // ours, likewise
  constexpr double least_inner = 0.5;   // ours, of the patch
  std::vector<double> heights;
  for (const Cell at : hole) heights.push_back(after.z(at.row, at.col));
  const double level = commonest(heights, reach);
  const auto in_patch = [&](Cell at) { return std::abs(after.z(at.row, at.col) - level) < reach; };
  std::vector<Cell> inner;
  double patch = 0.0;
  double below = 0.0;
  for (const Cell at : hole) {
    below += after.z(at.row, at.col) < level - 2.0 * reach ? 1.0 : 0.0;
    if (!in_patch(at)) continue;
    patch += 1.0;
    bool is_inner = true;
    for_each_neighbour(after.z, at, [&](Cell n) { is_inner = is_inner && in_patch(n); });
    if (is_inner) inner.push_back(at);
  }
  const auto cells = static_cast<double>(hole.size());
  const bool found =
      patch > least_share * cells &&
      below<most_below * cells&& static_cast<double>(inner.size())> least_inner * patch;
  return found ? inner : std::vector<Cell>{};
}

std::optional<Warning> flat_water(const SurfacePair& pair, const VolumeChange& change,
                                  const AreaChange& area) {
  constexpr double reach_in_sd = 3.0;
  constexpr double least_sd = 0.001;     // ours: mapping and waves [m]
  constexpr double rougher = 3.0;        // ours
  constexpr double largest_noise = 2.0;  // ours, in sd
  constexpr double least_area = 0.05;    // ours [m^2]
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
  const std::vector<Cell> patch = level_patch(after, hole, reach_in_sd * sd);
  const double size = static_cast<double>(patch.size()) * after.cell_size * after.cell_size;
  if (size < least_area) return std::nullopt;
  const double seen = roughness(after, patch);
  const double before = roughness(pair.before.height, patch);
  if (seen > largest_noise * sd || before < rougher * std::max(seen, sd)) return std::nullopt;
  return Warning{"flat_water",
                 "the lowest part of the hole, " + readable(size, 2) + " m^2, is level to " +
                     readable(1000.0 * seen, 2) + " mm where the ground before was uneven by " +
                     readable(1000.0 * before, 2) +
                     " mm, as water is: each centimetre of its depth hides " +
                     readable(0.01 * size, 2) + " m^3 of the hole; scan the hole without water",
                 true};
}

}  // namespace

std::vector<Warning> check_cover(const std::vector<const SurfacePair*>& pairs,
                                 const VolumeChange& change) {
  std::vector<Warning> found;
  if (auto warning = grass(pairs, change)) found.push_back(std::move(*warning));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!tells_scatter(*pairs[i])) continue;
    if (auto warning = flat_water(*pairs[i], change, change.areas[i])) {
      found.push_back(std::move(*warning));
    }
  }
  return found;
}

}  // namespace excavplan
