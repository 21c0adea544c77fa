// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/urdf_chain.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using Eigen::Vector3d;
using std::string;

constexpr double most_skew = 1e-3;          // sine of an angle; pi / 2 is often rounded to 1.5708
constexpr double placeholder_error = 0.01;  // of a rounded pi / 2 or 2 pi [rad]; ours
constexpr double clear_bend = 0.1;          // sine of a bend that is meant; ours
constexpr double clear_offset = 0.02;       // of the boom pin from the swing axis [m]; ours

class Chain {
 public:
  Chain(const UrdfTree& tree, const UrdfNames& names) : tree_(tree), names_(names) {}

  UrdfChain chain() {
    find_joints();
    const std::optional<string> tip = tip_link();
    add_ranges();
    const bool are_there = std::all_of(chain_.parts.begin(), chain_.parts.end(),
                                       [](const PlacedJoint& part) { return part.joint; });
    if (are_there) {
      find_swing();
      place(tip.value_or(chain_.parts[2].joint->child));
      check_axes();
      set_forward(tip.has_value());
    }
    if (!missing_.empty()) throw Error(ErrorKind::bad_file, complaint());
    return chain_;
  }

 private:
  void miss(const string& what) { missing_ += (missing_.empty() ? "" : "; ") + what; }

  string complaint() const {
    string text =
        tree_.file + ": it does not say all; state in " + names_.beside + " beside it: " + missing_;
    if (!misses_name_) return text;
    string moving;
    for (const UrdfJoint& joint : tree_.joints) {
      if (joint.type == "fixed" || moving.size() > 300) continue;
      moving += (moving.empty() ? "" : ", ") + joint.name;
    }
    return text + ". Its moving joints: " + (moving.empty() ? "none" : moving);
  }

  const UrdfJoint* named(const string& name, const string& word, const char* or_null = "") {
    const UrdfJoint* joint = tree_.joint(name);
    if (joint) return joint;
    misses_name_ = true;
    miss("urdf." + word + ", the name of its joint" + or_null + " (there is no " + in_quotes(name) +
         ")");
    return nullptr;
  }

  void find_joints() {
    for (std::size_t i = 0; i < 3; ++i) {
      chain_.parts[i].joint = named(names_.joints[i], front_words[i]);
    }
  }

  /// Not stated, and nothing moves above the boom: there is none.
  void find_swing() {
    if (!names_.swing) return;
    const auto above = tree_.chain_to(chain_.parts[0].joint->parent);
    const bool moves = std::any_of(above.begin(), above.end(),
                                   [](const UrdfJoint* joint) { return joint->type != "fixed"; });
    if (!names_.swing_stated && !moves) return;
    chain_.swing.joint = named(*names_.swing, "swing", " or null");
  }

  std::optional<string> tip_link() {
    const UrdfJoint* bucket = chain_.parts[2].joint;
    if (names_.tip_at) return bucket ? std::optional(bucket->child) : std::nullopt;
    if (const UrdfJoint* joint = tree_.joint(names_.tip)) return joint->child;
    if (tree_.link(names_.tip)) return names_.tip;
    miss("urdf.tip_m, [x, y, z] of the tooth tip in the frame of " +
         (bucket ? "link " + in_quotes(bucket->child) : "the link of the bucket's joint") +
         " (there is no joint or link " + in_quotes(names_.tip) + ")");
    return std::nullopt;
  }

  static bool is_range(const UrdfJoint* joint) {
    if (!joint || joint->type == "continuous") return false;
    const auto& [lower, upper, velocity, effort] = joint->limits;
    return lower && upper && *lower < *upper && *upper - *lower < 2.0 * pi - placeholder_error;
  }

  static bool is_quarter_turn(const UrdfJoint* joint) {
    return is_range(joint) && std::abs(*joint->limits.lower + 0.5 * pi) < placeholder_error &&
           std::abs(*joint->limits.upper - 0.5 * pi) < placeholder_error;
  }

