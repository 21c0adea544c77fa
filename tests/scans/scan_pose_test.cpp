// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/scan_pose.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "base/random.hpp"

#include "base/angles.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

/// Ground seen from a camera 2.5 m above it that looks down by `tilt` from the vertical, with a
/// heap on a part of it, noise and stray points.
Cloud tilted_view(double tilt, double noise, std::uint64_t seed) {
  Random random(seed);
  const Eigen::Matrix3d scan_from_site = (Eigen::Matrix3d() << 0, -1, 0, -std::cos(tilt), 0,
                                          -std::sin(tilt), std::sin(tilt), 0, -std::cos(tilt))
                                             .finished();
  Cloud cloud;
  for (int i = 0; i < 4000; ++i) {
    Eigen::Vector3d p(random.uniform(-1.0, 2.5), random.uniform(-1.5, 1.5), 0.0);
    if (i % 4 == 0) p.z() = random.uniform(0.05, 0.6);  // heap
    if (i % 50 == 0) p.z() = random.uniform(-1.0, 1.0);
    p.z() += noise * random.normal();
    cloud.points.push_back(scan_from_site * (p - Eigen::Vector3d(0, 0, 2.5)));
  }
  cloud.points.push_back(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  return cloud;
}

TEST(LevelOnGround, FindsUpAndHeightUnderAHeapAndOutliers) {
  for (const double tilt : {0.0, 10.0 * degree, 45.0 * degree}) {
    const LevelPose pose = level_on_ground(tilted_view(tilt, 0.005, 3));
    EXPECT_NEAR(pose.height, 2.5, 0.002) << tilt;
    EXPECT_NEAR(pose.tilt, tilt, 0.1 * degree);
    EXPECT_NEAR(pose.residual_sd, 0.005, 0.001);
    EXPECT_NEAR(pose.ground_share, 0.735, 0.04);
    const Eigen::Matrix3d rotation = pose.site_from_scan.topLeftCorner<3, 3>();
    EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-12);
    // x ahead: site x of the scene
    const Eigen::Matrix3d truth = (Eigen::Matrix3d() << 0, -std::cos(tilt), std::sin(tilt), -1, 0,
                                   0, 0, -std::sin(tilt), -std::cos(tilt))
                                      .finished();
    EXPECT_LT((rotation - truth).norm(), 0.3 * degree) << tilt;
  }
}

TEST(LevelOnGround, ErrorStaysSmallOverManyNoisyScans) {
  double squares = 0.0;
  constexpr int scans = 20;
  for (int seed = 1; seed <= scans; ++seed) {
    const LevelPose pose =
        level_on_ground(tilted_view(20.0 * degree, 0.02, static_cast<std::uint64_t>(seed)));
    squares += std::pow(pose.tilt - 20.0 * degree, 2);
  }
  EXPECT_LT(std::sqrt(squares / scans), 0.2 * degree);
}

/// The plane is that of least squares with weights 1 / range^4, as stereo errs: found here again by
/// the normal equations of z on x and y. The ground is bent, so that other weights give another.
TEST(LevelOnGround, CountsPointsByTheFourthPowerOfTheirRange) {
  Cloud scan;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (double x = 0.5; x < 4.0; x += 0.05) {
    for (double y = -1.5; y < 1.5; y += 0.05) {
      const Eigen::Vector3d p(x, y, -2.0 + 3e-4 * x * x);
      scan.points.push_back(p);
      const double weight = 1.0 / std::pow(p.norm(), 4);
      const Eigen::Vector3d terms(1.0, x, y);
      normal += weight * terms * terms.transpose();
      right += weight * p.z() * terms;
    }
  }
  const Eigen::Vector3d plane = normal.inverse() * right;
  const Eigen::Vector3d up = Eigen::Vector3d(-plane(1), -plane(2), 1.0).normalized();
  const LevelPose pose = level_on_ground(scan);
  ASSERT_EQ(pose.ground_share, 1.0);
  EXPECT_LT((pose.site_from_scan.block<1, 3>(2, 0).transpose() - up).norm(), 5e-6);
}

