// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/cloud_summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>

#include "base/non_finite.hpp"

namespace excavplan {
namespace {

constexpr double left_out = 0.001;  // of the points, on either side of an extent

/// The lowest of the values that stream by, so many of them.
class Lowest {
 public:
  explicit Lowest(std::size_t count) : count_(count) {}

  void add(double value) {
    if (value >= bound_) return;
    values_.push_back(value);
    if (values_.size() == 2 * count_) bound_ = highest();
  }
  /// The highest of them.
  double highest() {
    if (values_.size() < count_) refuse_change();
    const auto last = values_.begin() + static_cast<std::ptrdiff_t>(count_) - 1;
    std::nth_element(values_.begin(), last, values_.end());
    values_.resize(count_);
    return values_.back();
  }

 private:
  std::size_t count_;
  double bound_ = std::numeric_limits<double>::infinity();
  std::vector<double> values_;  ///< those, and some of the others
};

template <typename Use>
void for_each_finite(const PointSource& source, const Use& use) {
  source([&use](const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& point : points) {
      if (point.allFinite()) use(point);
    }
  });
}

/// Area of the square cells of edge `cell` that hold a point, and how many points they hold.
struct Occupied {
  double area = 0.0;
  std::size_t points = 0;
};
Occupied occupied_area(const PointSource& source, const Rectangle& extent, double cell) {
  const auto cells_along = [cell](double length) {
    return static_cast<std::size_t>(length / cell) + 1;
  };
  const std::size_t columns = cells_along(extent.x_max - extent.x_min);
  std::vector<bool> seen(columns * cells_along(extent.y_max - extent.y_min));
  Occupied occupied;
  for_each_finite(source, [&](const Eigen::Vector3d& point) {
    if (!extent.contains(point.x(), point.y())) return;
    const auto column = static_cast<std::size_t>((point.x() - extent.x_min) / cell);
    const auto row = static_cast<std::size_t>((point.y() - extent.y_min) / cell);
    seen[row * columns + column] = true;
    ++occupied.points;
  });
  occupied.area = static_cast<double>(std::count(seen.begin(), seen.end(), true)) * cell * cell;
  return occupied;
}

/// Finds the height at which most points lie, in layers of 0.25 m within 50 m of zero.
class Layers {
 public:
  void add(double z) {
    const double nearest = std::clamp(std::round(z / thickness), -limit, limit);
    ++counts_[static_cast<std::size_t>(nearest + limit)];
  }
  double commonest_height() const {
    const auto fullest = std::max_element(counts_.begin(), counts_.end()) - counts_.begin();
    return thickness * (static_cast<double>(fullest) - limit);
  }

 private:
  static constexpr double thickness = 0.25;
  static constexpr double limit = 200.0;  // layers from zero; the last ones hold all beyond
  std::array<std::size_t, 401> counts_{};
};

/// Adds up what one pass over a cloud shows.
class Totals {
 public:
  void add(const std::vector<Eigen::Vector3d>& points) {
    summary_.points += points.size();
    for (const Eigen::Vector3d& point : points) {
      if (point.allFinite()) add(point);
    }
  }

  /// But for extent and density, which take more passes.
  CloudSummary summary() const {
    CloudSummary summary = summary_;
    if (summary.finite_points == 0) {
      summary.centroid = summary.min = summary.max = Eigen::Vector3d::Constant(nan);
      summary.density = nan;
    } else {
      summary.centroid = first_ + sum_ / static_cast<double>(summary.finite_points);
    }
    summary.frame_guess = frame_guess(summary);
    return summary;
  }

 private:
  void add(const Eigen::Vector3d& point) {
    if (summary_.finite_points++ == 0) first_ = summary_.min = summary_.max = point;
    sum_ += point - first_;  // keeps the digits of large coordinates
    summary_.min = summary_.min.cwiseMin(point);
    summary_.max = summary_.max.cwiseMax(point);
    if (is_along_z(point, 0.0, std::numeric_limits<double>::infinity())) ++ahead_;
    layers_.add(point.z());
  }

