// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include <excavplan/scans/scan_surface.hpp>

#include "base/non_finite.hpp"
#include "base/parallel.hpp"
#include "clouds/cloud_summary.hpp"
#include "clouds/stream_sample.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan {
namespace {

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

/// @param height  of a point
template <typename Height>
std::vector<double> sorted_heights(const std::vector<Eigen::Vector3d>& points,
                                   const Height& height) {
  std::vector<double> heights;
  heights.reserve(points.size());
  for (const Eigen::Vector3d& point : points) heights.push_back(height(point));
  std::sort(heights.begin(), heights.end());
  return heights;
}

/// Equal heights.
struct Run {
  double height;
  std::size_t count;
};
std::vector<Run> runs_of(const std::vector<double>& sorted, double same) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i > 0 && sorted[i] - sorted[i - 1] <= same) {
      ++runs.back().count;
    } else {
      runs.push_back({sorted[i], 1});
    }
  }
  return runs;
}

/// Heights that three points and more share, but for a few points all of them; none else.
std::vector<double> shared_heights(const std::vector<double>& sorted, double same) {
  constexpr std::size_t fewest_sharing = 3;  // ours
  constexpr double most_alone = 0.05;        // of the points, ours
  std::vector<double> shared;
  std::size_t alone = 0;
  for (const Run& run : runs_of(sorted, same)) {
    if (run.count >= fewest_sharing) {
      shared.push_back(run.height);
    } else {
      alone += run.count;
    }
  }
  const double most = most_alone * static_cast<double>(sorted.size());
  return static_cast<double>(alone) > most ? std::vector<double>() : shared;
}

/// The step of rounded heights: the least distance of successive ones, where eight points share
/// each height, there are five heights, and 95 % of the distances are multiples of it; 0 else.
double height_step_of(const std::vector<double>& sorted) {
  constexpr std::size_t fewest_at_each = 8;  // points, ours
  constexpr std::size_t fewest_steps = 4;    // ours
  constexpr double same = 1e-5;              // [m]: heights of float32 a hundred metres up
  constexpr double most_other = 0.05;        // ours
  const std::vector<double> heights = shared_heights(sorted, same);
  const bool are_few = heights.size() * fewest_at_each <= sorted.size();
  if (!are_few || heights.size() <= fewest_steps) return 0.0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < heights.size(); ++i) steps.push_back(heights[i] - heights[i - 1]);
  const double least = *std::min_element(steps.begin(), steps.end());
  const auto others = std::count_if(steps.begin(), steps.end(), [&](double step) {
    return std::abs(step - least * std::round(step / least)) > same + 0.01 * least;
  });
  return static_cast<double>(others) > most_other * static_cast<double>(steps.size()) ? 0.0 : least;
}

/// A number that stands for "none" in some format: nines, the ends of an integer, a huge one.
bool stands_for_none(double height) {
  constexpr double huge = 1e30;
  const double size = std::abs(height);
  const bool is_nines =
      size > 98.0 && size < huge &&
      std::abs(std::round(std::log10(size + 1.0)) - std::log10(size + 1.0)) < 1e-9;
  return is_nines || size >= huge || size == 32767.0 || size == 32768.0 || size == 65535.0;
}

/// Runs far from the heights beside them that three points and more share and whose number is known
/// to mean "none", or that a good part of the points shares.
std::vector<Run> candidates_of(const std::vector<Run>& runs, double points) {
  constexpr std::size_t fewest = 3;     // ours
  constexpr double apart = 10.0;        // ours, of files in metres
  constexpr double least_share = 0.05;  // ours, of a number that is not known
  constexpr double most_share = 0.5;    // ours: more is the ground
  std::vector<Run> found;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool is_apart = (i == 0 || runs[i].height - runs[i - 1].height > apart) &&
                          (i + 1 == runs.size() || runs[i + 1].height - runs[i].height > apart);
    const double share = static_cast<double>(runs[i].count) / points;
    const bool is_often = share >= least_share && share <= most_share;
    if (!is_apart || runs[i].count < fewest) continue;
    if (is_often || stands_for_none(runs[i].height)) found.push_back(runs[i]);
  }
  return found;
}

/// Candidates far from where most of the other heights lie.
std::vector<double> far_runs(const std::vector<Run>& runs, const std::vector<double>& sorted) {
  constexpr double least = 10.0;   // ours, of files in metres
  constexpr double ranges = 10.0;  // ours, of the others from tenth to tenth
  constexpr double rounding = 1e-6;
  const std::vector<Run> candidates = candidates_of(runs, static_cast<double>(sorted.size()));
  std::vector<double> others;
  std::remove_copy_if(sorted.begin(), sorted.end(), std::back_inserter(others), [&](double height) {
    return std::any_of(candidates.begin(), candidates.end(),
                       [&](const Run& run) { return std::abs(run.height - height) <= rounding; });
  });
  std::vector<double> found;
  if (others.empty()) return found;
  const std::size_t n = others.size();
  const double far = std::max(least, ranges * (others[n * 9 / 10] - others[n / 10]));
  for (const Run& run : candidates) {
    if (std::abs(run.height - others[n / 2]) > far) found.push_back(run.height);
  }
  return found;
}

