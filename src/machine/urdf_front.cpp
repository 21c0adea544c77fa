// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/urdf_front.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"
#include "machine/machine_reading.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::string;

constexpr double shortest_link = 0.05;  // [m]; ours
constexpr double rounded = 1e-3;        // error of pi / 2 as 1.571 and the like [rad]

class Front {
 public:
  Front(const UrdfTree& tree, const UrdfNames& names)
      : tree_(tree), names_(names), chain_(chain_of(tree, names)) {}

  UrdfFront front() const {
    UrdfFront front;
    front.boom_pin = {(parts_[0].pin - swing_.pin).dot(forward_),
                      parts_[0].pin.z() - names_.ground};
    front.swing_x = swing_.pin.x();
    front.swing_y = swing_.pin.y();
    front.ahead = std::atan2(forward_.y(), forward_.x());
    if (swing_.joint) add_swing(front);
    for (std::size_t i = 0; i < 3; ++i) front.parts[i] = part(i);
    add_masses(front);
    return front;
  }

 private:
  void add_swing(UrdfFront& front) const {
    const double sign = swing_.axis.z() > 0.0 ? 1.0 : -1.0;
    front.swing_angle = {swing_.joint->name, sign};
    front.swing = swing_.joint->limits;
    auto& [lower, upper, velocity, effort] = front.swing;
    const bool limited = swing_.joint->type == "revolute" && lower && upper && *lower < *upper &&
                         *lower >= -widest_swing_range && *upper <= widest_swing_range;
    if (!limited) {
      lower = upper = std::nullopt;
    } else if (sign < 0.0) {
      std::tie(lower, upper) = std::pair(-*upper, -*lower);
    }
  }

  Vector2d in_plane(const Vector3d& point) const { return {point.dot(forward_), point.z()}; }
  Vector2d link(std::size_t i) const {
    return in_plane((i < 2 ? parts_[i + 1].pin : chain_.tip) - parts_[i].pin);
  }
  double direction_of(std::size_t i) const { return std::atan2(link(i).y(), link(i).x()); }

  /// The zero of an angle up to whole turns: so that the middle of the range stated is within half
  /// a turn of the URDF's zero, else that of the URDF's range, `middle`, within half a turn of
  /// ours.
  static double nearest_turn(double zero, double sign, double middle, const UrdfLimits& stated) {
    if (stated.lower && stated.upper) {
      const double ours = 0.5 * (*stated.lower + *stated.upper);
      return ours + std::remainder(zero - ours, 2.0 * pi);
    }
    const double ours = sign * middle + zero;
    return zero + std::remainder(ours, 2.0 * pi) - ours;
  }

  UrdfPart part(std::size_t i) const {
    const UrdfJoint& joint = *parts_[i].joint;
    UrdfPart part;
    part.length = link(i).norm();
    if (!(part.length >= shortest_link)) {
      tree_.refuse(joint, "is " + number_text(part.length) +
                              " m from the next pin, expected at least " +
                              number_text(shortest_link));
    }
    const Vector3d left = Vector3d::UnitZ().cross(forward_);
    const double sign = parts_[i].axis.dot(left) > 0.0 ? 1.0 : -1.0;
    double zero = (i == 0 ? 0.0 : direction_of(i - 1)) - direction_of(i);
    part.limits = joint.limits;
    auto& [lower, upper, velocity, effort] = part.limits;
    if (!chain_.has_range[i]) lower = upper = std::nullopt;
    zero =
        nearest_turn(zero, sign, lower && upper ? 0.5 * (*lower + *upper) : 0.0, names_.ranges[i]);
    if (std::abs(zero) < 1e-12) zero = 0.0;
    part.angle = {joint.name, sign, zero};
    if (lower) lower = sign * *lower + zero;
    if (upper) upper = sign * *upper + zero;
    if (sign < 0.0) std::swap(lower, upper);
    const double least = i == 1 ? 0.0 : -pi;  // of read_machine()
    if (lower && std::abs(*lower - least) < rounded) lower = std::max(*lower, least);
    if (upper && std::abs(*upper - pi) < rounded) upper = std::min(*upper, pi);
    return part;
  }

  /// To each part the mass of the links that its joint moves and the next does not.
  void add_masses(UrdfFront& front) const {
    std::map<string, const UrdfJoint*> above;
    for (const UrdfJoint& joint : tree_.joints) above.emplace(joint.child, &joint);
    std::array<Vector2d, 3> moments = {Vector2d::Zero(), Vector2d::Zero(), Vector2d::Zero()};
    for (const UrdfLink& link : tree_.links) {
      if (!link.mass || *link.mass <= 0.0) continue;
      for (auto at = above.find(link.name); at != above.end();
           at = above.find(at->second->parent)) {
        const auto owner = std::find_if(parts_.begin(), parts_.end(), [&](const PlacedJoint& part) {
          return part.joint == at->second;
        });
        if (owner == parts_.end()) continue;
        const auto i = static_cast<std::size_t>(owner - parts_.begin());
        const Vector2d centre = in_plane(frame_of(link.name) * link.centre - owner->pin);
        front.parts[i].mass.mass += *link.mass;
        moments[i] += *link.mass * centre;
        break;
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      LinkMass& mass = front.parts[i].mass;
      if (!(mass.mass > 0.0)) continue;
      const Vector2d centre = moments[i] / mass.mass;
      mass.along = centre.dot(direction(direction_of(i)));
      mass.across = cross(direction(direction_of(i)), centre);
    }
  }

  Eigen::Isometry3d frame_of(const string& link) const {
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    for (const UrdfJoint* joint : tree_.chain_to(link)) frame = frame * joint->origin;
    return frame;
  }

  const UrdfTree& tree_;
  const UrdfNames& names_;
  const UrdfChain chain_;
  const PlacedJoint& swing_ = chain_.swing;
  const std::array<PlacedJoint, 3>& parts_ = chain_.parts;
  const Vector3d& forward_ = chain_.forward;
};

}  // namespace

UrdfFront front_of(const UrdfTree& tree, const UrdfNames& names) {
  return Front(tree, names).front();
}

}  // namespace excavplan
