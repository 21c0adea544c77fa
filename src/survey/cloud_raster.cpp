// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <excavplan/error.hpp>
#include <excavplan/survey/scan_surface.hpp>

#include "base/text.hpp"
#include "ground/sight_lines.hpp"
#include "survey/cloud_cell.hpp"
#include "survey/points_by_cell.hpp"
#include "survey/scan_reading.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double most_cells = 1e8;

/// Lattice lines of the grid before `low` and behind `high`, with room for rounding.
struct Span {
  double first = 0.0;
  double count = 0.0;
};
Span span_of(double low, double high, double cell) {
  constexpr double rounding = 1e-9;
  const double first = std::floor(low / cell + rounding);
  return {first, std::ceil(high / cell - rounding) - first};
}

HeightMap empty_map(const Rectangle& extent, const RasterOptions& options) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorKind::bad_input, "rasterise: " + what);
  };
  if (!(options.cell_size > 0.0) || !std::isfinite(options.cell_size)) {
    refuse("cell is " + number_text(options.cell_size) + " m, must be > 0");
  }
  if (!(options.outlier_distance > 0.0)) {
    refuse("outlier_distance is " + number_text(options.outlier_distance) + ", must be > 0");
  }
  const Eigen::Vector2d& node = options.node;
  if (!node.allFinite()) refuse("node is not finite");
  const Span columns = span_of(extent.x_min - node.x(), extent.x_max - node.x(), options.cell_size);
  const Span rows = span_of(extent.y_min - node.y(), extent.y_max - node.y(), options.cell_size);
  if (!(columns.count > 0.0) || !(rows.count > 0.0)) {
    refuse("extent x " + number_text(extent.x_min) + " .. " + number_text(extent.x_max) + ", y " +
           number_text(extent.y_min) + " .. " + number_text(extent.y_max) + " m is empty");
  }
  if (!(columns.count * rows.count <= most_cells)) {
    refuse("cells of " + number_text(options.cell_size) + " m make a map of " +
           number_text(columns.count) + " x " + number_text(rows.count) +
           ", at most 100 million cells are possible");
  }
  HeightMap map;
  map.cell_size = options.cell_size;
  map.origin = node + options.cell_size * Eigen::Vector2d(columns.first, rows.first);
  map.z = Eigen::ArrayXXd::Constant(static_cast<Index>(rows.count),
                                    static_cast<Index>(columns.count), unknown);
  return map;
}

/// The level of every group of cells and how far points may be from it.
struct Levels {
  Eigen::ArrayXXd height;  ///< above the base [m]; NaN without points
  double noise = 0.0;      ///< lower quartile of the cells' robust sd [m]
};

/// Medians of all groups, from 64 to 128 points where there are more, and the noise: lower
/// quartile of the robust standard deviation (1.4826 times the median absolute deviation) of some
/// thousand groups spread over the map, which is that of level ground without outliers.
Levels find_levels(PointsByCell& points) {
  constexpr std::size_t enough_points = 128;
  constexpr std::size_t fewest_points = 5;
  constexpr std::size_t fewest_groups = 10;
  constexpr std::size_t most_samples = 4096;
  Levels levels{Eigen::ArrayXXd::Constant(points.group_rows(), points.group_columns(), unknown)};
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
    for (float& value : values) value = std::abs(value - static_cast<float>(level));
    noise.push_back(1.4826 * mean_median(values));
  });
  if (groups < fewest_groups) {
    levels.noise = std::numeric_limits<double>::infinity();
    return levels;
  }
  const auto quartile = noise.begin() + static_cast<std::ptrdiff_t>(noise.size() / 4);
  std::nth_element(noise.begin(), quartile, noise.end());
  levels.noise = *quartile;
  return levels;
}

/// Groups whose upper points are no ground, with the height above which those lie.
using Ceilings = std::unordered_map<Index, double>;

