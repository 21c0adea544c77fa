// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/sensor_place.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "base/normal_equations.hpp"
#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/plane_fit.hpp"

namespace excavplan {
namespace {

constexpr int degree = 4;  // ours: of the polynomial of the points on level ground
constexpr int level_terms = (degree + 1) * (degree + 2) / 2;
constexpr int unknowns = level_terms + 3;

using Unknowns = Eigen::Matrix<double, unknowns, 1>;
using Information = Eigen::Matrix<double, unknowns, unknowns>;

/// A square of cells.
struct SlopeBlock {
  Eigen::Vector3d place;     ///< from the middle of the scan [m]
  Eigen::Vector2d gradient;  ///< of the ground
  double points;
};

struct SlopeBlocks {
  std::vector<SlopeBlock> all;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector2d reach = Eigen::Vector2d::Ones();  ///< from the middle [m]
};

/// The block with its first cell at `from`; false where too little of it is known.
bool block_at(const Surface& surface, Cell from, Eigen::Index side, SlopeBlock& block) {
  constexpr double least_known = 0.8;  // ours
  constexpr double gentle = 0.15;      // ours: smaller gradients are noise and natural slope
  const HeightMap& map = surface.height;
  PlaneFit fit;
  block.points = 0.0;
  for (Eigen::Index c = from.col; c < from.col + side; ++c) {
    for (Eigen::Index r = from.row; r < from.row + side; ++r) {
      if (std::isnan(map.z(r, c))) continue;
      fit.add(map.x(c) - map.x(from.col), map.y(r) - map.y(from.row), map.z(r, c));
      block.points += surface.points(r, c);
    }
  }
  if (fit.count() < least_known * static_cast<double>(side * side)) return false;
  block.gradient = fit.plane().gradient();
  if (block.gradient.norm() < gentle) block.gradient.setZero();
  block.place = fit.mean() + Eigen::Vector3d(map.x(from.col), map.y(from.row), 0.0);
  return true;
}

/// Blocks all over the scan, at most some thousands.
SlopeBlocks blocks_of(const Surface& surface) {
  constexpr Eigen::Index side = 5;        // ours [cell]
  constexpr Eigen::Index most = 1000000;  // ours: cells that are looked at
  const Eigen::ArrayXXd& z = surface.height.z;
  const Eigen::Index stride = side * (1 + z.size() / most);
  SlopeBlocks blocks;
  for (Eigen::Index c = 0; c + side <= z.cols(); c += stride) {
    for (Eigen::Index r = 0; r + side <= z.rows(); r += side) {
      SlopeBlock block;
      if (block_at(surface, {r, c}, side, block)) blocks.all.push_back(block);
    }
  }
  if (blocks.all.empty()) return blocks;
  for (const SlopeBlock& block : blocks.all) blocks.middle += block.place;
  blocks.middle /= static_cast<double>(blocks.all.size());
  for (SlopeBlock& block : blocks.all) {
    block.place -= blocks.middle;
    blocks.reach = blocks.reach.cwiseMax(block.place.head<2>().cwiseAbs());
  }
  return blocks;
}

/// Above the middle [m].
double highest(const SlopeBlocks& blocks) {
  double most = 0.0;
  for (const SlopeBlock& block : blocks.all) most = std::max(most, block.place.z());
  return most;
}

/// The way of a ray to a point per unit of its fall.
Eigen::Vector2d tangent_to(const Eigen::Vector3d& point, const Eigen::Vector3d& inverse) {
  return (inverse.z() * point.head<2>() - inverse.head<2>()) / (1.0 - inverse.z() * point.z());
}

/// Its derivative by the inverse place.
Eigen::Matrix<double, 2, 3> tangent_change(const Eigen::Vector3d& point,
                                           const Eigen::Vector3d& inverse) {
  Eigen::Matrix<double, 2, 3> change;
  change << -Eigen::Matrix2d::Identity(), point.head<2>() + point.z() * tangent_to(point, inverse);
  return change / (1.0 - inverse.z() * point.z());
}

/// Poisson regression of the points of the blocks by Fisher's scoring, with Levenberg's damping.
class PointRegression {
 public:
  explicit PointRegression(const SlopeBlocks& blocks) : blocks_(blocks) {
    double points = 0.0;
    for (const SlopeBlock& block : blocks.all) points += block.points;
    best_.setZero();
    best_(0) = std::log(points / static_cast<double>(blocks.all.size()));
  }

