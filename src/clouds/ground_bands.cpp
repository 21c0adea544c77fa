// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/ground_bands.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/non_finite.hpp"
#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr std::size_t trusted = 5;  // points, whose median is hardly ever an outlier; ours
constexpr double crumb = 0.04;      // ours: soil lies in crumbs so high, which belong to it [m]

/// By the distances from the level, and of rounded heights at least as large as that leaves it.
double noise_of(std::vector<float>& heights, double level) {
  std::sort(heights.begin(), heights.end());
  float step = std::numeric_limits<float>::infinity();
  for (std::size_t i = 1; i < heights.size(); ++i) {
    if (heights[i] > heights[i - 1]) step = std::min(step, heights[i] - heights[i - 1]);
  }
  for (float& value : heights) value = std::abs(value - static_cast<float>(level));
  const double scatter = mad_to_sd * mean_median(heights);
  if (std::isinf(step)) return scatter;
  return std::max(scatter, static_cast<double>(step) / std::sqrt(12.0));
}

/// Medians of all groups, from 64 to 128 points where there are more, and the noise: lower
/// quartile of the robust standard deviation (1.4826 times the median absolute deviation) of some
/// thousand groups spread over the map, which is that of level ground without outliers.
GroundLevels find_levels(PointsByCell& points) {
  constexpr std::size_t enough_points = 128;
  constexpr std::size_t fewest_points = 5;
  constexpr std::size_t fewest_groups = 10;
  constexpr std::size_t most_samples = 4096;
  GroundLevels levels{Eigen::ArrayXXd::Constant(points.group_rows(), points.group_columns(), nan)};
  std::size_t groups = 0;
  for (Index group = 0; group < levels.height.size(); ++group) {
    if (points.in_group(group) >= fewest_points) ++groups;
  }
  const std::size_t stride = (groups + most_samples - 1) / most_samples;
  std::vector<float> values;
  std::vector<double> noise;
  std::size_t seen = 0;
  points.for_each_group([&](Index group, CellRange in_group) {
    values.clear();
    const std::size_t step = 1 + in_group.size() / enough_points;
    for (std::size_t i = 0; i < in_group.size(); i += step) values.push_back(in_group.first[i].z);
    const double level = mean_median(values);
    levels.height(group) = level;
    if (in_group.size() < fewest_points || seen++ % stride != 0) return;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*low < *high) noise.push_back(noise_of(values, level));
  });
  if (groups < fewest_groups) {
    levels.noise = std::numeric_limits<double>::infinity();
    return levels;
  }
  if (noise.empty()) return levels;  // rounded to one height in every group
  levels.noise = upper_quantile(noise, 0.25);
  return levels;
}

/// True if two cells around have their ground above `valley`, or too few are known.
bool upper_level_goes_on(const Eigen::ArrayXXd& lowest, Index cell, double valley) {
  constexpr int enough_known = 4;  // with the cell itself; ours
  constexpr int enough_above = 2;  // ours
  int known = 0;
  int above = 0;
  for_each_around(lowest, {cell % lowest.rows(), cell / lowest.rows()}, 1, [&](Cell n) {
    known += std::isnan(lowest(n.row, n.col)) ? 0 : 1;
    above += lowest(n.row, n.col) >= valley ? 1 : 0;
  });
  return known < enough_known || above >= enough_above;
}

/// True if at most one group around holds two surfaces too: outliers do not lie on a surface that
/// goes on.
bool is_alone(const std::unordered_map<Index, Overlay>& overlays, Index group, Index rows) {
  constexpr int enough = 2;  // ours
  int others = 0;
  for (const Index column : {-1, 0, 1}) {
    for (const Index row : {-1, 0, 1}) {
      if (column == 0 && row == 0) continue;
      const Index inside = group % rows + row;
      if (inside < 0 || inside >= rows) continue;
      others += static_cast<int>(overlays.count(group + column * rows + row));
    }
  }
  return others < enough;
}

/// By how much the height of a group may be wrong where it holds two surfaces: if the lower one
/// counts, by the share of the upper; if both do, by that of the smaller.
double doubt_by(const Overlay& both, bool only_lower) {
  const double share =
      only_lower ? both.share_above : std::min(both.share_above, 1.0 - both.share_above);
  return both.apart * share;
}

/// Takes what grows or hangs above the ground off the levels. A gap must be wider than noise makes
/// it, and than a slope does between a few points.
Cover lower_to_ground(PointsByCell& points, GroundLevels& levels, double group_size) {
  constexpr double gap_to_noise = 8.0;  // ours
  constexpr double gap_to_cell = 0.5;   // ours
  Cover cover{{}, Eigen::ArrayXXd::Zero(levels.height.rows(), levels.height.cols())};
  if (!std::isfinite(levels.noise)) return cover;
  const double gap = std::max({gap_to_noise * levels.noise, gap_to_cell * group_size, crumb});
  std::vector<Split> splits;
  std::unordered_map<Index, Overlay> overlays;
  std::vector<float> heights;
  const Index rows = levels.height.rows();
  points.for_each_group([&](Index group, CellRange in_group) {
    const CellsAround around = surroundings_of(levels.height, group % rows, group / rows);
    if (const auto both = overlay_in(in_group, around.slope, gap, heights)) {
      overlays[group] = *both;
    }
    auto split = two_levels(in_group, levels.height(group), gap, heights);
    if (!split) return;
    split->cell = group;
    splits.push_back(*split);
  });
  Eigen::ArrayXXd lowest = levels.height;
  for (const Split& split : splits) lowest(split.cell) = split.low;
  for (const Split& split : splits) {
    if (!split.among || upper_level_goes_on(lowest, split.cell, split.valley)) continue;
    levels.height(split.cell) = split.low;
    cover.ceilings[split.cell] = split.valley;
  }
  for (const auto& [group, both] : overlays) lowest(group) = both.low;
  for (const auto& [group, both] : overlays) {
    if (is_alone(overlays, group, rows)) continue;                  // as by outliers
    if (upper_level_goes_on(lowest, group, both.valley)) continue;  // as beside a wall
    cover.doubt(group) = doubt_by(both, cover.ceilings.count(group) > 0);
  }
  return cover;
}

}  // namespace

