// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/bucket_cavity.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

/// `by`: the unit vector at the angle of the turn.
Vector2d turned(const Vector2d& v, const Vector2d& by) {
  return {v.x() * by.x() - v.y() * by.y(), v.x() * by.y() + v.y() * by.x()};
}

}  // namespace

Cavity::Cavity(const Bucket& bucket) : bucket_(bucket), corners_(bucket.profile.size()) {
  turn_to(0.0);
}

void Cavity::turn_to(double phi3) {
  if (phi3 == phi3_) return;
  phi3_ = phi3;
  const Vector2d direction(std::cos(phi3), std::sin(phi3));
  double x_min = 0.0;
  double x_max = 0.0;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    corners_[i] = turned(bucket_.profile[i] - bucket_.profile.front(), direction);
    x_min = std::min(x_min, corners_[i].x());
    x_max = std::max(x_max, corners_[i].x());
  }
  slice_width_ = (x_max - x_min) / static_cast<double>(slices_.size());
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    slices_[i] = Slice{};
    slices_[i].x = x_min + (static_cast<double>(i) + 0.5) * slice_width_;
  }
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    cross_slices(corners_[i], corners_[(i + 1) % corners_.size()], i + 1 == corners_.size());
  }
}

/// Bounds the slices that a side of the profile crosses.
void Cavity::cross_slices(const Vector2d& a, const Vector2d& b, bool mouth) {
  const double slope = (b.y() - a.y()) / (b.x() - a.x());  // unused where upright
  const double low = std::min(a.x(), b.x());
  const double high = std::max(a.x(), b.x());
  for (Slice& slice : slices_) {
    if (!(low <= slice.x && slice.x < high)) continue;
    const double z = a.y() + slope * (slice.x - a.x());
    if (z < slice.low) {
      slice.low = z;
      slice.open_below = mouth;
    }
    if (z > slice.high) {
      slice.high = z;
      slice.open_above = mouth;
    }
  }
}

/// Sum of an area per width over the slices that are open to soil from above or from the lip, times
/// the width [m^3].
template <typename OfSlice>
double Cavity::over_slices(const OfSlice& of_slice) const {
  double height = 0.0;
  for (const Slice& slice : slices_) {
    if (slice.high > slice.low && !slice.open_below) height += of_slice(slice);
  }
  return height * slice_width_ * bucket_.width_inside;
}

double Cavity::capacity(double support, const HoldingSlopes& slopes) const {
  // Height at which the slopes of both sides meet.
  const double flank = 0.5 * slopes.heap * bucket_.width_inside;
  const Vector2d& top = corners_.back();
  return over_slices([&](const Slice& slice) {
    double surface = std::max(0.0, support) + slopes.face * std::max(0.0, slice.x);
    if (!slice.open_above) return std::clamp(surface - slice.low, 0.0, slice.high - slice.low);
    // The walls of the cut hold the soil beside the plates up to the level of the ground; behind
    // the top edge the cut is open.
    const double side = support > 0.0 ? std::max(slice.high, support) : slice.high;
    surface = std::min(surface, top.y() + slopes.heap * std::max(0.0, top.x() - slice.x));
    const double heap = std::max(0.0, surface - side);
    const double mean_heap = heap < flank ? heap - 0.5 * heap * heap / flank : 0.5 * flank;
    return std::max(0.0, std::min(surface, side) - slice.low) + mean_heap;
  });
}

double Cavity::pushed_in(double level) const {
  return over_slices([&](const Slice& slice) {
    const double height = std::max(0.0, level - slice.low);
    return slice.open_above ? height : std::min(height, slice.high - slice.low);
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

double bucket_capacity(const Machine& machine, double phi3, double support,
                       const HoldingSlopes& slopes) {
  require_machine(machine);
  for (const double number : {phi3, support, slopes.face, slopes.heap}) {
    require(std::isfinite(number), "capacity of a bucket: an argument", number, "finite");
  }
  Cavity cavity(machine.bucket);
  cavity.turn_to(phi3);
  return cavity.capacity(support, slopes);
}

}  // namespace excavplan