TEST(LevelOnGround, SameSeedSamePose) {
  const Cloud scan = tilted_view(0.3, 0.01, 5);
  EXPECT_EQ(level_on_ground(scan, 2).site_from_scan, level_on_ground(scan, 2).site_from_scan);
}

/// The same ground from a lidar (x forward, z up) 3 m above it that leans by 6 degrees.
Cloud lidar_view(const Eigen::Vector3d& sensor) {
  Random random(8);
  const Eigen::Matrix3d leaning =
      Eigen::AngleAxisd(6.0 * degree, Eigen::Vector3d::UnitY()).toRotationMatrix();
  Cloud cloud;
  for (int i = 0; i < 9000; ++i) {
    const double range = random.uniform(2.0, 12.0);
    const double angle = random.uniform(-1.2, 1.2);
    Eigen::Vector3d p(range * std::cos(angle), range * std::sin(angle), 0.0);
    if (i % 3 > 0) p.z() = random.uniform(0.2, 6.0);  // walls, machines
    p.z() += 0.01 * random.normal();
    const Eigen::Vector3d seen = leaning.transpose() * (p - Eigen::Vector3d(0, 0, 3.0));
    cloud.points.push_back(seen + sensor);
  }
  cloud.sensor_origin = sensor;
  return cloud;
}

TEST(LevelOnGround, OfALidarXStaysAhead) {
  const LevelPose pose = level_on_ground(lidar_view(Eigen::Vector3d::Zero()));
  EXPECT_NEAR(pose.height, 3.0, 0.005);
  EXPECT_NEAR(pose.tilt, 174.0 * degree, 0.1 * degree);
  EXPECT_GT(pose.site_from_scan(0, 0), std::cos(6.5 * degree));
  EXPECT_GT(pose.site_from_scan(1, 1), std::cos(0.5 * degree));
}

TEST(LevelOnGround, TheSensorMayStandElsewhere) {
  const Eigen::Vector3d sensor(400.0, -700.0, 55.0);
  const LevelPose here = level_on_ground(lidar_view(Eigen::Vector3d::Zero()));
  const LevelPose there = level_on_ground(lidar_view(sensor));
  EXPECT_NEAR(there.height, here.height, 1e-9);
  const Eigen::Vector4d placed = there.site_from_scan * sensor.homogeneous();
  EXPECT_LT((placed.head<3>() - Eigen::Vector3d(0.0, 0.0, here.height)).norm(), 1e-9);
}

TEST(LevelOnGround, AScanIsLevelledAsItsCloudWhateverItsUnitAndFrame) {
  const Cloud cloud = lidar_view(Eigen::Vector3d::Zero());
  Cloud millimetres = cloud;
  for (Eigen::Vector3d& p : millimetres.points) p *= 1000.0;
  millimetres.sensor_origin.reset();
  Scan scan;
  scan.clouds = {std::make_shared<const Cloud>(millimetres)};
  scan.unit = 0.001;
  const LevelPose plain = level_on_ground(cloud);
  EXPECT_LT((level_on_ground(scan).site_from_scan - plain.site_from_scan).norm(), 1e-9);
  Eigen::Matrix4d turned = Eigen::Matrix4d::Identity();
  turned.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix();
  turned(0, 3) = 30.0;
  scan.site_from_scan = turned;
  const Eigen::Matrix4d levelled = level_on_ground(scan).site_from_scan * turned;
  const Eigen::Vector3d up = levelled.row(2).head<3>();
  EXPECT_LT((up - plain.site_from_scan.row(2).head<3>().transpose()).norm(), 1e-9);
  EXPECT_NEAR(levelled(2, 3), plain.height, 1e-9);
}

/// Level ground with a heap, whose origin lies on it, as an app for phones lays it; z up, or y.
Cloud at_origin(bool is_y_up, double above) {
  Random random(3);
  Cloud cloud;
  for (int i = 0; i < 4000; ++i) {
    Eigen::Vector3d p(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), -above);
    if (i % 4 == 0) p.z() += random.uniform(0.05, 0.6);
    p.z() += 0.01 * p.x() + 0.003 * random.normal();  // leans by 0.57 deg
    cloud.points.push_back(is_y_up ? Eigen::Vector3d(-p.y(), p.z(), -p.x()) : p);
  }
  return cloud;
}

