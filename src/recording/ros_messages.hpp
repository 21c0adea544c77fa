// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "recording/recording_file.hpp"

/// @file What the messages of ROS 1 and ROS 2 say, from their bytes. Private to the library.
///
/// ROS 2: CDR of the OMG (DDSI-RTPS 2.3, 10; CORBA 3.3 part 2, 9.3), version 1, plain, big and
/// little endian. ROS 1: its own serialization (wiki.ros.org/msg), packed, little endian. The
/// fields are those of sensor_msgs, tf2_msgs and livox_ros_driver(2).
///
/// Every function throws Error (bad_file) "file: message 17 of /topic at 12.5 s: found X, expected
/// Y" if the message ends before its fields do or says what cannot be.

namespace excavplan {

/// What a topic of this type is good for here.
enum class MessageUse { none, points, depth, compressed, camera, transforms, joints };
MessageUse use_of(const std::string& type);

/// std_msgs/Header.
struct MessageHeader {
  std::int64_t stamp = 0;  ///< when it was measured, by the clock of who measured [ns since 1970]
  std::string frame;       ///< without the leading "/" of old ROS 1
};
/// Of any message that begins with one: all that MessageUse names but transforms.
MessageHeader decode_header(const std::string& file, const RecordedMessage& message);

/// Width and height of points or of an image, read without them; 1 high unless organised.
struct FrameSize {
  std::size_t width = 0;
  std::size_t height = 1;
  bool operator==(const FrameSize& other) const {
    return width == other.width && height == other.height;
  }
  std::size_t pixels() const { return width * height; }  ///< fits: the message holds them
};

/// sensor_msgs/PointCloud2, livox_ros_driver/CustomMsg.
struct PointMessage {
  FrameSize size;
  /// Row by row [m]; NaN where the message holds exactly (0, 0, 0), as drivers write where nothing
  /// came back.
  std::vector<Eigen::Vector3d> points;
};
PointMessage decode_points(const std::string& file, const RecordedMessage& message);

constexpr double millimetre = 0.001;  ///< [m]

/// sensor_msgs/Image with depths: 16UC1 and mono16 in counts of a unit (REP 118: 1 mm), 32FC1 [m];
/// sensor_msgs/CompressedImage of PNG: 16UC1, as it is or after the header of compressedDepth
/// (compressed_depth_image_transport), and 32FC1 after that header, as inverse depths.
struct DepthMessage {
  FrameSize size;
  std::vector<float> depths;  ///< row by row [m]; NaN where the message holds 0, NaN or infinity
  bool is_counted = false;    ///< in counts of the unit
};
DepthMessage decode_depths(const std::string& file, const RecordedMessage& message,
                           double unit = millimetre);

/// Width and height of what decode_points() and decode_depths() read, which has room for all of it.
FrameSize decode_size(const std::string& file, const RecordedMessage& message);

/// sensor_msgs/CameraInfo.
struct CameraMessage {
  FrameSize size;
  std::vector<double> distortion;                     ///< D
  Eigen::Matrix<double, 9, 1> intrinsics;             ///< K by rows, of the raw image [pixel]
  Eigen::Matrix<double, 12, 1> rectified_projection;  ///< P by rows, of the rectified image [pixel]
};
CameraMessage decode_camera(const std::string& file, const RecordedMessage& message);

/// geometry_msgs/TransformStamped: p_parent = rotation p_child + translation.
struct StampedTransform {
  std::string parent;
  std::string child;
  std::int64_t stamp = 0;                           ///< [ns since 1970]
  Eigen::Vector4d rotation = {0.0, 0.0, 0.0, 1.0};  ///< quaternion x, y, z, w as recorded
  Eigen::Vector3d translation = {0.0, 0.0, 0.0};    ///< [m]
  bool is_static = false;
  std::int64_t delay = 0;  ///< from the stamp to the recording [ns]; set by who reads it
};
/// True if the name of a topic ends in "tf_static".
bool holds_static_transforms(const std::string& topic);
/// tf2_msgs/TFMessage and tf/tfMessage.
std::vector<StampedTransform> decode_transforms(const std::string& file,
                                                const RecordedMessage& message);

/// Names and positions [rad; m of a sliding joint] of sensor_msgs/JointState.
std::vector<std::pair<std::string, double>> decode_joints(const std::string& file,
                                                          const RecordedMessage& message);

}  // namespace excavplan
