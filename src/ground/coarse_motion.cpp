// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/coarse_motion.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "base/angles.hpp"
#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/plane_fit.hpp"

namespace excavplan {
namespace {

// Ours: a sensor that was set up again by hand stands within these.
constexpr double farthest = 1.2;             // [m]
constexpr double widest = 6.0 * pi / 180.0;  // [rad]
constexpr double first_step = 0.1;           // [m]; half the shortest relief that is told apart
constexpr double first_turn = pi / 180.0;
constexpr int refinements = 3;  // each halves both steps
constexpr std::size_t most_samples = 1500;
constexpr double least_overlap = 0.5;  // of the samples

/// Height of a map about its plane, known cells alone.
class Relief {
 public:
  explicit Relief(const HeightMap& map) : map_(map), relief_(map.z) {
    std::vector<Eigen::Vector3d> points;
    for_each_cell(relief_, [&](Cell at) {
      const Eigen::Vector2d from = Eigen::Vector2d(map.x(at.col), map.y(at.row)) - map.origin;
      const double z = map.z(at.row, at.col);
      if (!std::isnan(z)) points.emplace_back(from.x(), from.y(), z);
    });
    plane_ = robust_plane(points).plane;
    for_each_cell(relief_, [&](Cell at) {
      relief_(at.row, at.col) -= plane_at({map.x(at.col), map.y(at.row)});
    });
  }

  const GroundPlane& plane() const { return plane_; }
  double plane_at(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d from = p - map_.origin;
    return plane_.at(from.x(), from.y());
  }
  const Eigen::ArrayXXd& cells() const { return relief_; }

  /// NaN outside the map.
  double nearest(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d place = (p - map_.origin) / map_.cell_size;
    const auto col = static_cast<Eigen::Index>(std::floor(place.x()));
    const auto row = static_cast<Eigen::Index>(std::floor(place.y()));
    const bool inside = row >= 0 && col >= 0 && row < relief_.rows() && col < relief_.cols();
    return inside ? relief_(row, col) : std::nan("");
  }

 private:
  const HeightMap& map_;
  Eigen::ArrayXXd relief_;
  GroundPlane plane_;
};

/// A motion in plan: a point p of the ground is in the scan after at c + R (p - c) + shift.
struct PlanMotion {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  double turn = 0.0;
};

class Matcher {
 public:
  Matcher(const HeightMap& before, const HeightMap& after) : one_(before), two_(after) {
    const Eigen::ArrayXXd& relief = one_.cells();
    const Eigen::Index known = relief.size() - relief.isNaN().count();
    const Eigen::Index stride = known / static_cast<Eigen::Index>(most_samples) + 1;
    Eigen::Index count = 0;
    for_each_cell(relief, [&](Cell at) {
      if (std::isnan(relief(at.row, at.col)) || count++ % stride != 0) return;
      samples_.push_back({{before.x(at.col), before.y(at.row)}, relief(at.row, at.col)});
      centre_ += samples_.back().place;
    });
    centre_ /= static_cast<double>(samples_.size());
  }

  std::optional<Eigen::Matrix4d> find() {
    Match best = improved({}, {farthest, widest, first_step, first_turn});
    double step = first_step;
    double turn = first_turn;
    for (int i = 0; i < refinements; ++i) {
      step *= 0.5;
      turn *= 0.5;
      best = improved(best, {step, turn, step, turn});
    }
    if (!std::isfinite(best.difference)) return std::nullopt;
    return correction(best.motion);
  }

 private:
  struct Sample {
    Eigen::Vector2d place;
    double relief;
  };

  struct Match {
    PlanMotion motion;
    double difference = std::numeric_limits<double>::infinity();
  };

  /// Motions that are tried around one.
  struct Steps {
    double reach, turns;  ///< furthest
    double step, turn;    ///< from one to the next
  };

  /// The best of a match and the motions around it.
  Match improved(const Match& about, const Steps& steps) {
    Match best = about;
    const int across = static_cast<int>(std::lround(steps.reach / steps.step));
    const int around = static_cast<int>(std::lround(steps.turns / steps.turn));
    for (int k = -around; k <= around; ++k) {
      for (int i = -across; i <= across; ++i) {
        for (int j = -across; j <= across; ++j) {
          const PlanMotion tried = {about.motion.shift + steps.step * Eigen::Vector2d(i, j),
                                    about.motion.turn + steps.turn * k};
          const double left = difference(tried);
          if (left < best.difference) best = {tried, left};
        }
      }
    }
    return best;
  }

  /// Lower quartile of the differences from their median [m].
  double difference(const PlanMotion& motion) {
    const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(motion.turn).toRotationMatrix();
    differences_.clear();
    for (const Sample& sample : samples_) {
      const double relief =
          two_.nearest(centre_ + rotation * (sample.place - centre_) + motion.shift);
      if (!std::isnan(relief)) differences_.push_back(relief - sample.relief);
    }
    if (static_cast<double>(differences_.size()) <
        least_overlap * static_cast<double>(samples_.size())) {
      return std::numeric_limits<double>::infinity();
    }
    const double middle = median(differences_);
    for (double& value : differences_) value = std::abs(value - middle);
    return upper_quantile(differences_, 0.25);
  }

  static Eigen::Vector3d normal_of(const Relief& relief) {
    const Eigen::Vector2d slope = relief.plane().gradient();
    return Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
  }

  /// Turns the ground after back in plan and onto the plane of the ground before.
  Eigen::Matrix4d correction(const PlanMotion& motion) const {
    const Eigen::Matrix3d back =
        Eigen::AngleAxisd(-motion.turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d turned = back * normal_of(two_);
    const Eigen::Vector3d normal = normal_of(one_);
    // From one normal to the other; both point upwards, so they are never opposite.
    Eigen::Quaterniond tilt;
    tilt.w() = std::sqrt(0.5 * (1.0 + normal.dot(turned)));
    tilt.vec() = turned.cross(normal) / (2.0 * tilt.w());
    const Eigen::Vector2d moved = centre_ + motion.shift;
    const Eigen::Vector3d from(moved.x(), moved.y(), two_.plane_at(moved));
    const Eigen::Vector3d to(centre_.x(), centre_.y(), one_.plane_at(centre_));
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    result.translate(to);
    result.rotate(tilt);
    result.rotate(back);
    result.translate(-from);
    return result.matrix();
  }

  Relief one_;
  Relief two_;
  std::vector<Sample> samples_;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  std::vector<double> differences_;
};

}  // namespace

std::optional<Eigen::Matrix4d> coarse_correction(const Surface& before, const Surface& after) {
  if (before.height.z.isNaN().all() || after.height.z.isNaN().all()) return std::nullopt;
  return Matcher(before.height, after.height).find();
}

}  // namespace excavplan
