// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <excavplan/ground/height_map.hpp>
#include "base/random.hpp"

#include "base/angles.hpp"

/// @file
/// Scans of digs whose volumes are known in closed form: a pit with sloped walls, a spill ridge
/// beside it and a dumped cone or windrow, on ground of any shape, with the errors of real surveys.
/// For tests and benchmarks. What a scan shows is ground + change, so that the ground does not
/// change the truth.

namespace excavplan::scenes {

constexpr double degree = pi / 180.0;

/// The dig area is 6 m x 5 m and the dump area 5 m x 5 m, each centred on its own origin. In a
/// whole scene the dump area lies beside the dig area.
constexpr Rectangle dig_extent = {-3.0, -2.5, 3.0, 2.5};
constexpr Rectangle dump_extent = {-2.5, -2.5, 2.5, 2.5};
constexpr Rectangle whole_extent = {-3.0, -2.5, 8.0, 2.5};
constexpr double dump_offset = 5.5;  ///< x of the dump area's origin in a whole scene [m]

/// 0 outside the map.
double height_of_cell(const HeightMap& map, double x, double y);

/// Lengths in m, angles in rad; k 1.25 as it stands.
struct Dig {
  double pit_length = 2.2;
  double pit_width = 1.0;
  double pit_depth = 0.30;
  double wall_angle = 70.0 * degree;
  double pit_x = 0.013;
  double pit_y = -0.207;
  double heading = 17.0 * degree;
  double ridge_offset = 0.85;  ///< of the crest from the axis of the pit
  double ridge_height = 0.15;
  double ridge_slope = 35.0 * degree;
  double bulking = 1.25;
  double heap_slope = 35.0 * degree;
  double heap_x = -0.021;  ///< in the dump area
  double heap_y = 0.034;
  double heap_crest = 0.0;  ///< length of a windrow's crest, along x; a cone has none
  /// Heights above the ground in the dump area that stand for the heap; `bulking` must fit them.
  std::shared_ptr<const HeightMap> heap_shape;

  double pit_volume() const {
    const double inset = pit_depth / std::tan(wall_angle);
    return pit_depth *
           (pit_length * pit_width - inset * (pit_length + pit_width) + 4.0 / 3.0 * inset * inset);
  }
  double ridge_volume() const {
    const double half_width = ridge_height / std::tan(ridge_slope);
    return ridge_height * half_width * (pit_length + pi / 3.0 * half_width);
  }
  double heap_volume() const { return bulking * pit_volume() - ridge_volume(); }
  /// From the crest to the foot: volume = tan(slope) (pi / 3 r^3 + crest r^2), by Newton's method,
  /// which comes down to the root from the cone's.
  double heap_radius() const {
    const double sought = heap_volume() / std::tan(heap_slope);
    double r = std::cbrt(3.0 * sought / pi);
    for (int i = 0; heap_crest > 0.0 && i < 30; ++i) {
      r -= (pi / 3.0 * r * r * r + heap_crest * r * r - sought) /
           (pi * r * r + 2.0 * heap_crest * r);
    }
    return r;
  }

  /// Change of height by pit and ridge.
  double dug(double x, double y) const {
    const double u = (x - pit_x) * std::cos(heading) + (y - pit_y) * std::sin(heading);
    const double v = (y - pit_y) * std::cos(heading) - (x - pit_x) * std::sin(heading);
    const double inside = std::min(0.5 * pit_length - std::abs(u), 0.5 * pit_width - std::abs(v));
    const double pit = std::clamp(inside * std::tan(wall_angle), 0.0, pit_depth);
    const double away = std::hypot(std::max(std::abs(u) - 0.5 * pit_length, 0.0), v - ridge_offset);
    return std::max(0.0, ridge_height - away * std::tan(ridge_slope)) - pit;
  }
  /// Change of height by the heap, in the dump area.
  double dumped(double x, double y) const {
    if (heap_shape) return height_of_cell(*heap_shape, x, y);
    const double away =
        std::hypot(std::max(std::abs(x - heap_x) - 0.5 * heap_crest, 0.0), y - heap_y);
    return std::max(0.0, (heap_radius() - away) * std::tan(heap_slope));
  }
};

/// Another dig for every seed: size, depth, walls, place, heading, bulking 1.0 .. 1.6.
Dig random_dig(std::uint64_t seed);

/// What is wrong with the scans. Each cloud errs in its own way.
struct ScanErrors {
  double noise = 0.0;         ///< of every coordinate of a point [m]
  double outliers = 0.0;      ///< share of points off by -0.3 .. 1 m in height
  double unseen = 0.0;        ///< share of the area in discs of 0.10 .. 0.25 m without points
  double tilt = 0.0;          ///< of both scans about x [rad]
  double slope = 0.0;         ///< of the ground along x [rad]
  double roughness = 0.0;     ///< of the ground, rms of eight waves of 0.26 .. 2.3 m [m]
  double shift = 0.0;         ///< of the after scan, in a random direction [m]
  double turn = 0.0;          ///< of the after scan, about a random axis [rad]
  double correlated = 0.0;    ///< height error that neighbours share [m]
  double correlation = 0.25;  ///< its length l: covariance exp(-d^2 / (2 l^2)) [m]
};

/// The errors of the accuracy table by name.
struct Variant {
  std::string name;
  ScanErrors errors;
};
std::vector<Variant> variants();
ScanErrors errors_of(const std::string& variant);

enum class Part { dig, dump, whole };

Rectangle extent_of(Part part);

double change_at(const Dig& dig, Part part, double x, double y);

/// Ground before the dig: a slope with waves on it.
class Ground {
 public:
  Ground(const ScanErrors& errors, std::uint64_t seed)
      : slope_x_(std::tan(errors.slope)), slope_y_(std::tan(0.375 * errors.slope)) {
    Random random(seed, 1);
    double power = 0.0;
    for (std::size_t i = 0; i < waves_.size(); ++i) {
      const double length = 0.26 * std::pow(2.3 / 0.26, static_cast<double>(i) / 7.0);
      const double heading = random.uniform(0.0, 2.0 * pi);
      waves_[i] = {2.0 * pi / length * std::cos(heading), 2.0 * pi / length * std::sin(heading),
                   random.uniform(0.0, 2.0 * pi), std::sqrt(length)};
      power += 0.5 * length;
    }
    for (Wave& wave : waves_) wave.height *= errors.roughness / std::sqrt(power);
  }
  double operator()(double x, double y) const {
    double z = slope_x_ * x + slope_y_ * y;
    if (waves_[0].height == 0.0) return z;
    for (const Wave& w : waves_) z += w.height * std::sin(w.x * x + w.y * y + w.phase);
    return z;
  }

