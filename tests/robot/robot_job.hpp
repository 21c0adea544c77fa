// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <excavplan/robot/job_session.hpp>

#include "job/trench_job.hpp"
#include "support/ros_bytes.hpp"

namespace excavplan::test {

using Take = std::function<void(const RobotMessage&)>;

inline Points points_of(const Scan& scan) {
  Points all;
  for (const auto& cloud : scan.clouds) {
    all.insert(all.end(), cloud->points.begin(), cloud->points.end());
  }
  return all;
}

/// The job of a short trench as plan-site begins it, and the messages of the robot that does it.
struct RobotJob {
  explicit RobotJob(Encoding with = cdr_little) : encoding(with) {
    const std::string data = EXCAVPLAN_DATA_SOURCE;
    save_order(of.path(), of.settings,
               {data + "/machines/zx120.json", data + "/laws/zx120-loam.json"});
    (void)SiteJob::begin(of.path(), load_order(of.path()), of.first, trial_begin);
  }

  JobSessionSettings settings(std::size_t scans = 1) const {
    JobSessionSettings made;
    made.folder = of.path();
    made.scans = scans;
    return made;
  }

  std::int64_t now() const {
    return static_cast<std::int64_t>(of.truth.time()) * 1'000'000'000 + later;
  }

  void send(const Take& take, const std::string& topic, const std::string& type,
            const std::string& bytes) const {
    take({topic, type, encoding.serialization == Serialization::cdr, bytes, now()});
  }
  void stand(const Take& take, std::vector<double> joints = {-0.6, 1.6, 0.5, 0.4},
             int messages = 4) {
    const std::vector<std::string> names = {"boom_joint", "arm_joint", "bucket_joint",
                                            "swing_joint"};
    std::vector<std::pair<std::string, double>> all;
    for (std::size_t i = 0; i < names.size(); ++i) all.emplace_back(names[i], joints[i]);
    for (int i = 0; i < messages; ++i) {
      later += 200'000'000;
      send(take, "/joint_states", "sensor_msgs/msg/JointState", joint_bytes(now(), all, encoding));
    }
  }
  /// @param frame  of the points
  void scan(const Take& take, const Points& points, const std::string& frame = "site") {
    later += 100'000'000;
    send(take, "/points", "sensor_msgs/msg/PointCloud2",
         cloud_bytes(now(), frame, points, 0, encoding));
  }
  Points points_now() { return points_of(of.truth.scan()); }

  /// Does a step on the true ground. @return what is told of it
  MotionReport drive(const JobStep& step) {
    of.report = of.truth.execute(step).report;
    later = 0;
    MotionReport report;
    report.step = step.id;
    report.payload_mass = of.report.payload_mass;
    report.joint_work = of.report.joint_work;
    report.stalled = of.report.stalled;
    report.base = of.report.base;
    return report;
  }

  ShortTrench site;
  TrenchJob of{site};
  Encoding encoding;
  std::int64_t later = 0;  ///< than the clock of the true ground [ns]
};

}  // namespace excavplan::test
