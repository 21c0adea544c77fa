// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/error.hpp>

#include "recording/ros_messages.hpp"
#include "recording/transform_tree.hpp"
#include "support/cases.hpp"
#include "support/ros_bytes.hpp"

namespace excavplan::test {
namespace {

const RecordedTopic cloud_topic = {"/points", "sensor_msgs/msg/PointCloud2"};
const RecordedTopic livox_topic = {"/livox", "livox_ros_driver2/msg/CustomMsg"};
const RecordedTopic depth_topic = {"/depth", "sensor_msgs/msg/Image"};
const RecordedTopic camera_topic = {"/camera_info", "sensor_msgs/msg/CameraInfo"};
const RecordedTopic tf_topic = {"/tf", "tf2_msgs/msg/TFMessage"};
const RecordedTopic joint_topic = {"/joint_states", "sensor_msgs/msg/JointState"};

Encoding any_encoding(Random& random) {
  const Encoding encodings[] = {cdr_little, cdr_big, ros1};
  return encodings[random.index(3)];
}

/// Of any length, so that what follows is aligned in all ways.
std::string any_name(Random& random) {
  std::string name(1 + random.index(9), 'a');
  for (char& letter : name) letter = static_cast<char>('a' + random.index(26));
  return name;
}

std::int64_t any_stamp(Random& random) {
  return static_cast<std::int64_t>(random.index(2147483648)) * 1000000000 +
         static_cast<std::int64_t>(random.index(1000000000));
}

RecordedMessage message_of(const RecordedTopic& topic, const std::string& bytes,
                           Encoding encoding) {
  return {topic, 0, encoding.serialization, bytes, "message"};
}

TEST(RecordingProperties, CloudsAreDecodedAsTheyWereWritten) {
  for_cases([](Random& random) {
    const Encoding encoding = any_encoding(random);
    const std::size_t rows = 1 + random.index(3), width = 1 + random.index(4);
    Points points;
    for (std::size_t i = 0; i < rows * width; ++i) {
      // multiples of 2^-10, which are exact as float32
      const Eigen::ArrayXd steps = (1024.0 * drawn_vector(random, 3, -50.0, 50.0).array()).round();
      points.emplace_back(steps / 1024.0);
    }
    const std::int64_t stamp = any_stamp(random);
    const std::string frame = any_name(random);
    const std::string bytes = cloud_bytes(stamp, frame, points, width, encoding);
    const RecordedMessage message = message_of(cloud_topic, bytes, encoding);
    EXPECT_EQ(decode_header("f", message).stamp, stamp);
    EXPECT_EQ(decode_header("f", message).frame, frame);
    EXPECT_EQ(decode_points("f", message).points, points);
    EXPECT_EQ(decode_size("f", message).height, rows);
    const std::string livox = livox_bytes(stamp, frame, points, encoding);
    EXPECT_EQ(decode_points("f", message_of(livox_topic, livox, encoding)).points, points);
  });
}

TEST(RecordingProperties, DepthsAreDecodedAsTheyWereWritten) {
  for_cases([](Random& random) {
    const Encoding encoding = any_encoding(random);
    const std::size_t width = 1 + random.index(5);
    std::vector<std::uint16_t> counts(width * (1 + random.index(4)));
    for (auto& count : counts) count = static_cast<std::uint16_t>(random.index(65536));
    const std::string bytes =
        depth_bytes(any_stamp(random), any_name(random), width, counts, encoding);
    const DepthMessage depth = decode_depths("f", message_of(depth_topic, bytes, encoding));
    ASSERT_EQ(depth.depths.size(), counts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] == 0) {
        EXPECT_TRUE(std::isnan(depth.depths[i]));
      } else {
        EXPECT_NEAR(depth.depths[i], 0.001 * counts[i], 1e-5);
      }
    }
  });
}

TEST(RecordingProperties, CamerasAndJointsAreDecodedAsTheyWereWritten) {
  for_cases([](Random& random) {
    const Encoding encoding = any_encoding(random);
    CameraNumbers numbers;
    numbers.width = random.index(10000);
    numbers.height = random.index(10000);
    numbers.focal = random.uniform(1.0, 1000.0);
    numbers.rectified_focal = random.uniform(1.0, 1000.0);
    numbers.distortion.resize(random.index(9));
    for (double& number : numbers.distortion) number = random.normal();
    const std::string bytes = camera_bytes(numbers, encoding);
    const CameraMessage camera = decode_camera("f", message_of(camera_topic, bytes, encoding));
    EXPECT_EQ(camera.size.width, numbers.width);
    EXPECT_EQ(camera.size.height, numbers.height);
    EXPECT_EQ(camera.distortion, numbers.distortion);
    EXPECT_EQ(camera.intrinsics(0), numbers.focal);
    EXPECT_EQ(camera.intrinsics(4), numbers.focal);
    EXPECT_EQ(camera.rectified_projection(5), numbers.rectified_focal);

    std::vector<std::pair<std::string, double>> joints(random.index(6));
    for (auto& [name, position] : joints) {
      name = any_name(random);
      position = drawn_number(random);
    }
    const std::string positions = joint_bytes(any_stamp(random), joints, encoding);
    EXPECT_EQ(decode_joints("f", message_of(joint_topic, positions, encoding)), joints);
  });
}

