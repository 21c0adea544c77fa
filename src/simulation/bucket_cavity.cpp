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
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Vector2d& a = corners_[i];
    const Vector2d& b = corners_[(i + 1) % corners_.size()];
    const double slope = (b.y() - a.y()) / (b.x() - a.x());  // unused where upright
    sides_[i] = {std::min(a.x(), b.x()), std::max(a.x(), b.x()), a.y() - slope * a.x(), slope};
  }
}

/// Sum of an area per width over the slices that are open to soil from above or from the lip, times
/// the width [m^3].
template <typename OfSlice>
double Cavity::over_slices(const OfSlice& of_slice) const {
  constexpr int slices = 64;
  double height = 0.0;
  for (int i = 0; i < slices; ++i) {
    const double x = x_min_ + (i + 0.5) / slices * (x_max_ - x_min_);
    const Slice slice = at(x);
    if (slice.high > slice.low && !slice.open_below) height += of_slice(x, slice);
  }
  return height * (x_max_ - x_min_) / slices * bucket_.width_inside;
}

double Cavity::capacity(double support, const HoldingSlopes& slopes) const {
  // Height at which the slopes of both sides meet.
  const double flank = 0.5 * slopes.heap * bucket_.width_inside;
  const Vector2d& top = corners_.back();
  return over_slices([&](double x, const Slice& slice) {
    double surface = std::max(0.0, support) + slopes.face * std::max(0.0, x);
    if (!slice.open_above) return std::clamp(surface - slice.low, 0.0, slice.high - slice.low);
    // The walls of the cut hold the soil beside the plates up to the level of the ground; behind
    // the top edge the cut is open.
    const double side = support > 0.0 ? std::max(slice.high, support) : slice.high;
    surface = std::min(surface, top.y() + slopes.heap * std::max(0.0, top.x() - x));
    const double heap = std::max(0.0, surface - side);
    const double mean_heap = heap < flank ? heap - 0.5 * heap * heap / flank : 0.5 * flank;
    return std::max(0.0, std::min(surface, side) - slice.low) + mean_heap;
  });
}

double Cavity::pushed_in(double support, double slope) const {
  return over_slices([&](double x, const Slice& slice) {
    const double height = support - slope * std::max(0.0, x) - slice.low;
    return slice.open_above ? std::max(0.0, height)
                            : std::clamp(height, 0.0, slice.high - slice.low);
  });
}

Cavity::Packed Cavity::packed(double volume) const {
  const Vector2d& floor = corners_[1];
  double left = volume / bucket_.width_inside;
  Vector2d front = floor;
  Vector2d moment = Vector2d::Zero();
  double filled = 0.0;
  for (std::size_t i = 1; i + 1 < corners_.size() && left > 0.0; ++i) {
    const Vector2d& a = corners_[i];
    const Vector2d& b = corners_[i + 1];
    const double sector = 0.5 * cross(a, b);
    const double share = std::min(1.0, left / sector);
    front = a + share * (b - a);
    moment += share * sector * (a + front) / 3.0;
    filled += share * sector;
    left -= sector;
  }
  return {std::atan2(cross(floor, front), floor.dot(front)),
          filled > 0.0 ? Vector2d(moment / filled) : Vector2d::Zero()};
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
