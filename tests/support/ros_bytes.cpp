// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/ros_bytes.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace excavplan::test {

std::string cloud_bytes(std::int64_t stamp, const std::string& frame, const Points& points,
                        std::size_t width, Encoding encoding) {
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

std::string depth_bytes(std::int64_t stamp, const std::string& frame, std::size_t width,
                        const std::vector<std::uint16_t>& counts, Encoding encoding) {
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

std::string camera_bytes(const CameraNumbers& camera, Encoding encoding) {
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

std::string transform_bytes(const std::vector<TransformNumbers>& transforms, Encoding encoding) {
  RosBytes message(encoding);
  message.u32(transforms.size());
  for (const TransformNumbers& transform : transforms) {
    message.header(transform.stamp, transform.parent).text(transform.child);
    for (int i = 0; i < 3; ++i) message.put(transform.translation[i]);
    for (int i = 0; i < 4; ++i) message.put(transform.rotation[i]);
  }
  return message;
}

std::string joint_bytes(std::int64_t stamp,
                        const std::vector<std::pair<std::string, double>>& joints,
                        Encoding encoding) {
  RosBytes message(encoding);
  message.header(stamp, "").u32(joints.size());
  for (const auto& joint : joints) message.text(joint.first);
  message.u32(joints.size());
  for (const auto& joint : joints) message.put(joint.second);
  return message.u32(0).u32(0);
}

std::string livox_bytes(std::int64_t stamp, const std::string& frame, const Points& points,
                        Encoding encoding) {
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
