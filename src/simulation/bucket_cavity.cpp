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
  left_ = x_min;
  slice_width_ = (x_max - x_min) / static_cast<double>(slice_count);
  constexpr double none = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < slice_count; ++i) {
    x_.data()[i] = x_min + (static_cast<double>(i) + 0.5) * slice_width_;
  }
  low_.fill(none);
  high_.fill(-none);
  for (std::size_t i = 0; i + 1 < corners_.size(); ++i) bound(corners_[i], corners_[i + 1]);
  EachSlice open;
  close_slices(side(corners_.back(), corners_.front()),
               {slice_count, x_.data(), low_.data(), high_.data()}, lid_.data(), open.data());
  keep(open);
}

ProfileSide Cavity::side(const Vector2d& a, const Vector2d& b) {
  const double slope = (b.y() - a.y()) / (b.x() - a.x());  // unused where upright
  return {std::min(a.x(), b.x()), std::max(a.x(), b.x()), a.x(), a.y(), slope};
}

/// Bounds the slices that a side of the profile crosses.
void Cavity::bound(const Vector2d& a, const Vector2d& b) {
  const ProfileSide crossing = side(a, b);
  if (!(crossing.from < crossing.end)) return;
  // A slice more on each side for what is rounded.
  const double first = std::max(0.0, (crossing.from - left_) / slice_width_ - 1.5);
  const double end = std::min<double>(slice_count, (crossing.end - left_) / slice_width_ + 1.5);
  const auto i = static_cast<std::size_t>(first);
  bound_slices(crossing, {static_cast<std::size_t>(end) - i, &x_[i], &low_[i], &high_[i]});
}

/// Keeps the open slices, in their order.
void Cavity::keep(const EachSlice& open) {
  const double top = corners_.back().x();
  for (std::size_t i = 0; i < slice_count; ++i) {
    ahead_.data()[i] = std::max(0.0, x_.data()[i]);
    short_of_top_.data()[i] = std::max(0.0, top - x_.data()[i]);
  }
  open_ = 0;
  for (std::size_t i = 0; i < slice_count; ++i) {
    if (!(open.data()[i] > 0.0)) continue;
    if (open_ < i) {
      for (EachSlice* each : {&low_, &high_, &lid_, &ahead_, &short_of_top_}) {
        each->data()[open_] = each->data()[i];
      }
    }
    ++open_;
  }
}

CavitySlices Cavity::slices() const {
  return {open_, low_.data(), high_.data(), lid_.data(), ahead_.data(), short_of_top_.data()};
}

/// Of soil that stands so high in the slices [m^3].
double Cavity::volume(double height) const { return height * slice_width_ * bucket_.width_inside; }

CavityLoad Cavity::load(double support, const HoldingSlopes& slopes) const {
  const double flank = 0.5 * slopes.heap * bucket_.width_inside;
  return {support, slopes.face, slopes.heap, corners_.back().y(), flank};
}

double Cavity::capacity(double support, const HoldingSlopes& slopes) const {
  EachSlice held;
  fill_slices(this->slices(), load(support, slopes), held.data());
  double sum = 0.0;
  for (std::size_t i = 0; i < open_; ++i) sum += held.data()[i];
  return volume(sum);
}

Cavity::Room Cavity::room(double level, const HoldingSlopes& slopes) const {
  EachSlice held;
  EachSlice pushed;
  fill_slices(this->slices(), load(level, slopes), held.data());
  push_into_slices(this->slices(), level, pushed.data());
  double held_sum = 0.0;
  double pushed_sum = 0.0;
  for (std::size_t i = 0; i < open_; ++i) {
    held_sum += held.data()[i];
    pushed_sum += pushed.data()[i];
  }
  return {volume(held_sum), volume(pushed_sum)};
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
