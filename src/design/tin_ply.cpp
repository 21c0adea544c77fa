// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "design/tin_ply.hpp"

#include <cstdint>

#include "base/scalar.hpp"

namespace excavplan {

std::string ply_of(const Tin& tin) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(tin.points.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(tin.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3d& point : tin.points) {
    for (const double value : {point.x(), point.y(), point.z()}) put(value, bytes);
  }
  for (const auto& triangle : tin.triangles) {
    put(std::uint8_t{3}, bytes);
    for (const std::uint32_t corner : triangle) put(static_cast<std::int32_t>(corner), bytes);
  }
  return bytes;
}

}  // namespace excavplan
