// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/clouds/cloud.hpp>
#include <excavplan/scans/scan_pose.hpp>

#include <algorithm>
#include <cstring>

#include <Eigen/Geometry>

#include "base/statistics.hpp"
#include "base/text.hpp"
#include "support/cases.hpp"
#include "support/las_file.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Eigen::Matrix4d any_motion(Random& random) {
  const Eigen::Vector4d quaternion = drawn_vector(random, 4, -1.0, 1.0);
  return pose_of_quaternion(drawn_vector(random, 3, -1e3, 1e3), quaternion.normalized());
}

Points any_points(Random& random, std::size_t count, bool special) {
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d point = drawn_vector(random, 3, -100.0, 100.0);
    if (special && random.uniform() < 0.1) {
      const auto axis = static_cast<Eigen::Index>(random.index(3));
      point(axis) = random.uniform() < 0.5 ? std::nan("") : drawn_number(random);
    }
    points.push_back(point);
  }
  return points;
}

bool equal(const Points& a, const Points& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const auto& p, const auto& q) {
           for (Eigen::Index i = 0; i < 3; ++i) {
             if (!(p(i) == q(i) || (std::isnan(p(i)) && std::isnan(q(i))))) return false;
           }
           return true;
         });
}

/// Many small clouds and one of many points, in every format that is written.
TEST(CloudProperties, CloudsReadBackPointByPoint) {
  const TemporaryFolder folder;
  const CloudFormat formats[] = {
      {"pcd", false}, {"pcd", true}, {"ply", false}, {"ply", true}, {"xyz", true}};
  for (const CloudFormat& format : formats) {
    for_cases(
        [&](Random& random) {
          const std::string path = folder.file(std::to_string(random.bits()));
          Cloud cloud;
          cloud.points = any_points(random, random.uniform() < 0.1 ? 1000 : 1 + random.index(9),
                                    format.name != "xyz");
          cloud.width = cloud.points.size();
          if (random.uniform() < 0.3) cloud.sensor_origin = drawn_vector(random, 3, -9.0, 9.0);
          write_cloud(path, cloud, format);
          const Cloud read = read_cloud(path);
          // float32 where that moves no point by more than 0.1 mm
          const bool exact = equal(read.points, cloud.points);
          double off = 0.0;
          for (std::size_t i = 0; i < cloud.points.size() && !exact; ++i) {
            const Eigen::Vector3d step = read.points.at(i) - cloud.points[i];
            off = std::max(off, step.array().isNaN().select(0.0, step.array()).abs().maxCoeff());
          }
          EXPECT_LE(off, 1e-4);
          if (format.text) {
            EXPECT_TRUE(exact);
          }
          EXPECT_EQ(read.width * read.height, cloud.points.size());
          if (format.name == "pcd" && cloud.sensor_origin) {
            ASSERT_TRUE(read.sensor_origin);
            EXPECT_LT((*read.sensor_origin - *cloud.sensor_origin).norm(), 1e-5);
          }
        },
        100);
  }
}

TEST(CloudProperties, LasPointsAreTheirCountsTimesTheScalePlusTheOffset) {
  const TemporaryFolder folder;
  for_cases(
      [&](Random& random) {
        LasFile file;
        file.minor = drawn_int(random, 0, 4);
        file.format = file.minor == 4 ? drawn_int(random, 0, 10) : drawn_int(random, 0, 3);
        file.scale = drawn_vector(random, 3, 1e-4, 1e-2);
        file.offset = drawn_vector(random, 3, -1e5, 1e5);
        file.points.clear();
        Points expected;
        for (std::size_t i = 1 + random.index(60); i > 0; --i) {
          LasPoint point;
          for (auto& count : point.xyz) count = static_cast<std::int32_t>(random.bits());
          point.withheld = random.uniform() < 0.2;
          point.kind = random.uniform() < 0.2 ? 7 : 2;  // 7: low noise
          file.points.push_back(point);
          if (point.withheld || point.kind == 7) continue;
          const Eigen::Array3d counts(point.xyz[0], point.xyz[1], point.xyz[2]);
          expected.emplace_back((counts * file.scale + file.offset).matrix());
        }
        const Cloud read = read_cloud(folder.write(std::to_string(random.bits()), file.bytes()));
        ASSERT_EQ(read.points.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
          EXPECT_LT((read.points[i] - expected[i]).norm(), 1e-6);
        }
      },
      300);
}

/// Numbers between commas may have blanks and tabs around them; names of columns too.
TEST(CloudProperties, BlanksAndTabsDoNotMatterInText) {
  const TemporaryFolder folder;
  for_cases(
      [&](Random& random) {
        const std::string blanks[] = {"", " ", "\t", " \t", "\t "};
        const auto blank = [&] { return blanks[random.index(std::size(blanks))]; };
        std::string text;
        for (const char* name : {"x", "y", "z"}) {
          text += text.empty() ? "" : ",";
          text += blank();
          text += name;
          text += blank();
        }
        const Points points = any_points(random, 1 + random.index(3), false);
        for (const Eigen::Vector3d& p : points) {
          text += "\n" + number_text(p.x());
          for (const double number : {p.y(), p.z()}) {
            text += blank() + ",";
            text += blank() + number_text(number);
          }
        }
        const std::string path = folder.write(std::to_string(random.bits()), text + "\n");
        EXPECT_TRUE(equal(read_cloud(path).points, points)) << text;
      },
      300);
}

