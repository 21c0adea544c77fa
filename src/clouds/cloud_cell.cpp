// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/cloud_cell.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

/// True if the points above `valley`, and above a slope, lie among the others in plan, as leaves
/// above ground do, and not beside them, as the upper level of a wall does: of the variance of "is
/// above" a plane through the points explains less than two thirds of what it would if a wall along
/// the cell parted them, 3 p (1 - p) with p the share above.
bool lies_among(CellRange points, double valley,
                const Eigen::Vector2d& slope = Eigen::Vector2d::Zero()) {
  const auto n = static_cast<double>(points.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const CellPoint& point : points) {
    const double above = height_above(point, slope) > valley ? 1.0 : 0.0;
    const Eigen::Vector3d p(point.from_centre_x(), point.from_centre_y(), above);
    sum += p;
    products += p * p.transpose();
  }
  const Eigen::Vector3d mean = sum / n;
  const Eigen::Matrix3d c = products / n - mean * mean.transpose();
  const double determinant = c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1);
  if (!(determinant > 1e-6)) return false;
  const double explained = (c(1, 1) * c(0, 2) * c(0, 2) - 2.0 * c(0, 1) * c(0, 2) * c(1, 2) +
                            c(0, 0) * c(1, 2) * c(1, 2)) /
                           determinant;
  return explained < 2.0 * c(2, 2) * c(2, 2);
}

/// Weighted sums over points (x, y, z) and their products.
struct Moments {
  double count = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0, zz = 0.0;

  void add(const Eigen::Vector3d& p, double weight) {
    const double x = weight * p.x();
    const double y = weight * p.y();
    count += weight;
    sum += weight * p;
    xx += x * p.x();
    xy += x * p.y();
    yy += y * p.y();
    xz += x * p.z();
    yz += y * p.z();
    zz += weight * p.z() * p.z();
  }
  void scale(double factor) {
    count *= factor;
    sum *= factor;
    for (double* const value : {&xx, &xy, &yy, &xz, &yz, &zz}) *value *= factor;
  }
  Eigen::Matrix2d plan_products() const { return (Eigen::Matrix2d() << xx, xy, xy, yy).finished(); }
  /// Of z - constant - slope . (x, y).
  double squares_about(double constant, const Eigen::Vector2d& slope) const {
    const Eigen::Vector2d plan = sum.head<2>();
    const Eigen::Vector2d with_height(xz, yz);
    return zz - 2.0 * slope.dot(with_height) + slope.dot(plan_products() * slope) -
           2.0 * constant * (sum.z() - slope.dot(plan)) + count * constant * constant;
  }
};

/// Mean and slope of weighted points.
class CellPlane {
 public:
  explicit CellPlane(const Moments& m) : mean_(m.sum / m.count) {
    const Eigen::Vector2d centre = mean_.head<2>();
    spread_ = m.plan_products() / m.count - centre * centre.transpose();
    with_height_ = Eigen::Vector2d(m.xz, m.yz) / m.count - mean_.z() * centre;
    determinant_ = spread_(0, 0) * spread_(1, 1) - spread_(0, 1) * spread_(0, 1);
  }

  const Eigen::Vector3d& mean() const { return mean_; }
  /// Variance in plan in the direction where it is smallest.
  double least_spread() const {
    const double half_trace = 0.5 * spread_.trace();
    return half_trace - std::sqrt(std::max(0.0, half_trace * half_trace - determinant_));
  }
  /// The inverse of the spread times a vector; the spread must not be degenerate.
  Eigen::Vector2d solve(const Eigen::Vector2d& v) const {
    return Eigen::Vector2d(spread_(1, 1) * v.x() - spread_(0, 1) * v.y(),
                           spread_(0, 0) * v.y() - spread_(0, 1) * v.x()) /
           determinant_;
  }
  Eigen::Vector2d slope() const { return solve(with_height_); }

 private:
  Eigen::Vector3d mean_;
  Eigen::Matrix2d spread_;
  Eigen::Vector2d with_height_;
  double determinant_ = 0.0;
};

/// mean_height() in two steps: the points of the band, then the height.
class CellMean {
 public:
  /// `noise` is that of a point on level ground [m].
  CellMean(CellRange points, const Band& band, double reference, double noise) {
    points_.reserve(points.size());
    for (const CellPoint& point : points) {
      if (!band.contains(point)) continue;
      points_.emplace_back(point.from_centre_x(), point.from_centre_y(),
                           static_cast<double>(point.z) - reference);
      all_.add(points_.back(), 1.0);
      lowest_ = std::min(lowest_, points_.back().z());
    }
    if (points_.empty()) return;
    shared_ = squared_ = all_;
    shared_.scale(1.0 / all_.count);
    squared_.scale(1.0 / (all_.count * all_.count));
    constexpr double rough = 3.0;  // ours
    if (residual_sd() > rough * noise) share_by_area();
  }

