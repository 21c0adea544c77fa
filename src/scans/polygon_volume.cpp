// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/polygon_volume.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/plan_geometry.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "ground/grid_cells.hpp"
#include "ground/hole_filling.hpp"
#include "ground/plane_fit.hpp"
#include "scans/scan_checks.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

// Ours:
constexpr double rim_width = 0.1, rim_cells = 2.0;  // to both sides of the outline [m], [cells]
constexpr double around = 1.0;                      // the polygon, that is surveyed [m]
constexpr std::size_t stretches = 24;               // of the rim
constexpr double of_relief = 0.5;                   // of a rim, by which the ground in it may bend
constexpr double most_unseen = 0.05, least_seen = 0.5;

double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

/// The nearest place of the outline: how far away, and how far along [m].
struct OnOutline {
  double away = std::numeric_limits<double>::infinity();
  double along = 0.0;
};
OnOutline nearest_of(const Polygon& polygon, const Vector2d& p) {
  OnOutline nearest;
  double before = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d side = polygon[(i + 1) % polygon.size()] - a;
    const double length = side.norm();
    const double share =
        length > 0.0 ? std::clamp((p - a).dot(side) / (length * length), 0.0, 1.0) : 0.0;
    const double away = (a + share * side - p).norm();
    if (away < nearest.away) nearest = {away, before + share * length};
    before += length;
  }
  return nearest;
}

double length_of(const Polygon& polygon) {
  double length = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    length += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  }
  return length;
}

Rectangle extent_of(const Polygon& polygon, double more) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  Rectangle r{endless, endless, -endless, -endless};
  for (const Vector2d& p : polygon) {
    r.x_min = std::min(r.x_min, p.x() - more);
    r.y_min = std::min(r.y_min, p.y() - more);
    r.x_max = std::max(r.x_max, p.x() + more);
    r.y_max = std::max(r.y_max, p.y() + more);
  }
  return r;
}

/// Ground of a stretch of the rim.
struct Stretch {
  std::vector<Eigen::Vector3d> points;  ///< centres of its cells
  Vector2d middle = Vector2d::Zero();
};

/// The surface that some stretches of a rim span.
class Base {
 public:
  explicit Base(const std::vector<const Stretch*>& rim) {
    PlaneFit fit;
    for (const Stretch* stretch : rim) {
      for (const Eigen::Vector3d& p : stretch->points) fit.add(p.x(), p.y(), p.z());
    }
    plane_ = fit.plane();
    for (const Stretch* stretch : rim) {
      double off = 0.0;
      for (const Eigen::Vector3d& p : stretch->points) off += p.z() - plane_.at(p.x(), p.y());
      off_.emplace_back(stretch->middle.x(), stretch->middle.y(),
                        off / static_cast<double>(stretch->points.size()));
    }
  }

  double at(const Vector2d& p) const {
    constexpr double least = 1e-6;  // [m^2]
    double sum = 0.0, weights = 0.0;
    for (const Eigen::Vector3d& stretch : off_) {
      const double weight = 1.0 / std::max(least, (stretch.head<2>() - p).squaredNorm());
      sum += weight * stretch.z();
      weights += weight;
    }
    return plane_.at(p.x(), p.y()) + sum / weights;
  }

  /// Of each stretch from the plane [m].
  std::vector<double> off() const {
    std::vector<double> heights;
    for (const Eigen::Vector3d& stretch : off_) heights.push_back(stretch.z());
    return heights;
  }

 private:
  GroundPlane plane_;
  std::vector<Eigen::Vector3d> off_;  ///< of each stretch at its middle [m]
};

struct Volumes {
  double above = 0.0, below = 0.0;
};

/// The ground in and around a polygon.
class PolygonGround {
 public:
  PolygonGround(const Surface& surface, const Polygon& polygon)
      : surface_(surface), polygon_(polygon), z_(surface.height.z), share_(z_) {
    const double cell = surface.height.cell_size;
    const double near = std::max(rim_width, rim_cells * cell);
    const double length = length_of(polygon);
    rim_.resize(stretches);
    for_each_cell(z_, [&](Cell at) {
      const Vector2d centre = place(at) - polygon.front();  // as precise far from the origin
      share_(at.row, at.col) = share_of(at);
      const OnOutline nearest = nearest_of(polygon, place(at));
      if (nearest.away > near || std::isnan(z_(at.row, at.col))) return;
      const double part = nearest.along / length * static_cast<double>(stretches);
      Stretch& stretch = rim_[std::min(stretches - 1, static_cast<std::size_t>(part))];
      stretch.points.emplace_back(centre.x(), centre.y(), z_(at.row, at.col));
      stretch.middle += centre;
    });
    for (Stretch& stretch : rim_) stretch.middle /= static_cast<double>(stretch.points.size());
    rim_.erase(std::remove_if(rim_.begin(), rim_.end(),
                              [](const Stretch& stretch) { return stretch.points.empty(); }),
               rim_.end());
    fill_unseen();
  }

