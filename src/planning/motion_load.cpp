// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/motion_load.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "machine/front_mass.hpp"
#include "planning/front_load.hpp"

namespace excavplan {
namespace {

/// Half of the gauge over the x of the front edge: half of the tumbler distance; ours, from 0.69 of
/// the ZX120's data sheet and alike of others.
constexpr double side_edge = 0.69;

bool is_off_the_dig(DigPhase phase) {
  return phase < DigPhase::penetrate || phase > DigPhase::scoop;
}

/// A load over what the machine can hold of it, where that is largest.
struct Worst {
  double share = 1.0;
  const WayPose* pose = nullptr;
  Joint joint = Joint::boom;

  void see(double other, const WayPose& at, Joint of = Joint::boom) {
    if (other > share) *this = {other, &at, of};
  }
};

/// Distance of the centre of all masses from the middle of the tracks over that of the edge in its
/// direction; above 1 the machine tips.
double tipping(const Machine& machine, const Body& body, const WayPose& pose,
               const Eigen::Vector2d& cavity) {
  const LinkPositions at = link_positions(machine, pose.joints.head<3>());
  const Eigen::Vector3d centres = link_centres(machine, at);
  double mass = body.mass + pose.payload;
  double moment = body.mass * body.centre.x() + pose.payload * bucket_point(at, cavity).x();
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    mass += machine.links[i].mass;
    moment += machine.links[i].mass * centres[static_cast<Eigen::Index>(i)];
  }
  const Eigen::Vector2d centre = moment / mass * direction(pose.joints[3]);
  const double along = centre.x() / (centre.x() < 0.0 ? body.rear_edge : body.front_edge);
  return std::max(along, std::abs(centre.y()) / (side_edge * body.front_edge));
}

std::string place(const WayPose& pose) {
  return std::string(name(pose.phase)) + ", boom, arm, bucket, swing at " +
         readable(pose.joints[0], 2) + ", " + readable(pose.joints[1], 2) + ", " +
         readable(pose.joints[2], 2) + ", " + readable(pose.joints[3], 2) + " rad";
}

}  // namespace

std::vector<Warning> load_warnings(const Machine& machine, const Way& way) {
  Worst overload, tips;
  const Eigen::Vector2d cavity = cavity_centre(machine.bucket);
  for (const WayPose& pose : way.poses) {
    if (!is_off_the_dig(pose.phase)) continue;
    const JointAngles torque = FrontLoad(machine, pose.payload).torque(pose.joints.head<3>());
    for (const Joint joint : {Joint::boom, Joint::arm, Joint::bucket}) {
      const auto i = static_cast<std::size_t>(joint);
      overload.see(std::abs(torque[static_cast<Eigen::Index>(i)]) / machine.limits[i].torque, pose,
                   joint);
    }
    if (machine.body) tips.see(tipping(machine, *machine.body, pose, cavity), pose);
  }
  std::vector<Warning> warnings;
  if (overload.pose) {
    warnings.emplace_back(
        WarningCode::motion_overload,
        std::string("the ") + name(overload.joint) + " needs " + readable(overload.share, 3) +
            " of its torque to hold links and payload at " + place(*overload.pose));
  }
  if (tips.pose) {
    warnings.emplace_back(
        WarningCode::motion_tips,
        "the machine tips: the centre of all masses is " + readable(tips.share, 3) +
            " of the way from the middle of the tracks to their edge at " + place(*tips.pose));
  }
  return warnings;
}

}  // namespace excavplan
