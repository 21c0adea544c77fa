// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

#include <excavplan/error.hpp>
#include <excavplan/survey/scan_surface.hpp>

#include "base/text.hpp"
#include "ground/robust.hpp"
#include "survey/cloud_cell.hpp"
#include "survey/cloud_outline.hpp"
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
  const Span columns = span_of(extent.x_min, extent.x_max, options.cell_size);
  const Span rows = span_of(extent.y_min, extent.y_max, options.cell_size);
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
  map.origin = options.cell_size * Eigen::Vector2d(columns.first, rows.first);
  map.z = Eigen::ArrayXXd::Constant(static_cast<Index>(rows.count),
                                    static_cast<Index>(columns.count), unknown);
  return map;
}

/// Gives all points, those that are not finite included, to a visitor; the same on every call.
using PointSource = std::function<void(const PointVisitor&)>;

/// The points of a scan by cell; cells are counted as Eigen stores the map, column by column. What
/// does not fit into memory at a time is read in bands of cells, each from the source.
class PointsByCell {
 public:
  PointsByCell(const PointSource& source, const HeightMap& map, std::uint64_t memory)
      : source_(source),
        origin_(map.origin),
        per_cell_(1.0 / map.cell_size),
        rows_(map.z.rows()),
        columns_(map.z.cols()),
        counts_(static_cast<std::size_t>(map.z.size())) {
    StreamSample<double> heights(1024);
    source_([&](const std::vector<Eigen::Vector3d>& points) {
      for (const Eigen::Vector3d& point : points) {
        const Place place = locate(point);
        if (place.cell == outside) continue;
        ++counts_[place.cell];
        heights.add(point.z());
      }
    });
    std::vector<double> sample = heights.values();
    base_ = sample.empty() ? 0.0 : median(sample);
    part(std::max<std::uint64_t>(memory / sizeof(CellPoint), 1));
  }

  double base() const { return base_; }  ///< that heights of points are counted from [m]
  std::size_t count(Index cell) const { return counts_[static_cast<std::size_t>(cell)]; }

  /// Calls `visit(cell, points)` for every cell with points, in their order.
  template <typename Visit>
  void for_each_cell(const Visit& visit) {
    for (std::size_t band = 0; band + 1 < bands_.size(); ++band) {
      if (band != loaded_) load(band);
      for (std::size_t cell = bands_[band]; cell < bands_[band + 1]; ++cell) {
        if (counts_[cell] == 0) continue;
        const std::size_t i = cell - bands_[band];
        visit(static_cast<Index>(cell),
              CellRange{points_.get() + begin_[i], points_.get() + begin_[i + 1]});
      }
    }
  }

 private:
  static constexpr std::size_t outside = std::numeric_limits<std::size_t>::max();

  struct Place {
    std::size_t cell = outside;
    double column = 0.0;
    double row = 0.0;
  };

  Place locate(const Eigen::Vector3d& point) const {
    Place place;
    place.column = (point.x() - origin_.x()) * per_cell_;
    place.row = (point.y() - origin_.y()) * per_cell_;
    const bool inside = place.column >= 0.0 && place.column < static_cast<double>(columns_) &&
                        place.row >= 0.0 && place.row < static_cast<double>(rows_) &&
                        std::isfinite(point.z());
    if (inside) {
      place.cell = static_cast<std::size_t>(place.row) +
                   static_cast<std::size_t>(rows_) * static_cast<std::size_t>(place.column);
    }
    return place;
  }

  /// Bands of at most so many points, but of one cell at least.
  void part(std::uint64_t most_points) {
    bands_.assign(1, 0);
    std::uint64_t points = 0;
    std::uint64_t most = 0;
    for (std::size_t cell = 0; cell < counts_.size(); ++cell) {
      if (points > 0 && points + counts_[cell] > most_points) {
        bands_.push_back(cell);
        points = 0;
      }
      points += counts_[cell];
      most = std::max(most, points);
    }
    bands_.push_back(counts_.size());
    // make_unique would write zeros over the whole block first.
    points_.reset(new CellPoint[most]);  // NOLINT(modernize-make-unique)
  }

  void load(std::size_t band) {
    const std::size_t first = bands_[band];
    const std::size_t last = bands_[band + 1];
    begin_.assign(last - first + 1, 0);
    for (std::size_t cell = first; cell < last; ++cell) {
      begin_[cell - first + 1] = begin_[cell - first] + counts_[cell];
    }
    std::vector<std::uint64_t> next(begin_.begin(), begin_.end() - 1);
    std::uint64_t placed = 0;
    source_([&](const std::vector<Eigen::Vector3d>& points) {
      for (const Eigen::Vector3d& point : points) {
        const Place place = locate(point);
        if (place.cell - first >= last - first) continue;  // outside wraps to the largest number
        const std::size_t cell = place.cell - first;
        if (next[cell] == begin_[cell + 1]) refuse_change();
        points_[next[cell]++] = {within(place.column), within(place.row),
                                 static_cast<float>(point.z() - base_)};
        ++placed;
      }
    });
    if (placed != begin_.back()) refuse_change();
    loaded_ = band;
  }

  static std::uint16_t within(double place) {
    return static_cast<std::uint16_t>(65536.0 * (place - std::floor(place)));
  }

  [[noreturn]] static void refuse_change() {
    throw Error(ErrorKind::bad_file, "a scan changed while it was read");
  }