TEST(CloudProperties, FramesReadBackAndAreRigid) {
  const TemporaryFolder folder;
  for_cases(
      [&](Random& random) {
        const Eigen::Matrix4d motion = any_motion(random);
        const std::string path = folder.file(std::to_string(random.bits()));
        write_frame(path, motion);
        EXPECT_EQ(read_frame(path), motion);
      },
      100);
  for_cases([](Random& random) {
    const Eigen::Matrix3d turn = any_motion(random).topLeftCorner<3, 3>();
    EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_NEAR(turn.determinant(), 1.0, 1e-12);
  });
}

TEST(CloudProperties, TransformsAreTakenBackByTheirInverse) {
  for_cases([](Random& random) {
    Cloud cloud;
    cloud.points = any_points(random, 4, false);
    cloud.sensor_origin = drawn_vector(random, 3, -9.0, 9.0);
    Cloud moved = cloud;
    const Eigen::Matrix4d motion = any_motion(random);
    transform(moved, motion);
    EXPECT_NEAR((moved.points[0] - *moved.sensor_origin).norm(),
                (cloud.points[0] - *cloud.sensor_origin).norm(), 1e-9);
    EXPECT_LT((moved.points[1] - (motion * cloud.points[1].homogeneous()).head<3>()).norm(), 1e-9);
    transform(moved, motion.inverse());
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      EXPECT_LT((moved.points[i] - cloud.points[i]).norm(), 1e-9);
    }
  });
}

TEST(CloudProperties, KnownPointsGiveTheMotionBack) {
  for_cases([](Random& random) {
    const Points in_scan = any_points(random, 3 + random.index(5), false);
    const Eigen::Matrix4d motion = any_motion(random);
    Points in_site;
    for (const Eigen::Vector3d& p : in_scan) {
      in_site.emplace_back((motion * p.homogeneous()).head<3>());
    }
    const PointPose pose = pose_of_points(in_scan, in_site);
    EXPECT_LT(pose.rms, 1e-9);
    for (std::size_t i = 0; i < in_scan.size(); ++i) {
      EXPECT_LT(((pose.site_from_scan * in_scan[i].homogeneous()).head<3>() - in_site[i]).norm(),
                1e-8);
    }
  });
}

/// Ground that is a plane has the heights of the plane, wherever its points lie in the cells.
TEST(CloudProperties, RastersOfAPlaneAreThePlane) {
  for_cases(
      [](Random& random) {
        const Eigen::Vector3d plane = drawn_vector(random, 3, -0.3, 0.3);
        Cloud cloud;
        for (int i = 0; i < 1600; ++i) {
          const double x = random.uniform(0.0, 1.0);
          const double y = random.uniform(0.0, 1.0);
          cloud.points.emplace_back(x, y, plane(0) + plane(1) * x + plane(2) * y);
        }
        RasterOptions options;
        options.cell_size = 0.2;
        const HeightMap map = rasterise(cloud, {0.0, 0.0, 1.0, 1.0}, options);
        for (Eigen::Index row = 0; row < 5; ++row) {
          for (Eigen::Index col = 0; col < 5; ++col) {
            const double expected = plane(0) + plane(1) * map.x(col) + plane(2) * map.y(row);
            EXPECT_NEAR(map.z(row, col), expected, 1e-4);
          }
        }
      },
      400);
}

TEST(CloudProperties, RobustMeansMoveWithTheValuesAndLieAmongThem) {
  for_cases([](Random& random) {
    std::vector<double> values(1 + random.index(15));
    for (double& value : values) value = random.normal();
    if (random.uniform() < 0.3) values[0] += 1e3;  // an outlier
    const RobustMean mean = robust_mean(values, 0.01);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    EXPECT_TRUE(*low <= mean.value + 1e-12 && mean.value <= *high + 1e-12);
    EXPECT_TRUE(mean.count >= 1 && mean.variance >= 0.0);
    std::vector<double> moved = values;
    const double shift = random.uniform(-10.0, 10.0), scale = random.uniform(0.5, 2.0);
    for (double& value : moved) value = scale * value + shift;
    const RobustMean other = robust_mean(moved, 0.01 * scale);
    EXPECT_NEAR(other.value, scale * mean.value + shift, 1e-9);
    EXPECT_NEAR(other.variance, scale * scale * mean.variance, 1e-9 * (1.0 + mean.variance));
  });
}

}  // namespace
}  // namespace excavplan::test
