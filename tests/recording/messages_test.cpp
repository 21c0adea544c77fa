// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/ros_messages.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "base/non_finite.hpp"
#include "support/errors.hpp"
#include "support/ros_bytes.hpp"

namespace excavplan::test {
namespace {

const RecordedTopic cloud_topic = {"/points", "sensor_msgs/msg/PointCloud2"};
const RecordedTopic livox_topic = {"/livox", "livox_ros_driver2/msg/CustomMsg"};
const RecordedTopic depth_topic = {"/depth", "sensor_msgs/msg/Image"};
const RecordedTopic camera_topic = {"/camera_info", "sensor_msgs/msg/CameraInfo"};
const RecordedTopic tf_topic = {"/tf", "tf2_msgs/msg/TFMessage"};
const RecordedTopic joint_topic = {"/joint_states", "sensor_msgs/msg/JointState"};

const std::string file = "run.db3";
const std::string place = "message 17 of /x at 12.5 s";

/// A message in a block of memory of its own, so that a sanitizer sees what is read beyond it.
class OwnMessage {
 public:
  OwnMessage(const RecordedTopic& topic, const std::string& bytes, Encoding encoding = cdr_little)
      : bytes_(bytes.begin(), bytes.end()),
        message_{topic, 0, encoding.serialization, {bytes_.data(), bytes_.size()}, place} {}
  operator const RecordedMessage&() const { return message_; }

 private:
  std::vector<char> bytes_;
  RecordedMessage message_;
};

/// The error of reading a message in every way, without "run.db3: message 17 of /x at 12.5 s: ".
std::string error_of_message(const RecordedTopic& topic, const std::string& bytes,
                             Encoding encoding = cdr_little) {
  const OwnMessage own(topic, bytes, encoding);
  const RecordedMessage& message = own;
  return error_about(
      [&] {
        switch (use_of(topic.type)) {
          case MessageUse::points:
            decode_size(file, message);
            decode_points(file, message);
            break;
          case MessageUse::depth:
            decode_size(file, message);
            decode_depths(file, message);
            break;
          case MessageUse::camera:
            decode_camera(file, message);
            break;
          case MessageUse::transforms:
            decode_transforms(file, message);
            break;
          default:
            decode_joints(file, message);
        }
      },
      file + ": " + place);
}

void expect_begins(const std::string& text, const std::string& start) {
  EXPECT_EQ(text.substr(0, start.size()), start) << text;
}

std::string bytes_of_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size();) {
    if (hex[i] == ' ') {
      ++i;
      continue;
    }
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    i += 2;
  }
  return bytes;
}

const Points three = {{1.0, 2.0, 3.0}, {-4.0, 0.5, 6.0}, {0.25, 0.0, -8.0}};

// ---- Bytes laid by hand -----------------------------------------------------------------------

TEST(RosMessages, HeaderInCdrLittleEndian) {
  // representation; sec; nanosec; length with NUL; "map"
  const OwnMessage message(cloud_topic,
                           bytes_of_hex("00010000 0500 0000 07000000 04000000 6d617000"));
  const MessageHeader header = decode_header(file, message);
  EXPECT_EQ(header.stamp, 5000000007);
  EXPECT_EQ(header.frame, "map");
}

TEST(RosMessages, HeaderInCdrBigEndian) {
  const OwnMessage message(cloud_topic,
                           bytes_of_hex("00000000 00000005 00000007 00000004 6d617000"));
  const MessageHeader header = decode_header(file, message);
  EXPECT_EQ(header.stamp, 5000000007);
  EXPECT_EQ(header.frame, "map");
}

TEST(RosMessages, HeaderOfRos1HasASequenceNumberAndNoNul) {
  const OwnMessage message(cloud_topic, bytes_of_hex("09000000 05000000 07000000 03000000 6d6170"),
                           ros1);
  const MessageHeader header = decode_header(file, message);
  EXPECT_EQ(header.stamp, 5000000007);
  EXPECT_EQ(header.frame, "map");
}

TEST(RosMessages, StampsBefore1970AndBeyondTheLastSecondStayInRange) {
  const OwnMessage before(cloud_topic, bytes_of_hex("00010000 ffffffff 00000000 01000000 00"));
  EXPECT_EQ(decode_header(file, before).stamp, -1000000000);
  const OwnMessage beyond(cloud_topic, bytes_of_hex("00010000 ffffff7f ffffffff 01000000 00"));
  EXPECT_EQ(decode_header(file, beyond).stamp, 2147483647LL * 1000000000 + 4294967295LL);
}

