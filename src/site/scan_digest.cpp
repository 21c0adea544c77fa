// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/scan_digest.hpp"

#include <algorithm>
#include <cstdint>

#include "base/input_file.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr std::size_t part_bytes = std::size_t{1} << 20;

std::string digest_of_file(const std::string& path) {
  const InputFile file(path);
  std::string digests;
  std::string part;
  for (std::uint64_t at = 0; at < file.size(); at += part.size()) {
    part.resize(std::min<std::uint64_t>(part_bytes, file.size() - at));
    file.read(at, part.data(), part.size());
    digests += checksum_text(part);
  }
  return checksum_text(digests);
}

std::string digest_of_cloud(const Cloud& cloud) {
  std::string bytes;
  bytes.reserve(cloud.points.size() * sizeof(Eigen::Vector3d));
  for (const Eigen::Vector3d& point : cloud.points) {
    bytes.append(reinterpret_cast<const char*>(point.data()), sizeof(Eigen::Vector3d));
  }
  return checksum_text(bytes);
}

}  // namespace

std::string scan_digest(const Scan& scan) {
  std::string digests;
  for (const std::string& file : scan.files) digests += digest_of_file(file);
  for (const auto& cloud : scan.clouds) digests += digest_of_cloud(*cloud);
  return checksum_text(digests);
}

}  // namespace excavplan
