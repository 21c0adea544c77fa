// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/section_bucket.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

void clip(Polygon& polygon, const Below& side, Polygon& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double at_p = side.at(p.x()) - p.y();
    const double at_q = side.at(q.x()) - q.y();
    if (at_p >= 0.0) scratch.push_back(p);
    if ((at_p < 0.0) != (at_q < 0.0)) scratch.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  polygon.swap(scratch);
}

AreaCentre area_centre(const Polygon& polygon) {
  AreaCentre result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double cross = p.x() * q.y() - p.y() * q.x();
    result.area += 0.5 * cross;
    result.centre += cross / 6.0 * (p + q);
  }
  if (result.area > 0.0) result.centre /= result.area;
  return result;
}

/// Volume over a stretch of mouth on which the soil's face stands `from` .. `to` above it,
/// linearly, between side plates from which it may only rise at `slope`.
double heap_over_mouth(double length, double from, double to, double width, double slope) {
  const double full = 0.5 * width * slope;  // the slopes of both plates meet here
  const auto integral = [&](double height) {
    const double low = std::clamp(height, 0.0, full);
    const double high = std::max(0.0, height - full);
    return low * low * (0.5 * width - low / (3.0 * slope)) + high * 0.5 * width * full;
  };
  if (std::abs(to - from) < 1e-12) return 0.0;
  return length * (integral(to) - integral(from)) / (to - from);
}

}  // namespace

void BucketSection::turn_to(double phi3) {
  turn_ = Eigen::Rotation2Dd(phi3);
  corners_.clear();
  for (const Vector2d& corner : bucket_.profile) {
    corners_.push_back(turned(corner - bucket_.profile.front()));
  }
}

double BucketSection::held(double support, const HoldingSlopes& slopes) {
  const Vector2d top = corners_.back();
  const Below face = {support, slopes.face};
  const Below rear = {top.y() + slopes.heap * top.x(), -slopes.heap};
  polygon_ = corners_;
  clip(polygon_, face, scratch_);
  // Soil runs over the top edge only where that is lower than the lip by more than the slope.
  if (top.x() > 0.0 && rear.height < 0.0) clip(polygon_, rear, scratch_);
  const double inside = area_centre(polygon_).area * bucket_.width_inside;
  return top.x() > 0.0 ? inside + heaped(top, face, rear, slopes.heap) : inside;
}

double BucketSection::pushed_in(double level) {
  const Vector2d top = corners_.back();
  polygon_ = corners_;
  clip(polygon_, {level, 0.0}, scratch_);
  double area = area_centre(polygon_).area;
  if (top.x() > 0.0) {
    const double fall = top.y() / top.x();  // of the level towards the mouth
    const double end = fall * top.x() > level ? level / fall : top.x();
    area += end * (level - 0.5 * fall * end);
  }
  return area * bucket_.width_inside;
}

AreaCentre BucketSection::buried(const Below& ground) {
  polygon_ = corners_;
  clip(polygon_, ground, scratch_);
  return area_centre(polygon_);
}

double BucketSection::heaped(const Vector2d& top, const Below& face, const Below& rear,
                             double slope) const {
  const Below mouth = {0.0, top.y() / top.x()};
  const auto above = [&](double x) {
    return std::min(face.height + face.slope * x, rear.height + rear.slope * x) - mouth.slope * x;
  };
  const double crossing = (rear.height - face.height) / (face.slope - rear.slope);
  const double peak = std::clamp(crossing, 0.0, top.x());
  const double width = bucket_.width_inside;
  return heap_over_mouth(peak, above(0.0), above(peak), width, slope) +
         heap_over_mouth(top.x() - peak, above(peak), above(top.x()), width, slope);
}

PackedFront::PackedFront(const Bucket& bucket) {
  const auto direction = [&](std::size_t i) {
    const Vector2d side = bucket.profile[i] - bucket.profile[0];
    return std::atan2(side.y(), side.x());
  };
  const double floor = direction(1);
  mouth_ = std::remainder(direction(bucket.profile.size() - 1) - floor, 2.0 * pi);
  BucketSection section(bucket);
  for (int i = 0; i <= steps; ++i) {
    const double turn = floor + mouth_ * i / steps;
    section.turn_to(-turn);  // the front is level
    const AreaCentre soil = section.buried({});
    volume_.push_back(soil.area * bucket.width_inside);
    centre_.emplace_back(Eigen::Rotation2Dd(turn) * soil.centre);
  }
}

PackedFront::Fill PackedFront::of(double volume) const {
  const auto above = std::upper_bound(volume_.begin(), volume_.end(), volume);
  if (above == volume_.begin()) return {0.0, centre_.front()};
  if (above == volume_.end()) return {mouth_, centre_.back()};
  const auto i = static_cast<std::size_t>(above - 1 - volume_.begin());
  const double share = (volume - volume_[i]) / (volume_[i + 1] - volume_[i]);
  return {mouth_ * (static_cast<double>(i) + share) / steps,
          centre_[i] + share * (centre_[i + 1] - centre_[i])};
}

double clipped_capacity(const Machine& machine, double phi3, double support,
                        const HoldingSlopes& slopes) {
  BucketSection section(machine.bucket);
  section.turn_to(phi3);
  return section.held(support, slopes);
}

}  // namespace excavplan