  void fit() {
    constexpr int most_rounds = 50;
    constexpr double settled = 1e-3;  // ours: of the logarithm of the likelihood
    double damping = 1e-3;
    double loss = loss_of(best_);
    for (int round = 0; round < most_rounds && damping < 1e6; ++round) {
      look_around();
      Information damped = information_;
      damped.diagonal() *= 1.0 + damping;
      const Unknowns next = best_ + damped.ldlt().solve(score_);
      const double reached = loss_of(next);
      if (!(reached < loss)) {
        damping *= 10.0;
        continue;
      }
      best_ = next;
      damping *= 0.3;
      if (loss - reached < settled) break;
      loss = reached;
    }
    look_around();
  }

  Eigen::Vector3d inverse() const { return best_.tail<3>(); }
  /// The power of h / r^3, height and range from the place found, with which the points of level
  /// ground go: 1 for equal angles between rays.
  double power_of_range() const {
    const Eigen::Vector3d sensor(inverse().x() / inverse().z(), inverse().y() / inverse().z(),
                                 1.0 / inverse().z());
    NormalEquations<2> equations;
    for (const SlopeBlock& block : blocks_.all) {
      const Eigen::Vector3d ray = sensor - block.place;
      equations.add({1.0, std::log(ray.z() / std::pow(ray.norm(), 3))},
                    terms_of(block).dot(best_.head<level_terms>()));
    }
    return equations.solution().y();
  }
  /// Squares of what is left, 1 for random points.
  double scatter() const { return scatter_ / (static_cast<double>(blocks_.all.size()) - unknowns); }
  /// Of the inverse place; the points scatter as they do, at least as random ones.
  Eigen::Matrix3d covariance() const {
    const Information all = information_.ldlt().solve(Information::Identity());
    return std::max(1.0, scatter()) * all.bottomRightCorner<3, 3>();
  }

 private:
  double slope_factor(const Unknowns& at, const SlopeBlock& block) const {
    constexpr double least = 0.1;  // ours: returns mix where a ray grazes the ground
    return std::max(least, 1.0 + block.gradient.dot(tangent_to(block.place, at.tail<3>())));
  }

  Eigen::Matrix<double, level_terms, 1> terms_of(const SlopeBlock& block) const {
    const Eigen::Array2d at = block.place.head<2>().array() / blocks_.reach.array();
    Eigen::Matrix<double, level_terms, 1> terms;
    int next = 0;
    for (int power = 0; power <= degree; ++power) {
      for (int of_y = 0; of_y <= power; ++of_y) {
        terms(next++) = std::pow(at.x(), power - of_y) * std::pow(at.y(), of_y);
      }
    }
    return terms;
  }

  double expected(const Unknowns& at, const SlopeBlock& block) const {
    return std::exp(terms_of(block).dot(at.head<level_terms>())) * slope_factor(at, block);
  }

  double loss_of(const Unknowns& at) const {
    double loss = 0.0;
    for (const SlopeBlock& block : blocks_.all) {
      if (!(at(unknowns - 1) * block.place.z() < 1.0)) return HUGE_VAL;  // above the sensor
      const double mean = expected(at, block);
      loss += mean - block.points * std::log(mean);
    }
    return loss;
  }

  void look_around() {
    information_.setZero();
    score_.setZero();
    scatter_ = 0.0;
    for (const SlopeBlock& block : blocks_.all) {
      const double mean = expected(best_, block);
      Unknowns change;
      change << terms_of(block),
          (block.gradient.transpose() * tangent_change(block.place, best_.tail<3>())).transpose() /
              slope_factor(best_, block);
      information_ += mean * change * change.transpose();
      score_ += (block.points - mean) * change;
      scatter_ += std::pow(block.points - mean, 2) / mean;
    }
  }