  void add_ranges() {
    const auto& parts = chain_.parts;
    const bool alike = std::all_of(parts.begin(), parts.end(), [](const PlacedJoint& part) {
      return is_quarter_turn(part.joint);
    });
    const bool some = std::any_of(tree_.joints.begin(), tree_.joints.end(),
                                  [](const UrdfJoint& joint) { return is_range(&joint); });
    string ends;
    const auto add = [&](std::size_t i, const char* end, const std::optional<double>& stated) {
      if (!stated) ends += (ends.empty() ? "joints." : ", joints.") + string(front_words[i]) + end;
    };
    for (std::size_t i = 0; i < 3; ++i) {
      chain_.has_range[i] = is_range(parts[i].joint) && !alike;
      if (chain_.has_range[i] || (!parts[i].joint && some)) continue;
      add(i, ".lower_rad", names_.ranges[i].lower);
      add(i, ".upper_rad", names_.ranges[i].upper);
    }
    if (ends.empty()) return;
    miss(ends + ", in the angles of excavplan" +
         (alike ? " (+-pi/2 on every joint is taken for no range)" : ""));
  }

  /// Places the joints from the root to the tip, and sees that they come in this order.
  void place(const string& tip) {
    std::vector<PlacedJoint*> wanted;
    if (chain_.swing.joint) wanted.push_back(&chain_.swing);
    for (PlacedJoint& part : chain_.parts) wanted.push_back(&part);
    auto next = wanted.begin();
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    for (const UrdfJoint* joint : tree_.chain_to(tip)) {
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
                   "does not lie on the way to the tip " + in_quotes(tip) + " in its place");
    }
    chain_.tip = frame * names_.tip_at.value_or(Vector3d::Zero());
  }

  void check_axes() const {
    const Vector3d up = Vector3d::UnitZ();
    if (const UrdfJoint* swing = chain_.swing.joint) {
      require_turning(*swing);
      if (chain_.swing.axis.cross(up).norm() > most_skew) {
        tree_.refuse(*swing, "has an axis that is not upright");
      }
    }
    for (const PlacedJoint& part : chain_.parts) {
      require_turning(*part.joint);
      if (std::abs(part.axis.dot(up)) > most_skew) {
        tree_.refuse(*part.joint, "has an axis that is not level");
      }
      if (part.axis.cross(chain_.parts[0].axis).norm() > most_skew) {
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

  void set_forward(bool has_tip) {
    Vector3d& forward = chain_.forward;
    forward = chain_.parts[0].axis.cross(Vector3d::UnitZ()).normalized();
    const double side = names_.forward ? names_.forward->dot(forward) / clear_bend : ahead(has_tip);
    if (std::abs(side) < 1.0) {
      miss(names_.forward ? "another urdf.forward, as that stated lies across the boom's plane"
                          : "urdf.forward, 'x', '-x', 'y' or '-y' of the root's frame (with all "
                            "joints at zero the front stands upright)");
    }
    if (side < 0.0) forward = -forward;
  }

  /// Above 1 the front points to `forward`, below -1 away from it.
  double ahead(bool has_tip) const {
    const auto& [boom, arm, bucket] = chain_.parts;
    const Vector3d left = Vector3d::UnitZ().cross(chain_.forward);
    const std::array<Vector3d, 3> links = {arm.pin - boom.pin, bucket.pin - arm.pin,
                                           chain_.tip - bucket.pin};
    std::array<double, 3> angle{};  // direction of each link [rad]
    double turned = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const UrdfLimits& limits = chain_.parts[i].joint->limits;
      const double nearest =
          chain_.has_range[i] ? std::min(std::max(0.0, *limits.lower), *limits.upper) : 0.0;
      turned += chain_.parts[i].axis.dot(left) > 0.0 ? nearest : -nearest;
      angle[i] = std::atan2(links[i].z(), links[i].dot(chain_.forward)) - turned;
    }
    const double lean = std::cos(angle[0]) / clear_bend;
    const double offset = (boom.pin - chain_.swing.pin).dot(chain_.forward) / clear_offset;
    const double curl = has_tip ? std::sin(angle[1] - angle[2]) / clear_bend : 0.0;
    for (const double sign : {lean, std::sin(angle[0] - angle[1]) / clear_bend, offset, curl}) {
      if (std::abs(sign) >= 1.0) return sign;
    }
    return 0.0;
  }

  const UrdfTree& tree_;
  const UrdfNames& names_;
  UrdfChain chain_;
  string missing_;
  bool misses_name_ = false;
};

}  // namespace

UrdfChain chain_of(const UrdfTree& tree, const UrdfNames& names) {
  return Chain(tree, names).chain();
}

}  // namespace excavplan
