// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/survey/cloud.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include <excavplan/error.hpp>

#include "base/check.hpp"
#include "survey/cloud_outline.hpp"

namespace excavplan {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double left_out = 0.001;  // of the points, on either side of an extent

using Values = std::vector<double>;

Values finite_values(const Cloud& cloud, Eigen::Index axis) {
  Values values;
  values.reserve(cloud.points.size());
  for (const Eigen::Vector3d& point : cloud.points) {
    if (point.allFinite()) values.push_back(point[axis]);
  }
  return values;
}

double nth(Values& values, std::size_t n) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(n);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Area of the square cells of edge `cell` that hold a point, and how many points they hold.
struct Occupied {
  double area = 0.0;
  std::size_t points = 0;
};
Occupied occupied_area(const Cloud& cloud, const Rectangle& extent, double cell) {
  const auto cells_along = [cell](double length) {
    return static_cast<std::size_t>(length / cell) + 1;
  };
  const std::size_t columns = cells_along(extent.x_max - extent.x_min);
  std::vector<bool> seen(columns * cells_along(extent.y_max - extent.y_min));
  Occupied occupied;
  for (const Eigen::Vector3d& point : cloud.points) {
    if (!point.allFinite() || !extent.contains(point.x(), point.y())) continue;
    const auto column = static_cast<std::size_t>((point.x() - extent.x_min) / cell);
    const auto row = static_cast<std::size_t>((point.y() - extent.y_min) / cell);
    seen[row * columns + column] = true;
    ++occupied.points;
  }
  occupied.area = static_cast<double>(std::count(seen.begin(), seen.end(), true)) * cell * cell;
  return occupied;
}

/// In cells of some ten points: first if the cloud filled its extent, then as it really does.
double points_per_area(const Cloud& cloud, std::size_t finite_points) {
  constexpr double points_per_cell = 10.0;
  constexpr double narrowest = 1e-6;  // [m]; a line of points has no area
  constexpr double most_cells = 1e8;  // ours
  const Rectangle extent = plan_extent(cloud);
  const double width = extent.x_max - extent.x_min;
  const double length = extent.y_max - extent.y_min;
  if (std::min(width, length) < narrowest) return unknown;
  const auto points = static_cast<double>(finite_points);
  if (!std::isfinite(width * length)) return unknown;
  // Bounds the grid's memory.
  const double smallest_cell =
      std::max(std::max(width, length) / points, std::sqrt(width * length / most_cells));
  Occupied occupied{width * length, finite_points};
  for (int pass = 0; pass < 2; ++pass) {
    const double cell = std::sqrt(points_per_cell * occupied.area / points);
    occupied = occupied_area(cloud, extent, std::max(cell, smallest_cell));
  }
  return static_cast<double>(occupied.points) / occupied.area;
}

/// Height at which most points lie, in layers of 0.25 m within 50 m of zero.
double commonest_height(const Cloud& cloud) {
  constexpr double layer = 0.25;
  constexpr std::ptrdiff_t farthest = 200;  // layers from zero; the last ones hold all beyond
  std::vector<std::size_t> counts(2 * farthest + 1);
  for (const Eigen::Vector3d& point : cloud.points) {
    if (!point.allFinite()) continue;
    constexpr auto limit = static_cast<double>(farthest);
    const double nearest = std::clamp(std::round(point.z() / layer), -limit, limit);
    ++counts[static_cast<std::size_t>(nearest + limit)];
  }
  const auto fullest = std::max_element(counts.begin(), counts.end()) - counts.begin();
  return layer * static_cast<double>(fullest - farthest);
}

/// Of the points within 60 degrees of the z axis, ahead, from `nearest` to `farthest` along it:
/// wider than depth cameras see.
std::size_t seen_along_z(const Cloud& cloud, double nearest, double farthest) {
  constexpr double tan_view = 1.7320508;
  return static_cast<std::size_t>(
      std::count_if(cloud.points.begin(), cloud.points.end(), [&](const Eigen::Vector3d& point) {
        return point.z() > nearest && point.z() < farthest &&
               point.head<2>().norm() < tan_view * point.z();
      }));
}

/// Without the farthest 0.1 % on either side.
double height_span(const Cloud& cloud) {
  Values values = finite_values(cloud, 2);
  const auto beyond = static_cast<std::size_t>(left_out * static_cast<double>(values.size()));
  const double lowest = nth(values, beyond);
  return nth(values, values.size() - 1 - beyond) - lowest;
}

/// The box of finite points without the farthest 0.1 % on each side.
Eigen::AlignedBox3d usual_box(const Cloud& cloud) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Values values = finite_values(cloud, axis);
    const auto beyond = static_cast<std::size_t>(left_out * static_cast<double>(values.size()));
    box.min()(axis) = nth(values, beyond);
    box.max()(axis) = nth(values, values.size() - 1 - beyond);
  }
  return box;
}