  const SlopeBlocks& blocks_;
  Unknowns best_;
  Information information_;
  Unknowns score_;
  double scatter_ = 0.0;
};

}  // namespace

Eigen::Vector3d SensorPlace::place() const {
  return middle_ + Eigen::Vector3d(inverse_.x(), inverse_.y(), 1.0) / inverse_.z();
}

double SensorPlace::tangent_sd(const Eigen::Vector3d& point) const {
  constexpr double of_model = 0.07;  // ours: by which tangents found in simulated scans are off
  const Eigen::Vector3d from = point - middle_;
  const Eigen::Vector2d tangent = tangent_to(from, inverse_);
  const double length = std::max(tangent.norm(), 1e-9);
  const Eigen::RowVector3d along = tangent.transpose() / length * tangent_change(from, inverse_);
  return std::hypot(std::sqrt((along * covariance_ * along.transpose()).value()),
                    of_model * length);
}

double SensorPlace::misfit(const Eigen::Vector3d& place, const Rectangle& area) const {
  const Eigen::Vector3d from = place - middle_;
  if (!(from.z() > 0.0)) return HUGE_VAL;
  const Eigen::Vector3d inverse = Eigen::Vector3d(from.x(), from.y(), 1.0) / from.z();
  double most = 0.0;
  for (const double x : {area.x_min, 0.5 * (area.x_min + area.x_max), area.x_max}) {
    for (const double y : {area.y_min, 0.5 * (area.y_min + area.y_max), area.y_max}) {
      const Eigen::Vector3d point(x, y, middle_.z());
      const Eigen::Vector3d offset = point - middle_;
      const double apart = (tangent_to(offset, inverse) - tangent_to(offset, inverse_)).norm();
      most = std::max(most, apart / tangent_sd(point));
    }
  }
  return most;
}

std::optional<SensorPlace> infer_sensor(const Surface& surface) {
  constexpr std::size_t fewest = 150;     // ours: blocks
  constexpr double significant = 50.0;    // ours: by chance 1e-10, but patterns are not random
  constexpr double least_sds = 4.0;       // ours: of the height
  constexpr double least_power = 0.9;     // ours
  constexpr double highest_ground = 0.6;  // ours: of the height, near which the fit is bounded
  if (surface.points.size() == 0) return std::nullopt;
  const SlopeBlocks blocks = blocks_of(surface);
  if (blocks.all.size() < fewest) return std::nullopt;
  PointRegression regression(blocks);
  regression.fit();
  const Eigen::Vector3d inverse = regression.inverse();
  const Eigen::Matrix3d covariance = regression.covariance();
  const bool is_told = squared_by(covariance, inverse) > significant &&
                       inverse.z() > least_sds * std::sqrt(covariance(2, 2));
  if (!is_told || inverse.z() * highest(blocks) > highest_ground) return std::nullopt;
  // Thinned points, and those of cameras that look down, are even and thin out little with range.
  if (regression.scatter() < 1.0 && regression.power_of_range() < least_power) return std::nullopt;
  return SensorPlace(blocks.middle, inverse, covariance);
}

std::optional<PlaceDoubt> doubt_of_place(const Surface& surface) {
  constexpr double most = 6.0;          // ours [sd]; right places: up to 3, 2 m off: 7 and more
  constexpr double least_level = 0.01;  // ours: of the heights
  if (surface.sensors.size() != 1) return std::nullopt;
  const Eigen::Vector3d& told = surface.sensors.front();
  const Rectangle extent = surface.height.extent();
  if (const auto inferred = infer_sensor(surface)) {
    if (!(inferred->misfit(told, extent) > most)) return std::nullopt;
    return PlaceDoubt{told, inferred->place()};
  }
  std::vector<double> heights = known_values(surface.height.z);
  if (heights.empty()) return std::nullopt;
  if (told.z() > upper_quantile(heights, least_level)) return std::nullopt;
  return PlaceDoubt{told, std::nullopt};
}

}  // namespace excavplan