/// In CDR a float64 begins at a multiple of 8 behind the representation: after "a" and "b" (6 bytes
/// each with length and NUL) there are gaps. ROS 1 has none.
TEST(RosMessages, TransformAlignedInCdr) {
  const OwnMessage message(
      tf_topic,
      bytes_of_hex(
          "00010000 01000000 05000000 00000000 02000000 6100 0000 02000000 6200 000000000000"
          "000000000000f03f 0000000000000040 0000000000000840"
          "0000000000000000 0000000000000000 0000000000000000 000000000000f03f"));
  const auto transforms = decode_transforms(file, message);
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(transforms[0].parent, "a");
  EXPECT_EQ(transforms[0].child, "b");
  EXPECT_EQ(transforms[0].stamp, 5000000000);
  EXPECT_EQ(transforms[0].translation, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(transforms[0].rotation, Eigen::Vector4d(0.0, 0.0, 0.0, 1.0));
  EXPECT_FALSE(transforms[0].is_static);
}

TEST(RosMessages, TransformPackedInRos1) {
  const OwnMessage message(
      tf_topic,
      bytes_of_hex("01000000 09000000 05000000 00000000 02000000 2f61 01000000 62"
                   "000000000000f03f 0000000000000040 0000000000000840"
                   "0000000000000000 0000000000000000 0000000000000000 000000000000f03f"),
      ros1);
  const auto transforms = decode_transforms(file, message);
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(transforms[0].parent, "a") << "without its slash";
  EXPECT_EQ(transforms[0].translation, Eigen::Vector3d(1.0, 2.0, 3.0));
}

// ---- Every encoding ---------------------------------------------------------------------------

class EveryEncoding : public testing::TestWithParam<Encoding> {};
INSTANTIATE_TEST_SUITE_P(RosMessages, EveryEncoding, testing::Values(cdr_little, cdr_big, ros1));

TEST_P(EveryEncoding, Points) {
  const OwnMessage message(cloud_topic, cloud_bytes(3, "lidar", three, 0, GetParam()), GetParam());
  const PointMessage cloud = decode_points(file, message);
  EXPECT_EQ(cloud.points, three);
  EXPECT_EQ(cloud.size, (FrameSize{3, 1}));
  EXPECT_EQ(decode_size(file, message), cloud.size);
  EXPECT_EQ(decode_header(file, message).frame, "lidar");
}

TEST_P(EveryEncoding, Livox) {
  const OwnMessage message(livox_topic, livox_bytes(3, "livox", three, GetParam()), GetParam());
  EXPECT_EQ(decode_points(file, message).points, three);
  EXPECT_EQ(decode_size(file, message), (FrameSize{3, 1}));
}

TEST_P(EveryEncoding, Depths) {
  const OwnMessage message(
      depth_topic, depth_bytes(3, "camera", 3, {1, 2, 3, 0, 5, 65535}, GetParam()), GetParam());
  const DepthMessage image = decode_depths(file, message);
  EXPECT_EQ(image.size, (FrameSize{3, 2}));
  EXPECT_FLOAT_EQ(image.depths[1], 0.002F);
  EXPECT_TRUE(std::isnan(image.depths[3]));
  EXPECT_FLOAT_EQ(image.depths[5], 65.535F);
}

TEST_P(EveryEncoding, Camera) {
  const OwnMessage message(
      camera_topic, camera_bytes({640, 480, 600.0, 590.0, {0.1, -0.2}}, GetParam()), GetParam());
  const CameraMessage camera = decode_camera(file, message);
  EXPECT_EQ(camera.size, (FrameSize{640, 480}));
  EXPECT_EQ(camera.distortion, (std::vector<double>{0.1, -0.2}));
  EXPECT_EQ(camera.intrinsics[4], 600.0);
  EXPECT_EQ(camera.rectified_projection[0], 590.0);
  EXPECT_EQ(camera.rectified_projection[6], 2.0);
}

TEST_P(EveryEncoding, Transforms) {
  const OwnMessage message(
      tf_topic,
      transform_bytes({{1, "map", "base"}, {2, "base", "x", {1.0, 2.0, 3.0}, {1.0, 0.0, 0.0, 0.0}}},
                      GetParam()),
      GetParam());
  const auto transforms = decode_transforms(file, message);
  ASSERT_EQ(transforms.size(), 2U);
  EXPECT_EQ(transforms[1].child, "x");
  EXPECT_EQ(transforms[1].translation.z(), 3.0);
  EXPECT_EQ(transforms[1].rotation.x(), 1.0);
}

TEST_P(EveryEncoding, Joints) {
  const OwnMessage message(joint_topic, joint_bytes(3, {{"boom", 0.5}, {"arm", -1.5}}, GetParam()),
                           GetParam());
  EXPECT_EQ(decode_joints(file, message),
            (std::vector<std::pair<std::string, double>>{{"boom", 0.5}, {"arm", -1.5}}));
}

// ---- Layouts of points ------------------------------------------------------------------------

struct Layout {
  std::array<std::uint32_t, 3> offset = {0, 4, 8};
  std::array<unsigned, 3> datatype = {7, 7, 7};
  std::uint32_t point_step = 12;
  std::uint32_t row_step = 24;
  std::uint32_t width = 2;
  std::uint32_t height = 1;
  bool big_endian = false;
  std::vector<std::string> names = {"x", "y", "z"};
};

std::string layout_bytes(const Layout& layout, const std::string& data) {
  RosBytes message(cdr_little);
  message.header(0, "lidar").u32(layout.height).u32(layout.width).u32(layout.names.size());
  for (std::size_t i = 0; i < layout.names.size(); ++i) {
    const std::size_t axis = std::min<std::size_t>(i, 2);
    message.text(layout.names[i]).u32(layout.offset[axis]).u8(layout.datatype[axis]).u32(1);
  }
  return message.u8(layout.big_endian ? 1 : 0)
      .u32(layout.point_step)
      .u32(layout.row_step)
      .data(data)
      .u8(1);
}

template <typename T>
void append(std::string& data, T value, bool big_endian = false) {
  RosBytes bytes(ros1);
  bytes.append(value, big_endian);
  data += bytes.bytes();
}

TEST(RosMessages, CoordinatesOfAnyTypeAtAnyPlaceInAnyOrder) {
  // z int16 at 1, x float64 at 3, y uint8 at 11, and two bytes that are no coordinate
  std::string data;
  for (const int i : {1, 2}) {
    append(data, std::uint8_t{99});
    append(data, static_cast<std::int16_t>(-300 * i));
    append(data, 0.1 * i);
    append(data, static_cast<std::uint8_t>(250 + i));
    append(data, std::uint8_t{99});
  }
  const Layout layout = {{1, 3, 11}, {3, 8, 2}, 13, 26, 2, 1, false, {"z", "x", "y"}};
  const OwnMessage message(cloud_topic, layout_bytes(layout, data));
  const Points points = decode_points(file, message).points;
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0], Eigen::Vector3d(0.1, 251.0, -300.0));
  EXPECT_EQ(points[1], Eigen::Vector3d(0.2, 252.0, -600.0));
}

