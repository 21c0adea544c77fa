// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "recording/recording_file.hpp"

namespace excavplan::test {

/// How a message is written.
struct Encoding {
  Serialization serialization = Serialization::cdr;
  bool big_endian = false;
};
constexpr Encoding cdr_little = {Serialization::cdr, false};
constexpr Encoding cdr_big = {Serialization::cdr, true};
constexpr Encoding ros1 = {Serialization::ros1, false};

/// Writes the fields of a message one after the other.
class RosBytes {
 public:
  explicit RosBytes(Encoding encoding) : encoding_(encoding) {
    if (is_cdr()) bytes_ = {'\0', encoding.big_endian ? '\0' : '\1', '\0', '\0'};
  }
  template <typename T>
  RosBytes& put(T value) {
    while (is_cdr() && (bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\0';
    append(value, encoding_.big_endian);
    return *this;
  }
  RosBytes& u8(unsigned value) { return put(static_cast<std::uint8_t>(value)); }
  RosBytes& u32(std::size_t value) { return put(static_cast<std::uint32_t>(value)); }
  RosBytes& text(const std::string& value) {
    u32(value.size() + (is_cdr() ? 1 : 0));
    bytes_ += value;
    if (is_cdr()) bytes_ += '\0';
    return *this;
  }
  RosBytes& raw(const std::string& value) {
    bytes_ += value;
    return *this;
  }
  RosBytes& data(const std::string& value) { return u32(value.size()).raw(value); }
  RosBytes& header(std::int64_t stamp, const std::string& frame) {
    if (!is_cdr()) u32(7);
    return u32(static_cast<std::size_t>(stamp / 1000000000))
        .u32(static_cast<std::size_t>(stamp % 1000000000))
        .text(frame);
  }
  template <typename T>
  void append(T value, bool big_endian) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, raw.size());
    if (big_endian) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
  }
  const std::string& bytes() const { return bytes_; }
  operator std::string() const { return bytes_; }

 private:
  bool is_cdr() const { return encoding_.serialization == Serialization::cdr; }
  Encoding encoding_;
  std::string bytes_;
};

using Points = std::vector<Eigen::Vector3d>;

/// x, y, z as float32, 4 bytes of padding each, in one row or rows of `width`.
inline std::string cloud_bytes(std::int64_t stamp, const std::string& frame, const Points& points,
                               std::size_t width = 0, Encoding encoding = cdr_little) {
  if (width == 0) width = points.size();
  RosBytes message(encoding);
  message.header(stamp, frame).u32(width == 0 ? 0 : points.size() / width).u32(width).u32(3);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    message.text(std::string(1, "xyz"[axis])).u32(4 * axis).u8(7).u32(1);
  }
  RosBytes data({Serialization::ros1, false});
  for (const Eigen::Vector3d& point : points) {
    for (int axis = 0; axis < 3; ++axis) data.append(static_cast<float>(point[axis]), false);
    data.append(std::uint32_t{0xFFFFFFFF}, false);
  }
  return message.u8(0).u32(16).u32(16 * width).data(data).u8(1);
}

/// 16UC1 [mm] or another encoding of 16 bits.
inline std::string depth_bytes(std::int64_t stamp, const std::string& frame, std::size_t width,
                               const std::vector<std::uint16_t>& counts,
                               Encoding encoding = cdr_little) {
  RosBytes data({Serialization::ros1, false});
  for (const std::uint16_t count : counts) data.append(count, false);
  return RosBytes(encoding)
      .header(stamp, frame)
      .u32(counts.size() / width)
      .u32(width)
      .text("16UC1")
      .u8(0)
      .u32(2 * width)
      .data(data);
}

struct CameraNumbers {
  std::size_t width = 0;
  std::size_t height = 0;
  double focal = 0.0;            ///< of K [pixel]
  double rectified_focal = 0.0;  ///< of P [pixel]
  std::vector<double> distortion = {};
};

/// With the centre at (1, 1) in K and at (2, 2) in P.
inline std::string camera_bytes(const CameraNumbers& camera, Encoding encoding = cdr_little) {
  RosBytes message(encoding);
  message.header(0, "camera").u32(camera.height).u32(camera.width).text("plumb_bob");
  message.u32(camera.distortion.size());
  for (const double value : camera.distortion) message.put(value);
  for (const double value : {camera.focal, 0.0, 1.0, 0.0, camera.focal, 1.0, 0.0, 0.0, 1.0}) {
    message.put(value);
  }
  for (const double value : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) message.put(value);
  const double f = camera.rectified_focal;
  for (const double value : {f, 0.0, 2.0, 0.0, 0.0, f, 2.0, 0.0, 0.0, 0.0, 1.0, 0.0}) {
    message.put(value);
  }
  for (int i = 0; i < 6; ++i) message.u32(0);
  return message.u8(0);
}

struct TransformNumbers {
  std::int64_t stamp = 0;
  std::string parent;
  std::string child;
  Eigen::Vector3d translation = {0.0, 0.0, 0.0};
  Eigen::Vector4d rotation = {0.0, 0.0, 0.0, 1.0};  ///< x, y, z, w
};

inline std::string transform_bytes(const std::vector<TransformNumbers>& transforms,
                                   Encoding encoding = cdr_little) {
  RosBytes message(encoding);
  message.u32(transforms.size());
  for (const TransformNumbers& transform : transforms) {
    message.header(transform.stamp, transform.parent).text(transform.child);
    for (int i = 0; i < 3; ++i) message.put(transform.translation[i]);
    for (int i = 0; i < 4; ++i) message.put(transform.rotation[i]);
  }
  return message;
}

inline std::string joint_bytes(std::int64_t stamp,
                               const std::vector<std::pair<std::string, double>>& joints,
                               Encoding encoding = cdr_little) {
  RosBytes message(encoding);
  message.header(stamp, "").u32(joints.size());
  for (const auto& joint : joints) message.text(joint.first);
  message.u32(joints.size());
  for (const auto& joint : joints) message.put(joint.second);
  return message.u32(0).u32(0);
}

/// livox_ros_driver2/CustomMsg.
inline std::string livox_bytes(std::int64_t stamp, const std::string& frame, const Points& points,
                               Encoding encoding = cdr_little) {
  RosBytes message(encoding);
  message.header(stamp, frame).put(std::uint64_t{5}).u32(points.size()).raw({1, 0, 0, 0});
  message.u32(points.size());
  for (const Eigen::Vector3d& point : points) {
    message.u32(100);
    for (int axis = 0; axis < 3; ++axis) message.put(static_cast<float>(point[axis]));
    message.u8(40).u8(16).u8(2);
  }
  return message;
}

}  // namespace excavplan::test
