// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <excavplan/error.hpp>
#include <excavplan/survey/cloud.hpp>

#include "json_file.hpp"

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
  if (!(options.cell > 0.0) || !std::isfinite(options.cell)) {
    refuse("cell is " + number_text(options.cell) + " m, must be > 0");
  }
  if (!(options.outlier_distance > 0.0)) {
    refuse("outlier_distance is " + number_text(options.outlier_distance) + ", must be > 0");
  }
  const Span columns = span_of(extent.x_min, extent.x_max, options.cell);
  const Span rows = span_of(extent.y_min, extent.y_max, options.cell);
  if (!(columns.count > 0.0) || !(rows.count > 0.0)) {
    refuse("extent x " + number_text(extent.x_min) + " .. " + number_text(extent.x_max) + ", y " +
           number_text(extent.y_min) + " .. " + number_text(extent.y_max) + " m is empty");
  }
  if (!(columns.count * rows.count <= most_cells)) {
    refuse("cells of " + number_text(options.cell) + " m make a map of " +
           number_text(columns.count) + " x " + number_text(rows.count) +
           ", at most 100 million cells are possible");
  }
  HeightMap map;
  map.cell = options.cell;
  map.origin = options.cell * Eigen::Vector2d(columns.first, rows.first);
  map.z = Eigen::ArrayXXd::Constant(static_cast<Index>(rows.count),
                                    static_cast<Index>(columns.count), unknown);
  return map;
}

/// A point with its plan position against the centre of its cell [cell].
struct CellPoint {
  float x;
  float y;
  double z;
};

/// The points of a cloud by cell; cells are counted as Eigen stores the map, column by column.
class PointsByCell {
 public:
  PointsByCell(const Cloud& cloud, const HeightMap& map) {
    const auto cells = static_cast<std::size_t>(map.z.size());
    if (cloud.points.size() >= outside) {
      throw Error(ErrorKind::bad_input, "rasterise: the cloud has " +
                                            std::to_string(cloud.points.size()) +
                                            " points, at most 2^32 - 2 are possible");
    }
    begin_.assign(cells + 1, 0);
    std::vector<std::uint32_t> cell_of(cloud.points.size());
    for (std::size_t i = 0; i < cell_of.size(); ++i) {
      cell_of[i] = locate(cloud.points[i], map);
      if (cell_of[i] != outside) ++begin_[cell_of[i]];
    }
    std::uint32_t total = 0;
    for (std::uint32_t& begin : begin_) total += std::exchange(begin, total);

    points_.resize(total);
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    const auto rows = static_cast<std::uint32_t>(map.z.rows());
    for (std::size_t i = 0; i < cell_of.size(); ++i) {
      if (cell_of[i] == outside) continue;
      const Eigen::Vector3d& point = cloud.points[i];
      const double x = (point.x() - map.x(cell_of[i] / rows)) / map.cell;
      const double y = (point.y() - map.y(cell_of[i] % rows)) / map.cell;
      points_[next[cell_of[i]]++] = {static_cast<float>(x), static_cast<float>(y), point.z()};
    }
  }

  struct Range {
    const CellPoint* first;
    const CellPoint* last;
    const CellPoint* begin() const { return first; }
    const CellPoint* end() const { return last; }
    std::size_t size() const { return static_cast<std::size_t>(last - first); }
  };
  Range in_cell(Index cell) const {
    const auto i = static_cast<std::size_t>(cell);
    return {points_.data() + begin_[i], points_.data() + begin_[i + 1]};
  }

 private:
  static constexpr std::uint32_t outside = std::numeric_limits<std::uint32_t>::max();

  static std::uint32_t locate(const Eigen::Vector3d& point, const HeightMap& map) {
    const double column = (point.x() - map.origin.x()) / map.cell;
    const double row = (point.y() - map.origin.y()) / map.cell;
    const bool inside = column >= 0.0 && column < static_cast<double>(map.z.cols()) && row >= 0.0 &&
                        row < static_cast<double>(map.z.rows()) && std::isfinite(point.z());
    if (!inside) return outside;
    return static_cast<std::uint32_t>(row) +
           static_cast<std::uint32_t>(map.z.rows()) * static_cast<std::uint32_t>(column);
  }

  std::vector<std::uint32_t> begin_;  // of the points of every cell, and the end
  std::vector<CellPoint> points_;
};

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

Eigen::ArrayXXd cell_medians(const PointsByCell& points, const HeightMap& map) {
  Eigen::ArrayXXd medians = map.z;
  std::vector<double> heights;
  for (Index cell = 0; cell < medians.size(); ++cell) {
    const auto in_cell = points.in_cell(cell);
    if (in_cell.size() == 0) continue;
    heights.clear();
    for (const CellPoint& point : in_cell) heights.push_back(point.z);
    medians(cell) = median(heights);
  }
  return medians;
}