  std::string frame_guess(const CloudSummary& summary) const {
    constexpr double map_distance = 1e4;
    constexpr double ground_height = 0.5;
    if (summary.finite_points == 0) return "unknown";
    if (summary.centroid.head<2>().norm() > map_distance) return "map (large coordinates)";
    if (ahead_ * 100 >= summary.finite_points * 99) return "camera (z forward)";
    const Eigen::Vector3d size = summary.max - summary.min;
    const bool is_wide = std::max(size.x(), size.y()) > size.z();
    if (is_wide && std::abs(layers_.commonest_height()) <= ground_height) {
      return "site (z up, ground near 0)";
    }
    return "unknown";
  }

  CloudSummary summary_;
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  std::size_t ahead_ = 0;
  Layers layers_;
};

}  // namespace

Eigen::AlignedBox3d usual_box(const PointSource& source, std::size_t finite_points) {
  const auto beyond = static_cast<std::size_t>(left_out * static_cast<double>(finite_points));
  std::vector<Lowest> low(3, Lowest(beyond + 1));
  std::vector<Lowest> high = low;  // of the negated coordinates
  for_each_finite(source, [&](const Eigen::Vector3d& point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = point[static_cast<Eigen::Index>(axis)];
      low[axis].add(value);
      high[axis].add(-value);
    }
  });
  return {Eigen::Vector3d(low[0].highest(), low[1].highest(), low[2].highest()),
          -Eigen::Vector3d(high[0].highest(), high[1].highest(), high[2].highest())};
}

Rectangle plan_of(const Eigen::AlignedBox3d& box) {
  const auto above = [](double value) {
    return std::nextafter(value, std::numeric_limits<double>::infinity());
  };
  return {box.min().x(), box.min().y(), above(box.max().x()), above(box.max().y())};
}

double points_per_area(const PointSource& source, std::size_t finite_points,
                       const Rectangle& extent) {
  constexpr double points_per_cell = 10.0;
  constexpr double narrowest = 1e-6;  // [m]; a line of points has no area
  constexpr double most_cells = 1e8;  // ours
  const double width = extent.x_max - extent.x_min;
  const double length = extent.y_max - extent.y_min;
  if (std::min(width, length) < narrowest) return nan;
  const auto points = static_cast<double>(finite_points);
  if (!std::isfinite(width * length)) return nan;
  // Bounds the grid's memory.
  const double smallest_cell =
      std::max(std::max(width, length) / points, std::sqrt(width * length / most_cells));
  Occupied occupied{width * length, finite_points};
  for (int pass = 0; pass < 2; ++pass) {
    const double cell = std::sqrt(points_per_cell * occupied.area / points);
    occupied = occupied_area(source, extent, std::max(cell, smallest_cell));
  }
  return static_cast<double>(occupied.points) / occupied.area;
}

bool is_along_z(const Eigen::Vector3d& point, double nearest, double farthest) {
  constexpr double tan_view = 1.7320508;
  return point.z() > nearest && point.z() < farthest &&
         point.head<2>().norm() < tan_view * point.z();
}

PointSource points_of(const Cloud& cloud) {
  return [&cloud](const PointVisitor& visit) { visit(cloud.points); };
}

CloudSummary summary_of(const PointSource& source) {
  Totals totals;
  source([&totals](const std::vector<Eigen::Vector3d>& points) { totals.add(points); });
  CloudSummary summary = totals.summary();
  if (summary.finite_points == 0) return summary;
  summary.extent = plan_of(usual_box(source, summary.finite_points));
  summary.density = points_per_area(source, summary.finite_points, *summary.extent);
  return summary;
}

CloudSummary summarise(const Cloud& cloud) {
  CloudSummary summary = summary_of(points_of(cloud));
  summary.width = cloud.width;
  summary.height = cloud.height;
  summary.left_out = cloud.left_out;
  return summary;
}

Rectangle plan_extent(const Cloud& cloud) {
  const PointSource source = points_of(cloud);
  std::size_t finite_points = 0;
  for_each_finite(source, [&finite_points](const Eigen::Vector3d&) { ++finite_points; });
  if (finite_points == 0) {
    throw Error(ErrorKind::bad_input, "extent of a cloud: none of its " +
                                          std::to_string(cloud.points.size()) +
                                          " points is finite");
  }
  return plan_of(usual_box(source, finite_points));
}

}  // namespace excavplan
