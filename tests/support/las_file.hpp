// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <Eigen/Core>

/// @file LAS files, laid byte by byte from the tables of the ASPRS LAS Specification 1.4 - R15, as
/// no packaged program writes LAS.

namespace excavplan::test {

struct LasPoint {
  std::array<std::int32_t, 3> xyz{};
  int kind = 2;  ///< classification: ground
  bool withheld = false;
};

/// What a LAS file says; `bytes()` lays it.
struct LasFile {
  int minor = 2;
  int format = 0;
  std::vector<LasPoint> points = {{{1000, 2000, 3000}}, {{-4000, 5500, 60000}}};
  Eigen::Array3d scale = {0.001, 0.001, 0.001};
  Eigen::Array3d offset = {0.0, 0.0, 0.0};
  std::vector<std::string> records = {};   ///< contents of variable length records
  std::vector<std::string> extended = {};  ///< of those behind the points, from 1.4
  std::string record_user = "LASF_Projection";
  int record_kind = 34735;      ///< GeoKeyDirectoryTag
  std::size_t extra_bytes = 0;  ///< behind the fields of a point
  std::size_t more_header = 0;  ///< behind the fields of the header
  bool has_old_count = true;    ///< since 1.4 it may be 0

  std::string bytes() const {
    constexpr std::array<std::size_t, 5> header_sizes = {227, 227, 227, 235, 375};
    constexpr std::array<std::size_t, 11> sizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    const std::size_t header_size = header_sizes[static_cast<std::size_t>(minor)] + more_header;
    const std::size_t row = sizes[static_cast<std::size_t>(format)] + extra_bytes;
    std::size_t points_at = header_size;
    for (const std::string& record : records) points_at += 54 + record.size();

    std::string out(header_size, '\0');
    out.replace(0, 4, "LASF");
    put<std::uint8_t>(out, 24, 1);
    put(out, 25, static_cast<std::uint8_t>(minor));
    put(out, 94, static_cast<std::uint16_t>(header_size));
    put(out, 96, static_cast<std::uint32_t>(points_at));
    put(out, 100, static_cast<std::uint32_t>(records.size()));
    put(out, 104, static_cast<std::uint8_t>(format));
    put(out, 105, static_cast<std::uint16_t>(row));
    put(out, 107, static_cast<std::uint32_t>(has_old_count ? points.size() : 0));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(out, 131 + 8 * axis, scale[static_cast<Eigen::Index>(axis)]);
      put(out, 155 + 8 * axis, offset[static_cast<Eigen::Index>(axis)]);
    }
    if (minor >= 4) {
      put(out, 235,
          static_cast<std::uint64_t>(extended.empty() ? 0 : points_at + points.size() * row));
      put(out, 243, static_cast<std::uint32_t>(extended.size()));
      put(out, 247, static_cast<std::uint64_t>(points.size()));
    }
    for (const std::string& record : records) out += record_of(record, false);
    for (const LasPoint& point : points) out += point_of(point, row);
    for (const std::string& record : extended) out += record_of(record, true);
    return out;
  }

  /// Writes a number over bytes of a file.
  template <typename T>
  static void put(std::string& bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  }

 private:
  std::string point_of(const LasPoint& point, std::size_t row) const {
    std::string bytes(row, '\x5A');
    for (std::size_t axis = 0; axis < 3; ++axis) put(bytes, 4 * axis, point.xyz[axis]);
    if (format < 6) {
      put(bytes, 15, static_cast<std::uint8_t>(point.kind | (point.withheld ? 128 : 0)));
    } else {
      put(bytes, 15, static_cast<std::uint8_t>(point.withheld ? 4 : 0));
      put(bytes, 16, static_cast<std::uint8_t>(point.kind));
    }
    return bytes;
  }
  std::string record_of(const std::string& content, bool is_extended) const {
    std::string head(is_extended ? 60 : 54, '\0');
    head.replace(2, record_user.size(), record_user);
    put(head, 18, static_cast<std::uint16_t>(record_kind));
    if (is_extended) {
      put(head, 20, static_cast<std::uint64_t>(content.size()));
    } else {
      put(head, 20, static_cast<std::uint16_t>(content.size()));
    }
    return head + content;
  }
};

}  // namespace excavplan::test