  /// Above the reference. The slope is the points' own if they are enough and spread over the cell,
  /// else that of the surroundings.
  CellHeight result(const Eigen::Vector2d& slope_around) const {
    if (points_.empty()) return {};
    const CellPlane plane(shared_);
    if (!tells_slope(plane)) {
      return height_of(plane.mean(), slope_around, Eigen::Vector2d::Zero(), 1.0);
    }
    return height_of(plane.mean(), plane.slope(), plane.solve(plane.mean().head<2>()), 3.0);
  }

 private:
  static constexpr std::size_t enough = 8;  ///< points for a slope; ours
  /// A scan is no better than this, however many its points [m].
  static constexpr double least_sd = 1e-4;

  /// Enough points, with at least half the standard deviation of an even spread, 1 / sqrt(12), in
  /// every direction.
  bool tells_slope(const CellPlane& plane) const {
    constexpr double least_spread = 0.25 / 12.0;
    return points_.size() >= enough && plane.least_spread() >= least_spread;
  }

  /// About the plane through all points; 0 if they are too few for one.
  double residual_sd() const {
    const CellPlane plane(shared_);
    if (!tells_slope(plane)) return 0.0;
    const double constant = plane.mean().z() - plane.slope().dot(plane.mean().head<2>());
    return std::sqrt(std::max(0.0, all_.squares_about(constant, plane.slope())) /
                     (all_.count - 3.0));
  }

  /// Weights by the nearest of at most some hundred points, found on a lattice over the cell.
  void share_by_area() {
    constexpr std::size_t most_points = 400;
    constexpr std::size_t along = 16;
    const std::size_t step = 1 + points_.size() / most_points;
    std::vector<double> shares(points_.size());
    for (std::size_t node = 0; node < along * along; ++node) {
      const std::size_t column = node / along;
      const std::size_t row = node % along;
      const double x = (static_cast<double>(column) + 0.5) / along - 0.5;
      const double y = (static_cast<double>(row) + 0.5) / along - 0.5;
      std::size_t nearest = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < points_.size(); i += step) {
        const double dx = points_[i].x() - x;
        const double dy = points_[i].y() - y;
        const double distance = dx * dx + dy * dy;
        if (distance < least) {
          least = distance;
          nearest = i;
        }
      }
      shares[nearest] += 1.0 / (along * along);
    }
    shared_ = squared_ = {};
    for (std::size_t i = 0; i < points_.size(); i += step) {
      shared_.add(points_[i], shares[i]);
      squared_.add(points_[i], shares[i] * shares[i]);
    }
  }

  /// Height at the centre of the cell and its variance, that of the sum of z_i w_i (1 - lever .
  /// (p_i - mean)) over the points, w_i being the share of a point: residual scatter about the
  /// plane times the sum of the squared factors. `parameters` have been fitted.
  CellHeight height_of(const Eigen::Vector3d& mean, const Eigen::Vector2d& slope,
                       const Eigen::Vector2d& lever, double parameters) const {
    CellHeight result;
    const Eigen::Vector2d centre = mean.head<2>();
    const Eigen::Vector2d squared_centre = squared_.sum.head<2>();
    result.height = mean.z() - slope.dot(centre);
    result.points = static_cast<int>(points_.size());
    result.lowest = lowest_;
    const double freedom = all_.count - parameters;
    if (freedom < 1.0) return result;
    const double constant = 1.0 + lever.dot(centre);
    const double factors = constant * constant * squared_.count -
                           2.0 * constant * lever.dot(squared_centre) +
                           lever.dot(squared_.plan_products() * lever);
    result.variance =
        std::max(all_.squares_about(result.height, slope) / freedom * factors, least_sd * least_sd);
    return result;
  }

  std::vector<Eigen::Vector3d> points_;  ///< accepted, from the centre of the cell [cell, cell, m]
  double lowest_ = std::numeric_limits<double>::infinity();
  Moments all_;      ///< with weight 1
  Moments shared_;   ///< with shares that add up to 1
  Moments squared_;  ///< with the squares of the shares
};

/// Of heights into a lower and an upper part.
struct Partition {
  Overlay overlay;
  double explained = 0.0;  // of the squares about the mean [-]
  std::size_t below = 0;   // heights in the lower part
};

/// Larger of the standard deviations of the two parts [m].
double scatter_of_parts(const std::vector<float>& heights, std::size_t below) {
  double largest = 0.0;
  for (const auto& [from, to] :
       {std::pair(std::size_t{0}, below), std::pair(below, heights.size())}) {
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      sum += static_cast<double>(heights[i]);
      squares += static_cast<double>(heights[i]) * static_cast<double>(heights[i]);
    }
    const auto n = static_cast<double>(to - from);
    largest = std::max(largest, std::sqrt(std::max(0.0, squares / n - sum * sum / n / n)));
  }
  return largest;
}