  double seen_of_rim() const {
    return static_cast<double>(rim_.size()) / static_cast<double>(stretches);
  }
  /// Of the polygon.
  double unseen() const { return unseen_ / share_.sum(); }

  /// All stretches but one; past the end: all.
  Base base_without(std::size_t left_out) const {
    std::vector<const Stretch*> rim;
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      if (i != left_out) rim.push_back(&rim_[i]);
    }
    return Base(rim);
  }
  std::size_t rim_size() const { return rim_.size(); }

  /// By the sign of the mean over the cells around, so that noise on even ground takes each other.
  Volumes volumes_over(const Base& base) const {
    const ArrayXXd off = off_from(base);
    Volumes sum;
    each_inside([&](Cell at, double area) {
      const double volume = area * off(at.row, at.col);
      (is_above(off, at) ? sum.above : sum.below) += is_above(off, at) ? volume : -volume;
    });
    return sum;
  }

  /// Variances by noise and cells [m^6].
  Volumes variances_over(const Base& base) const {
    const ArrayXXd off = off_from(base);
    const double usual = usual_variance();
    const double highest = off.abs().maxCoeff();
    Volumes sum, even;
    Volumes filled;
    each_inside([&](Cell at, double area) {
      const bool above = is_above(off, at);
      const double own = surface_.variance(at.row, at.col);
      const double variance = std::isnan(own) ? usual : own;
      (above ? sum.above : sum.below) += area * area * (variance + bend_variance(at));
      if (std::isnan(surface_.height.z(at.row, at.col))) {
        (above ? filled.above : filled.below) += area * 0.25 * highest;
      }
      if (std::abs(off(at.row, at.col)) > 3.0 * std::sqrt(variance)) return;
      (above ? even.above : even.below) += area * 0.4 * std::sqrt(variance) / mean_cells;
    });
    sum.above += even.above * even.above + filled.above * filled.above;
    sum.below += even.below * even.below + filled.below * filled.below;
    return sum;
  }

  /// Mean square of what the stretches of the rim lie off its plane, but for noise [m^2].
  double relief(const Base& base) const {
    const double usual = usual_variance();
    double sum = 0.0;
    const std::vector<double> off = base.off();
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      sum += off[i] * off[i] - usual / static_cast<double>(rim_[i].points.size());
    }
    return std::max(0.0, sum / static_cast<double>(rim_.size()));
  }

 private:
  double usual_variance() const {
    std::vector<double> known = known_values(surface_.variance);
    return known.empty() ? 0.0 : median(known);
  }

  static constexpr int mean_reach = 2;       // cells to every side; ours
  static constexpr double mean_cells = 5.0;  // along an edge

  Vector2d place(Cell at) const { return {surface_.height.x(at.col), surface_.height.y(at.row)}; }

  /// Of a cell, by points of it.
  double share_of(Cell at) const {
    constexpr int along = 5;
    int inside = 0;
    for (int x = 0; x < along; ++x) {
      for (int y = 0; y < along; ++y) {
        const Vector2d off((x + 0.5) / along - 0.5, (y + 0.5) / along - 0.5);
        if (is_inside(polygon_, place(at) + surface_.height.cell_size * off)) ++inside;
      }
    }
    return static_cast<double>(inside) / (along * along);
  }

  void fill_unseen() {
    std::vector<Cell> unknown;
    for_each_cell(z_, [&](Cell at) {
      if (!std::isnan(z_(at.row, at.col))) return;
      unknown.push_back(at);
      unseen_ += share_(at.row, at.col);
    });
    if (!unknown.empty() && unknown.size() < static_cast<std::size_t>(z_.size())) {
      fill(z_, unknown, Filling::membrane);
    }
  }

  ArrayXXd off_from(const Base& base) const {
    ArrayXXd off = z_;
    for_each_cell(off,
                  [&](Cell at) { off(at.row, at.col) -= base.at(place(at) - polygon_.front()); });
    return off;
  }

  bool is_above(const ArrayXXd& off, Cell at) const {
    double sum = 0.0;
    for_each_around(off, at, mean_reach, [&](Cell n) { sum += off(n.row, n.col); });
    return sum > 0.0;
  }

  template <typename Visit>
  void each_inside(Visit visit) const {
    const double cell_area = std::pow(surface_.height.cell_size, 2);
    for_each_cell(share_, [&](Cell at) {
      const double share = share_(at.row, at.col);
      if (share > 0.0) visit(at, share * cell_area);
    });
  }

  /// Of the mean height of a cell about that at its centre, by the bend of the ground.
  double bend_variance(Cell at) const {
    double sum = 0.0;
    int count = 0;
    for_each_neighbour(z_, at, [&](Cell n) {
      sum += z_(n.row, n.col) - z_(at.row, at.col);
      ++count;
    });
    return count < 4 ? 0.0 : std::pow(sum / 24.0, 2);
  }

  const Surface& surface_;
  const Polygon& polygon_;
  ArrayXXd z_;           ///< filled
  ArrayXXd share_;       ///< of each cell that lies in the polygon
  double unseen_ = 0.0;  ///< [cells]
  std::vector<Stretch> rim_;
};