TEST(LevelOnGround, TheOriginMayLieOnTheGround) {
  for (const double above : {0.0, 0.03, -0.03}) {
    for (const bool is_y_up : {false, true}) {
      SCOPED_TRACE(above);
      const LevelPose pose = level_on_ground(at_origin(is_y_up, above));
      EXPECT_NEAR(pose.height, above, 0.002);
      EXPECT_NEAR(pose.residual_sd, 0.003, 0.001);
      // a metre ahead, and above the ground there
      const Eigen::Vector3d site(1.0, 0.0, 0.5);
      const Eigen::Vector3d leaning(1.0 - 0.005, 0.0, 0.5 + 0.01);
      const Eigen::Vector3d seen =
          is_y_up ? Eigen::Vector3d(0.0, leaning.z(), -leaning.x()) : leaning;
      const Eigen::Vector3d placed = (pose.site_from_scan * seen.homogeneous()).head<3>();
      EXPECT_LT((placed - site - Eigen::Vector3d(0.0, 0.0, above)).norm(), 0.004);
    }
  }
  Cloud told = at_origin(false, 0.0);
  told.sensor_origin = Eigen::Vector3d::Zero();
  EXPECT_NE(test::error_of([&] { level_on_ground(told); }).find("it is not the ground"),
            std::string::npos);
}

TEST(PoseOfQuaternion, TurnsAndMoves) {
  const double half = std::sqrt(0.5);
  const Eigen::Matrix4d pose = pose_of_quaternion({1, 2, 3}, {0, 0, half, half});
  Eigen::Matrix4d expected;
  expected << 0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1;
  EXPECT_LT((pose - expected).norm(), 1e-12);
  EXPECT_LT((pose_of_quaternion({1, 2, 3}, {0, 0, 0.7075, 0.7075}) - expected).norm(), 1e-12);
  const auto error = [](const Eigen::Vector3d& at, const Eigen::Vector4d& turn) {
    return test::error_of([&] { pose_of_quaternion(at, turn); });
  };
  EXPECT_EQ(error({0, 0, 0}, {0, 0, 0, 1.01}),
            "pose of a scan: the quaternion's norm is 1.01, must be 1 to 0.001");
  EXPECT_EQ(error({0, 0, 0}, {0, 0, 0, NAN}), "pose of a scan: a number is not finite");
  EXPECT_EQ(error({0, INFINITY, 0}, {0, 0, 0, 1}), "pose of a scan: a number is not finite");
}

std::string level_error(const Cloud& scan) {
  return test::error_of([&] { level_on_ground(scan); });
}

TEST(LevelOnGround, RefusesWhatHasNoGround) {
  Cloud scan;
  EXPECT_EQ(level_error(scan), "pose of a scan: 0 finite points, must be 100 or more to level it");
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    scan.points.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 3));
  }
  EXPECT_NE(level_error(scan).find("of its points lie on one plane, less than 10 %"),
            std::string::npos);
  for (Eigen::Vector3d& p : scan.points) p.y() = 0.01;
  EXPECT_NE(level_error(scan).find("less than 0.05 m: it is not the ground"), std::string::npos);
}

Eigen::Isometry3d some_pose() {
  return Eigen::Translation3d(3.0, -2.0, 1.5) *
         Eigen::AngleAxisd(2.3, Eigen::Vector3d(1, -2, 0.5).normalized());
}

const std::vector<Eigen::Vector3d> targets = {{0, 0, 0}, {2, 0.1, 0}, {0.3, 1.7, 0.2}, {1, 1, 1}};

TEST(PoseOfPoints, FindsTheExactMotionOfThreePointsAndMore) {
  for (const std::size_t count : {3U, 4U}) {
    std::vector<Eigen::Vector3d> scan;
    const std::vector<Eigen::Vector3d> site(targets.begin(),
                                            targets.begin() + static_cast<std::ptrdiff_t>(count));
    for (const Eigen::Vector3d& p : site) scan.push_back(some_pose().inverse() * p);
    const PointPose pose = pose_of_points(scan, site);
    EXPECT_LT((pose.site_from_scan - some_pose().matrix()).norm(), 1e-12);
    EXPECT_LT(pose.rms, 1e-12);
    EXPECT_EQ(pose.residuals.size(), count);
  }
}

