// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/motion_load.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <excavplan/soil/soil.hpp>

#include "base/text.hpp"
#include "machine/machine_mass.hpp"
#include "planning/front_load.hpp"
#include "simulation/across_tracks.hpp"

namespace excavplan {
namespace {

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

/// All masses of a machine in a pose.
struct Masses {
  double mass = 0.0;                                 ///< [kg]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< mass times place [kg m]
};

Masses masses_of(const Machine& machine, const Body& body, const WayPose& pose,
                 const Eigen::Vector2d& cavity) {
  const LinkPositions at = link_positions(machine, pose.joints.head<3>());
  Masses all{body.mass + pose.payload, Eigen::Vector3d::Zero()};
  Eigen::Vector2d moment = body.mass * body.centre + pose.payload * bucket_point(at, cavity);
  const std::array<Eigen::Vector2d, 3> centres = link_centres(machine, at);
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    all.mass += machine.links[i].mass;
    moment += machine.links[i].mass * centres[i];
  }
  all.moment << moment.x() * direction(pose.joints[3]), moment.y();
  return all;
}

/// Where the plumb line from the centre of all masses meets the plane of the tracks: its distance
/// from their middle over that of the edge in its direction; above 1 the machine tips.
double tipping(const Body& body, const Masses& all, const Eigen::Vector3d& up) {
  const Eigen::Vector3d centre = all.moment / all.mass;
  const Eigen::Vector2d foot = centre.head<2>() - centre.z() / up.z() * up.head<2>();
  const double along = foot.x() / (foot.x() < 0.0 ? body.rear_edge : body.front_edge);
  return std::max(along, std::abs(foot.y()) / (side_edge * body.front_edge));
}

/// About the swing axis, by weight alone [N m].
double swing_torque(const Masses& all, const Eigen::Vector3d& up) {
  return gravity * std::abs(all.moment.y() * up.x() - all.moment.x() * up.y());
}

std::string place(const WayPose& pose) {
  return std::string(name(pose.phase)) + ", boom, arm, bucket, swing at " +
         readable(pose.joints[0], 2) + ", " + readable(pose.joints[1], 2) + ", " +
         readable(pose.joints[2], 2) + ", " + readable(pose.joints[3], 2) + " rad";
}

}  // namespace

std::vector<Warning> load_warnings(const Machine& machine, const Way& way,
                                   const Attitude& on_slope) {
  Worst overload, tips, turns;
  const Eigen::Vector2d cavity = cavity_centre(machine.bucket);
  for (const WayPose& pose : way.poses) {
    if (machine.body) {
      const Masses all = masses_of(machine, *machine.body, pose, cavity);
      const bool counts = is_off_the_dig(pose.phase) || !on_slope.is_level();
      if (counts) tips.see(tipping(*machine.body, all, on_slope.up()), pose);
      if (machine.swing) {
        turns.see(swing_torque(all, machine.attitude.up()) / machine.swing->torque, pose);
      }
    }
    if (!is_off_the_dig(pose.phase)) continue;
    const JointAngles torque =
        FrontLoad(machine, pose.payload).torque(pose.joints.head<3>(), pose.joints[3]);
    for (const Joint joint : {Joint::boom, Joint::arm, Joint::bucket}) {
      const auto i = static_cast<std::size_t>(joint);
      overload.see(std::abs(torque[static_cast<Eigen::Index>(i)]) / machine.limits[i].torque, pose,
                   joint);
    }
  }
  std::vector<Warning> warnings;
  const auto needs = [&](const std::string& what, const Worst& worst) {
    warnings.emplace_back(WarningCode::motion_overload,
                          "the " + what + " needs " + readable(worst.share, 3) +
                              " of its torque to hold links and payload at " + place(*worst.pose));
  };
  if (overload.pose) needs(name(overload.joint), overload);
  if (turns.pose) needs("swing", turns);
  if (tips.pose) {
    warnings.emplace_back(
        WarningCode::motion_tips,
        "the machine tips: the centre of all masses is " + readable(tips.share, 3) +
            " of the way from the middle of the tracks to their edge at " + place(*tips.pose));
  }
  return warnings;
}

}  // namespace excavplan
