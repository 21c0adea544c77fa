// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Eigenvalues>

#include <excavplan/scans/scan_surface.hpp>

#include "base/parallel.hpp"
#include "clouds/cloud_summary.hpp"
#include "clouds/stream_sample.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Direction of least scatter of the points in a box, z >= 0.
Eigen::Vector3d normal_of(const Cloud& cloud, const Eigen::AlignedBox3d& box) {
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

/// Heights that three points and more share, but for a few points all of them; none else.
std::vector<double> shared_heights(const Cloud& cloud, double same) {
  constexpr std::size_t fewest_sharing = 3;  // ours
  constexpr double most_alone = 0.05;        // of the points, ours
  std::vector<double> heights;
  for (const Eigen::Vector3d& point : cloud.points) heights.push_back(point.z());
  std::sort(heights.begin(), heights.end());
  std::vector<double> shared;
  std::size_t alone = 0;
  for (auto from = heights.begin(); from != heights.end();) {
    auto to = from + 1;
    while (to != heights.end() && *to - *(to - 1) <= same) ++to;
    const auto count = static_cast<std::size_t>(to - from);
    if (count >= fewest_sharing) {
      shared.push_back(*from);
    } else {
      alone += count;
    }
    from = to;
  }
  const double most = most_alone * static_cast<double>(heights.size());
  return static_cast<double>(alone) > most ? std::vector<double>() : shared;
}

/// The step of rounded heights: the least distance of successive ones, where eight points share
/// each height, there are five heights, and 95 % of the distances are multiples of it; 0 else.
double height_step_of(const Cloud& cloud) {
  constexpr std::size_t fewest_at_each = 8;  // points, ours
  constexpr std::size_t fewest_steps = 4;    // ours
  constexpr double same = 1e-5;              // [m]: heights of float32 a hundred metres up
  constexpr double most_other = 0.05;        // ours
  const std::vector<double> heights = shared_heights(cloud, same);
  const bool are_few = heights.size() * fewest_at_each <= cloud.points.size();
  if (!are_few || heights.size() <= fewest_steps) return 0.0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < heights.size(); ++i) steps.push_back(heights[i] - heights[i - 1]);
  const double least = *std::min_element(steps.begin(), steps.end());
  const auto others = std::count_if(steps.begin(), steps.end(), [&](double step) {
    return std::abs(step - least * std::round(step / least)) > same + 0.01 * least;
  });
  return static_cast<double>(others) > most_other * static_cast<double>(steps.size()) ? 0.0 : least;
}

/// Extent and density of a cloud that streams by.
class CloudOutline {
 public:
  void add(const std::vector<Eigen::Vector3d>& points);
  ScanOutline result() const;

 private:
  ScanOutline outline_;
  StreamSample<Eigen::Vector3d> sample_{std::size_t{1} << 16};
};

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
  const PointSource source = points_of(cloud);
  const Eigen::AlignedBox3d box = usual_box(source, cloud.points.size());
  outline.extent = plan_of(box);
  const auto sampled = static_cast<double>(cloud.points.size());
  outline.density = points_per_area(source, cloud.points.size(), *outline.extent) *
                    (static_cast<double>(outline.finite_points) / sampled);
  outline.height = box.sizes().z();
  outline.height_step = height_step_of(cloud);
  const auto along_z = std::count_if(
      cloud.points.begin(), cloud.points.end(),
      [](const Eigen::Vector3d& point) { return is_along_z(point, nearest_seen, farthest_seen); });
  outline.seen_along_z = static_cast<double>(along_z) / sampled;
  outline.normal = normal_of(cloud, box);
  return outline;
}

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

ScanOutline outline(const Scan& scan) {
  CloudOutline found;
  const VisitedScan visited =
      visit_scan(scan, [&found](const std::vector<Eigen::Vector3d>& points) { found.add(points); });
  ScanOutline result = found.result();
  result.machine_points = visited.machine_points;
  return result;
}

std::vector<ScanOutline> outlines(const std::vector<Scan>& scans, unsigned threads) {
  std::vector<ScanOutline> found(scans.size());
  parallel_for(scans.size(), threads, [&](std::size_t i) { found[i] = outline(scans[i]); });
  return found;
}

CloudSummary summarise(const Scan& scan) {
  CloudShape shape;
  CloudSummary summary =
      summary_of([&](const PointVisitor& visit) { shape = visit_scan(scan, visit).shape; });
  summary.width = shape.width;
  summary.height = shape.height;
  summary.left_out = shape.left_out;
  return summary;
}

}  // namespace excavplan
