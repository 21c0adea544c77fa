// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/lookout.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/angles.hpp"
#include "base/parallel.hpp"
#include "base/statistics.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Numbers of our own choice.
constexpr int headings = 8;
constexpr double place_step = 0.5;         // of places to stand [m]
constexpr double same_place = 1.0;         // [m]
constexpr double farthest = 5.0;           // from the design along, from what is hidden across [m]
constexpr std::size_t most_cells = 200;    // that are looked for from each place
constexpr double least_revealed = 0.0005;  // of the design, to be worth a scan
constexpr double way_price = 0.0001;       // of the design, for a metre of the way [1/m]
constexpr double slack = 0.01;  // by which a ray may be within the ground that it passes [m]
constexpr double outermost =
    0.02;  // share of a cloud's points beside the sector that is counted on

/// The highest ground between the eye and a place lies below the line of sight.
bool is_open(const HeightMap& surface, const Vector3d& eye, const Vector3d& at) {
  const Vector3d way = eye - at;
  const double length = way.head<2>().norm();
  for (double r = surface.cell_size; r < length; r += surface.cell_size) {
    const Vector3d on = at + way * (r / length);
    if (height_at(surface, on.x(), on.y()) > on.z() + slack) return false;
  }
  return true;
}

class Lookout {
 public:
  explicit Lookout(const LookTask& task) : task_(task), surface_(task.ground.surface()) {
    std::vector<Vector3d> unseen;
    for_each_cell(task.map.target.z, [&](Cell at) {
      if (std::isnan(task.map.target.z(at.row, at.col))) return;
      ++all_;
      const double z = surface_.z(at.row, at.col);
      if (!std::isnan(task.seen(at.row, at.col)) || std::isnan(z)) return;
      unseen.emplace_back(surface_.x(at.col), surface_.y(at.row), z);
    });
    const std::size_t step = 1 + unseen.size() / most_cells;
    for (std::size_t i = 0; i < unseen.size(); i += step) hidden_.push_back(unseen[i]);
    weight_ = all_ > 0 ? static_cast<double>(step) / all_ : 0.0;
  }

  std::optional<JobStation> best() const {
    const std::vector<JobStation> places = candidates();
    std::vector<double> revealed(places.size());
    parallel_for(places.size(), 0, [&](std::size_t i) { revealed[i] = share_seen(places[i]); });
    std::optional<JobStation> best;
    double worth = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (revealed[i] < least_revealed) continue;
      const Vector2d at = task_.frame.place(places[i].along, places[i].beside);
      const double way = (at - Vector2d(task_.base.x, task_.base.y)).norm();
      const double value = revealed[i] - way_price * way;
      if (best && !(value > worth)) continue;
      best = places[i];
      worth = value;
    }
    return best;
  }

 private:
  /// All along the design: what lies at the foot of one end is seen from beyond the other.
  std::vector<JobStation> candidates() const {
    Eigen::AlignedBox2d box;
    for (const Vector3d& at : hidden_) box.extend(task_.frame.of(at.head<2>()));
    std::vector<JobStation> places;
    if (box.isEmpty()) return places;
    box.min().x() = task_.frame.near;
    box.max().x() = task_.frame.far;
    const auto steps = [&](int axis) {
      return static_cast<int>((box.sizes()[axis] + 2.0 * farthest) / place_step);
    };
    const Vector2d first = box.min() - Vector2d(farthest, farthest);
    for (int i = 0; i <= steps(0); ++i) {
      for (int k = 0; k <= steps(1); ++k) {
        for (int h = 0; h < headings; ++h) {
          places.push_back({first.x() + i * place_step,
                            first.y() + k * place_step,
                            {},
                            wrapped(2.0 * pi * h / headings)});
        }
      }
    }
    return places;
  }

  /// What was not seen from there will not be from beside it, whatever the map says.
  bool is_here(const JobStation& place) const {
    const Vector2d at = task_.frame.place(place.along, place.beside);
    return (at - Vector2d(task_.base.x, task_.base.y)).norm() < same_place;
  }

  /// Of the cells of the design.
  double share_seen(const JobStation& place) const {
    if (is_here(place) || !can_stand(task_.frame, place, task_.settings.site.machine, task_.map))
      return 0.0;
    const BasePose base = base_at(task_.frame, place, task_.ground, task_.settings.site.machine);
    int seen = 0;
    for (const Vector3d& at : hidden_) {
      seen += std::any_of(task_.looks.begin(), task_.looks.end(),
                          [&](const SensorLook& look) { return sees(look, base, at); });
    }
    return weight_ * seen;
  }

  bool sees(const SensorLook& look, const BasePose& base, const Vector3d& at) const {
    const Eigen::Rotation2Dd turn(base.heading);
    const Vector2d eye = Vector2d(base.x, base.y) + turn * look.from.head<2>();
    const Vector2d way = at.head<2>() - eye;
    const double height = base.z + look.from.z() - at.z();
    if (way.norm() > look.range || std::atan2(height, way.norm()) > look.steepest) return false;
    const double azimuth = std::atan2(way.y(), way.x()) - base.heading - look.azimuth;
    if (std::abs(wrapped(azimuth)) > look.half_sector) return false;
    return is_open(surface_, {eye.x(), eye.y(), at.z() + height}, at);
  }

  const LookTask& task_;
  HeightMap surface_;
  std::vector<Vector3d> hidden_;
  int all_ = 0;
  double weight_ = 0.0;  ///< of one of `hidden_`, as a share of the design
};