/// The number of points of a CustomMsg stands in it twice.
TEST(RecordingProperties, PointsThatAreMiscountedAreRefused) {
  for_cases([](Random& random) {
    const std::size_t said = random.index(5), held = random.index(5);
    RosBytes message(ros1);
    message.header(any_stamp(random), any_name(random)).put(std::uint64_t{5});
    message.u32(said).raw({1, 0, 0, 0}).u32(held);
    for (std::size_t i = 0; i < held; ++i) message.raw(std::string(19, '\1'));
    const std::string bytes = message;
    const RecordedMessage recorded = message_of(livox_topic, bytes, ros1);
    if (said == held) {
      EXPECT_EQ(decode_points("f", recorded).points.size(), held);
    } else {
      EXPECT_THROW(decode_points("f", recorded), Error);
    }
  });
}

/// A message that ends early is refused, wherever it ends.
TEST(RecordingProperties, CutMessagesAreRefused) {
  for_cases([](Random& random) {
    const Encoding encoding = any_encoding(random);
    const Points points = {drawn_vector(random, 3, -50.0, 50.0)};
    std::string bytes = cloud_bytes(any_stamp(random), any_name(random), points, 0, encoding);
    bytes.resize(random.index(bytes.size() - 1));
    EXPECT_THROW(decode_points("f", message_of(cloud_topic, bytes, encoding)), Error);
  });
}

Eigen::Vector4d any_quaternion(Random& random) {
  return Eigen::Vector4d(drawn_vector(random, 4, -1.0, 1.0)).normalized();
}

TransformNumbers any_link(Random& random, const std::string& parent, const std::string& child) {
  TransformNumbers link;
  link.stamp = any_stamp(random);
  link.parent = parent;
  link.child = child;
  link.translation = drawn_vector(random, 3, -10.0, 10.0);
  link.rotation = any_quaternion(random);
  return link;
}

TEST(RecordingProperties, TransformsAreDecodedAsTheyWereWritten) {
  for_cases([](Random& random) {
    const Encoding encoding = any_encoding(random);
    std::vector<TransformNumbers> links(random.index(4));
    for (TransformNumbers& link : links) {
      const std::string parent = any_name(random);
      link = any_link(random, parent, any_name(random));
    }
    const std::string bytes = transform_bytes(links, encoding);
    const auto read = decode_transforms("f", message_of(tf_topic, bytes, encoding));
    ASSERT_EQ(read.size(), links.size());
    for (std::size_t i = 0; i < links.size(); ++i) {
      EXPECT_EQ(read[i].stamp, links[i].stamp);
      EXPECT_EQ(read[i].parent, links[i].parent);
      EXPECT_EQ(read[i].child, links[i].child);
      EXPECT_EQ(read[i].rotation, links[i].rotation);
      EXPECT_EQ(read[i].translation, links[i].translation);
    }
  });
}

Eigen::Isometry3d pose_of(const TransformNumbers& link) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(link.rotation).toRotationMatrix();
  pose.translation() = link.translation;
  return pose;
}

/// map - a - b, map - c: any two frames, there and back.
TEST(RecordingProperties, TransformsChainAndInvert) {
  for_cases([](Random& random) {
    const TransformNumbers a = any_link(random, "map", "a");
    const TransformNumbers b = any_link(random, "a", "b");
    const TransformNumbers c = any_link(random, "map", "c");
    std::vector<StampedTransform> links;
    for (const TransformNumbers& link : {a, b, c}) {
      links.push_back({link.parent, link.child, link.stamp, link.rotation, link.translation, true});
    }
    const TransformTree tree("f", 0, links);
    const Eigen::Isometry3d expected = pose_of(c).inverse() * pose_of(a) * pose_of(b);
    const Eigen::Vector3d p = drawn_vector(random, 3, -5.0, 5.0);
    EXPECT_LT((tree.lookup("c", "b", 0) * p - expected * p).norm(), 1e-9);
    EXPECT_LT((tree.lookup("b", "c", 0) * (tree.lookup("c", "b", 0) * p) - p).norm(), 1e-9);
  });
}

/// Between two stamps places lie on the line between them and turns on the arc, by the time.
TEST(RecordingProperties, PosesBetweenStampsAreInterpolated) {
  for_cases([](Random& random) {
    const TransformNumbers first = any_link(random, "map", "a");
    const TransformNumbers last = any_link(random, "map", "a");
    constexpr std::int64_t span = 500000000;
    const TransformTree tree("f", 0,
                             {{"map", "a", 0, first.rotation, first.translation, false},
                              {"map", "a", span, last.rotation, last.translation, false}});
    const double share = random.uniform();
    const auto time = static_cast<std::int64_t>(share * span);
    const double part = static_cast<double>(time) / static_cast<double>(span);
    const Eigen::Isometry3d pose = tree.lookup("map", "a", time);
    EXPECT_LT(
        (pose.translation() - ((1.0 - part) * first.translation + part * last.translation)).norm(),
        1e-9);
    const Eigen::Quaterniond from(first.rotation), to(last.rotation);
    const Eigen::Quaterniond at(pose.linear());
    const double whole = from.angularDistance(to);
    EXPECT_NEAR(from.angularDistance(at), part * whole, 1e-6);
    EXPECT_NEAR(at.angularDistance(to), (1.0 - part) * whole, 1e-6);
  });
}

}  // namespace
}  // namespace excavplan::test