/// Lower quartile of the cells' robust standard deviation (1.4826 times the median absolute
/// deviation), from some thousand cells spread over the map: level ground without outliers.
double noise_of_level_cells(const PointsByCell& points, const Eigen::ArrayXXd& medians) {
  constexpr std::size_t fewest_points = 5;
  constexpr std::size_t fewest_cells = 10;
  constexpr std::size_t most_samples = 4096;
  std::vector<Index> cells;
  for (Index cell = 0; cell < medians.size(); ++cell) {
    if (points.in_cell(cell).size() >= fewest_points) cells.push_back(cell);
  }
  if (cells.size() < fewest_cells) return std::numeric_limits<double>::infinity();
  const std::size_t stride = (cells.size() + most_samples - 1) / most_samples;
  std::vector<double> deviations;
  std::vector<double> noise;
  for (std::size_t i = 0; i < cells.size(); i += stride) {
    deviations.clear();
    for (const CellPoint& point : points.in_cell(cells[i])) {
      deviations.push_back(std::abs(point.z - medians(cells[i])));
    }
    noise.push_back(1.4826 * median(deviations));
  }
  const auto quartile = noise.begin() + static_cast<std::ptrdiff_t>(noise.size() / 4);
  std::nth_element(noise.begin(), quartile, noise.end());
  return *quartile;
}

struct Band {
  double low;
  double high;
  bool contains(double z) const { return z >= low && z <= high; }
};

/// The heights that ground in a cell may have; see rasterise(). The farthest neighbour on each side
/// is left out only where enough others remain.
Band band_around(const Eigen::ArrayXXd& medians, Index row, Index column, double gap) {
  constexpr std::size_t enough = 5;
  std::array<double, 9> heights{};
  std::size_t count = 0;
  const Index last_column = std::min(column + 1, medians.cols() - 1);
  const Index last_row = std::min(row + 1, medians.rows() - 1);
  for (Index c = std::max<Index>(column - 1, 0); c <= last_column; ++c) {
    for (Index r = std::max<Index>(row - 1, 0); r <= last_row; ++r) {
      if (!std::isnan(medians(r, c))) heights[count++] = medians(r, c);
    }
  }
  std::sort(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(count));
  const std::size_t dropped = count >= enough ? 1 : 0;
  const double low = heights[dropped];
  const double high = heights[count - 1 - dropped];
  const double reach = gap + 0.5 * (high - low);
  return {low - reach, high + reach};
}

/// First and second moments of accepted points, heights against a reference.
class Moments {
 public:
  void add(const CellPoint& point, double reference) {
    const Eigen::Vector3d p(static_cast<double>(point.x), static_cast<double>(point.y),
                            point.z - reference);
    ++count_;
    sum_ += p;
    products_ += p * p.transpose();
  }

  std::size_t count() const { return count_; }

  /// The mean height, moved to the cell's centre along a plane through the points if they are
  /// enough and spread over the cell: at least half the standard deviation of an even spread,
  /// 1 / sqrt(12), in every direction.
  double height_at_centre() const {
    constexpr std::size_t enough = 8;
    constexpr double least_variance = 0.25 / 12.0;
    const Eigen::Vector3d mean = sum_ / static_cast<double>(count_);
    if (count_ < enough) return mean.z();
    const Eigen::Matrix3d c = products_ / static_cast<double>(count_) - mean * mean.transpose();
    const double half_trace = 0.5 * (c(0, 0) + c(1, 1));
    const double determinant = c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1);
    const double smallest =
        half_trace - std::sqrt(std::max(0.0, half_trace * half_trace - determinant));
    if (smallest < least_variance) return mean.z();
    const double slope_x = (c(1, 1) * c(0, 2) - c(0, 1) * c(1, 2)) / determinant;
    const double slope_y = (c(0, 0) * c(1, 2) - c(0, 1) * c(0, 2)) / determinant;
    return mean.z() - slope_x * mean.x() - slope_y * mean.y();
  }

 private:
  std::size_t count_ = 0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
};

}  // namespace

HeightMap rasterise(const Cloud& cloud, const Rectangle& extent, const RasterOptions& options) {
  HeightMap map = empty_map(extent, options);
  const PointsByCell points(cloud, map);
  const Eigen::ArrayXXd medians = cell_medians(points, map);
  const double gap = options.outlier_distance * noise_of_level_cells(points, medians);
  for (Index column = 0; column < map.z.cols(); ++column) {
    for (Index row = 0; row < map.z.rows(); ++row) {
      const auto in_cell = points.in_cell(column * map.z.rows() + row);
      const double reference = medians(row, column);
      if (in_cell.size() == 1) map.z(row, column) = reference;
      if (in_cell.size() < 2) continue;
      const Band band = band_around(medians, row, column, gap);
      Moments moments;
      for (const CellPoint& point : in_cell) {
        if (band.contains(point.z)) moments.add(point, reference);
      }
      if (moments.count() > 0) map.z(row, column) = reference + moments.height_at_centre();
    }
  }
  return map;
}

}  // namespace excavplan