/// True if two cells around have their ground above `valley`, or too few are known.
bool upper_level_goes_on(const Eigen::ArrayXXd& lowest, Index cell, double valley) {
  constexpr int enough_known = 4;  // with the cell itself; ours
  constexpr int enough_above = 2;  // ours
  const Index column = cell / lowest.rows();
  const Index row = cell % lowest.rows();
  int known = 0;
  int above = 0;
  for (Index c = std::max<Index>(column - 1, 0); c <= std::min(column + 1, lowest.cols() - 1);
       ++c) {
    for (Index r = std::max<Index>(row - 1, 0); r <= std::min(row + 1, lowest.rows() - 1); ++r) {
      known += std::isnan(lowest(r, c)) ? 0 : 1;
      above += lowest(r, c) >= valley ? 1 : 0;
    }
  }
  return known < enough_known || above >= enough_above;
}

/// What lies above the ground in groups of cells.
struct Cover {
  Ceilings ceilings;
  Eigen::ArrayXXd doubt;  ///< of the height, where points lie on two surfaces [m]
};

/// By how much the height of a group may be wrong where it holds two surfaces: if the lower one
/// counts, by the share of the upper; if both do, by that of the smaller.
double doubt_by(const Overlay& both, bool only_lower) {
  const double share =
      only_lower ? both.share_above : std::min(both.share_above, 1.0 - both.share_above);
  return both.apart * share;
}

/// Takes what grows or hangs above the ground off the levels. A gap must be wider than noise makes
/// it, and than a slope does between a few points.
Cover lower_to_ground(PointsByCell& points, Levels& levels, double group_size) {
  constexpr double gap_to_noise = 8.0;  // ours
  constexpr double gap_to_cell = 0.5;   // ours
  Cover cover{{}, Eigen::ArrayXXd::Zero(levels.height.rows(), levels.height.cols())};
  if (!std::isfinite(levels.noise)) return cover;
  const double gap = std::max(gap_to_noise * levels.noise, gap_to_cell * group_size);
  std::vector<Split> splits;
  std::unordered_map<Index, Overlay> overlays;
  std::vector<float> heights;
  const Index rows = levels.height.rows();
  points.for_each_group([&](Index group, CellRange in_group) {
    const Surroundings around = surroundings_of(levels.height, group % rows, group / rows);
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
    if (upper_level_goes_on(lowest, group, both.valley)) continue;  // as beside a wall
    cover.doubt(group) = doubt_by(both, cover.ceilings.count(group) > 0);
  }
  return cover;
}

/// Heights that the ground may have in the cells of a group, and its slope.
struct Expected {
  Band band;
  double level = 0.0;
  Eigen::Vector2d slope;  // [m/cell]
};

Expected expected_in(const PointsByCell& points, const Levels& levels, const Ceilings& ceilings,
                     double gap, Index group) {
  constexpr std::size_t trusted = 5;  // points, whose median is hardly ever an outlier; ours
  const Index rows = levels.height.rows();
  Surroundings around = surroundings_of(levels.height, group % rows, group / rows);
  const double level = levels.height(group);
  if (points.in_group(group) >= trusted) {
    around.low = std::min(around.low, level);
    around.high = std::max(around.high, level);
  }
  const double reach = gap + 0.5 * (around.high - around.low);
  Band band{around.low - reach, around.high + reach};
  if (const auto ceiling = ceilings.find(group); ceiling != ceilings.end()) {
    band.high = std::min(band.high, ceiling->second);
  }
  return {band, level, around.slope / static_cast<double>(points.side())};
}

Surface surface_of(const PointSource& source, const HeightMap& map, const RasterOptions& options) {
  PointsByCell points(source, map, options.memory);
  Levels levels = find_levels(points);
  const Cover cover =
      lower_to_ground(points, levels, static_cast<double>(points.side()) * map.cell_size);
  const double gap = options.outlier_distance * levels.noise;
  Surface surface{map, map.z, Eigen::ArrayXXi::Zero(map.z.rows(), map.z.cols())};
  surface.doubt = Eigen::ArrayXXd::Zero(map.z.rows(), map.z.cols());
  points.for_each_cell([&](Index cell, CellRange in_cell) {
    const Index group = points.group_of(cell);
    const Expected ground = expected_in(points, levels, cover.ceilings, gap, group);
    const CellHeight result =
        mean_height(in_cell, ground.band, ground.level, levels.noise, ground.slope);
    surface.height.z(cell) = points.base() + (ground.level + result.height);
    surface.variance(cell) = result.variance;
    surface.doubt(cell) = cover.doubt(group);
    surface.points(cell) = static_cast<int>(std::lround(result.points * points.per_kept(cell)));
  });
  return surface;
}

/// What one standpoint saw: its points that count, and the space that they show to be empty.
struct View {
  Eigen::ArrayXXi dropped;  ///< 1 for cells whose returns are mixed or that it saw in part
  Eigen::ArrayXXi seen;     ///< 1 for cells that it saw
  Eigen::ArrayXXd ceiling;  ///< of ground, by its rays [m]
};

View view_from(const Standpoint& from, const HeightMap& map, const RasterOptions& options) {
  const PointSource source = [&from](const PointVisitor& visit) { visit_scan(from.scan, visit); };
  Surface seen = surface_of(source, map, options);
  seen.sensors = {from.place};
  View view;
  view.dropped = drop_mixed_returns(seen);
  view.seen = (!seen.height.z.isNaN()).cast<int>();
  const SightLines sight(seen.height, from.place);
  view.ceiling = map.z;
  for_each_cell(map.z, [&](Cell at) { view.ceiling(at.row, at.col) = sight.ceiling(at); });
  return view;
}

/// True if a point of a view counts: not mixed, and not in space that is empty by another view.
bool counts(const std::vector<View>& views, std::size_t own, const HeightMap& map,
            const Eigen::Vector3d& point) {
  constexpr double place = 0.5;  // ours: of a cell, by which clouds may lie apart
  const Eigen::Vector2d at = (point.head<2>() - map.origin) / map.cell_size;
  const Rectangle all = {0.0, 0.0, static_cast<double>(map.z.cols()) - 0.5,
                         static_cast<double>(map.z.rows()) - 0.5};
  if (!all.contains(std::floor(at.x()), std::floor(at.y()))) return true;
  const auto row = static_cast<Index>(at.y());
  const auto col = static_cast<Index>(at.x());
  if (views[own].dropped(row, col) != 0) return false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i != own && point.z() > views[i].ceiling(row, col) + place * map.cell_size) return false;
  }
  return true;
}