/// What points about their sensor say of its view; its azimuth is that of the site.
SensorLook look_along(const std::vector<Vector3d>& ways) {
  Vector2d sum = Vector2d::Zero();
  for (const Vector3d& way : ways) sum += way.head<2>().normalized();
  const double middle = std::atan2(sum.y(), sum.x());
  std::vector<double> off, ranges, steep;
  for (const Vector3d& way : ways) {
    off.push_back(wrapped(std::atan2(way.y(), way.x()) - middle));
    ranges.push_back(way.head<2>().norm());
    steep.push_back(std::atan2(-way.z(), ranges.back()));
  }
  const double right = quantile(off, outermost), left = quantile(off, 1.0 - outermost);
  SensorLook look;
  look.azimuth = middle + 0.5 * (left + right);
  look.half_sector = 0.5 * (left - right);
  look.range = quantile(std::move(ranges), 1.0 - outermost);
  look.steepest = quantile(std::move(steep), 1.0 - outermost);
  return look;
}

}  // namespace

std::vector<SensorLook> looks_of(const Scan& scan, const BasePose& base) {
  std::vector<SensorLook> looks;
  const Eigen::Isometry3d site_from_scan(scan.site_from_scan);
  const Eigen::Rotation2Dd back(-base.heading);
  for (const auto& cloud : scan.clouds) {
    if (!cloud->sensor_origin) continue;
    const Vector3d eye = site_from_scan * (scan.unit * *cloud->sensor_origin);
    std::vector<Vector3d> ways;
    for (const Vector3d& point : cloud->points) {
      if (point.allFinite()) ways.emplace_back(site_from_scan * (scan.unit * point) - eye);
    }
    if (ways.empty()) continue;
    SensorLook look = look_along(ways);
    look.from.head<2>() = back * (eye.head<2>() - Vector2d(base.x, base.y));
    look.from.z() = eye.z() - base.z;
    look.azimuth = wrapped(look.azimuth - base.heading);
    looks.push_back(look);
  }
  return looks;
}

std::vector<SensorLook> usual_looks() { return {{{0.6, 0.0, 3.0}, 0.0, pi, 12.0, 1.0}}; }

std::optional<JobStation> best_lookout(const LookTask& task) { return Lookout(task).best(); }

}  // namespace excavplan