/// With one stretch of the rim left out after the other (Quenouille 1956) [m^6].
Volumes rim_variances(const PolygonGround& ground) {
  std::vector<Volumes> without;
  Volumes mean;
  const auto n = static_cast<double>(ground.rim_size());
  for (std::size_t i = 0; i < ground.rim_size(); ++i) {
    without.push_back(ground.volumes_over(ground.base_without(i)));
    mean.above += without.back().above / n;
    mean.below += without.back().below / n;
  }
  Volumes sum;
  for (const Volumes& each : without) {
    sum.above += (n - 1.0) / n * std::pow(each.above - mean.above, 2);
    sum.below += (n - 1.0) / n * std::pow(each.below - mean.below, 2);
  }
  return sum;
}

}  // namespace

PolygonVolume volume_over(const Scan& scan, const std::vector<Eigen::Vector2d>& polygon) {
  require(polygon.size() >= 3 && std::all_of(polygon.begin(), polygon.end(),
                                             [](const Vector2d& p) { return p.allFinite(); }),
          "volume: the polygon needs at least three corners, all finite");
  PolygonVolume result;
  result.area = area_of(polygon);
  require(result.area > 0.0, "volume: area of the polygon", result.area, "above 0 m^2");
  result.warnings = scan.doubts;
  const ScanOutline all = outline(scan);
  if (auto none = check_no_data(all, scan)) result.warnings.push_back(std::move(*none));
  Scan near = scan;
  near.no_data.insert(near.no_data.end(), all.no_data.begin(), all.no_data.end());
  near.area = extent_of(polygon, around);
  const ScanOutline seen = outline(near);
  const auto refuse = [&](const std::string& what) {
    throw FrameError(name_of(scan) + ": " + what + ": are polygon and scan in the same frame?");
  };
  if (!seen.extent || !(seen.density > 0.0)) refuse("no ground is seen in the polygon");
  RasterOptions raster;
  raster.cell_size = cell_for({seen});
  const Surface surface = survey_surface(near, *near.area, raster);
  const PolygonGround ground(surface, polygon);
  if (ground.seen_of_rim() < least_seen || ground.unseen() > least_seen) {
    refuse("only " + readable(100.0 * ground.seen_of_rim(), 2) + " % of the polygon's rim and " +
           readable(100.0 * (1.0 - ground.unseen()), 2) + " % of its area are seen");
  }
  const Base base = ground.base_without(ground.rim_size());
  const Volumes volumes = ground.volumes_over(base), own = ground.variances_over(base),
                rim = rim_variances(ground);
  const double bend = std::pow(of_relief * result.area, 2) * ground.relief(base);
  result.above = {volumes.above, std::sqrt(own.above + rim.above + bend)};
  result.below = {volumes.below, std::sqrt(own.below + rim.below + bend)};
  if (ground.unseen() > most_unseen || ground.seen_of_rim() < 1.0) {
    result.warnings.emplace_back(
        WarningCode::zone_partly_unseen,
        name_of(scan) + ": " + readable(100.0 * ground.unseen(), 2) + " % of the polygon and " +
            readable(100.0 * (1.0 - ground.seen_of_rim()), 2) +
            " % of its rim are unseen, and filled from around: scan from another place");
  }
  return result;
}

}  // namespace excavplan