TEST(RosMessages, BigEndianPointsInALittleEndianMessage) {
  std::string data;
  for (const float value : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}) append(data, value, true);
  Layout layout;
  layout.big_endian = true;
  const OwnMessage message(cloud_topic, layout_bytes(layout, data));
  EXPECT_EQ(decode_points(file, message).points, (Points{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}));
}

TEST(RosMessages, OrganisedPointsWithPaddedRows) {
  std::string data;
  for (const float row : {10.0F, 20.0F}) {
    for (const float column : {1.0F, 2.0F}) {
      for (const float axis : {0.1F, 0.2F, 0.3F}) append(data, row + column + axis);
    }
    if (row < 20.0F) data += "padding";  // none is needed behind the last row
  }
  Layout layout;
  layout.height = 2;
  layout.row_step = 31;
  const OwnMessage message(cloud_topic, layout_bytes(layout, data));
  const PointMessage cloud = decode_points(file, message);
  EXPECT_EQ(cloud.size, (FrameSize{2, 2}));
  ASSERT_EQ(cloud.points.size(), 4U);
  EXPECT_FLOAT_EQ(static_cast<float>(cloud.points[3].z()), 22.3F);
}

TEST(RosMessages, PointsAtTheOriginAndNanAreUnknown) {
  const OwnMessage message(
      cloud_topic, cloud_bytes(0, "lidar", {{0.0, -0.0, 0.0}, {0.0, 0.0, 1.0}, {nan, 1.0, 1.0}}));
  const Points points = decode_points(file, message).points;
  EXPECT_TRUE(points[0].array().isNaN().all());
  EXPECT_EQ(points[1], Eigen::Vector3d(0.0, 0.0, 1.0));
  EXPECT_TRUE(std::isnan(points[2].x()));
}