 private:
  struct Wave {
    double x, y, phase, height;
  };
  double slope_x_, slope_y_;
  std::array<Wave, 8> waves_{};
};

/// A smooth random height error of standard deviation 1 over an area: white noise on a lattice
/// of a fifth of the length, smoothed by a Gaussian, bilinear between its nodes.
class SmoothError {
 public:
  SmoothError(const Rectangle& extent, double length, Random random) : step_(length / 5.0) {
    constexpr int reach = 11;  // three standard deviations of the kernel
    origin_ = {extent.x_min - length, extent.y_min - length};
    const auto nodes = [&](double span) {
      return static_cast<Eigen::Index>(std::ceil((span + 2.0 * length) / step_)) + 2;
    };
    const Eigen::Index rows = nodes(extent.y_max - extent.y_min);
    const Eigen::Index cols = nodes(extent.x_max - extent.x_min);
    Eigen::ArrayXXd white(rows + 2 * reach, cols + 2 * reach);
    for (Eigen::Index i = 0; i < white.size(); ++i) white.data()[i] = random.normal();
    Eigen::ArrayXd weight(2 * reach + 1);
    for (int i = -reach; i <= reach; ++i) weight(i + reach) = std::exp(-i * i / 25.0);
    weight /= std::sqrt(weight.square().sum());
    Eigen::ArrayXXd along = Eigen::ArrayXXd::Zero(rows, white.cols());
    for (int i = 0; i <= 2 * reach; ++i) along += weight(i) * white.middleRows(i, rows);
    field_ = Eigen::ArrayXXd::Zero(rows, cols);
    for (int i = 0; i <= 2 * reach; ++i) field_ += weight(i) * along.middleCols(i, cols);
  }
  double operator()(double x, double y) const {
    const double u = (x - origin_.x()) / step_;
    const double v = (y - origin_.y()) / step_;
    const auto col = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(u), 0, field_.cols() - 2);
    const auto row = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(v), 0, field_.rows() - 2);
    const double s = u - static_cast<double>(col);
    const double t = v - static_cast<double>(row);
    return (1.0 - t) * ((1.0 - s) * field_(row, col) + s * field_(row, col + 1)) +
           t * ((1.0 - s) * field_(row + 1, col) + s * field_(row + 1, col + 1));
  }

 private:
  double step_;
  Eigen::Vector2d origin_;
  Eigen::ArrayXXd field_;
};

using Points = std::vector<Eigen::Vector3d>;

struct Disc {
  double x, y, radius;
  bool contains(double px, double py) const {
    return (px - x) * (px - x) + (py - y) * (py - y) < radius * radius;
  }
};

std::vector<Disc> unseen_discs(const Rectangle& extent, double share, Random random);

Eigen::Isometry3d random_motion(double shift, double turn, Random random);

/// One scan: `points` even over the area but where it is unseen. Equal seeds show the same ground;
/// scan 0 is the one before, scan 1 the one after.
Points scan(const Dig& dig, Part part, const ScanErrors& errors, std::size_t points,
            std::uint64_t seed, bool after);

}  // namespace excavplan::scenes
