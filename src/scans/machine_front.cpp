// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/machine_front.hpp>

#include <algorithm>
#include <cmath>

#include <excavplan/machine/kinematics.hpp>

#include "base/check.hpp"
#include "base/plan_geometry.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

/// A place given along and across (to the left of) a direction from a pin.
Eigen::Vector2d place(const Eigen::Vector2d& pin, double angle, const Eigen::Vector2d& at) {
  const Eigen::Vector2d ahead = direction(angle);
  return pin + at.x() * ahead + at.y() * Eigen::Vector2d(-ahead.y(), ahead.x());
}

/// The knee of a link of two straight halves of even weight that has this centre: the centre is the
/// mean of both halves' middles, (start + 2 knee + end) / 4.
Eigen::Vector2d knee(const LinkMass& link, double length) {
  return {2.0 * link.along - 0.5 * length, 2.0 * link.across};
}

/// True inside an outline, or within `margin` of it.
bool is_near(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& outline, double margin) {
  bool is_inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    if (distance_to_side(p, a, b) <= margin) return true;
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) is_inside = !is_inside;
  }
  return is_inside;
}

}  // namespace

MachineFront::MachineFront(const Machine& machine, const MachinePosture& posture, double margin)
    : ahead_(direction(posture.swing)),
      half_width_(0.5 * machine.bucket.width_outside),
      margin_(margin) {
  require_machine(machine);
  require(std::isfinite(posture.swing), "swing of the machine", posture.swing, "finite");
  for (const double angle : posture.joints) {
    require(std::isfinite(angle), "joint angle of the machine", angle, "finite");
  }
  require(std::isfinite(margin) && margin >= 0.0, "margin about the machine", margin, ">= 0 m");
  const LinkPositions at = link_positions(machine, posture.joints);
  outlines_.push_back(
      {machine.boom_pin,
       place(machine.boom_pin, at.phi1, knee(machine.links[0], machine.boom_length)), at.arm_pin});
  outlines_.push_back({at.arm_pin,
                       place(at.arm_pin, at.phi2, knee(machine.links[1], machine.arm_length)),
                       at.bucket_pin});
  Outline bucket = {at.bucket_pin};
  for (const Eigen::Vector2d& corner : machine.bucket.profile) {
    bucket.push_back(place(at.bucket_pin, at.phi3, corner));
  }
  outlines_.push_back(std::move(bucket));
}

bool MachineFront::holds(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d plan = point.head<2>();
  if (!(std::abs(cross(ahead_, plan)) <= half_width_ + margin_)) return false;
  const Eigen::Vector2d p(ahead_.dot(plan), point.z());
  return std::any_of(outlines_.begin(), outlines_.end(),
                     [&](const Outline& outline) { return is_near(p, outline, margin_); });
}

}  // namespace excavplan