TEST(RosMessages, CloudsWithoutPoints) {
  const OwnMessage none(cloud_topic, cloud_bytes(0, "lidar", {}));
  EXPECT_TRUE(decode_points(file, none).points.empty());
  Layout rows_of_nothing;
  rows_of_nothing.width = 0;
  rows_of_nothing.height = 4294967295;
  const OwnMessage rows(cloud_topic, layout_bytes(rows_of_nothing, ""));
  EXPECT_TRUE(decode_points(file, rows).points.empty());
}

TEST(RosMessages, DepthsInMetres) {
  std::string data;
  for (const float value : {1.5F, 0.0F, std::numeric_limits<float>::infinity(), -1.0F}) {
    append(data, value, true);
  }
  const OwnMessage message(
      depth_topic,
      RosBytes(cdr_little).header(0, "camera").u32(2).u32(2).text("32FC1").u8(1).u32(8).data(data));
  const std::vector<float> depths = decode_depths(file, message).depths;
  EXPECT_EQ(depths[0], 1.5F);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_TRUE(std::isnan(depths[i])) << i;
}

TEST(RosMessages, JointsWithoutPositionsAreNone) {
  const OwnMessage message(joint_topic,
                           RosBytes(cdr_little).header(0, "").u32(1).text("boom").u32(0).u32(0));
  EXPECT_TRUE(decode_joints(file, message).empty());
}

TEST(RosMessages, StaticTransformsByTheNameOfTheTopic) {
  const RecordedTopic topic = {"/robot/tf_static", tf_topic.type};
  const OwnMessage message(topic, transform_bytes({{1, "/map", "/base"}}));
  const auto transforms = decode_transforms(file, message);
  EXPECT_TRUE(transforms.at(0).is_static);
  EXPECT_EQ(transforms.at(0).child, "base");
}

// ---- Messages that are wrong ------------------------------------------------------------------

TEST(RosMessages, ErrorsSayWhatWasFoundAndExpected) {
  const auto of_layout = [](const Layout& layout) {
    return error_of_message(cloud_topic, layout_bytes(layout, std::string(24, '\1')));
  };
  Layout layout;
  layout.width = 3;
  EXPECT_EQ(of_layout(layout), "found 24 bytes of data, expected 3 x 1 points of 12 bytes");
  layout = {};
  layout.height = 2;
  layout.row_step = 23;
  EXPECT_EQ(of_layout(layout), "found rows of 23 bytes, expected 24 for 2 points of 12 bytes");
  layout = {};
  layout.offset[1] = 9;
  EXPECT_EQ(of_layout(layout),
            "found points of 12 bytes, expected 4 bytes of a coordinate at byte 9");
  layout = {};
  layout.datatype[2] = 9;
  EXPECT_EQ(of_layout(layout), "found datatype 9 of field z, expected 1 to 8");
  layout = {};
  layout.names = {"x", "y"};
  EXPECT_EQ(of_layout(layout), "found field z 0 times, expected x, y and z once each");
  layout.names = {"x", "y", "z", "x"};
  EXPECT_EQ(of_layout(layout), "found field x 2 times, expected x, y and z once each");
}

TEST(RosMessages, RepresentationsOtherThanPlainCdrAreRefused) {
  for (const char* const head : {"00020000", "00070000", "000b0000", "01010000"}) {
    expect_begins(error_of_message(cloud_topic, bytes_of_hex(head)), "found the representation ");
  }
}

TEST(RosMessages, ImagesThatHoldNoDepths) {
  const std::string bytes =
      RosBytes(cdr_little).header(0, "camera").u32(1).u32(1).text("rgb8").u8(0).u32(3).data("abc");
  EXPECT_EQ(error_of_message(depth_topic, bytes),
            "found an image of encoding 'rgb8', expected depths as 16UC1, mono16 or 32FC1");
}