TEST(PoseOfPoints, ResidualsTellTheErrorAndTheBadPoint) {
  std::vector<Eigen::Vector3d> scan;
  for (const Eigen::Vector3d& p : targets) scan.push_back(some_pose().inverse() * p);
  scan[3] += Eigen::Vector3d(0.1, 0.0, 0.0);
  const PointPose pose = pose_of_points(scan, targets);
  EXPECT_GT(pose.rms, 0.02);
  EXPECT_LT(pose.rms, 0.05);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(pose.residuals[i], pose.residuals[3]);
  // Least squares: no small motion does better.
  const auto rms_of = [&](const Eigen::Matrix4d& motion) {
    double sum = 0.0;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      sum += ((motion * scan[i].homogeneous()).head<3>() - targets[i]).squaredNorm();
    }
    return std::sqrt(sum / 4.0);
  };
  EXPECT_NEAR(rms_of(pose.site_from_scan), pose.rms, 1e-12);
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d axis(random.normal(), random.normal(), random.normal());
    const Eigen::Isometry3d nudge =
        Eigen::Translation3d(1e-3 * random.normal(), 1e-3 * random.normal(), 1e-3) *
        Eigen::AngleAxisd(1e-3, axis.normalized());
    EXPECT_GE(rms_of(nudge.matrix() * pose.site_from_scan), pose.rms - 1e-12);
  }
}

TEST(PoseOfPoints, NeverMirrors) {
  std::vector<Eigen::Vector3d> mirrored = targets;
  for (Eigen::Vector3d& p : mirrored) p.x() = -p.x();
  EXPECT_THROW(pose_of_points(mirrored, targets), Error);
  std::vector<Eigen::Vector3d> flat = targets;  // which a turn mirrors too
  for (Eigen::Vector3d& p : flat) p.z() = 0.0;
  for (std::size_t i = 0; i < flat.size(); ++i) mirrored[i] = {-flat[i].x(), flat[i].y(), 0.0};
  const PointPose pose = pose_of_points(mirrored, flat);
  EXPECT_NEAR((pose.site_from_scan.topLeftCorner<3, 3>().determinant()), 1.0, 1e-12);
  EXPECT_LT(pose.rms, 1e-9);
}

TEST(PoseOfPoints, RefusesWhatLeavesItFree) {
  const auto error = [](const std::vector<Eigen::Vector3d>& scan,
                        const std::vector<Eigen::Vector3d>& site) {
    return test::error_of([&] { pose_of_points(scan, site); });
  };
  EXPECT_EQ(error({{0, 0, 0}}, {{0, 0, 0}}), "pose of a scan: 1 known points, must be 3 or more");
  EXPECT_NE(error({{0, 0, 0}}, {}).find("1 points of the scan, but 0 known places"),
            std::string::npos);
  const std::vector<Eigen::Vector3d> line = {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {5, 5, 0}};
  EXPECT_EQ(
      error(line, line),
      "pose of a scan: the known points lie on one line, so the rotation about it is undetermined");
  std::vector<Eigen::Vector3d> in_mm = targets;
  for (Eigen::Vector3d& p : in_mm) p *= 1000.0;
  EXPECT_NE(error(in_mm, targets).find("0.00100 times as far from each other in the site"),
            std::string::npos);
  std::vector<Eigen::Vector3d> exchanged = targets;
  std::swap(exchanged[0], exchanged[2]);
  EXPECT_NE(error(exchanged, targets).find("points are exchanged, mirrored or wrong"),
            std::string::npos);
  std::vector<Eigen::Vector3d> one_wrong = targets;
  one_wrong[1].z() += 0.8;
  EXPECT_NE(error(one_wrong, targets).find("m off: points are exchanged, mirrored or wrong"),
            std::string::npos);
  EXPECT_NE(error({{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})
                .find("known point 3 has a coordinate that is not finite"),
            std::string::npos);
}

}  // namespace
}  // namespace excavplan
