// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/bucket_cavity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr double steepest_face = 80.0 * pi / 180.0;  // of soil, however cohesive; ours

Vector2d turned(const Vector2d& v, double angle) {
  return {v.x() * std::cos(angle) - v.y() * std::sin(angle),
          v.x() * std::sin(angle) + v.y() * std::cos(angle)};
}

Vector2d centroid_of(const std::vector<Vector2d>& polygon) {
  Vector2d sum = Vector2d::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    area += cross(a, b);
    sum += cross(a, b) * (a + b);
  }
  return sum / (3.0 * area);
}

}  // namespace

/// Extent of the cavity above one x. Its mouth may be the upper or the lower bound.
struct Cavity::Slice {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool open_below = false;
  bool open_above = false;
};

Cavity::Cavity(const Bucket& bucket)
    : bucket_(bucket), corners_(bucket.profile.size()), sides_(bucket.profile.size()) {
  turn_to(0.0);
}

void Cavity::turn_to(double phi3) {
  x_min_ = x_max_ = 0.0;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    corners_[i] = turned(bucket_.profile[i] - bucket_.profile.front(), phi3);
    x_min_ = std::min(x_min_, corners_[i].x());
    x_max_ = std::max(x_max_, corners_[i].x());
  }
  centroid_ = centroid_of(corners_);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Vector2d& a = corners_[i];
    const Vector2d& b = corners_[(i + 1) % corners_.size()];
    const double slope = (b.y() - a.y()) / (b.x() - a.x());  // unused where upright
    sides_[i] = {std::min(a.x(), b.x()), std::max(a.x(), b.x()), a.y() - slope * a.x(), slope};
  }
}

double Cavity::capacity(double support, const HoldingSlopes& slopes) const {
  const double width = bucket_.width_inside;
  const double flank = 0.5 * slopes.heap * width;  // height at which the slopes of both sides meet
  const Vector2d& top = corners_.back();
  constexpr int slices = 64;
  double area = 0.0;
  for (int i = 0; i < slices; ++i) {
    const double x = x_min_ + (i + 0.5) / slices * (x_max_ - x_min_);
    const Slice slice = at(x);
    if (!(slice.high > slice.low) || slice.open_below) continue;
    double surface = std::max(0.0, support) + slopes.face * std::max(0.0, x);
    if (!slice.open_above) {
      area += std::clamp(surface - slice.low, 0.0, slice.high - slice.low);
      continue;
    }
    // The walls of the cut hold the soil beside the plates up to the level of the ground; behind
    // the top edge the cut is open.
    const double side = support > 0.0 ? std::max(slice.high, support) : slice.high;
    surface = std::min(surface, top.y() + slopes.heap * std::max(0.0, top.x() - x));
    const double heap = std::max(0.0, surface - side);
    const double mean_heap = heap < flank ? heap - 0.5 * heap * heap / flank : 0.5 * flank;
    area += std::max(0.0, std::min(surface, side) - slice.low) + mean_heap;
  }
  return area * (x_max_ - x_min_) / slices * width;
}

double Cavity::packed_front(double volume) const {
  const std::vector<Vector2d>& profile = bucket_.profile;
  const Vector2d floor = profile[1] - profile[0];
  double area = volume / bucket_.width_inside;
  Vector2d front = floor;
  for (std::size_t i = 1; i + 1 < profile.size() && area > 0.0; ++i) {
    const Vector2d a = profile[i] - profile[0];
    const Vector2d b = profile[i + 1] - profile[0];
    const double sector = 0.5 * cross(a, b);
    front = a + std::min(1.0, area / sector) * (b - a);
    area -= sector;
  }
  return std::atan2(cross(floor, front), floor.dot(front));
}

Cavity::Slice Cavity::at(double x) const {
  Slice slice;
  for (const Side& side : sides_) {
    if (!(side.x_low <= x && x < side.x_high)) continue;
    const bool mouth = &side == &sides_.back();
    const double z = side.offset + side.slope * x;
    if (z < slice.low) {
      slice.low = z;
      slice.open_below = mouth;
    }
    if (z > slice.high) {
      slice.high = z;
      slice.open_above = mouth;
    }
  }
  return slice;
}

double bucket_capacity(const Machine& machine, double phi3, double support,
                       const HoldingSlopes& slopes) {
  Cavity cavity(machine.bucket);
  cavity.turn_to(phi3);
  return cavity.capacity(support, slopes);
}

double stable_slope(const SoilState& soil, double height, double least) {
  const double phi = soil.friction_angle;
  const auto stands = [&](double angle) {
    return 4.0 * soil.cohesion * std::sin(angle) * std::cos(phi) >=
           soil.unit_weight * height * (1.0 - std::cos(angle - phi));
  };
  double low = least;
  double high = steepest_face;
  if (high <= low || stands(high)) return std::max(low, high);
  if (!stands(low)) return low;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (stands(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace excavplan