TEST(RosMessages, LivoxCountsMustAgree) {
  const std::string bytes =
      RosBytes(cdr_little).header(0, "livox").put(std::uint64_t{0}).u32(2).raw({0, 0, 0, 0}).u32(0);
  EXPECT_EQ(error_of_message(livox_topic, bytes), "found 0 points, expected point_num = 2");
}

TEST(RosMessages, JointsNeedAPositionEach) {
  const std::string bytes =
      RosBytes(cdr_little).header(0, "").u32(2).text("a").text("b").u32(1).put(1.0).u32(0).u32(0);
  EXPECT_EQ(error_of_message(joint_topic, bytes),
            "found 1 positions, expected 2, one for each name, or none");
}

std::map<const RecordedTopic*, std::string> whole_messages(Encoding encoding) {
  return {{&cloud_topic, cloud_bytes(1, "lidar", three, 0, encoding)},
          {&livox_topic, livox_bytes(1, "livox", three, encoding)},
          {&depth_topic, depth_bytes(1, "camera", 2, {1, 2, 3, 4}, encoding)},
          {&camera_topic, camera_bytes({4, 3, 5.0, 5.0, {0.1}}, encoding)},
          {&tf_topic, transform_bytes({{1, "map", "base"}, {1, "base", "lidar"}}, encoding)},
          {&joint_topic, joint_bytes(1, {{"boom", 1.0}, {"arm", 2.0}}, encoding)}};
}

/// Up to the end of what is read; behind it lie fields that nobody needs.
std::size_t needed_bytes(const RecordedTopic& topic, const std::string& bytes, Encoding encoding) {
  std::size_t needed = bytes.size();
  while (needed > 0 &&
         error_of_message(topic, bytes.substr(0, needed - 1), encoding) == "no error") {
    --needed;
  }
  return needed;
}

TEST_P(EveryEncoding, MessagesThatEndEarly) {
  std::size_t malformed = 0;
  for (const auto& [topic, bytes] : whole_messages(GetParam())) {
    EXPECT_EQ(error_of_message(*topic, bytes, GetParam()), "no error") << topic->name;
    const std::size_t needed = needed_bytes(*topic, bytes, GetParam());
    EXPECT_GT(needed, bytes.size() / 2) << topic->name;
    for (std::size_t size = 0; size < needed; ++size, ++malformed) {
      expect_begins(error_of_message(*topic, bytes.substr(0, size), GetParam()), "found ");
    }
  }
  EXPECT_GT(malformed, 500U);
}

/// Numbers that promise more than there is, at every place of every message.
TEST_P(EveryEncoding, LengthsOfAnySizeNeverReadBeyondTheMessage) {
  for (const auto& [topic, bytes] : whole_messages(GetParam())) {
    for (std::size_t at = 0; at + 4 <= bytes.size(); ++at) {
      for (const char value : {'\xFF', '\x7F', '\x80', '\0', '\x10'}) {
        std::string changed = bytes;
        changed.replace(at, 4, 4, value);
        error_of_message(*topic, changed, GetParam());
      }
    }
  }
}

TEST_P(EveryEncoding, MutatedMessages) {
  std::mt19937 random(7);
  for (const auto& [topic, bytes] : whole_messages(GetParam())) {
    for (int round = 0; round < 2000; ++round) {
      std::string changed = bytes;
      for (auto changes = random() % 4 + 1; changes > 0; --changes) {
        const std::size_t at = random() % changed.size();
        const unsigned long to = random();
        changed[at] = static_cast<char>(to % 256);
        if (to % 7 == 0) changed.resize(at + 1);
      }
      error_of_message(*topic, changed, GetParam());
    }
  }
}

TEST(RosMessages, UsesByType) {
  EXPECT_EQ(use_of("tf/msg/tfMessage"), MessageUse::transforms);
  EXPECT_EQ(use_of("livox_ros_driver/msg/CustomMsg"), MessageUse::points);
  EXPECT_EQ(use_of("sensor_msgs/msg/CompressedImage"), MessageUse::compressed);
  EXPECT_EQ(use_of("sensor_msgs/msg/Imu"), MessageUse::none);
  EXPECT_EQ(use_of(""), MessageUse::none);
}

}  // namespace
}  // namespace excavplan::test