  const PointSource& source_;
  Eigen::Vector2d origin_;
  double per_cell_;
  Index rows_;
  Index columns_;
  std::vector<std::uint32_t> counts_;
  std::vector<std::size_t> bands_;  ///< first cells, and the end
  double base_ = 0.0;
  std::size_t loaded_ = outside;
  std::vector<std::uint64_t> begin_;  ///< of the points of every cell of the band, and the end
  std::unique_ptr<CellPoint[]> points_;
};

/// The level of every cell and how far points may be from it.
struct Levels {
  Eigen::ArrayXXd height;  ///< above the base [m]; NaN without points
  double noise = 0.0;      ///< lower quartile of the cells' robust sd [m]
};

/// Medians of all cells, from 128 to 256 points where there are more, and the noise: lower quartile
/// of the robust standard deviation (1.4826 times the median absolute deviation) of some thousand
/// cells spread over the map, which is that of level ground without outliers.
Levels find_levels(PointsByCell& points, const HeightMap& map) {
  constexpr std::size_t enough_points = 256;
  constexpr std::size_t fewest_points = 5;
  constexpr std::size_t fewest_cells = 10;
  constexpr std::size_t most_samples = 4096;
  std::size_t cells = 0;
  for (Index cell = 0; cell < map.z.size(); ++cell) {
    if (points.count(cell) >= fewest_points) ++cells;
  }
  const std::size_t stride = (cells + most_samples - 1) / most_samples;
  Levels levels{map.z};
  std::vector<float> values;
  std::vector<double> noise;
  std::size_t seen = 0;
  points.for_each_cell([&](Index cell, CellRange in_cell) {
    values.clear();
    const std::size_t step = 1 + in_cell.size() / enough_points;
    for (std::size_t i = 0; i < in_cell.size(); i += step) values.push_back(in_cell.first[i].z);
    const double level = mean_median(values);
    levels.height(cell) = level;
    if (in_cell.size() < fewest_points || seen++ % stride != 0) return;
    for (float& value : values) value = std::abs(value - static_cast<float>(level));
    noise.push_back(1.4826 * mean_median(values));
  });
  if (cells < fewest_cells) {
    levels.noise = std::numeric_limits<double>::infinity();
    return levels;
  }
  const auto quartile = noise.begin() + static_cast<std::ptrdiff_t>(noise.size() / 4);
  std::nth_element(noise.begin(), quartile, noise.end());
  levels.noise = *quartile;
  return levels;
}

/// Cells whose upper points are no ground, with the height above which those lie.
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

/// Takes what grows or hangs above the ground off the levels. A gap must be wider than noise makes
/// it, and than a slope does between a few points.
Ceilings lower_to_ground(PointsByCell& points, Levels& levels, double cell_size) {
  constexpr double gap_to_noise = 8.0;  // ours
  constexpr double gap_to_cell = 0.5;   // ours
  Ceilings ceilings;
  if (!std::isfinite(levels.noise)) return ceilings;
  const double gap = std::max(gap_to_noise * levels.noise, gap_to_cell * cell_size);
  std::vector<Split> splits;
  std::vector<float> heights;
  points.for_each_cell([&](Index cell, CellRange in_cell) {
    auto split = two_levels(in_cell, levels.height(cell), gap, heights);
    if (!split) return;
    split->cell = cell;
    splits.push_back(*split);
  });
  Eigen::ArrayXXd lowest = levels.height;
  for (const Split& split : splits) lowest(split.cell) = split.low;
  for (const Split& split : splits) {
    if (!split.among || upper_level_goes_on(lowest, split.cell, split.valley)) continue;
    levels.height(split.cell) = split.low;
    ceilings[split.cell] = split.valley;
  }
  return ceilings;
}

Surface surface_of(const PointSource& source, const HeightMap& map, const RasterOptions& options) {
  PointsByCell points(source, map, options.memory);
  Levels levels = find_levels(points, map);
  const Ceilings ceilings = lower_to_ground(points, levels, map.cell_size);
  constexpr std::size_t trusted = 5;  // points, whose median is hardly ever an outlier; ours
  const double gap = options.outlier_distance * levels.noise;
  const Index rows = map.z.rows();
  Surface surface{map, map.z, Eigen::ArrayXXi::Zero(rows, map.z.cols())};
  points.for_each_cell([&](Index cell, CellRange in_cell) {
    Surroundings around = surroundings_of(levels.height, cell % rows, cell / rows);
    const double level = levels.height(cell);
    if (in_cell.size() >= trusted) {
      around.low = std::min(around.low, level);
      around.high = std::max(around.high, level);
    }
    const double reach = gap + 0.5 * (around.high - around.low);
    Band band{around.low - reach, around.high + reach};
    if (const auto ceiling = ceilings.find(cell); ceiling != ceilings.end()) {
      band.high = std::min(band.high, ceiling->second);
    }
    const CellHeight result = mean_height(in_cell, band, level, levels.noise, around.slope);
    surface.height.z(cell) = points.base() + (level + result.height);
    surface.variance(cell) = result.variance;
    surface.points(cell) = result.points;
  });
  return surface;
}

}  // namespace

Surface survey_surface(const Scan& scan, const Rectangle& extent, const RasterOptions& options) {
  const PointSource source = [&scan](const PointVisitor& visit) { visit_scan(scan, visit); };
  Surface surface = surface_of(source, empty_map(extent, options), options);
  surface.sensor = sensor_of(scan);
  return surface;
}

HeightMap rasterise(const Cloud& cloud, const Rectangle& extent, const RasterOptions& options) {
  const PointSource source = [&cloud](const PointVisitor& visit) { visit(cloud.points); };
  return surface_of(source, empty_map(extent, options), options).height;
}

}  // namespace excavplan