/// Direction of least scatter of finite points but the farthest, z >= 0.
Eigen::Vector3d normal_of(const Cloud& cloud) {
  const Eigen::AlignedBox3d box = usual_box(cloud);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const Eigen::Vector3d& point : cloud.points) {
    if (!box.contains(point)) continue;
    sum += point;
    count += 1.0;
  }
  const Eigen::Vector3d mean = sum / std::max(count, 1.0);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : cloud.points) {
    if (!box.contains(point)) continue;
    scatter += (point - mean) * (point - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  const Eigen::Vector3d normal = axes.eigenvectors().col(0);
  return normal.z() < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

/// The step of which all heights are multiples: the median distance of successive heights, where an
/// eighth of them differ at most; 0 else.
double height_step_of(const Cloud& cloud) {
  constexpr std::size_t fewest_at_each = 8;  // points, ours
  constexpr double same = 1e-5;              // [m]: heights of float32 a hundred metres up
  Values heights = finite_values(cloud, 2);
  std::sort(heights.begin(), heights.end());
  Values steps;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    const double step = heights[i] - heights[i - 1];
    if (step > same) steps.push_back(step);
  }
  if (steps.empty() || (steps.size() + 1) * fewest_at_each > heights.size()) return 0.0;
  return nth(steps, steps.size() / 2);
}

std::string guess_frame(const Cloud& cloud, const CloudSummary& summary) {
  constexpr double map_distance = 1e4;
  constexpr double ground_height = 0.5;
  if (summary.finite_points == 0) return "unknown";
  if (summary.centroid.head<2>().norm() > map_distance) return "map (large coordinates)";
  const std::size_t ahead = seen_along_z(cloud, 0.0, std::numeric_limits<double>::infinity());
  if (ahead * 100 >= summary.finite_points * 99) return "camera (z forward)";
  const Eigen::Vector3d size = summary.max - summary.min;
  const bool is_wide = std::max(size.x(), size.y()) > size.z();
  if (is_wide && std::abs(commonest_height(cloud)) <= ground_height) {
    return "site (z up, ground near 0)";
  }
  return "unknown";
}

}  // namespace

void transform(Cloud& cloud, const Eigen::Matrix4d& site_from_scan) {
  if (!site_from_scan.allFinite()) refuse("transform: a number of site_from_scan is not finite");
  const Eigen::Matrix3d rotation = site_from_scan.topLeftCorner<3, 3>();
  const Eigen::Vector3d shift = site_from_scan.topRightCorner<3, 1>();
  for (Eigen::Vector3d& point : cloud.points) point = rotation * point + shift;
  if (cloud.sensor_origin) cloud.sensor_origin = rotation * *cloud.sensor_origin + shift;
}