/// From several standpoints.
Surface surface_of(const std::vector<Standpoint>& standpoints, const HeightMap& map,
                   const RasterOptions& options) {
  std::vector<View> views;
  for (const Standpoint& from : standpoints) views.push_back(view_from(from, map, options));
  const PointSource kept = [&](const PointVisitor& visit) {
    std::vector<Eigen::Vector3d> some;
    for (std::size_t i = 0; i < standpoints.size(); ++i) {
      visit_scan(standpoints[i].scan, [&](const std::vector<Eigen::Vector3d>& points) {
        some.clear();
        std::copy_if(points.begin(), points.end(), std::back_inserter(some),
                     [&](const Eigen::Vector3d& p) { return counts(views, i, map, p); });
        visit(some);
      });
    }
  };
  Surface surface = surface_of(kept, map, options);
  surface.seen_from = Eigen::ArrayXXi::Zero(map.z.rows(), map.z.cols());
  for (std::size_t i = 0; i < views.size(); ++i) {
    surface.sensors.push_back(standpoints[i].place);
    surface.seen_from += (1 << i) * views[i].seen;
  }
  return surface;
}

}  // namespace

Surface survey_surface(const Scan& scan, const Rectangle& extent, const RasterOptions& options) {
  const std::vector<Standpoint> standpoints = standpoints_of(scan);
  const HeightMap map = empty_map(extent, options);
  if (standpoints.size() > 1) return surface_of(standpoints, map, options);
  const PointSource source = [&scan](const PointVisitor& visit) { visit_scan(scan, visit); };
  Surface surface = surface_of(source, map, options);
  if (!standpoints.empty()) surface.sensors = {standpoints.front().place};
  return surface;
}

HeightMap rasterise(const Cloud& cloud, const Rectangle& extent, const RasterOptions& options) {
  const PointSource source = [&cloud](const PointVisitor& visit) { visit(cloud.points); };
  return surface_of(source, empty_map(extent, options), options).height;
}

}  // namespace excavplan