GroundBands::GroundBands(PointsByCell& points, double cell_size, double outlier_distance)
    : points_(points),
      levels_(find_levels(points)),
      cover_(lower_to_ground(points, levels_, static_cast<double>(points.side()) * cell_size)),
      gap_(outlier_distance * levels_.noise) {
  if (points.side() > 1) find_fine_levels();
}

/// From a plane that the levels around are off by so much [m].
double GroundBands::reach_of(double off_plane) const {
  constexpr double bend = 3.0;  // ours: of the ground in a cell, to that of those around
  return std::max(gap_ + bend * off_plane, crumb);
}

CellsAround GroundBands::around_group(Index group) const {
  const Index rows = levels_.height.rows();
  const Index row = group % rows, column = group / rows;
  if (points_.side() == 1) return surroundings_of(levels_.height, row, column);
  if (column != column_of_around_) around_.assign(static_cast<std::size_t>(rows), std::nullopt);
  column_of_around_ = column;
  auto& around = around_[static_cast<std::size_t>(row)];
  if (!around) around = surroundings_of(levels_.height, row, column);
  return *around;
}

Band GroundBands::by_groups(Index cell) const {
  const Index group = points_.group_of(cell);
  CellsAround around = around_group(group);
  if (points_.in_group(group) >= trusted) {
    const double level = levels_.height(group);
    around.low = std::min(around.low, level);
    around.high = std::max(around.high, level);
    const double off = std::abs(level - around.plane);
    around.off_plane = std::max(around.off_plane, off);
    around.off_plane_all = std::max(around.off_plane_all, off);
  }
  const double reach = std::max(gap_ + 0.5 * (around.high - around.low), crumb);
  Band band{around.low - reach, around.high + reach};
  if (const auto ceiling = cover_.ceilings.find(group); ceiling != cover_.ceilings.end()) {
    band.high = std::min(band.high, ceiling->second);
  }
  band.slope = around.slope / static_cast<double>(points_.side());
  band.plane_slope = band.slope;
  band.plane = around.plane + band.slope.dot(points_.from_centre_of_group(cell));
  band.reach = reach_of(points_.side() > 1 ? around.off_plane_all : around.off_plane);
  return band;
}

Band GroundBands::band(Index cell) const {
  Band band = by_groups(cell);
  if (fine_.size() == 0 || std::isnan(fine_(cell))) return band;
  const Index rows = fine_.rows();
  const CellsAround around = surroundings_of(fine_, cell % rows, cell / rows);
  const double off = std::max(around.off_plane, std::abs(fine_(cell) - around.plane));
  if (reach_of(off) >= band.reach) return band;
  band.plane = around.plane;
  band.plane_slope = around.slope;
  band.reach = reach_of(off);
  return band;
}

/// Medians above the slope of the group.
void GroundBands::find_fine_levels() {
  Eigen::ArrayXXd fine = Eigen::ArrayXXd::Constant(points_.rows(), points_.columns(), nan);
  std::vector<float> heights;
  points_.for_each_cell([&](Index cell, CellRange in_cell) {
    const Band band = by_groups(cell);
    heights.clear();
    for (const CellPoint& point : in_cell) {
      if (!band.contains(point)) continue;
      heights.push_back(static_cast<float>(height_above(point, band.slope)));
    }
    if (heights.size() >= trusted) fine(cell) = mean_median(heights);
  });
  fine_ = fine;
}

DistanceBins::DistanceBins(double gap) : per_bin_(4.0 / std::max(gap, 1e-6)) {}

std::size_t DistanceBins::of(double distance) const {
  const double bin = distance * per_bin_;
  return bin < static_cast<double>(count) ? static_cast<std::size_t>(bin) : count;
}

void OutlierTally::add(CellRange points, const Band& band) {
  const std::size_t reach = bins_.of(band.farthest());
  if (reach >= DistanceBins::count) return;
  Class& alike = by_reach_[reach];
  alike.points += static_cast<double>(points.size());
  for (const CellPoint& point : points) {
    if (band.contains(point)) continue;
    const double off = band.from_plane(point);
    if (const std::size_t bin = bins_.of(std::abs(off)); bin < DistanceBins::count) {
      alike.off[bin] += off;
    }
  }
}

OutlierBias OutlierTally::bias() const {
  constexpr double most_even = 0.1;  // ours: of the points
  double all = 0.0;
  for (const Class& alike : by_reach_) all += alike.points;
  OutlierBias bias{bins_};
  double points = 0.0;
  for (const Class& alike : by_reach_) {
    if (points > 0.0 && points >= most_even * all) break;
    points += alike.points;
    for (std::size_t i = 0; i < DistanceBins::count; ++i) bias.at[i + 1] += alike.off[i];
  }
  if (!(points > 0.0)) return bias;
  double sum = 0.0;
  for (double& at : bias.at) at = (sum += at) / points;
  return bias;
}

}  // namespace excavplan