CloudSummary summarise(const Cloud& cloud) {
  CloudSummary summary;
  summary.points = cloud.points.size();
  summary.min.setConstant(std::numeric_limits<double>::infinity());
  summary.max = -summary.min;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto first = std::find_if(cloud.points.begin(), cloud.points.end(),
                                  [](const Eigen::Vector3d& point) { return point.allFinite(); });
  for (auto point = first; point != cloud.points.end(); ++point) {
    if (!point->allFinite()) continue;
    ++summary.finite_points;
    sum += *point - *first;  // keeps the digits of large coordinates
    summary.min = summary.min.cwiseMin(*point);
    summary.max = summary.max.cwiseMax(*point);
  }
  if (summary.finite_points == 0) {
    summary.centroid = summary.min = summary.max = Eigen::Vector3d::Constant(unknown);
    summary.density = unknown;
  } else {
    summary.centroid = *first + sum / static_cast<double>(summary.finite_points);
    summary.density = points_per_area(cloud, summary.finite_points);
  }
  summary.frame_guess = guess_frame(cloud, summary);
  return summary;
}

void CloudOutline::add(const std::vector<Eigen::Vector3d>& points) {
  outline_.points += points.size();
  for (const Eigen::Vector3d& point : points) {
    if (point.allFinite()) ++outline_.finite_points;
  }
  sample_.add(points);
}

ScanOutline CloudOutline::result() const {
  constexpr double nearest_seen = 0.1;    // ours, of a depth camera [m]
  constexpr double farthest_seen = 20.0;  // likewise
  ScanOutline outline = outline_;
  outline.density = unknown;
  Cloud cloud;
  for (const Eigen::Vector3d& point : sample_.values()) {
    if (point.allFinite()) cloud.points.push_back(point);
  }
  if (cloud.points.empty()) return outline;
  outline.extent = plan_extent(cloud);
  const auto sampled = static_cast<double>(cloud.points.size());
  outline.density = points_per_area(cloud, cloud.points.size()) *
                    (static_cast<double>(outline.finite_points) / sampled);
  outline.height = height_span(cloud);
  outline.height_step = height_step_of(cloud);
  outline.seen_along_z =
      static_cast<double>(seen_along_z(cloud, nearest_seen, farthest_seen)) / sampled;
  outline.normal = normal_of(cloud);
  return outline;
}

namespace {

double cell_of_points(const std::vector<ScanOutline>& outlines, double points) {
  constexpr double widest_fine = 0.05;  // [m]
  constexpr double fewest_cells_along = 100.0;
  constexpr double sparsest = 1e-9;  // of points that there are [1/m^2]
  double least = widest_fine;
  double density = std::numeric_limits<double>::infinity();
  for (const ScanOutline& outline : outlines) {
    if (!outline.extent) continue;
    const Rectangle& r = *outline.extent;
    least = std::min(least, std::min(r.x_max - r.x_min, r.y_max - r.y_min) / fewest_cells_along);
    if (outline.density > sparsest && outline.density < density) density = outline.density;
  }
  return std::max(least, std::sqrt(points / density));
}

}  // namespace

double cell_for(const std::vector<ScanOutline>& outlines) { return cell_of_points(outlines, 12.0); }

double survey_cell(const std::vector<ScanOutline>& outlines) {
  return cell_of_points(outlines, 2.0);
}

Rectangle plan_extent(const Cloud& cloud) {
  Rectangle extent;
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    Values values = finite_values(cloud, axis);
    if (values.empty()) {
      throw Error(ErrorKind::bad_input, "extent of a cloud: none of its " +
                                            std::to_string(cloud.points.size()) +
                                            " points is finite");
    }
    const auto beyond = static_cast<std::size_t>(left_out * static_cast<double>(values.size()));
    const double lowest = nth(values, beyond);
    const double highest = nth(values, values.size() - 1 - beyond);
    const double above = std::nextafter(highest, std::numeric_limits<double>::infinity());
    (axis == 0 ? extent.x_min : extent.y_min) = lowest;
    (axis == 0 ? extent.x_max : extent.y_max) = above;
  }
  return extent;
}

}  // namespace excavplan
