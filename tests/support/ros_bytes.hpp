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
std::string cloud_bytes(std::int64_t stamp, const std::string& frame, const Points& points,
                        std::size_t width = 0, Encoding encoding = cdr_little);

/// 16UC1 [mm] or another encoding of 16 bits.
std::string depth_bytes(std::int64_t stamp, const std::string& frame, std::size_t width,
                        const std::vector<std::uint16_t>& counts, Encoding encoding = cdr_little);

struct CameraNumbers {
  std::size_t width = 0;
  std::size_t height = 0;
  double focal = 0.0;            ///< of K [pixel]
  double rectified_focal = 0.0;  ///< of P [pixel]
  std::vector<double> distortion = {};
};

/// With the centre at (1, 1) in K and at (2, 2) in P.
std::string camera_bytes(const CameraNumbers& camera, Encoding encoding = cdr_little);

struct TransformNumbers {
  std::int64_t stamp = 0;
  std::string parent;
  std::string child;
  Eigen::Vector3d translation = {0.0, 0.0, 0.0};
  Eigen::Vector4d rotation = {0.0, 0.0, 0.0, 1.0};  ///< x, y, z, w
};

std::string transform_bytes(const std::vector<TransformNumbers>& transforms,
                            Encoding encoding = cdr_little);

std::string joint_bytes(std::int64_t stamp,
                        const std::vector<std::pair<std::string, double>>& joints,
                        Encoding encoding = cdr_little);

/// livox_ros_driver2/CustomMsg.
std::string livox_bytes(std::int64_t stamp, const std::string& frame, const Points& points,
                        Encoding encoding = cdr_little);

}  // namespace excavplan::test