/// Heights that mean "none": those far from all others, and a zero that a few points in a hundred
/// share where hardly any share another height.
std::vector<double> no_data_in(const std::vector<double>& sorted) {
  constexpr std::size_t fewest = 6;      // points; ours
  constexpr double least_share = 0.002;  // ours, of a zero
  constexpr double most_share = 0.2;     // ours: more is ground that someone drew
  constexpr double more_often = 20.0;    // ours, than the next that is shared
  constexpr double same = 1e-9;
  if (sorted.size() < fewest) return {};
  const std::vector<Run> runs = runs_of(sorted, same);
  std::vector<double> found = far_runs(runs, sorted);
  double zeros = 0.0, next = 1.0;
  for (const Run& run : runs) {
    if (std::find(found.begin(), found.end(), run.height) != found.end()) continue;
    double& count = std::abs(run.height) <= same ? zeros : next;
    count = std::max(count, static_cast<double>(run.count));
  }
  const auto points = static_cast<double>(sorted.size());
  if (zeros > least_share * points && zeros < most_share * points && zeros > more_often * next) {
    found.push_back(0.0);
  }
  return found;
}

/// How far points are spread in plan (Welford 1962).
class PlanSpread {
 public:
  void add(const Eigen::Vector3d& point) {
    count_ += 1.0;
    const Eigen::Vector2d off = point.head<2>() - mean_;
    mean_ += off / count_;
    squares_ += off.cwiseProduct(point.head<2>() - mean_);
  }
  Eigen::Array2d sd() const { return (squares_ / std::max(count_, 1.0)).array().sqrt(); }

 private:
  double count_ = 0.0;
  Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d squares_ = Eigen::Vector2d::Zero();
};

/// True of chosen points that are spread as all are, as no data is, or lie at one place.
template <typename Chosen>
bool are_strewn(const std::vector<Eigen::Vector3d>& points, const Chosen& is_chosen) {
  constexpr double wide = 0.5;     // ours, in each direction
  constexpr double narrow = 1e-3;  // [m]
  PlanSpread all;
  PlanSpread chosen;
  for (const Eigen::Vector3d& point : points) {
    all.add(point);
    if (is_chosen(point)) chosen.add(point);
  }
  return chosen.sd().maxCoeff() < narrow || (chosen.sd() > wide * all.sd()).all();
}

/// Extent and density of a cloud that streams by.
class CloudOutline {
 public:
  explicit CloudOutline(const Scan& scan)
      : is_moved_(scan.site_from_scan != Eigen::Matrix4d::Identity() || scan.unit != 1.0),
        file_from_site_(scan.site_from_scan.inverse()),
        unit_(scan.unit) {}

  void add(const std::vector<Eigen::Vector3d>& points);
  ScanOutline result() const;

 private:
  /// Takes the points without data out of a sample. @return the heights of the others, sorted
  std::vector<double> drop_no_data(std::vector<Eigen::Vector3d>& points,
                                   ScanOutline& outline) const;

  bool is_moved_;  ///< heights in the file are others than in the site's frame
  Eigen::Matrix4d file_from_site_;
  double unit_;
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

std::vector<double> CloudOutline::drop_no_data(std::vector<Eigen::Vector3d>& points,
                                               ScanOutline& outline) const {
  const auto height_in_site = [](const Eigen::Vector3d& point) { return point.z(); };
  const auto height_in_file = [&](const Eigen::Vector3d& point) {
    return is_moved_ ? (file_from_site_ * point.homogeneous()).z() / unit_ : point.z();
  };
  const auto is_none = [&height_in_file](std::vector<double> none) {
    return [&height_in_file, none = std::move(none)](const Eigen::Vector3d& point) {
      return is_no_data(height_in_file(point), none);
    };
  };
  std::vector<double> heights = sorted_heights(points, height_in_file);
  std::vector<double>& none = outline.no_data;
  none = no_data_in(heights);
  const auto is_drawn = [&](double height) {  // a level thing at height 0
    return height == 0.0 && !are_strewn(points, is_none({height}));
  };
  none.erase(std::remove_if(none.begin(), none.end(), is_drawn), none.end());
  if (none.empty()) return is_moved_ ? sorted_heights(points, height_in_site) : heights;
  const auto before = static_cast<double>(points.size());
  points.erase(std::remove_if(points.begin(), points.end(), is_none(none)), points.end());
  outline.no_data_share = 1.0 - static_cast<double>(points.size()) / before;
  outline.no_data_points = static_cast<std::uint64_t>(
      std::llround(outline.no_data_share * static_cast<double>(outline.finite_points)));
  outline.finite_points -= outline.no_data_points;
  return sorted_heights(points, height_in_site);
}

ScanOutline CloudOutline::result() const {
  constexpr double nearest_seen = 0.1;    // ours, of a depth camera [m]
  constexpr double farthest_seen = 20.0;  // likewise
  ScanOutline outline = outline_;
  outline.density = nan;
  Cloud cloud;
  for (const Eigen::Vector3d& point : sample_.values()) {
    if (point.allFinite()) cloud.points.push_back(point);
  }
  const std::vector<double> heights = drop_no_data(cloud.points, outline);
  if (cloud.points.empty()) return outline;
  const PointSource source = points_of(cloud);
  const Eigen::AlignedBox3d box = usual_box(source, cloud.points.size());
  outline.extent = plan_of(box);
  const auto sampled = static_cast<double>(cloud.points.size());
  outline.density = points_per_area(source, cloud.points.size(), *outline.extent) *
                    (static_cast<double>(outline.finite_points) / sampled);
  outline.height = box.sizes().z();
  outline.height_step = height_step_of(heights);
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
  CloudOutline found(scan);
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
