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

constexpr double most_skew = 1e-3;      // sine of an angle; pi / 2 is often rounded to 1.5708
constexpr double shortest_link = 0.05;  // [m]; ours

/// A joint at the zero of all joints, in the frame of the root.
struct PlacedJoint {
  const UrdfJoint* joint = nullptr;
  Vector3d pin = Vector3d::Zero();
  Vector3d axis = Vector3d::UnitZ();
};

class Front {
 public:
  Front(const UrdfTree& tree, const UrdfNames& names) : tree_(tree), names_(names) {}

  UrdfFront front() {
    place_chain();
    check_axes();
    set_plane();
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
  const UrdfJoint& named(const string& name, const char* what) const {
    if (const UrdfJoint* joint = tree_.joint(name)) return *joint;
    string all;
    for (const UrdfJoint& joint : tree_.joints) {
      if (joint.type == "fixed" || all.size() > 300) continue;
      all += (all.empty() ? "" : ", ") + joint.name;
    }
    throw Error(ErrorKind::bad_file,
                tree_.file + ": has no joint " + in_quotes(name) + " (" + what +
                    "); its moving joints: " + (all.empty() ? "none" : all) +
                    "; say in the JSON beside it which is which, as {\"urdf\": {\"" + what +
                    "\": \"NAME\"}}");
  }

  string tip_link() const {
    if (const UrdfJoint* joint = tree_.joint(names_.tip)) return joint->child;
    if (tree_.link(names_.tip)) return names_.tip;
    return named(names_.tip, "tip").child;
  }

  /// Places the joints from the root to the tip, and sees that they come in this order.
  void place_chain() {
    const std::array<const char*, 3> words = {"boom", "arm", "bucket"};
    if (names_.swing) swing_.joint = &named(*names_.swing, "swing");
    for (std::size_t i = 0; i < 3; ++i) parts_[i].joint = &named(names_.joints[i], words[i]);
    std::vector<PlacedJoint*> wanted;
    if (swing_.joint) wanted.push_back(&swing_);
    for (PlacedJoint& part : parts_) wanted.push_back(&part);
    auto next = wanted.begin();
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    for (const UrdfJoint* joint : tree_.chain_to(tip_link())) {
      frame = frame * joint->origin;
      const bool inside = next != wanted.begin() && next != wanted.end();
      if (next != wanted.end() && (*next)->joint == joint) {
        **next = {joint, frame.translation(), frame.linear() * joint->axis};
        ++next;
      } else if (inside && joint->type != "fixed") {
        tree_.refuse(*joint, "moves too, between " + in_quotes((*std::prev(next))->joint->name) +
                                 " and " + in_quotes((*next)->joint->name) +
                                 ": only swing, boom, arm and bucket may");
      }
    }
    if (next != wanted.end()) {
      tree_.refuse(*(*next)->joint,
                   "does not lie on the way to the tip " + in_quotes(names_.tip) + " in its place");
    }
    tip_ = frame.translation();
  }

  void check_axes() const {
    const Vector3d up = Vector3d::UnitZ();
    if (swing_.joint) {
      require_turning(*swing_.joint);
      if (swing_.axis.cross(up).norm() > most_skew) {
        tree_.refuse(*swing_.joint, "has an axis that is not upright");
      }
    }
    for (const PlacedJoint& part : parts_) {
      require_turning(*part.joint);
      if (std::abs(part.axis.dot(up)) > most_skew) {
        tree_.refuse(*part.joint, "has an axis that is not level");
      }
      if (part.axis.cross(parts_[0].axis).norm() > most_skew) {
        tree_.refuse(*part.joint,
                     "has an axis that is not parallel to that of the boom: the front "
                     "is not planar");
      }
    }
  }

  void require_turning(const UrdfJoint& joint) const {
    if (joint.mimics) {
      tree_.refuse(joint, "has a 'mimic', expected a joint that moves by itself");
    }
    if (joint.type == "revolute" || joint.type == "continuous") return;
    tree_.refuse(joint, "is " + in_quotes(joint.type) + ", expected 'revolute' or 'continuous'");
  }

  /// Forward is where the tip is with all joints in the middle of their ranges.
  void set_plane() {
    forward_ = parts_[0].axis.cross(Vector3d::UnitZ()).normalized();
    JointAngles middle;
    for (std::size_t i = 0; i < 3; ++i) {
      const UrdfPart at = part(i);
      middle[static_cast<int>(i)] =
          0.5 * (at.limits.lower.value_or(0.0) + at.limits.upper.value_or(0.0));
    }
    double ahead = 0.0;
    double angle = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      angle -= middle[static_cast<int>(i)];
      ahead += part(i).length * std::cos(angle);
    }
    if (ahead < 0.0) forward_ = -forward_;
  }

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
    return in_plane((i < 2 ? parts_[i + 1].pin : tip_) - parts_[i].pin);
  }
  double direction_of(std::size_t i) const { return std::atan2(link(i).y(), link(i).x()); }

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
    if (joint.type == "continuous") lower = upper = std::nullopt;
    const double middle = sign * 0.5 * (lower.value_or(0.0) + upper.value_or(0.0)) + zero;
    zero += std::remainder(middle, 2.0 * pi) - middle;
    if (std::abs(zero) < 1e-12) zero = 0.0;
    part.angle = {joint.name, sign, zero};
    if (lower) lower = sign * *lower + zero;
    if (upper) upper = sign * *upper + zero;
    if (sign < 0.0) std::swap(lower, upper);
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
  PlacedJoint swing_;
  std::array<PlacedJoint, 3> parts_;
  Vector3d tip_ = Vector3d::Zero();
  Vector3d forward_ = Vector3d::UnitX();
};

}  // namespace

UrdfFront front_of(const UrdfTree& tree, const UrdfNames& names) {
  return Front(tree, names).front();
}

}  // namespace excavplan
