// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/plan_stamp.hpp"

#include <cmath>
#include <utility>

namespace excavplan {
namespace {

/// Heading about z, then pitch about y, then roll about x.
nlohmann::ordered_json pose_json(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d& turn = pose.linear();
  const Eigen::Vector3d& at = pose.translation();
  return {{"x_m", at.x()},
          {"y_m", at.y()},
          {"z_m", at.z()},
          {"heading_rad", std::atan2(turn(1, 0), turn(0, 0))},
          {"pitch_rad", std::atan2(-turn(2, 0), std::hypot(turn(2, 1), turn(2, 2)))},
          {"roll_rad", std::atan2(turn(2, 1), turn(2, 2))}};
}

Eigen::Isometry3d read_pose(JsonObject object) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const double x = object.number("x_m"), y = object.number("y_m");
  pose.translation() = Eigen::Vector3d(x, y, object.number("z_m"));
  const double heading = object.number("heading_rad"), pitch = object.number("pitch_rad");
  pose.linear() = (Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(object.number("roll_rad"), Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  object.done();
  return pose;
}

}  // namespace

nlohmann::ordered_json stamp_json(const PlanStamp& stamp) {
  nlohmann::ordered_json json = {{"id", stamp.id}, {"pose", pose_json(stamp.pose)}};
  if (stamp.scanned) json["scanned_s"] = 1e-9 * static_cast<double>(*stamp.scanned);
  if (stamp.expires) json["expires_s"] = 1e-9 * static_cast<double>(*stamp.expires);
  return json;
}

PlanStamp read_stamp(JsonObject object) {
  PlanStamp stamp;
  stamp.id = object.text("id");
  stamp.pose = read_pose(object.object("pose"));
  for (const auto& [key, time] :
       {std::pair("scanned_s", &stamp.scanned), std::pair("expires_s", &stamp.expires)}) {
    if (object.has(key)) *time = std::llround(1e9 * object.number(key, -9e9, 9e9));
  }
  object.done();
  return stamp;
}

}  // namespace excavplan