/// By least squares, of sorted heights, with at least `fewest` in each part.
Partition best_partition(const std::vector<float>& heights, std::size_t fewest) {
  double all = 0.0;
  double squares = 0.0;
  for (const float height : heights) {
    all += static_cast<double>(height);
    squares += static_cast<double>(height) * static_cast<double>(height);
  }
  const auto n = static_cast<double>(heights.size());
  const double total = squares - all * all / n;
  Partition best;
  double below = 0.0;
  for (std::size_t i = 1; i <= heights.size() - fewest; ++i) {
    below += static_cast<double>(heights[i - 1]);
    if (i < fewest) continue;
    const auto count = static_cast<double>(i);
    const double apart = (all - below) / (n - count) - below / count;
    const double explained = count * (n - count) / n * apart * apart / total;
    if (explained <= best.explained) continue;
    const double valley =
        0.5 * (static_cast<double>(heights[i - 1]) + static_cast<double>(heights[i]));
    best = {{apart, 1.0 - count / n, below / count, valley}, explained, i};
  }
  return best;
}

}  // namespace

std::optional<Split> two_levels(CellRange points, double level, double gap,
                                std::vector<float>& heights) {
  const std::size_t support = std::max<std::size_t>(3, points.size() / 10);
  const std::size_t step = 1 + points.size() / 50;
  std::size_t above = 0;
  std::size_t below = 0;
  for (const CellPoint& point : points) {
    const double off = static_cast<double>(point.z) - level;
    above += off > 0.5 * gap ? 1 : 0;
    below += off < -0.5 * gap ? 1 : 0;
  }
  if (std::max(above, below) < support) return std::nullopt;
  heights.clear();
  for (const CellPoint& point : points) heights.push_back(point.z);
  std::sort(heights.begin(), heights.end());
  double widest = gap;
  std::size_t top = 0;  // of the lower level
  for (std::size_t i = support - 1; i + step + support <= heights.size(); ++i) {
    const auto width = static_cast<double>(heights[i + step]) - static_cast<double>(heights[i]);
    if (width > widest) {
      widest = width;
      top = i;
    } else if (top > 0 && width < gap) {
      break;
    }
  }
  if (top == 0) return std::nullopt;
  Split split;
  split.valley = static_cast<double>(heights[top]) + 0.5 * widest;
  split.low = static_cast<double>(heights[top / 2]);
  split.among = lies_among(points, split.valley);
  return split;
}

std::optional<Overlay> overlay_in(CellRange points, const Eigen::Vector2d& slope, double by_noise,
                                  std::vector<float>& heights) {
  constexpr double least = 0.03;  // [m]: clods are as high
  constexpr double most_explained = 0.85;
  constexpr double most_scatter = 0.6;  // of a part, to their distance: outliers scatter more
  constexpr std::size_t enough = 20;
  const std::size_t fewest = std::max<std::size_t>(3, points.size() / 10);
  if (points.size() < 2 * fewest) return std::nullopt;
  heights.clear();
  for (const CellPoint& point : points) {
    heights.push_back(static_cast<float>(height_above(point, slope)));
  }
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  if (static_cast<double>(*high - *low) < least) return std::nullopt;
  std::sort(heights.begin(), heights.end());
  const Partition best = best_partition(heights, fewest);
  const bool is_noise =
      best.overlay.apart < by_noise && (best.explained < most_explained || points.size() < enough);
  if (best.overlay.apart < least || is_noise) return std::nullopt;
  if (scatter_of_parts(heights, best.below) > most_scatter * best.overlay.apart ||
      !lies_among(points, best.overlay.valley, slope)) {
    return std::nullopt;
  }
  return best.overlay;
}

CellsAround surroundings_of(const Eigen::ArrayXXd& levels, Eigen::Index row, Eigen::Index column) {
  constexpr std::size_t enough = 5;
  struct Neighbour {
    double z = 0.0, x = 0.0, y = 0.0;
  };
  std::array<Neighbour, 9> around;
  std::size_t count = 0;
  for_each_around(levels, {row, column}, 1, [&](Cell at) {
    const double z = levels(at.row, at.col);
    if (std::isnan(z)) return;
    around[count++] = {z, static_cast<double>(at.col - column), static_cast<double>(at.row - row)};
  });
  std::sort(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Neighbour& a, const Neighbour& b) { return a.z < b.z; });
  const std::size_t dropped = count >= enough ? 1 : 0;
  CellsAround result{around[dropped].z, around[count - 1 - dropped].z};
  if (dropped == 0) return result;
  Moments kept;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    kept.add({around[i].x, around[i].y, around[i].z - result.low}, 1.0);
  }
  const CellPlane plane(kept);
  constexpr double nearly_in_a_row = 0.1;  // [cell^2]
  if (!(plane.least_spread() > nearly_in_a_row)) return result;
  result.slope = plane.slope();
  const double rise = plane.mean().z() - plane.slope().dot(plane.mean().head<2>());
  result.plane = result.low + rise;
  constexpr std::size_t tell_bend = 8;  // ours: fewer are near any plane
  if (count < tell_bend) return result;
  result.off_plane = result.off_plane_all = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double off = std::abs(around[i].z - result.plane -
                                result.slope.dot(Eigen::Vector2d(around[i].x, around[i].y)));
    result.off_plane_all = std::max(result.off_plane_all, off);
    if (i > 0 && i + 1 < count) result.off_plane = std::max(result.off_plane, off);
  }
  return result;
}

CellHeight mean_height(CellRange points, const Band& band, double reference, double noise) {
  return CellMean(points, band, reference, noise).result(band.slope);
}

}  // namespace excavplan
